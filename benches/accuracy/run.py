"""Steps by accuracy at singular places, stiff stops, friction and short pulses, against motions that holonom has no part in.

    cargo build --release
    python3 benches/accuracy/run.py [--family NAME] [--only NAME] [--method NAME] [--accuracy A] [--all] [--end S] [--truths]

A run that completes is right when its error is within ten times the accuracy. The error is the largest of all rows and columns: of
places over the size of the mechanism, the diagonal of the box around the origin and all parts at the start, of angles in rad, as a
direction has the length of the mechanism. Velocities are shown, over the largest speed, and not judged. The growth of a mechanism is
what its motion makes of a small change of the start: errors beyond ten times the accuracy, but not beyond that times the growth, are
counted apart. --truths compares the truths with runs of small equal steps instead. The variable HOLONOM names another binary.
Needs numpy and scipy.
"""

import argparse
import collections
import csv
import dataclasses
import functools
import json
import math
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402
from scipy.special import erf  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benches" / "hard"))

from case import toml  # noqa: E402

HOLONOM = os.environ.get("HOLONOM") or pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "holonom"

METHODS = ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "generalized-alpha", "radau", "ggl/bdf",
           "lagrange-3/bdf", "ode/dopri5", "ode/dop853"]

# What a hundredth of the error costs in steps, by the order of the method; others are of order 2.
ORDER = {"radau": 5, "ggl/bdf": 4, "lagrange-3/bdf": 4, "ode/dopri5": 5, "ode/dop853": 8}

ACCURACIES, ALL = [1e-3, 1e-5, 1e-7, 1e-9], [10.0**-k for k in range(3, 10)]

# CPU time a run may take, s. One that is sure to take longer, by what the accuracy before took, is left out.
LIMIT = 20.0

# Rows of a run besides the start, share of the accuracy that is right, and the change of the start that growth is measured with.
ROWS, WITHIN, NUDGE = 20, 10.0, 1e-7

GRAVITY = 9.81

VERDICTS = ["within", "grown", "worse", "stopped", "refused", "timeout", "left out"]


@dataclasses.dataclass
class Case:
    """A mechanism; its truth gives places and speeds, a row of each for every time, from a start that may be nudged."""

    family: str
    name: str
    model: dict
    end: float
    truth: object
    columns: tuple
    # Size, m, by which errors of the columns are divided; angles are in rad.
    length: float
    # Method and step of the run that the truth is compared with, and until when, s.
    probe: tuple = ("ggl/radau-5", 1e-3)
    until: float = math.inf

    def rates(self):
        return tuple(name + "_rate" if "angle" in name else name[:-1] + "v" + name[-1] for name in self.columns)

    def sizes(self):
        return np.array([1.0 if "angle" in name else self.length for name in self.columns])


def plane(gravity, **entries):
    return {"plane": "xy", "gravity": [0, -gravity], **entries}


def bar(first, second):
    return {"between": [first, second], "mass": 1}


def pin(first, second, at):
    return {"type": "revolute", "between": [first, second], "at": list(at)}


def solved(slopes, start, times, **options):
    """States of y' = slopes(t, y) at rising times."""
    settings = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, **options}
    return solve_ivp(slopes, (0.0, times[-1]), start, t_eval=times, **settings).y.T


def one_freedom(acceleration, start, show):
    """The truth of a mechanism with a coordinate q: q̈ = acceleration(q, q̇), of which `show` makes places and speeds for each row."""

    def truth(times, nudge=0.0):
        begin = [start[0] + nudge, start[1] + nudge * max(abs(start[1]), 1.0)]
        states = solved(lambda t, y: [y[1], acceleration(*y)], begin, times)
        return tuple(np.array(part, dtype=float) for part in zip(*(show(*state) for state in states)))

    return truth


# Singular mechanisms. The truths agree with equal steps to 1e-9 (--truths); with the heavy slider to 4e-8, which falls with the step as
# it should; the cardan at 1e-6 only up to its corner, behind which three methods by accuracy agree with it.


