"""Functions of Python in formulas, against the same formulas written out."""

import ctypes
import gc
import math
import pickle
import threading
import weakref

import holonom as hm
import numpy as np
import pytest


def pendulum(plane="xz"):
    m = hm.Model(title="Arm", plane=plane)
    arm = m.body("arm", mass=2, inertia=0.3, position=[0.4, 0])
    pin = m.revolute("pin", m.ground, arm, at=[0, 0])
    tip = m.point("tip", mass=0.1, position=[0.8, 0])
    m.constraint_distance("string", arm, tip)
    return m, pin, tip


def closer(angle, rate):
    return -3 * math.sin(angle) - 0.2 * rate


def drag(velocity):
    return -0.1 * np.linalg.norm(velocity) * velocity


def written():
    m, pin, tip = pendulum()
    m.effort("motor", joint=pin, effort="-3*sin(pin.angle) - 0.2*pin.angle_rate")
    m.expression("wind", point=tip, force=["-0.1*sqrt(vx^2 + vz^2)*vx", "-0.1*sqrt(vx^2 + vz^2)*vz"])
    return m.simulate(end=1, step=0.01)


def with_functions(closer, drag, derivatives=(None, None)):
    m, pin, tip = pendulum()
    spring = m.function("closer", closer, derivative=derivatives[0])
    wind = m.function("drag", drag, values=2, derivative=derivatives[1])
    m.effort("motor", joint=pin, effort=spring("pin.angle", pin["angle_rate"]))
    m.expression("wind", point=tip, force=wind("tip.velocity"))
    return m


def same(m):
    run, truth = m.simulate(end=1, step=0.01), written()
    assert run.status == "completed"
    return max(np.abs(run[name] - truth[name]).max() for name in ("pin.angle", "tip.x", "tip.z")) < 1e-12


def test_a_function_is_the_formula_that_it_computes():
    assert same(with_functions(closer, drag))


def test_derivatives_may_be_given():
    def slopes(angle, rate):
        return [-3 * math.cos(angle), -0.2]

    def slopes_of_drag(v):
        speed = np.linalg.norm(v)
        return -0.1 * (speed * np.eye(2) + (np.outer(v, v) / speed if speed else 0))

    assert same(with_functions(closer, drag, (slopes, slopes_of_drag)))


def test_compiled_functions_are_called_by_their_addresses():
    number, pointer = ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    of_numbers = ctypes.CFUNCTYPE(number, number, number)(closer)

    def write(v, out):
        out[0], out[1] = (-0.1 * math.hypot(v[0], v[1]) * v[k] for k in range(2))

    of_pointers = ctypes.CFUNCTYPE(None, pointer, pointer)(write)
    assert same(with_functions(of_numbers, of_pointers))


def test_numba():
    numba = pytest.importorskip("numba")
    pointer = numba.types.CPointer(numba.types.float64)

    @numba.cfunc(numba.types.void(pointer, pointer))
    def write(v, out):
        speed = math.sqrt(v[0] ** 2 + v[1] ** 2)
        out[0] = -0.1 * speed * v[0]
        out[1] = -0.1 * speed * v[1]

    assert same(with_functions(numba.cfunc("float64(float64, float64)")(closer), write))


def test_jax():
    jnp = pytest.importorskip("jax.numpy")
    m = with_functions(
        lambda angle, rate: -3 * jnp.sin(angle) - 0.2 * rate,
        lambda v: -0.1 * jnp.sqrt(v @ v + 1e-300) * v,
        ("jax", "jax"),
    )
    assert same(m)


def test_functions_are_read_by_measures_events_drives_and_files():
    m = hm.loads(
        """
        plane = "xz"
        [body.arm]
        mass = 2
        inertia = 0.3
        position = [0.4, 0]
        [joint.pin]
        type = "revolute"
        between = ["ground", "arm"]
        at = [0, 0]
        [drive.motor]
        type = "angle"
        joint = "pin"
        profile = "turn(t)"
        [measure.height]
        value = "sine(pin.angle)"
        [event.up]
        when = "sine(pin.angle) - 0.5"
        """
    )
    with pytest.raises(hm.ModelError, match="`turn` is no function"):
        m.simulate(end=1, step=0.01)
    m.function("turn", lambda t: t * t)
    m.function("sine", math.sin)
    run = m.simulate(end=1, step=0.01)
    assert np.abs(run["pin.angle"] - run.t**2).max() < 1e-12
    assert np.abs(run["pin.angle_rate"] - 2 * run.t).max() < 1e-8, "rates are differences"
    assert np.abs(run["height"] - np.sin(run.t**2)).max() < 1e-12
    assert run.summary["events"][0]["t"] == pytest.approx(math.sqrt(math.pi / 6), abs=1e-10)


