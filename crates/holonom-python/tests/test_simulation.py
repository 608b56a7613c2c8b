"""Simulations that a program steps."""

import copy
import pickle
import threading
import time

import numpy as np
import pytest

import holonom as hm


def trolley(**how):
    """A mass on a rail, pushed by an input."""
    m = hm.Model(gravity=[0, 0, 0])
    m.input("push", default=0, unit="N")
    m.point("p", mass=2, position=[0, 0, 0])
    m.expression("push-force", point="p", force=["push", 0, 0])
    m.measure("fastest", value="max(p.vx)", unit="m/s")
    return hm.Simulation(m, step=0.1, **how)


def test_stepping_gives_the_bits_of_a_run():
    model = hm.load("example:four-bar")
    run, sim = model.simulate(end=0.5, step=0.01), hm.Simulation(model, step=0.01)
    assert sim.columns == run.columns
    skipped = {"dE_integrator", "dE_projection"}
    for k in range(len(run)):
        assert all(sim[name] == run[name][k] or np.isnan(run[name][k]) for name in run.columns if name not in skipped)
        sim.step()


def test_inputs_count_from_the_next_step_on():
    sim = trolley()
    assert dict(sim.inputs) == {"push": 0}
    for _ in range(10):
        sim.step()
    sim.inputs["push"] = 4
    assert sim.step(5) and sim.time == pytest.approx(1.5) and sim.steps == 15
    # a = F/m = 2 m/s² for half a second
    assert sim["p.vx"] == pytest.approx(1) and sim["p.x"] == pytest.approx(0.25)
    sim.inputs["push"] = -8
    sim.step(5)
    assert sim["p.vx"] == pytest.approx(-1) and sim["fastest"] == pytest.approx(1)
    assert sim.inputs["push"] == sim["push"] == -8


@pytest.mark.parametrize("method", [None, "generalized-alpha", "radau"])
def test_a_state_goes_on_to_the_same_bits(method):
    sim = hm.Simulation(hm.load("example:four-bar"), step=0.01, method=method)
    sim.step(20)
    state = sim.state()

    def follow(sim):
        rows = []
        for _ in range(20):
            assert sim.step()
            rows.append([sim[name] for name in sim.columns])
        return np.array(rows).tobytes()

    first = follow(sim)
    other = hm.Simulation(hm.load("example:four-bar"), step=0.01, method=method)
    again = pickle.loads(pickle.dumps(state))
    assert again == state and again.time == state.time == pytest.approx(0.2)
    for simulation in (sim, other):
        simulation.set_state(again)
        assert simulation.time == state.time
        assert follow(simulation) == first


def test_running_measures_are_part_of_the_state():
    sim = trolley()
    sim.inputs["push"] = 2
    sim.step(10)
    state = sim.state()
    sim.inputs["push"] = 20
    sim.step(10)
    assert sim["fastest"] > 5
    sim.set_state(state)
    sim.inputs["push"] = -2
    sim.step(5)
    assert sim["fastest"] == pytest.approx(1) and sim["p.vx"] == pytest.approx(0.5)


def test_a_simulation_says_why_it_ended():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", mass=1, position=[0, 0, 0], velocity=[1, 0, 0])
    m.event("arrived", when="p.x - 0.25", stop=True)
    sim = hm.Simulation(m, step=0.1)
    steps = 0
    while sim.step():
        steps += 1
    assert steps == 2 and sim.time == pytest.approx(0.25) and "`arrived`" in sim.ended
    assert sim.step() and sim.ended is None


def test_others_read_a_simulation_while_a_thread_takes_many_steps():
    sim = hm.Simulation(hm.load("example:robot-arm"))
    begun = time.perf_counter()
    sim.step(100)
    count = int(200 / (time.perf_counter() - begun))
    # Two seconds of steps.
    thread = threading.Thread(target=sim.step, args=(count,))
    thread.start()
    waits = []
    while thread.is_alive():
        begun = time.perf_counter()
        assert sim.time >= 0
        waits.append(time.perf_counter() - begun)
    assert max(waits) < 0.5 and sim.steps == 100 + count


@pytest.mark.parametrize("name, value", [("inputs", {"push": 4}), ("step", 0.01), ("input", {"push": 4}), ("ended", None)])
def test_what_would_cut_off_a_simulation_is_not_set(name, value):
    sim = trolley()
    with pytest.raises(AttributeError, match=name):
        setattr(sim, name, value)
    sim.inputs["push"] = 4
    assert sim.step(10) and sim["p.vx"] == pytest.approx(2)


def test_a_class_of_its_own_may_step_otherwise():
    class Twice(hm.Simulation):
        def step(self, count=1):
            return super().step(2 * count)

    sim = Twice(hm.load("example:double-pendulum"), step=0.01)
    sim.step()
    assert sim.steps == 2


