"""Pulses of 1 N·s within 1e-4 s.

Truths agree with equal steps to 1e-9; at a place to 3e-5 of the speed, which falls with the step.
"""

import math
from functools import partial

import numpy as np
from scipy.special import erf

from mechanism import Case, bar, plane, solved

GRAVITY = 9.81

# How long a pulse is, and when it begins, s; and when one does between times that steps end at anyway.
LASTS, AT, BETWEEN = 1e-4, 0.3, 0.37123


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


def bell(t, at=AT, width=LASTS / 5):
    s = (t - at) / width
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
    yield pulse("rectangular", f"1e4*(step(t-{AT})-step(t-{AT}-{LASTS}))", lambda t: ramps(t, AT))
    yield pulse("half a sine", f"5e3*pi*sin(pi*(t-{AT})/{LASTS})*step(t-{AT})*step({AT + LASTS}-t)", half_sine)
    for name, at in [("bell without ends", AT), ("bell between times", BETWEEN)]:
        yield pulse(name, f"exp(-((t-{at})/{LASTS / 5})^2)/({LASTS / 5}*sqrt(pi))", partial(bell, at=at), probe=("lagrange-1/rk4", 1e-6))
    train_of = "+".join(f"({(-1) ** k})*(step(t-{0.05 + 0.1 * k:.2f})-step(t-{0.05 + 0.1 * k:.2f}-{LASTS}))" for k in range(10))
    yield pulse("train of ten", f"1e4*({train_of})", train)
    yield pulse("rectangular at a place", "1e4*(step(x+0.7)-step(x+0.7-1e-4))", at_place, speed=1.0, probe=("lagrange-1/rk4", 1e-7),
                until=0.32)
    yield oscillator()
    yield pendulum()