def four_bars(n, end):
    """n windows of bars that stand on the ground, in line when they lie: one angle, of all standing bars."""
    points, bars = {}, {}
    for k in range(n + 1):
        points[f"b{k}"] = {"position": [k, 0], "fixed": True}
        points[f"t{k}"] = {"position": [k, 1], "velocity": [1, 0]}
        bars[f"v{k}"] = bar(f"b{k}", f"t{k}")
    bars |= {f"h{k}": bar(f"t{k}", f"t{k + 1}") for k in range(n)}
    pull = GRAVITY * ((n + 1) / 2 + n) / ((n + 1) / 3 + n)

    def show(q, rate):
        s, c = math.sin(q), math.cos(q)
        return ([x for k in range(n + 1) for x in (k + s, c)], [v for _ in range(n + 1) for v in (rate * c, -rate * s)])

    truth = one_freedom(lambda q, _: pull * math.sin(q), [0.0, 1.0], show)
    columns = tuple(f"t{k}.{c}" for k in range(n + 1) for c in "xy")
    return Case("four-bars", f"{n} windows", plane(GRAVITY, point=points, bar=bars), end, truth, columns, math.hypot(n, 1))


def parallelogram(name, links, angle, rate, gravity, end, bodies=False):
    """Links side by side, without mass or bodies, from a line on the ground to a coupler; flat at the angles 0 and π."""
    spacing = 0.5
    reach = spacing * (links - 1)
    s, c = math.sin(angle), math.cos(angle)
    places = [spacing * k - reach / 2 for k in range(links)]
    coupler = {"mass": 1, "inertia": reach**2 / 12, "position": [reach / 2 + c, s], "velocity": [-rate * s, rate * c],
               "points": {f"p{k}": [x, 0.0] for k, x in enumerate(places)}}
    if bodies:
        model = plane(gravity, body={"coupler": coupler}, joint={})
        for k in range(links):
            foot = [spacing * k, 0.0]
            model["body"][f"link{k}"] = {"mass": 1, "inertia": 1 / 12, "position": [foot[0] + c / 2, s / 2],
                                         "orientation": {"angle": angle}, "velocity": [-rate * s / 2, rate * c / 2],
                                         "angular_velocity": rate}
            model["joint"][f"foot{k}"] = pin("ground", f"link{k}", foot)
            model["joint"][f"head{k}"] = pin(f"link{k}", "coupler", [foot[0] + c, s])
    else:
        rods = {f"link{k}": {"type": "distance", "between": [[spacing * k, 0.0], f"coupler.p{k}"]} for k in range(links)}
        model = plane(gravity, body={"coupler": coupler}, constraint=rods)
    mass = links if bodies else 0.0
    pull = gravity * (mass / 2 + 1) / (mass / 3 + 1)

    def show(q, v):
        return [reach / 2 + math.cos(q), math.sin(q), 0.0], [-v * math.sin(q), v * math.cos(q), 0.0]

    truth = one_freedom(lambda q, _: -pull * math.cos(q), [angle, rate], show)
    columns = ("coupler.x", "coupler.y", "coupler.angle")
    return Case("parallelograms", name, model, end, truth, columns, math.hypot(reach + c, s))


def slider_crank(name, slider, gravity, end, bodies=False):
    """Crank and rod alike, so that the slider passes the crank's bearing when the crank is upright; it could stay there."""
    angle, rate = math.pi / 4, 2 * math.sqrt(2)
    s, c = math.sin(angle), math.cos(angle)
    tip, pushed, end_speed = [c, s], [-rate * s, rate * c], [-2 * rate * s, 0.0]
    if bodies:
        model = plane(
            gravity,
            body={
                "crank": {"mass": 1, "inertia": 1 / 12, "position": [c / 2, s / 2], "orientation": {"angle": angle},
                          "velocity": [-rate * s / 2, rate * c / 2], "angular_velocity": rate},
                "rod": {"mass": 1, "inertia": 1 / 12, "position": [1.5 * c, s / 2], "orientation": {"angle": -angle},
                        "velocity": [-1.5 * rate * s, rate * c / 2], "angular_velocity": -rate},
                "block": {"mass": slider, "inertia": 0.01, "position": [2 * c, 0.0], "velocity": end_speed},
            },
            joint={"bearing": pin("ground", "crank", [0.0, 0.0]), "knee": pin("crank", "rod", tip),
                   "heel": pin("rod", "block", [2 * c, 0.0]),
                   "rail": {"type": "prismatic", "between": ["ground", "block"], "axis": [1, 0]}})
        columns = ("crank.x", "crank.y", "rod.x", "rod.y", "block.x", "rod.angle")
    else:
        model = plane(
            gravity,
            point={"o": {"position": [0, 0], "fixed": True}, "tip": {"position": tip, "velocity": pushed},
                   "block": {"mass": slider, "position": [2 * c, 0.0], "velocity": end_speed}},
            bar={"crank": bar("o", "tip"), "rod": bar("tip", "block")},
            constraint={"rail": {"type": "point-on-line", "point": "block", "direction": [1, 0]}})
        columns = ("tip.x", "tip.y", "block.x")

    def acceleration(q, v):
        s, c = math.sin(q), math.cos(q)
        inertia = 1 / 3 + 1 / 12 + 2.25 * s * s + 0.25 * c * c + 4 * slider * s * s
        return -(0.5 * s * c * (4 + 8 * slider) * v * v + gravity * c) / inertia

    def show(q, v):
        s, c = math.sin(q), math.cos(q)
        if bodies:
            return [c / 2, s / 2, 1.5 * c, s / 2, 2 * c, -q], [-v * s / 2, v * c / 2, -1.5 * v * s, v * c / 2, -2 * v * s, -v]
        return [c, s, 2 * c], [-v * s, v * c, -2 * v * s]

    return Case("slider-crank", name, model, end, one_freedom(acceleration, [angle, rate], show), columns, 2 * c,
                ("ggl/radau-5", 1e-3 if slider < 10 else 1e-4))


