"""Thin rods, plates and coins, and mechanisms far away from the origin."""

import math

import numpy as np

import rank
import truth
from case import Case, revolute, rod, space, with_reactions

GRAVITY = 9.81

# The moment of a rod about itself over that across; what a plate's largest moment falls short of the other two.
THIN = (0.0, 1e-12, 1e-9, 1e-7, 1e-4)


def rods(n, thin, reactions=False):
    """Hinged rods of a metre along x that swing about y."""
    body, joint = {}, {}
    for k in range(n):
        body[f"b{k}"] = {"mass": 1.0, "inertia": rank.moments_along(0, thin), "position": [k + 0.5, 0, 0]}
        joint[f"j{k}"] = revolute("ground" if k == 0 else f"b{k - 1}", f"b{k}", [k, 0, 0], [0, 1, 0])
    return swinging(f"{n} thin rods, {thin:g}", space(body=body, joint=joint), n, 1 / 12, reactions)


def plates(n, thin, reactions=False):
    """Hinged square plates of a metre along x, in the plane of x and y, that swing about y."""
    body, joint = {}, {}
    for k in range(n):
        moments = [1 / 12, 1 / 12, (2 - thin) / 12]
        body[f"b{k}"] = {"mass": 1.0, "inertia": moments, "position": [k + 0.5, 0, 0]}
        joint[f"j{k}"] = revolute("ground" if k == 0 else f"b{k - 1}", f"b{k}", [k, 0, 0], [0, 1, 0])
    return swinging(f"{n} plates, {thin:g}", space(body=body, joint=joint), n, 1 / 12, reactions)


def swinging(name, model, n, moment, reactions):
    """Links of a metre and 1 kg released level in the plane of x and z."""
    moving = truth.chain([(1, 0.5, 1, moment)] * n, [0.0] * n)
    return Case(name + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, 0.01, 0.5,
                lambda times: [rank.centres(row) for row in truth.ends(moving(times), [1] * n)],
                tuple(f"b{k}.{axis}" for k in range(n) for axis in "xz"), length=n, energy=n * n * GRAVITY, weight=n * GRAVITY,
                speed=math.sqrt(2 * GRAVITY * n), expect={"dof": n, "redundant": 0})


def hanging(kind, thin, spin):
    """A rod of a metre along −z on a ball or a universal joint, tilted by a push about x and y; on a ball it may spin about itself."""
    across, rates = 1 / 12, (1.5, -1.0)
    body = {"rod": {"mass": 2.0, "inertia": [2 * m for m in rank.moments_along(2, thin)], "position": [0, 0, -0.5],
                    "velocity": [-0.5 * rates[1], 0.5 * rates[0], 0], "angular_velocity": [*rates, spin]}}
    if kind == "universal":
        joint = {"type": "universal", "between": ["ground", "rod"], "at": [0, 0, 0], "axes": [[1, 0, 0], [0, 1, 0]]}
        moving = truth.universal((0, 0), rates, 2 * (across + 0.25), 2 * thin * across, 1.0)
        places = lambda times: [centre_of_tilts(y) for y in moving(times)]
    else:
        joint = {"type": "spherical", "between": ["ground", "rod"], "at": [0, 0, 0]}
        moving = truth.top([0, 0, -1], [-rates[1], rates[0], 0], -spin, 2 * (across + 0.25), 2 * thin * across, 1.0)
        places = lambda times: [[0.5 * x for x in n] for n in moving(times)]
    expect = {"dof": 2, "redundant": 0} if kind == "universal" else {}
    return Case(f"thin rod on a {kind} joint, {thin:g}" + (f", spin {spin:g}" if spin else ""), space(body=body, joint={"ball": joint}),
                0.01, 0.5, places, ("rod.x", "rod.y", "rod.z"), length=1.0, energy=2 * GRAVITY, weight=2 * GRAVITY, expect=expect)


def centre_of_tilts(y):
    a, b = y[:2]
    return [-0.5 * math.sin(b), 0.5 * math.sin(a) * math.cos(b), -0.5 * math.cos(a) * math.cos(b)]


def coin(thick):
    """A coin of 1 kg that rolls leaning; its moments are a flat disc's but for `thick` of them."""
    radius, lean, spin = 0.2, 0.3, 12.0
    along, across = 0.5 * radius**2, 0.25 * radius**2 * (1 + thick)
    c, s = math.cos(lean), math.sin(lean)
    start = {"mass": 1.0, "inertia": [across, across, along], "position": [0, 0, radius * c],
             "orientation": {"axis": [1, 0, 0], "angle": lean - 0.5 * math.pi}, "velocity": [spin * radius, 0, 0],
             "angular_velocity": [0, spin * c, spin * s]}
    contact = {"type": "rolling", "between": ["ground", "disc"], "at": [0, 0, radius * c], "axis": [0, c, s], "normal": [0, 0, 1],
               "radius": radius}
    moving = truth.disc(radius, across, along, [0, c, s], [0, spin * c, spin * s], [0, 0, radius * c])
    return Case(f"coin, {thick:g}", space(body={"disc": start}, joint={"contact": contact}), 0.005, 0.5, moving,
                ("disc.x", "disc.y", "disc.z"), length=radius, energy=4.0, speed=2.4, rate=12.0)


