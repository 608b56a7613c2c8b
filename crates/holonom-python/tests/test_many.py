"""Many models: in threads, and one after the other in the same memory."""

import gc
import os
import pathlib
from concurrent.futures import ThreadPoolExecutor

import pytest

import holonom as hm

STATM = pathlib.Path("/proc/self/statm")


def bits(run):
    return b"".join(run[name].tobytes() for name in run.columns)


def test_simulations_in_threads_have_the_bits_that_they_have_alone():
    model = hm.load("example:four-bar")
    model.function("lag", lambda x: -0.1 * x)
    model.expression("air", point="P[1]", force=["lag('P[1].vx')", "lag('P[1].vy')"])

    def simulate(k):
        return bits(model.simulate(end=0.05, set={"bar.horizontal.mass": 1 + k / 60}))

    def step(k):
        sim = hm.Simulation(model, step=0.01, set={"bar.horizontal.mass": 1 + k / 60})
        sim.step(5)
        return sim["P[1].x"], sim["energy"]

    for work in (simulate, step):
        with ThreadPoolExecutor(8) as threads:
            together = list(threads.map(work, range(60)))
        assert together == [work(k) for k in range(60)]
        assert len(set(together)) == 60


def one_of_many():
    m = hm.Model(gravity=[0, 0, -9.81])
    m.input("push")
    p = m.point("p", mass=1, position=[0, 0, 0])
    # The function holds the model, which holds the function.
    f = m.function("f", lambda y: -y * len(m))
    m.expression("motor", point=p, force=["push", f("p.y"), 0])
    run = m.simulate(end=0.03, step=0.01)
    assert len(run[p].position) == len(run) and run.summary["status"] == "completed"
    sim = hm.Simulation(m, step=0.01)
    sim.step(3)
    sim.set_state(sim.state())
    with pytest.raises(hm.ModelError):
        m.point("p", mass=1)


@pytest.mark.skipif(not STATM.exists(), reason="the system does not tell its memory so")
def test_models_leave_no_memory_behind():
    def resident():
        gc.collect()
        return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def build(count):
        for _ in range(count):
            one_of_many()

    build(100)
    before = resident()
    build(200)
    # A model with its run takes tens of kilobytes.
    assert resident() - before < 200 * 10_000