def gimbals(ring, miss):
    """A rotor in two rings, all with the same inertia about any axis. The third axis comes down to the first and would pass it `miss`
    beside, had the rings no inertia. With it M of the three angles is regular everywhere, so that they may be integrated."""
    lean, rotor = 1.0, 1.0
    drift = miss / math.sin(lean) ** 2
    c, s = math.cos(lean), math.sin(lean)
    start = [0.0, lean, 0.0, drift, -1.0, -c * drift]
    third = np.array([0.0, -s, c])
    turned = {"axis": [1, 0, 0], "angle": lean}
    rates = [np.array([0.0, 0.0, drift])]
    rates += [rates[0] + [-1.0, 0.0, 0.0]]
    rates += [rates[1] - c * drift * third]
    bodies = {}
    for name, inertia, rate in zip(["outer", "inner", "rotor"], [ring, ring, rotor], rates):
        bodies[name] = {"mass": 1, "inertia": [inertia] * 3, "position": [0, 0, 0], "angular_velocity": rate}
    bodies["inner"]["orientation"] = bodies["rotor"]["orientation"] = turned

    def hinge(first, second, axis):
        return {"type": "revolute", "between": [first, second], "at": [0, 0, 0], "axis": list(axis)}

    model = {"gravity": [0, 0, 0], "body": bodies,
             "joint": {"first": hinge("ground", "outer", [0, 0, 1]), "second": hinge("outer", "inner", [1, 0, 0]),
                       "third": hinge("inner", "rotor", third.tolist())}}

    def slopes(_, y):
        # Both momenta along the outer axes are constant; α̇ and γ̇ follow from them.
        first, third = y[3], y[4]
        c, s = math.cos(y[1]), math.sin(y[1])
        alpha = (first - c * third) / (2 * ring + rotor * s * s)
        gamma = third / rotor - c * alpha
        return [alpha, y[5], gamma, 0.0, 0.0, -rotor * s * alpha * gamma / (ring + rotor)]

    def truth(times, nudge=0.0):
        _, _, _, a, b, g = np.array(start) + nudge * np.array([0, 0, 0, 1, 1, 1])
        tilt = lean + nudge
        momenta = [(2 * ring + rotor) * a + rotor * math.cos(tilt) * g, rotor * (g + math.cos(tilt) * a)]
        states = solved(slopes, [nudge, tilt, nudge, *momenta, b], times)
        rates = np.array([slopes(0.0, y)[:3] for y in states])
        return states[:, :3] - [0.0, lean, 0.0], rates

    columns = ("first.angle", "second.angle", "third.angle")
    return Case("gimbals", f"rings {ring:g} kg·m², {miss:g} beside lock", model, 2.0, truth, columns, 1.0,
                ("lagrange-1/gauss-6", 1e-3 if ring > 1e-3 or miss > 1e-2 else 2e-5))


