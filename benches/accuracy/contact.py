"""A mass on a rail, against stops and under friction.

Truths of stops agree with equal steps to 2e-8 at 1e4 and 1e6 N/m, between two stops to 2e-7, which is what steps that do not end at the
contact leave; stiffer contacts are the same in their own units, and are compared up to the contact only.

Friction is F tanh(ẋ/v), as the docs have it. Its truths agree with Gauss' method in equal steps to 1e-11; that at 1e-6 m/s only until it is
slow, and is the same motion in its own units.
"""

import functools
import math

import numpy as np
from scipy.integrate import solve_ivp

from mechanism import Case, plane, solved


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


def cases():
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