def test_a_sampled_controller_is_called_once_a_sample():
    times = []

    def controller(t, angle, rate):
        times.append(t)
        return -20 * angle - 3 * rate

    m, pin, _ = pendulum()
    m.input("torque", unit="N*m")
    says = m.function("controller", controller)
    m.event("sample", every=0.02, set={"torque": says("t", "pin.angle", "pin.angle_rate")})
    m.effort("motor", joint=pin, effort="torque")
    run = m.simulate(end=1, step=0.005)
    assert times == [pytest.approx(0.02 * k, abs=1e-12) for k in range(51)]
    held = run["torque"].reshape(-1)[:-1].reshape(50, 4)
    assert (held == held[:, :1]).all() and len(set(held[:, 0])) == 50


@pytest.mark.parametrize("given", [np.complex128(1 + 2j), 1 + 2j, np.array([1 + 2j, 0]), [np.complex64(1 + 2j), 0]])
def test_complex_numbers_are_no_numbers(given):
    m, _, tip = pendulum()
    count = 2 if np.ndim(given) else 1
    force = m.function("force", lambda x: given, values=count)("tip.x")
    m.expression("wind", point=tip, force=force if count == 2 else [force, 0])
    with pytest.raises(hm.FunctionError, match="wanted"):
        m.simulate(end=1, step=0.01)


def test_complex_derivatives_are_no_derivatives():
    m, _, tip = pendulum()
    force = m.function("force", lambda x: -x, derivative=lambda x: -1 + 2j)("tip.x")
    m.expression("wind", point=tip, force=[force, 0])
    with pytest.raises(hm.FunctionError, match="complex"):
        m.simulate(end=1, step=0.01)


def test_a_function_that_raises_ends_the_run_and_keeps_it():
    def late(angle, t):
        if t > 0.5:
            raise LookupError("too late")
        return -angle

    m, pin, _ = pendulum()
    f = m.function("late", late)
    m.effort("motor", joint=pin, effort=f("pin.angle", "t"))
    with pytest.raises(hm.FunctionError, match="the function `late` raised LookupError") as error:
        m.simulate(end=1, step=0.01)
    assert isinstance(error.value.__cause__, LookupError)
    assert error.value.run.status == "stopped" and error.value.run.t[-1] == pytest.approx(0.5)
    sim = hm.Simulation(m, step=0.01)
    with pytest.raises(hm.FunctionError):
        sim.step(100)
    assert sim.time == pytest.approx(0.5)


def raising(error, after=0.5):
    """A pendulum with a force and a measure of a function that raises after some time."""

    def late(angle, t):
        if t > after:
            raise error
        return -angle

    m, pin, _ = pendulum()
    return m, pin, m.function("late", late)("pin.angle", "t")


@pytest.mark.parametrize("where", ["force", "measure"])
def test_it_is_told_which_function_has_ended_the_run(where):
    m, pin, call = raising(LookupError("too late"))
    if where == "force":
        m.effort("motor", joint=pin, effort=call)
    else:
        m.measure("m", value=f"max({call})")
    words = "the function `late` raised LookupError('too late')"
    with pytest.raises(hm.FunctionError) as error:
        m.simulate(end=1, step=0.01)
    run = error.value.run
    assert (run.status, run.reason) == ("stopped", words) and run.t[-1] == pytest.approx(0.51 if where == "measure" else 0.5)
    sim = hm.Simulation(m, step=0.01)
    with pytest.raises(hm.FunctionError):
        sim.step(100)
    assert (sim.ended, sim.event) == (words, None) and sim.time == pytest.approx(run.t[-1])