def cardan(short):
    """Two shafts with flywheels on a universal joint, bent by a right angle less `short`: while the one turns the other stands, and
    where they change places the path of both angles has a corner of this radius, passed at constant speed."""
    ratio = math.sin(short)
    bend = math.pi / 2 - short
    second = -0.5
    first = math.atan(ratio * math.tan(second))
    along = np.array([math.cos(bend), math.sin(bend), 0.0])
    across = np.array([-math.sin(bend), math.cos(bend), 0.0])
    pins = [[0.0, math.cos(first), math.sin(first)],
            (math.cos(second) * np.array([0, 0, 1.0]) - math.sin(second) * across).tolist()]

    def slopes(_, y):
        c1, s1, c2, s2 = math.cos(y[0]), math.sin(y[0]), math.cos(y[1]), math.sin(y[1])
        a, b = s1 * s2 + ratio * c1 * c2, c1 * c2 + ratio * s1 * s2
        size = math.hypot(a, b)
        return [a / size, b / size]

    def truth(times, nudge=0.0):
        states = solved(slopes, [first, second], [(1 + nudge) * t + nudge for t in times])
        return states - [first, second], (1 + nudge) * np.array([slopes(0.0, y) for y in states])

    rates = slopes(0.0, [first, second])

    def shaft(axis, rate):
        return {"mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0], "angular_velocity": (rate * np.array(axis)).tolist()}

    def bearing(name, axis):
        return {"type": "revolute", "between": ["ground", name], "at": [0, 0, 0], "axis": list(axis)}

    model = {"gravity": [0, 0, 0], "body": {"one": shaft([1.0, 0.0, 0.0], rates[0]), "two": shaft(along, rates[1])},
             "joint": {"first": bearing("one", [1, 0, 0]), "second": bearing("two", along.tolist()),
                       "cross": {"type": "universal", "between": ["one", "two"], "at": [0, 0, 0], "axes": pins}}}
    return Case("gimbals", f"cardan {short:g} short of a right angle", model, 4.0, truth, ("first.angle", "second.angle"), 1.0,
                ("ggl/radau-5", 1e-3), 4.0 if short > 1e-4 else 2.0)


# A mass on a rail. Truths of stops agree with equal steps to 2e-8 at 1e4 and 1e6 N/m, between two stops to 2e-7, which is what steps that
# do not end at the contact leave; stiffer contacts are the same in their own units, and are compared up to the contact only.


def on_rail(place, speed, **forces):
    return plane(0, body={"block": {"mass": 1, "inertia": 0.01, "position": [place, 0.0], "velocity": [speed, 0.0]}},
                 joint={"rail": {"type": "prismatic", "between": ["ground", "block"], "axis": [1, 0]}}, force=forces)


@functools.cache
def contact(damped):
    """A contact in its own units, p̈ = -p (1 + damped ṗ) from p = 0, ṗ = 1: when it ends, and p and ṗ until then."""
    if damped == 0.0:
        return math.pi, lambda t: (np.sin(t), np.cos(t))

    def leaves(_, y):
        return y[0]

    leaves.terminal, leaves.direction = True, -1
    found = solve_ivp(lambda _, y: [y[1], -y[0] * (1 + damped * y[1])], (0, 10), [0, 1], method="DOP853", rtol=1e-13, atol=1e-15,
                      events=leaves, dense_output=True)
    return found.t_events[0][0], found.sol


def stop(stiffness, speed, damped):
    """1 kg against a stop after half a second; `damped` is the dissipation times the speed."""
    gap, rate = 0.5 * speed, math.sqrt(stiffness)
    model = on_rail(-gap, speed, stop={"type": "stop", "joint": "rail", "upper": gap, "stiffness": float(stiffness),
                                       "dissipation": damped / speed})
    lasts, inside = contact(damped)

    def truth(times, nudge=0.0):
        places, rates = [], []
        for t in times:
            if t <= 0.5:
                x, v = t - 0.5, 1.0
            elif (t - 0.5) * rate < lasts:
                p, v = inside((t - 0.5) * rate)
                x = p / rate
            else:
                v = inside(lasts)[1]
                x = v * (t - 0.5 - lasts / rate)
            places.append([speed * x])
            rates.append([speed * v])
        return np.array(places), np.array(rates)

    name = f"{stiffness:.0e} N/m, {speed:g} m/s" + (", damped" if damped else "")
    return Case("stops", name, model, 1.0, truth, ("block.x",), gap, ("lagrange-1/rk4", 1e-6 if stiffness > 1e5 else 1e-5),
                1.0 if stiffness < 1e7 else 0.4)


def walls(stiffness):
    """1 kg at 1 m/s between two stops that are 0.2 m apart, without loss."""
    gap, rate = 0.2, math.sqrt(stiffness)
    model = on_rail(-gap / 2, 1.0, stop={"type": "stop", "joint": "rail", "lower": 0.0, "upper": gap, "stiffness": float(stiffness)})
    contact, cycle = math.pi / rate, gap + math.pi / rate

    def truth(times, nudge=0.0):
        places, rates = [], []
        for t in times:
            count, inside = divmod(t, cycle)
            sign = -1.0 if count % 2 else 1.0
            phase = rate * (inside - gap)
            x, v = (inside - gap / 2, 1.0) if phase <= 0 else (gap / 2 + math.sin(phase) / rate, math.cos(phase))
            places.append([sign * x])
            rates.append([sign * v])
        return np.array(places), np.array(rates)

    return Case("stops", f"two of {stiffness:.0e} N/m", model, 2.0, truth, ("block.x",), gap / 2, ("lagrange-1/rk4", 2e-6),
                2.0 if stiffness < 1e7 else 0.15)


# Friction F tanh(ẋ/v), as the docs have it. Truths agree with Gauss' method in equal steps to 1e-11; that at 1e-6 m/s only until it is slow,
# and is the same motion in its own units.


def slide(creep, load):
    """1 kg at 1 m/s under a friction of 2 N and a load below it, which it goes on to creep under."""
    friction = 2.0
    model = on_rail(-1.0, 1.0, rub={"type": "friction", "joint": "rail", "effort": friction, "speed": creep},
                    pull={"type": "effort", "joint": "rail", "effort": load})
    # Beyond 20 v the tangent is 1, and within it the motion has time of its own, v/F; then it creeps.
    fast, last = 20.0, math.atanh(load / friction)
    braked = (1.0 - fast * creep) / (friction - load)
    until = 1.0 * braked - 0.5 * (friction - load) * braked**2
    settles, unit = 100.0, creep / friction
    inner = solve_ivp(lambda _, y: [y[1], load / friction - math.tanh(y[1])], (0, settles), [0.0, fast], method="DOP853", rtol=1e-13,
                      atol=1e-15, dense_output=True).sol

    def truth(times, nudge=0.0):
        places, rates = [], []
        for t in times:
            if t <= braked:
                x, v = t - 0.5 * (friction - load) * t * t, 1 - (friction - load) * t
            else:
                own = (t - braked) / unit
                way, speed = inner(min(own, settles))
                way += last * max(own - settles, 0.0)
                x, v = until + way * creep * unit, speed * creep
            places.append([x - 1.0])
            rates.append([v])
        return np.array(places), np.array(rates)

    name = f"slides to {'creep under 1 N' if load else 'rest'}, {creep:g} m/s"
    return Case("friction", name, model, 2.0, truth, ("block.x",), 1.0, ("lagrange-1/gauss-6", max(creep / 20, 1e-5)),
                2.0 if creep > 1e-5 else 0.45)


def stick_slip(creep):
    """1 kg on a spring whose other end is moved to and fro; it sticks while the spring pulls with less than 2 N."""
    friction, stiffness, swing = 2.0, 100.0, 0.1
    model = on_rail(-1.0, 0.0, rub={"type": "friction", "joint": "rail", "effort": friction, "speed": creep},
                    spring={"type": "spring", "between": ["hand", "block"], "stiffness": stiffness, "rest_length": 1.0})
    model["point"] = {"hand": {"motion": [f"{swing}*sin(3*t)", 0]}}

    def truth(times, nudge=0.0):
        def slopes(t, y):
            return [y[1], stiffness * (swing * math.sin(3 * t) - y[0]) - friction * math.tanh(y[1] / creep)]

        states = solved(slopes, [nudge, nudge], times, atol=1e-16)
        return states[:, :1] - 1.0, states[:, 1:]

    return Case("friction", f"spring, stick and slip, {creep:g} m/s", model, 2.0, truth, ("block.x",), 1.0,
                ("lagrange-1/gauss-6", max(creep / 20, 1e-5)))


# Pulses of 1 N·s within 1e-4 s. Truths agree with equal steps to 1e-9; at a place to 3e-5 of the speed, which falls with the step.

LASTS, AT = 1e-4, 0.3


def ramps(t, at, lasts=LASTS):
    """Place and speed after a rectangular pulse of 1 N·s on 1 kg."""
    inside = min(max(t - at, 0.0), lasts)
    return 0.5 * inside * inside / lasts + max(t - at - lasts, 0.0), inside / lasts


def pulse(name, force, motion, end=1.0, speed=0.0, probe=("lagrange-1/gauss-6", 1e-5), until=math.inf):
    """1 kg at -1 m, that a force along x acts on."""
    model = plane(0, point={"m": {"mass": 1, "position": [-1, 0], "velocity": [speed, 0]}},
                  force={"push": {"type": "expression", "point": "m", "force": [force, 0]}})

    def truth(times, nudge=0.0):
        rows = [motion(t) for t in times]
        return np.array([[x - 1.0] for x, _ in rows]), np.array([[v] for _, v in rows])

    return Case("pulses", name, model, end, truth, ("m.x",), 1.0, probe, until)


def half_sine(t):
    inside = min(max(t - AT, 0.0), LASTS)
    phase = math.pi * inside / LASTS
    return 0.5 * (inside - LASTS / math.pi * math.sin(phase)) + max(t - AT - LASTS, 0.0), 0.5 * (1 - math.cos(phase))


def bell(t, width=LASTS / 5):
    s = (t - AT) / width
    return 0.5 * width * (s + s * erf(s) + math.exp(-s * s) / math.sqrt(math.pi)), 0.5 * (1 + erf(s))


def train(t):
    parts = [(-1) ** k * np.array(ramps(t, 0.05 + 0.1 * k)) for k in range(10)]
    return tuple(sum(parts))


def at_place(t):
    """From 1 m/s, 1e4 N within 1e-4 m of the origin of x: 1 J more."""
    if t <= AT:
        return t, 1.0
    fast = math.sqrt(3.0)
    lasts = (fast - 1.0) / 1e4
    inside = min(t - AT, lasts)
    return AT + inside + 0.5e4 * inside**2 + fast * max(t - AT - lasts, 0.0), 1.0 + 1e4 * inside


def oscillator():
    stiffness = 100.0
    model = plane(0, point={"m": {"mass": 1, "position": [1, 0]}},
                  force={"push": {"type": "expression", "point": "m", "force": [f"1e4*(step(t-{AT})-step(t-{AT}-{LASTS}))", 0]},
                         "spring": {"type": "spring", "between": ["ground", "m"], "stiffness": stiffness, "rest_length": 1.0}})
    rate = math.sqrt(stiffness)

    def truth(times, nudge=0.0):
        def part(t):
            # What a force from t = 0 on does to it.
            return np.array([(1 - math.cos(rate * t)) / stiffness, math.sin(rate * t) / rate]) / LASTS if t > 0 else np.zeros(2)

        rows = np.array([part(t - AT) - part(t - AT - LASTS) for t in times])
        return 1.0 + rows[:, :1], rows[:, 1:]

    return Case("pulses", "rectangular, on a spring", model, 1.0, truth, ("m.x",), 1.0, ("lagrange-1/gauss-6", 1e-5))


def pendulum():
    """A bar that falls from level and is struck upwards at its tip."""
    model = plane(GRAVITY, point={"tip": {"position": [1, 0]}}, bar={"arm": bar("ground", "tip")},
                  force={"push": {"type": "expression", "point": "tip", "force": [0, f"1e4*(step(t-{AT})-step(t-{AT}-{LASTS}))"]}})

    def truth(times, nudge=0.0):
        states, here, t = [], [nudge, nudge], 0.0
        for until, push in [(AT, 0.0), (AT + LASTS, 1e4), (math.inf, 0.0)]:
            inside = [s - t for s in times if t <= s < until]
            stop = [until - t] if until < math.inf else []
            part = solved(lambda _, y, push=push: [y[1], 3 * (push - GRAVITY / 2) * math.cos(y[0])], here, [*inside, *stop])
            states.extend(part[:len(inside)])
            here, t = part[-1], until
        q, v = np.array(states).T
        return np.array([np.cos(q), np.sin(q)]).T, np.array([-v * np.sin(q), v * np.cos(q)]).T

    return Case("pulses", "rectangular, on a pendulum", model, 1.0, truth, ("tip.x", "tip.y"), 1.0, ("lagrange-1/gauss-6", 1e-5))


def cases():
    for n in (1, 2, 3, 5, 10):
        yield four_bars(n, 3.0)
    for links in (4, 8):
        yield parallelogram(f"{links} links from flat", links, 0.0, 1.0, 0.0, 4.0)
        yield parallelogram(f"{links} links through flat", links, math.pi / 3, -1.0, 0.0, 5.0)
        yield parallelogram(f"{links} links from flat, gravity", links, 0.0, -1.0, GRAVITY, 2.0)
        yield parallelogram(f"{links} links through flat, gravity", links, math.pi / 3, 0.0, GRAVITY, 2.0)
    yield parallelogram("2 links through flat", 2, math.pi / 3, -1.0, 0.0, 5.0)
    yield parallelogram("4 bodies through flat", 4, math.pi / 3, -1.0, 0.0, 5.0, bodies=True)
    yield parallelogram("4 bodies from flat, gravity", 4, 0.0, -1.0, GRAVITY, 2.0, bodies=True)
    yield slider_crank("equal lengths", 1.0, 0.0, 1.5)
    yield slider_crank("equal lengths, gravity", 1.0, GRAVITY, 1.5)
    yield slider_crank("equal lengths, heavy slider", 100.0, 0.0, 1.2)
    yield slider_crank("equal lengths, bodies, gravity", 1.0, GRAVITY, 1.5, bodies=True)
    for ring in (0.1, 1e-6):
        for miss in (1e-1, 1e-3, 1e-6):
            yield gimbals(ring, miss)
    for short in (1e-1, 1e-3, 1e-6):
        yield cardan(short)
    for speed in (1.0, 10.0):
        for damped in (0.0, 0.3):
            for stiffness in (1e4, 1e6, 1e8, 1e10):
                yield stop(stiffness, speed, damped)
    for stiffness in (1e6, 1e10):
        yield walls(stiffness)
    for load in (0.0, 1.0):
        for creep in (1e-2, 1e-4, 1e-6):
            yield slide(creep, load)
    for creep in (1e-2, 1e-3, 1e-4):
        yield stick_slip(creep)
    yield pulse("rectangular", f"1e4*(step(t-{AT})-step(t-{AT}-{LASTS}))", lambda t: ramps(t, AT))
    yield pulse("half a sine", f"5e3*pi*sin(pi*(t-{AT})/{LASTS})*step(t-{AT})*step({AT + LASTS}-t)", half_sine)
    yield pulse("bell without ends", f"exp(-((t-{AT})/{LASTS / 5})^2)/({LASTS / 5}*sqrt(pi))", bell, probe=("lagrange-1/rk4", 1e-6))
    train_of = "+".join(f"({(-1) ** k})*(step(t-{0.05 + 0.1 * k:.2f})-step(t-{0.05 + 0.1 * k:.2f}-{LASTS}))" for k in range(10))
    yield pulse("train of ten", f"1e4*({train_of})", train)
    yield pulse("rectangular at a place", "1e4*(step(x+0.7)-step(x+0.7-1e-4))", at_place, speed=1.0, probe=("lagrange-1/rk4", 1e-7),
                until=0.32)
    yield oscillator()
    yield pendulum()


# Running and judging.


class Ended(Exception):
    """A run without results: its verdict, what its summary says, and why."""


def call(command, limit):
    """Output of a command that may use so much CPU time, s."""
    bound = int(math.ceil(limit))
    confine = functools.partial(resource.setrlimit, resource.RLIMIT_CPU, (bound, bound + 1))
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=10 * limit, preexec_fn=confine)
    except subprocess.TimeoutExpired:
        raise Ended("timeout", {}, f"over {10 * limit:.0f} s") from None
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Ended("timeout", {}, f"over {limit:.0f} s of CPU")
    found = json.loads(done.stdout) if done.stdout.startswith("{") else {}
    if done.returncode != 0:
        verdict = {2: "refused", 3: "stopped"}.get(done.returncode, "stopped")
        text = (done.stderr or done.stdout).strip().splitlines()
        raise Ended(verdict, found, str(found.get("reason") or (text[0] if text else f"exit {done.returncode}")))
    return found


