"""What Python adds to the engine: to a whole run, to a step in a loop, to a call of a force; then a thousand runs in threads and the memory of
ten thousand models.

    python benches/python/run.py [--repeats 7] [--models 10000] [--runs 1000]

needs the package as `pip install .` makes it, numba, and the command of the same sources: `holonom`, or what HOLONOM says. Times are those
of the processor, and the least of several repeats that take turns, so that other programs disturb them little.
"""

import argparse
import math
import os
import pathlib
import resource
import subprocess
import tempfile
import threading
import time

import numba

import holonom as hm

RUNS = {
    "double pendulum": ("double-pendulum", {"end": 400, "step": 1e-3}),
    "four-bar": ("four-bar", {"end": 100, "step": 1e-3}),
    "chain": ("chain", {"end": 20, "step": 1e-2}),
}


def of_command(model, keys):
    """Processor time of the command, s."""
    settings = [word for key, value in keys.items() for word in (f"--{key}", str(value))]
    with tempfile.TemporaryDirectory() as folder:
        words = [os.environ.get("HOLONOM", "holonom"), "run", f"example:{model}", *settings, "--no-report", "--quiet", "--out", folder + "/out"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def of_package(model, keys):
    """Processor time of the same run by the package, its table written, s."""
    with tempfile.TemporaryDirectory() as folder:
        before = time.process_time()
        hm.load(f"example:{model}").simulate(**keys).write(folder + "/out", report=False)
        return time.process_time() - before


def whole_runs(repeats):
    for name, (model, keys) in RUNS.items():
        pairs = [(of_package(model, keys), of_command(model, keys)) for _ in range(repeats)]
        package, command = (min(times) for times in zip(*pairs))
        print(f"simulate, {name}: package {package:.3f} s, command {command:.3f} s, ratio {package / command:.3f} (at most 1.02)")


def particle():
    m = hm.Model(gravity=[0, 0, -9.81])
    m.input("push")
    p = m.point("p", mass=1, position=[0, 0, 0])
    m.expression("motor", point=p, force=["push", 0, 0])
    return m


def least(work, repeats):
    """Least processor time of some work in this thread, s."""
    times = []
    for _ in range(repeats):
        before = time.thread_time()
        work()
        times.append(time.thread_time() - before)
    return min(times)


def single_steps(repeats, count=20_000):
    for name, model in (("particle", particle()), ("four-bar", hm.load("example:four-bar"))):
        sim = hm.Simulation(model, step=1e-3)
        start = sim.state()

        def one_by_one():
            sim.set_state(start)
            for _ in range(count):
                sim.step()

        def at_once():
            sim.set_state(start)
            sim.step(count)

        each, all_of_them = least(one_by_one, repeats) / count, least(at_once, repeats) / count
        above = (each - all_of_them) * 1e6
        print(f"step(), {name}: {each * 1e6:.2f} µs in a loop, the step itself {all_of_them * 1e6:.2f} µs, {above:.2f} µs above (at most 1.0)")
    sim = hm.Simulation(particle(), step=1e-3)

    def controlled():
        for _ in range(count):
            sim.inputs["push"] = -4 * sim["p.x"] - 2 * sim["p.vx"]
            sim.step()

    print(f"step() with an input set and two columns read: {least(controlled, repeats) / count * 1e6:.2f} µs")


def force(angle, rate):
    return -5.0 * math.sin(angle) - 0.5 * rate


def pendulum(function, terms, derivative=None):
    """A pendulum with a moment that is a sum of calls, each at a place of its own: a call is not repeated where the last one was."""
    m = hm.Model(plane="xz")
    arm = m.body("arm", mass=2, inertia=0.3, position=[0.4, 0])
    pin = m.revolute("pin", m.ground, arm, at=[0, 0])
    call = m.function("force", function, derivative=derivative)
    effort = " + ".join(call(f"pin.angle + {k / 100}", "pin.angle_rate") for k in range(terms))
    m.effort("spring", joint=pin, effort=f"({effort})/{terms}")
    return hm.Simulation(m, step=1e-3)


def calls_of_forces(repeats, few=1, many=21, count=2000):
    """Cost of a call: what twenty more of them in every evaluation of the force cost, over how many they are."""
    calls = [0]

    def counted(angle, rate):
        calls[0] += 1
        return force(angle, rate)

    numbers = []
    for terms in (few, many):
        calls[0] = 0
        pendulum(counted, terms).step(count)
        numbers.append(calls[0])
    compiled = numba.cfunc("float64(float64, float64)")(force)
    sorts = (("Python", force, cost_of_callable(repeats), 1500), ("Numba", compiled, cost_of_compiled(repeats), 50))
    for name, function, itself, limit in sorts:
        times = []
        for terms in (few, many):
            sims = [pendulum(function, terms) for _ in range(repeats)]
            times.append(min(least(lambda sim=sim: sim.step(count), 1) for sim in sims))
        call = (times[1] - times[0]) / (numbers[1] - numbers[0])
        print(
            f"a force of {name}: {call * 1e9:.0f} ns a call with all around it, the callable itself {itself * 1e9:.0f} ns, "
            f"{(call - itself) * 1e9:.0f} ns above (at most {limit})"
        )


def cost_of_callable(repeats, count=100_000):
    def loop():
        for _ in range(count):
            force(0.3, 0.2)

    def empty():
        for _ in range(count):
            pass

    return (least(loop, repeats) - least(empty, repeats)) / count


def cost_of_compiled(repeats, count=1_000_000):
    """The same of the compiled force; each call waits for the one before."""
    inner = numba.njit(force)

    @numba.njit
    def loop(count):
        value = 0.2
        for _ in range(count):
            value = inner(value, value)
        return value

    loop(1)
    return least(lambda: loop(count), repeats) / count


def columns_of(run):
    return b"".join(run[name].tobytes() for name in run.columns)


def in_threads(count, workers=8):
    model = hm.load("example:four-bar")

    def simulate(k):
        return columns_of(model.simulate(end=0.05, set={"bar.horizontal.mass": 1 + k / count}))

    found = [b""] * count

    def work(first):
        for k in range(first, count, workers):
            found[k] = simulate(k)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(workers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    same = sum(found[k] == simulate(k) for k in range(count))
    print(f"{count} simulations in {workers} threads: {same} have the bits that they have one by one")


def resident():
    """Memory of this process, MiB."""
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def memory(count):
    for done in range(count + 1):
        if done % (count // 10) == 0:
            print(f"resident after {done} models, each built, run and stepped: {resident():.1f} MiB")
        m = particle()
        m.function("f", lambda x: -x)
        m.expression("more", point="p", force=[0, "f(p.y)", 0])
        run = m.simulate(end=0.05, step=0.01)
        len(run["p"].position), run.summary["status"]
        sim = hm.Simulation(m, step=0.01)
        sim.step(3)
        sim.set_state(sim.state())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--models", type=int, default=10_000)
    parser.add_argument("--runs", type=int, default=1000)
    given = parser.parse_args()
    whole_runs(given.repeats)
    single_steps(given.repeats)
    calls_of_forces(given.repeats)
    in_threads(given.runs)
    memory(given.models)


if __name__ == "__main__":
    main()
