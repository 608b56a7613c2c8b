"""Bars in line, flat parallelograms and cranks at a dead centre.

The truths agree with equal steps to 1e-9 (--truths); with the heavy slider to 4e-8, which falls with the step as it should.
"""

import math

import numpy as np

from mechanism import Case, bar, plane, solved

GRAVITY = 9.81


def pin(first, second, at):
    return {"type": "revolute", "between": [first, second], "at": list(at)}


def one_freedom(acceleration, start, show):
    """The truth of a mechanism with a coordinate q: q̈ = acceleration(q, q̇), of which `show` makes places and speeds for each row."""

    def truth(times, nudge=0.0):
        begin = [start[0] + nudge, start[1] + nudge * max(abs(start[1]), 1.0)]
        states = solved(lambda t, y: [y[1], acceleration(*y)], begin, times)
        return tuple(np.array(part, dtype=float) for part in zip(*(show(*state) for state in states)))

    return truth


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
