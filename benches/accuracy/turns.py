"""Rotors and pendulums of many turns: what velocities are off by adds up to a way far longer than the mechanism.

The truths agree with equal steps to 1e-7 (--truths).
"""

import math

from mechanism import Case, plane
from singular import GRAVITY, one_freedom, pin


def hinged(name, gravity, end, acceleration, rate):
    """A rod of 1 m and 1 kg that is hinged at the origin; at the angle 0 it lies along x."""
    rod = {"shape": {"rod": 1.0}, "mass": 1, "position": [0.5, 0], "velocity": [0, rate / 2], "angular_velocity": rate}
    model = plane(gravity, body={"rod": rod}, joint={"hinge": pin("ground", "rod", [0, 0])})
    truth = one_freedom(lambda q, _: acceleration(q), [0.0, rate], lambda q, rate: ([q], [rate]))
    return Case("turns", name, model, end, truth, ("hinge.angle",), 1.0, ("ggl/radau-5", 2e-3), 10.0)


def cases():
    for turns in (10, 100):
        yield hinged(f"rotor of {turns} turns", 0, turns * 2 * math.pi / 10, lambda q: 0.0, 10.0)
        yield hinged(f"pendulum of {turns} swings", GRAVITY, turns * 1.9, lambda q: -1.5 * GRAVITY * math.cos(q), 0.0)