def run(case, method, end, limit, folder, **keys):
    """Summary of a run, and its largest errors of places and of speeds."""
    path = folder / "model.toml"
    path.write_text(toml(case.model))
    settings = [part for key, value in keys.items() for part in ("--set", f"simulation.{key}={value!r}")]
    command = [HOLONOM, "run", path, "--method", method, "--end", repr(end), *settings, "--json", "--no-report", "--out", folder / "out"]
    if "step" in keys:
        command += ["--every", str(round(end / ROWS / keys["step"]))]
    else:
        command += ["--step", repr(end / ROWS)]
    found = call(command, limit)
    with open(folder / "out" / "trajectory.csv") as file:
        rows = list(csv.DictReader(file))[1:]
    places, speeds = true_motion(case, tuple(end * (k + 1) / ROWS for k in range(ROWS)))
    if len(rows) != ROWS:
        raise Ended("stopped", found, f"{len(rows)} rows in place of {ROWS}")

    def error(columns, truth, unit):
        here = np.array([[float(row[name]) for name in columns] for row in rows])
        worst = float(np.max(np.abs(here - truth) / unit))
        return worst if math.isfinite(worst) else math.inf

    return found, error(case.columns, places, case.sizes()), error(case.rates(), speeds, max(float(np.max(np.abs(speeds))), 1e-300))