def test_a_measure_raises_as_often_as_it_is_looked_at():
    m, pin, call = raising(LookupError("too late"))
    m.measure("m", value=call)
    sim = hm.Simulation(m, step=0.01)
    assert sim.step(60)
    for _ in range(3):
        with pytest.raises(hm.FunctionError, match="too late"):
            sim["m"]
    # The motion does not need it.
    assert np.isfinite(sim["pin.angle"]) and sim.step()


def test_a_simulation_goes_on_when_what_a_function_had_to_raise_is_over():
    m, pin, _ = pendulum()
    left = [0]

    def force(angle, t):
        if t > 0.5 and left[0]:
            left[0] -= 1
            raise KeyboardInterrupt
        return -angle

    m.effort("motor", joint=pin, effort=m.function("force", force)("pin.angle", "t"))
    sims = [hm.Simulation(m, step=0.01) for _ in range(2)]
    sims[0].step(100)
    left[0] = 1
    with pytest.raises(KeyboardInterrupt):
        sims[1].step(100)
    sims[1].step(50)
    assert sims[1].ended is None and sims[1]["pin.angle"] == pytest.approx(sims[0]["pin.angle"], abs=1e-12)


@pytest.mark.parametrize("order", [KeyboardInterrupt, SystemExit])
def test_orders_to_end_come_out_of_functions_as_they_are(order):
    m, pin, call = raising(order())
    m.effort("motor", joint=pin, effort=call)
    sim = hm.Simulation(m, step=0.01)
    with pytest.raises(order):
        sim.step(100)
    assert sim.ended == f"the function `late` raised {order()!r}" and sim.time == pytest.approx(0.5)
    with pytest.raises(order):
        m.simulate(end=1, step=0.01)
    with pytest.raises(order):
        hm.sweep(m, {"simulation.end": [0.1, 1, 0.2]}, step=0.01)


@pytest.mark.parametrize("gives", ["a text", [1.0, 2.0], None])
def test_what_is_no_number_is_told(gives):
    m, pin, _ = pendulum()
    f = m.function("odd", lambda angle: gives)
    m.effort("motor", joint=pin, effort=f("pin.angle"))
    with pytest.raises(hm.FunctionError, match="a number is wanted"):
        m.simulate(end=1, step=0.01)


def test_a_function_cannot_have_the_simulation_that_calls_it():
    sims = []
    m, pin, _ = pendulum()
    f = m.function("selfish", lambda angle: -sims[0]["pin.angle"] if sims else -angle)
    m.effort("motor", joint=pin, effort=f("pin.angle"))
    sims.append(hm.Simulation(m, step=0.01))
    with pytest.raises(hm.FunctionError) as error:
        sims[0].step()
    assert "give the function what it reads as arguments" in str(error.value.__cause__)


def test_functions_of_two_simulations_that_wait_for_each_other_are_refused():
    sims, errors, meet = {}, [], threading.Barrier(2, timeout=60)

    def simulation(other):
        def look(angle):
            if other not in sims:
                return -angle
            if not errors:
                meet.wait()
            return -angle - 0 * sims[other].time

        m, pin, _ = pendulum()
        m.effort("motor", joint=pin, effort=m.function("look", look)("pin.angle"))
        return hm.Simulation(m, step=0.01)

    def go(sim):
        try:
            sim.step(3)
        except hm.FunctionError as error:
            errors.append(str(error.__cause__))
            meet.abort()

    sims.update(a=simulation("b"), b=simulation("a"))
    threads = [threading.Thread(target=go, args=[sim], daemon=True) for sim in sims.values()]
    [thread.start() for thread in threads]
    [thread.join(60) for thread in threads]
    assert not any(thread.is_alive() for thread in threads)
    assert "wait for each other" in errors[0]


def test_other_threads_may_look_while_functions_are_called():
    m, pin, _ = pendulum()
    f = m.function("back", lambda angle: -angle)
    m.effort("motor", joint=pin, effort=f("pin.angle"))
    sim, is_done = hm.Simulation(m, step=1e-3), threading.Event()

    def look():
        while not is_done.is_set():
            assert sim.time >= 0 and abs(sim["pin.angle"]) < 10

    thread = threading.Thread(target=look)
    thread.start()
    for _ in range(20):
        sim.step(20)
    is_done.set()
    thread.join(60)
    assert not thread.is_alive() and sim.steps == 400