def away(far):
    """A place far from the origin in all directions."""
    return np.array([far, 0.5 * far, -far])


def far_points(n, far, planar_rate=0.0):
    """A pendulum of n points of 1 kg, and a metre each, that swings in the plane of x and z at a far place."""
    origin = away(far)
    point, rods_ = {}, {}
    for k in range(n):
        point[f"P{k}"] = {"mass": 1.0, "position": origin + [k + 1, 0, 0], "velocity": [0, 0, planar_rate * (k + 1)]}
        first = origin if k == 0 else f"P{k - 1}"
        rods_[f"r{k}"] = rod(first, f"P{k}")
    moving = truth.chain([(1, 1, 1, 0)] * n, [0.0] * n, [planar_rate] * n)
    places = lambda times: [shifted(row, origin) for row in truth.ends(moving(times), [1] * n)]
    return placed(f"{'pendulum' if n == 1 else 'double pendulum'} at {far:.0e} m", space(point=point, constraint=rods_), far, places,
                  tuple(f"P{k}.{axis}" for k in range(n) for axis in "xz"), n)


def far_links(n, far, reactions):
    """The same of rigid rods with square sections."""
    origin = away(far)
    body, joint = {}, {}
    for k in range(n):
        body[f"b{k}"] = {"mass": 1.0, "inertia": rank.moments_along(0, 0.01), "position": origin + [k + 0.5, 0, 0]}
        joint[f"j{k}"] = revolute("ground" if k == 0 else f"b{k - 1}", f"b{k}", origin + [k, 0, 0], [0, 1, 0])
    moving = truth.chain([(1, 0.5, 1, 1 / 12)] * n, [0.0] * n)
    places = lambda times: [shifted(rank.centres(row), origin) for row in truth.ends(moving(times), [1] * n)]
    model = space(body=body, joint=joint)
    return placed(f"{n} links at {far:.0e} m" + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, far,
                  places, tuple(f"b{k}.{axis}" for k in range(n) for axis in "xz"), n, {"dof": n, "redundant": 0})


def shifted(row, origin):
    return [x + origin[2 * (k % 2)] for k, x in enumerate(row)]


def far_four_bar(far, reactions):
    """A parallel four-bar on four hinges: a pendulum of one freedom with three redundant rows."""
    origin, tilt, rate = away(far), math.pi / 3, -2.0
    head = np.array([math.cos(tilt), 0, math.sin(tilt)])
    swing = rate * np.array([-head[2], 0, head[0]])
    body, joint = {}, {}
    for name, at in (("left", np.zeros(3)), ("right", np.array([2.0, 0, 0]))):
        body[name] = {"mass": 1.0, "inertia": rank.moments_along(0, 0.01), "position": origin + at + 0.5 * head,
                      "orientation": {"axis": [0, 1, 0], "angle": -tilt}, "velocity": 0.5 * swing, "angular_velocity": [0, -rate, 0]}
        joint[f"{name}-foot"] = revolute("ground", name, origin + at, [0, 1, 0])
        joint[f"{name}-head"] = revolute(name, "beam", origin + at + head, [0, 1, 0])
    body["beam"] = {"mass": 2.0, "inertia": rank.moments_along(0, 0.01, 2 / 3), "position": origin + head + [1, 0, 0], "velocity": swing}
    moving = truth.pendulum(2 / 3 + 2, 3.0, tilt, rate)
    places = lambda times: [[origin[0] + 1 + math.cos(a), origin[2] + math.sin(a)] for a in moving(times)]
    model = space(body=body, joint=joint)
    return placed(f"four-bar at {far:.0e} m" + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, far,
                  places, ("beam.x", "beam.z"), 2, {"dof": 1, "redundant": 3} if reactions else {"dof": 1})


def placed(name, model, far, places, columns, size, expect=None):
    return Case(name, model, 0.01, 0.5, places, columns, length=float(size), energy=2 * size * GRAVITY * size, weight=2 * size * GRAVITY,
                speed=math.sqrt(2 * GRAVITY * size), offset=far, floor=1e-9 + 50 * 2.0**-52 * far, expect=expect or {})


def cases():
    for thin in THIN:
        yield rank.bricard(f"thin Bricard, {thin:g}", thin)
        yield from (rods(n, thin) for n in (2, 3))
        yield hanging("spherical", thin, 0.0)
        yield hanging("universal", thin, 0.0)
    yield from (rank.bricard(f"thin Bricard, {thin:g}", thin, reactions=True) for thin in (0.0, 1e-9))
    yield from (rods(2, thin, True) for thin in (0.0, 1e-9))
    yield from (hanging("spherical", thin, 30.0) for thin in (1e-7, 1e-4))
    yield from (plates(2, thin) for thin in THIN)
    yield from (plates(2, thin, True) for thin in (0.0, 1e-9))
    yield from (coin(thick) for thick in (0.0, 1e-12, 1e-9, 1e-6, 1e-3))
    for far in (1e4, 1e7):
        yield from (far_points(n, far) for n in (1, 2))
        yield from (far_links(n, far, reactions) for n in (1, 2) for reactions in (False, True))
        yield from (far_four_bar(far, reactions) for reactions in (False, True))