TRUTHS = {}


def true_motion(case, times):
    if (case.family, case.name, times) not in TRUTHS:
        TRUTHS[case.family, case.name, times] = case.truth(list(times))
    return TRUTHS[case.family, case.name, times]


def growth(case, end):
    """What the motion makes of a small change of the start, at most; 1 where the truth is not integrated."""
    times = [end * (k + 1) / ROWS for k in range(ROWS)]
    change = np.abs(case.truth(times, NUDGE)[0] - case.truth(times)[0]) / case.sizes()
    return max(float(np.max(change)) / NUDGE, 1.0)


def judged(case, method, accuracy, end, grows, limit, folder):
    """Verdict, summary, errors over the accuracy, and reason of a run."""
    try:
        found, place, speed = run(case, method, end, limit, folder, accuracy=accuracy)
    except Ended as ended:
        verdict, found, reason = ended.args
        return verdict, found, None, None, reason
    factor = place / accuracy
    verdict = "within" if factor <= WITHIN else "grown" if factor <= WITHIN * grows else "worse"
    return verdict, found, factor, speed / accuracy, ""


def line(case, method, accuracy, verdict, found, place, speed, reason):
    head = f"{case.family:14} {case.name:38} {method:21} {accuracy:7.0e} {verdict:8}"
    factors = " ".join(f"{'' if x is None else f'{x:.2g}':>8}" for x in (place, speed))
    work = f"{found['work']['steps_taken']:9} {found['work']['rejected_steps']:7} {found['time']['cpu_s']:7.2f}" if found else f"{'':25}"
    return f"{head} {factors} {work} {reason}".rstrip()


