"""Gimbals near their lock, and universal joints near a right angle.

The truths agree with equal steps to 1e-9 (--truths); the cardan at 1e-6 only up to its corner, behind which three methods by accuracy
agree with it.
"""

import math

import numpy as np

from mechanism import Case, solved


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
        # Were both outer rates nudged alike, the way beside the lock would stay what it is.
        _, _, _, a, b, g = np.array(start) + nudge * np.array([0, 0, 0, 1, 1, -1])
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


def cases():
    for ring in (0.1, 1e-6):
        for miss in (1e-1, 1e-3, 1e-6):
            yield gimbals(ring, miss)
    for short in (1e-1, 1e-3, 1e-6):
        yield cardan(short)