class Controller:
    """A function of a model that holds what is made of the model."""

    def __init__(self, make):
        m, pin, _ = pendulum()
        m.effort("motor", joint=pin, effort=m.function("push", self.push, derivative=self.slope)("pin.angle"))
        self.made = make(m)

    def push(self, angle):
        return -5 * angle

    def slope(self, angle):
        return [-5.0]


MADE = {
    "a model": lambda m: m,
    "a run": lambda m: m.simulate(end=0.1, step=0.01),
    "a simulation": lambda m: hm.Simulation(m, step=0.01),
    "a study": lambda m: hm.sweep(m, {"simulation.end": [0.1, 0.2]}, step=0.01),
}


@pytest.mark.parametrize("make", MADE.values(), ids=MADE.keys())
def test_what_a_function_holds_is_collected_with_it(make):
    controller = Controller(make)
    alive = weakref.ref(controller)
    gc.collect()
    assert alive() is controller
    del controller
    gc.collect()
    assert alive() is None


def test_models_with_functions_are_copied_and_pickled():
    m = with_functions(closer, drag)
    run = m.simulate(end=0.5, step=0.01)
    for other in (m.copy(), pickle.loads(pickle.dumps(m))):
        assert (other.simulate(end=0.5, step=0.01)["pin.angle"] == run["pin.angle"]).all()


def test_numbers_of_numpy_are_numbers_of_arguments_and_values():
    m, pin, tip = pendulum()
    wind = m.function("wind", lambda velocity, t: -0.1 * velocity, arguments=np.array([2, 1]), values=np.int64(2))
    spring = m.function("spring", lambda *given: -given[0], arguments=np.int64(2))
    m.expression("air", point=tip, force=wind("tip.velocity", "t"))
    m.effort("motor", joint=pin, effort=spring("pin.angle", "t"))
    assert (wind.parts().sizes, spring.parts().sizes) == ([2, 1], [1, 1]) and m.simulate(end=0.1, step=0.01).completed


def refused(call):
    m, pin, tip = pendulum()
    with pytest.raises(hm.ModelError) as error:
        call(m, pin)
    return str(error.value)


WRONG = {
    "twice": (lambda m, pin: [m.function("f", closer) for _ in range(2)], "that of a function already"),
    "as a body": (lambda m, pin: m.function("arm", closer), "that of a body already"),
    "an entry as a function": (lambda m, pin: (m.function("f", closer), m.point("f", mass=1)), "that of a function already"),
    "no callable": (lambda m, pin: m.function("f", 3), "a callable is wanted"),
    "no values": (lambda m, pin: m.function("f", closer, values=0), "1 or more"),
    "odd arguments": (lambda m, pin: m.function("f", closer, arguments=[0]), "`arguments` is [0]"),
    "odd derivative": (lambda m, pin: m.function("f", closer, derivative="exact"), 'give a callable, "jax"'),
    "another number of arguments": (
        lambda m, pin: (m.effort("e", joint=pin, effort="f(pin.angle)"), m.function("f", closer), m.simulate(end=1, step=0.1)),
        "`f` takes 2 arguments, and these are 1",
    ),
    "called in two ways": (
        lambda m, pin: (lambda f: [f("1", "t"), f("t")])(m.function("f", closer)),
        "add the callable under another name",
    ),
    "unseen arguments": (
        lambda m, pin: (m.function("f", lambda *all: 0.0), m.simulate(end=1, step=0.1)),
        "give arguments=2",
    ),
    "a reserved name": (lambda m, pin: (m.function("sin", closer), m.simulate(end=1, step=0.1)), "give it another name"),
    "types of a library that are not set": (
        lambda m, pin: m.function("f", ctypes.CDLL(None).labs),
        "set its argtypes and its restype",
    ),
    "compiled for other types": (
        lambda m, pin: m.function("f", ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_int)(abs)),
        "compile it as float64(float64, …)",
    ),
}


@pytest.mark.parametrize("call, words", WRONG.values(), ids=WRONG.keys())
def test_a_wrong_function_is_told_what_is_wrong(call, words):
    assert words in refused(call)