def compare_truths(selected, given, folder):
    for case in selected:
        method, step = case.probe
        end = min(given.end or case.end, case.until)
        step = end / ROWS / math.ceil(end / ROWS / step - 1e-9)
        try:
            _, place, speed = run(case, method, end, 10 * given.limit, folder, step=step)
            print(f"{case.family:14} {case.name:38} {method:21} {step:9.2g} {place:9.1e} {speed:9.1e}", flush=True)
        except Ended as ended:
            print(f"{case.family:14} {case.name:38} {method:21} {step:9.2g} {ended.args[0]}: {ended.args[2]}", flush=True)


def table(title, counts):
    print(f"\n{title:22} " + " ".join(f"{verdict:>8}" for verdict in VERDICTS))
    for name, found in [*counts.items(), ("all", sum(counts.values(), collections.Counter()))]:
        print(f"{name:22} " + " ".join(f"{found[verdict]:8}" for verdict in VERDICTS))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--family", action="append", default=[], help="only families with this in their name")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="only mechanisms with this in their name")
    parser.add_argument("--method", action="append", default=[], help="only this method, any that chooses steps")
    parser.add_argument("--accuracy", action="append", default=[], type=float, help="only this accuracy")
    parser.add_argument("--all", action="store_true", help="all accuracies 1e-3, 1e-4, …, 1e-9 in place of every other one")
    parser.add_argument("--end", type=float, help="end of all runs, s")
    parser.add_argument("--limit", type=float, default=LIMIT, help="CPU time a run may take, s")
    parser.add_argument("--truths", action="store_true", help="compare the truths with runs of small equal steps")
    given = parser.parse_args()

    def is_chosen(case):
        return all(any(part in name for part in parts or [""]) for parts, name in ((given.family, case.family), (given.only, case.name)))

    selected = [case for case in cases() if is_chosen(case)]
    accuracies = sorted(given.accuracy or (ALL if given.all else ACCURACIES), reverse=True)
    by_family, by_method = {}, {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        if given.truths:
            return compare_truths(selected, given, folder)
        for case in selected:
            end = given.end or case.end
            grows = growth(case, end)
            print(f"\n{case.family}: {case.name}, {end:g} s, growth {grows:.2g}")
            print(f"{'family':14} {'mechanism':38} {'method':21} {'acc.':>7} {'verdict':8} {'error/a.':>8} {'speed/a.':>8} "
                  f"{'steps':>9} {'rejec.':>7} {'CPU s':>7}")
            for method in given.method or METHODS:
                took, before = 0.0, None
                for accuracy in accuracies:
                    needs = took * (before / accuracy) ** (1 / ORDER.get(method, 2)) if before else 0.0
                    if needs > given.limit:
                        cell = ("left out", {}, None, None, f"would take {needs:.0f} s")
                    else:
                        cell = judged(case, method, accuracy, end, grows, given.limit, folder)
                    if cell[1]:
                        took, before = cell[1]["time"]["cpu_s"], accuracy
                    by_family.setdefault(case.family, collections.Counter())[cell[0]] += 1
                    by_method.setdefault(method, collections.Counter())[cell[0]] += 1
                    print(line(case, method, accuracy, *cell), flush=True)
    table("family", by_family)
    table("method", by_method)
    sys.exit(any(found["worse"] or found["timeout"] for found in by_family.values()))


if __name__ == "__main__":
    main()