def test_an_accuracy_is_that_of_each_nominal_step():
    """What the chapter says to do for an accuracy at the end."""
    model, end, step, accuracy = hm.load("example:double-pendulum"), 2, 0.01, 1e-6
    truth = model.simulate(end=end, step=step, accuracy=1e-11, method="radau")
    sim = hm.Simulation(model, step=step, accuracy=accuracy * step / end)
    sim.step(round(end / step))
    size = 2
    assert max(abs(sim[name] - truth[name][-1]) for name in truth if name.endswith((".x", ".z"))) < accuracy * size


def test_a_simulation_has_no_end():
    sim = hm.Simulation(hm.load("example:double-pendulum"), step=0.01, end=0.05)
    assert sim.step(10) and sim.ended is None and sim.time == pytest.approx(0.1)


def test_columns_are_looked_for_and_listed_by_their_names():
    model = hm.load("example:double-pendulum")
    run, sim = model.simulate(end=0.1, step=0.01), hm.Simulation(model, step=0.01)
    study = hm.sweep(model, {"simulation.end": [0.1, 0.2]}, step=0.01)
    for one in (run, sim, study):
        assert list(one) == one.columns and "energy" in one and "energie" not in one and 0 not in one


def test_without_forces_of_joints_there_are_none():
    m = hm.load("example:four-bar")
    m.output(reactions=False)
    sim = hm.Simulation(m)
    sim.step()
    assert sim.columns == m.simulate(end=0.1).columns
    with pytest.raises(KeyError):
        sim["no.column"]


def test_forces_are_found_when_they_are_looked_at():
    model = hm.load("example:slider-crank")
    run, sim = model.simulate(end=0.5, step=0.005), hm.Simulation(model, step=0.005)
    forces = [name for name in run.columns if name.rsplit(".")[-1] in ("fx", "fy", "fz", "ax", "ay")]
    largest = max(abs(run[name]).max() for name in forces)
    for k in range(0, len(run), 10):
        motion = [name for name in run.columns if name.rsplit(".")[-1] in ("x", "y", "vx", "vy")]
        assert [sim[name] for name in motion] == [run[name][k] for name in motion]
        assert max(abs(sim[name] - run[name][k]) for name in forces) < 1e-11 * largest
        sim.step(10)


def test_an_input_counts_at_once_for_forces():
    m = hm.Model(gravity=[0, 0, 0])
    m.input("push", unit="N")
    cart = m.body("cart", mass=2, inertia=[1, 1, 1], position=[0, 0, 0], points={"middle": [0, 0, 0]})
    m.prismatic("rail", m.ground, cart, at=[0, 0, 0], axis=[1, 0, 0])
    m.expression("across", point=cart["middle"], force=[0, "push", 0])
    sim = hm.Simulation(m, step=0.1)
    sim.step()
    assert sim["rail.fy"] == pytest.approx(0, abs=1e-12)
    sim.inputs["push"] = 3
    assert sim["rail.fy"] == pytest.approx(-3)


LANDING = """
plane = "xz"
gravity = [0, -10]
[point.p]
mass = 1
position = [0, 5]
[input.F]
[event.land]
when = "p.z"
stop = true
[event.mark]
when = "p.z"
set = { F = 2 }
"""


@pytest.mark.parametrize("step", [0.01, 0.013, 0.1, 0.3])
def test_an_event_ends_a_simulation_that_is_stepped(step):
    sim = hm.Simulation(hm.loads(LANDING), step=step)
    for _ in range(1000):
        if not sim.step():
            break
    assert (sim.event, sim.ended) == ("land", "ended by the event `land`")
    assert sim.time == pytest.approx(1, abs=1e-9)


TRIP = """
plane = "xz"
[body.arm]
mass = 2
inertia = 0.1
position = [0.3, 0]
[joint.shoulder]
type = "revolute"
between = ["ground", "arm"]
at = [0, 0]
[input.torque]
[input.tripped]
[event.controller]
every = 0.01
set = { torque = "40*(0.5*sin(t) - shoulder.angle) - 6*shoulder.angle_rate" }
[event.overload]
when = "torque - 1"
direction = "rising"
set = { tripped = "tripped + 1" }
[event.second]
when = "tripped - 0.5"
stop = true
[force.motor]
type = "effort"
joint = "shoulder"
effort = "torque"
"""


@pytest.mark.parametrize("step", [0.003, 0.005, 0.01, 0.02])
@pytest.mark.parametrize("method", ["conserving-ggl", "radau"])
def test_an_event_sees_an_input_that_jumps_between_steps(step, method):
    run = hm.loads(TRIP).simulate(end=1, step=step, method=method)
    assert [event["event"] for event in run.summary["events"]] == ["overload", "second"]
    assert all(event["t"] == pytest.approx(0.01, abs=1e-9) for event in run.summary["events"])
    assert run["torque"][-1] == pytest.approx(1.503, abs=1e-3) and run["tripped"][-1] == 1


def test_an_event_sees_an_input_that_a_program_sets():
    m = hm.Model(gravity=[0, 0, 0])
    m.input("u")
    m.point("p", mass=1, position=[0, 0, 0])
    m.event("on", when="u - 0.5", stop=True)
    sim = hm.Simulation(m, step=0.1)
    assert sim.step(3)
    sim.inputs["u"] = 1
    assert not sim.step() and sim.event == "on" and sim.time == pytest.approx(0.3)


def test_the_row_of_an_event_that_ends_a_run_is_there_whatever_is_left_out():
    run = hm.loads(LANDING).simulate(end=3, step=0.3, every=5)
    assert run.t.tolist() == pytest.approx([0, 1], abs=1e-9) and run["p.az"][-1] == pytest.approx(-10)


def test_repeated_events_set_repeated_inputs():
    m = hm.loads("plane = 'xz'\n[point.p]\nmass = 1\nposition = [0, 0]\n[input.a]\nrepeat = 'i = 1 to 3'\n"
                 "[event.e]\nrepeat = 'i = 1 to 3'\nevery = 0.5\nset = { 'a[i]' = 'a[i] + i' }\n")  # fmt: skip
    run = m.simulate(end=1.2, step=0.1)
    assert [run[f"a[{i}]"][-1] for i in (1, 2, 3)] == [3, 6, 9]


def test_running_measures_take_each_step_with_the_input_it_had():
    """What a program sets an input to between steps counts from there on, before and after; looks are no part of the run."""
    model = hm.Model(gravity=[0, 0, 0])
    model.input("u", unit="N")
    model.point("p", mass=2, position=[0, 0, 0])
    model.expression("f", point="p", force=["u", 0, 0])
    model.measure("impulse", value="integral(u)")
    model.measure("work_done", value="integral(u*p.vx)")
    model.measure("most", value="max(u)")
    simulation = hm.Simulation(model, step=0.1)
    pushes = [1.0, 5.0, -3.0, 4.0, 0.0, 7.0]
    for push in pushes:
        simulation.inputs["u"] = 1000.0
        assert simulation["most"] == 1000.0
        simulation.inputs["u"] = push
        simulation.step()
    assert simulation["impulse"] == pytest.approx(0.1 * sum(pushes), abs=1e-12)
    assert simulation["work_done"] == pytest.approx(simulation["work"], abs=1e-12)
    assert simulation["most"] == 7.0


def test_a_state_is_of_its_own_mechanism():
    def pendulum(mass, title=""):
        model = hm.Model(title=title)
        model.point("bob", mass=mass, position=[1, 0, 0])
        model.constraint_distance("rod", between=[[0, 0, 0], "bob"])
        return hm.Simulation(model, step=0.01)

    state = pendulum(1).state()
    pendulum(1, "the same").set_state(state)
    with pytest.raises(hm.ModelError, match="another model"):
        pendulum(5).set_state(state)


@pytest.mark.parametrize("read", ["nothing", "a velocity", "the quaternion"])
def test_quaternions_do_not_depend_on_what_was_read(read):
    m = hm.Model(gravity=[0, 0, 0])
    m.body("top", mass=1, inertia=[1, 1, 1], position=[0, 0, 0], angular_velocity=[0, 0, 1.5 * np.pi])
    sim = hm.Simulation(m, step=0.01)
    for _ in range(100):
        sim.step()
        if read != "nothing":
            sim["top.vx" if read == "a velocity" else "top.qw"]
    # Three quarters of a turn: half of that is the angle of the quaternion.
    assert sim["top.qw"] == pytest.approx(-np.sqrt(0.5), abs=1e-3) and sim["top.qz"] == pytest.approx(np.sqrt(0.5), abs=1e-3)


@pytest.mark.parametrize("take", [copy.copy, copy.deepcopy, pickle.dumps])
def test_two_simulations_never_share_an_engine(take):
    m = hm.Model()
    m.point("bob", mass=1, position=[0, 0, 0])
    with pytest.raises(hm.ModelError, match="neither copied nor pickled"):
        take(hm.Simulation(m, step=0.01))


def test_a_simulation_goes_on_when_what_failed_is_mended():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("bob", mass=1, position=[0, 0, 0])
    m.input("push", default=3)
    m.expression("thrust", point="bob", force=["sqrt(1 + push)", 0, 0])
    sim = hm.Simulation(m, step=0.1, accuracy=1e-6)
    sim.step()
    sim.inputs["push"] = -2
    assert not sim.step()
    sim.inputs["push"] = 3
    assert sim.step() and sim.time > 0.1
