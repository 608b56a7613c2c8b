"""All cases: two bodies on a joint, couplers between hinges, rolling."""

import numpy as np

from chains import FLAT, FLOATING, NONE, Z, move, other_two, slide, turn, unit
from checks import case
from kinds import (
    U,
    W,
    constant_velocity,
    cylindrical,
    distance,
    fixed,
    flat_point_on_line,
    flat_prismatic,
    flat_revolute,
    generic,
    generic_all,
    orientation,
    parallel,
    perpendicular,
    planar,
    point_on_closed_curve,
    point_on_curve,
    point_on_line,
    point_on_plane,
    prismatic,
    revolute,
    revolute_spherical,
    screw,
    spherical,
    universal,
)
from motion import Body, Motion, rotation


class Draw:
    """Decimals that look arbitrary and are the same everywhere."""

    def __init__(self, seed):
        self.i = 1000 * seed

    def number(self, low, high):
        self.i += 1
        return round(low + (high - low) * ((self.i * 0.6180339887498949) % 1.0), 3)

    def vector(self, size, middle=NONE):
        return np.array([round(m + self.number(-size, size), 3) for m in middle])

    def rate(self):
        return self.number(0.7, 1.6) * (1.0 if self.number(0, 1) < 0.5 else -1.0)

    def quat(self):
        return unit([self.number(-1, 1) for _ in range(4)])


def gap(frames, parent, place_a, body, place_b):
    """From the place on the parent to that on the body, both places given at the start."""
    a, b = frames[parent.name if parent else None], frames[body.name]
    origin = parent.position if parent else np.zeros(3)
    return b.p + b.R @ (place_b - body.position) - a.p - a.R @ (place_a - origin), a.R, b.R


def started(draw, first, n, speeds):
    """State at the start: the first body's place, zeros, the rates: those of the first body, then relative ones."""
    start = np.zeros(n + speeds)
    if first:
        size = 2 if first.chain is FLAT else 3
        start[:size] = first.position[:size]
    start[n:] = [draw.rate() for _ in range(speeds)]
    return start


def two_bodies(seed, function, name=None, kind_name=None, ground=False, flat=False, **more):
    """One joint between A, or the ground, and B."""
    draw, k = Draw(seed), 0 if ground else 3 if flat else 6
    kind_name = kind_name or function.__name__.replace("_", "-")
    level = np.array([1.0, 1.0, 0.0 if flat else 1.0])
    quat = lambda: unit([draw.number(0.3, 1), 0, 0, draw.number(-1, 1)]) if flat else draw.quat()
    joint = function(k, draw.vector(0.1, [0.4, 0.1, 0.5]) * level)
    place = joint["keys"].get("at", joint["place"])
    place_a, place_b = place if np.ndim(place) == 2 else (place, place)
    a = None if ground else Body("A", None, draw.vector(0.1, [0.0, -0.2, 0.3]) * level, quat(), FLAT if flat else FLOATING)
    centre = draw.vector(0.1, place_b + [0.35, 0.3, -0.2]) * level
    chain = [move(place_a - (a.position if a else 0.0)), *joint["links"], move(centre - place_b)]
    b = Body("B", a and "A", centre, quat(), chain)
    n = k + joint["freedom"]
    keys = dict(type=kind_name, between=["A" if a else "ground", "B"], **joint["keys"])
    if flat:
        keys.update({key: keys[key][:2] for key in ("at", "axis") if key in keys})
    return case(
        name or kind_name,
        kind_name,
        joint["freedom"],
        Motion([a, b] if a else [b], n, flat=flat),
        started(draw, a, n, n),
        {"joint": keys},
        [("joint", "B", place_b, None, None)],
        lambda frames: np.array(joint["equations"](*gap(frames, a, place_a, b, place_b)), float),
        {f"joint.{key}": parts for key, parts in joint["named"].items()},
        **more,
    )


HINGES = {"revolute": ["turn"], "prismatic": ["slide"], "cylindrical": ["slide", "turn"]}


def coupled(seed, name, kind_name, keys, hinges, freedom):
    """Housing A with B and C on hinges j1 and j2 which a coupler ties. `hinges`: for each its type and, by "slide" and "turn",
    which multiples of the coordinates it follows: {number from 6: factor}."""
    draw, n = Draw(seed), 6 + freedom
    a = Body("A", None, draw.vector(0.1, [0.0, -0.2, 0.3]), draw.quat(), FLOATING)
    bodies, joints, watched, named, places = [a], {}, [], {}, []
    for j, (kind_of_hinge, follows) in enumerate(hinges):
        axis = [U, np.array([1.0, -1.0, 2.0])][j]
        at = draw.vector(0.1, [[0.4, 0.1, 0.5], [-0.3, 0.2, 0.1]][j])
        centre = draw.vector(0.1, at + [[0.15, 0.1, -0.1], [-0.1, 0.15, 0.1]][j])
        each = [(how, k, factor) for how, parts in follows.items() for k, factor in parts.items()]
        links = [(slide if how == "slide" else turn)(axis, k, factor) for how, k, factor in each]
        body = Body("BC"[j], "A", centre, draw.quat(), [move(at - a.position), *links, move(centre - at)])
        bodies.append(body)
        joints[f"j{j + 1}"] = dict(type=kind_of_hinge, between=["A", body.name], at=at, axis=axis)
        watched.append((f"j{j + 1}", body.name, at, HINGES[kind_of_hinge], axis))
        for how, parts in follows.items():
            named[f"j{j + 1}.{'angle' if how == 'turn' else 'displacement'}"] = parts
        places.append((body, at, axis))
    joints["coupler"] = dict(type=kind_name, **keys)

    def equations(frames):
        """Of the hinges, by the table of kinds, and of the coupler, with the coordinates read off the bodies."""
        found, read = [], {}
        for j, (body, at, axis) in enumerate(places):
            d, A, B = gap(frames, a, at, body, at)
            e, f = other_two(axis)
            read[f"j{j + 1}.displacement"] = d @ (A @ unit(axis))
            read[f"j{j + 1}.angle"] = np.arctan2((A @ np.cross(unit(axis), e)) @ (B @ e), (A @ e) @ (B @ e))
            found += [d @ (A @ e), d @ (A @ f), (A @ e) @ (B @ unit(axis)), (A @ f) @ (B @ unit(axis))]
            freed = HINGES[joints[f"j{j + 1}"]["type"]]
            found += [] if "slide" in freed else [read[f"j{j + 1}.displacement"]]
            found += [] if "turn" in freed else [read[f"j{j + 1}.angle"]]
        return np.array(found + [COUPLERS[kind_name](keys, read)])

    note = "reaction: of the hinge alone; with_coupler: and what the coupler exerts on the same body"
    return case(
        name, kind_name, freedom, Motion(bodies, n), started(draw, a, n, n), joints, watched, equations, named, note=note
    )


def pulley(keys, q):
    first, second = keys["radii"]
    return first * q["j1.angle"] + (second if keys["crossed"] else -second) * q["j2.angle"]


COUPLERS = {
    "gear": lambda keys, q: q["j1.angle"] - keys["ratio"] * q["j2.angle"],
    "rack-and-pinion": lambda keys, q: q["j2.displacement"] - keys["radius"] * q["j1.angle"],
    "pulley": pulley,
    "linear": lambda keys, q: sum(term["factor"] * q[term["joint"]] for term in keys["terms"]),
    "cam": lambda keys, q: q["j2.displacement"] - eval(keys["lift"], {"q": q["j1.angle"]}),
}


def rolling(seed, name="rolling", ground=True):
    """Disc B on a plane of the ground, or of A. Coordinates: the contact's place in the plane, heading, tilt, turn of the disc;
    the last three have independent rates, the contact moves by radius times turn along the heading."""
    draw, k, radius = Draw(seed), 0 if ground else 6, 0.3
    a = None if ground else Body("A", None, draw.vector(0.1, [0.0, -0.2, 0.3]), draw.quat(), FLOATING)
    contact = np.array([0.2, -0.1, 0.0]) if ground else draw.vector(0.1, [0.4, 0.1, 0.5])
    normal, quat = Z if ground else W, unit([0.7, 0.55, 0.15, 0.25] if ground else [0.7, 0.2, -0.3, 0.1])
    n, axis = unit(normal), rotation(quat) @ Z
    up = unit(n - (n @ axis) * axis)
    heading, centre = np.cross(axis, up), contact + radius * up
    links = [slide(heading, k), slide(np.cross(n, heading), k + 1), turn(n, k + 2), turn(heading, k + 3)]
    chain = [move(contact - (a.position if a else 0.0)), *links, move(radius * up), turn(axis, k + 4)]
    b = Body("B", a and "A", centre, quat, chain, (1.7, [0.05, 0.05, 0.09, 0.0, 0.0, 0.0]))

    def rates(q, u):
        c, s, heading_rate, turn_rate = np.cos(q[k + 2]), np.sin(q[k + 2]), u[k], u[k + 2]
        N, bias = np.zeros((k + 5, k + 3)), np.zeros(k + 5)
        N[:k, :k], N[k + 2 :, k:] = np.eye(k), np.eye(3)
        N[k : k + 2, k + 2] = radius * c, radius * s
        bias[k : k + 2] = radius * turn_rate * heading_rate * np.array([-s, c])
        return N, bias

    def equations(frames):
        d, A, B = gap(frames, a, contact, b, centre)
        frame, base, normal, axis_now = frames["B"], frames["A" if a else None], A @ n, B @ axis
        arm = -radius * unit(normal - (normal @ axis_now) * axis_now)  # from the centre to the lowest point
        touch = frame.p + arm
        slip = frame.v + np.cross(frame.w, arm) - base.v - np.cross(base.w, touch - base.p)
        return np.array([(d + arm) @ normal, *slip, *(frame.moment - np.cross(arm, frame.force))])

    start = started(draw, a, k + 5, k + 3)
    start[-3:] = 0.4, -0.3, 6.0  # fast enough to stay up
    keys = dict(type="rolling", between=["A" if a else "ground", "B"], at=centre, axis=axis, normal=normal, radius=radius)
    motion, watched = Motion([a, b] if a else [b], k + 5, rates), [("joint", "B", centre, None, None)]
    note = "freedom: of the velocities; moment of the reaction about the centre of the disc"
    return case(name, "rolling", 3, motion, start, {"joint": keys}, watched, equations, note=note)


def all_cases():
    free = "the joint exerts no force, so the moment is the same about every place"
    kinds = [(1, spherical), (10, revolute), (12, prismatic), (12, cylindrical), (10, universal), (11, planar), (11, fixed)]
    kinds += [(10, screw), (2, constant_velocity), (12, point_on_line), (12, point_on_plane), (12, point_on_curve)]
    kinds += [(11, distance), (2, revolute_spherical)]
    yield from (two_bodies(seed, function) for seed, function in kinds)
    for seed, function in [(11, parallel), (12, perpendicular), (4, orientation)]:
        yield two_bodies(seed, function, note=free)
    yield two_bodies(12, point_on_closed_curve, "point-on-curve-closed", "point-on-curve")
    yield two_bodies(6, generic, "generic-x-z-rx")
    yield two_bodies(10, generic_all, "generic-all", "generic")
    revolutes = lambda ratio: [("revolute", {"turn": {6: ratio}}), ("revolute", {"turn": {6: 1.0}})]
    yield coupled(31, "gear", "gear", dict(joints=["j1", "j2"], ratio=-1.6), revolutes(-1.6), 1)
    rack = [("revolute", {"turn": {6: 1.0}}), ("prismatic", {"slide": {6: 0.3}})]
    yield coupled(32, "rack-and-pinion", "rack-and-pinion", dict(joints=["j1", "j2"], radius=0.3), rack, 1)
    for seed, crossed in ((33, False), (34, True)):
        keys = dict(joints=["j1", "j2"], radii=[0.2, 0.35], crossed=crossed)
        ratio = (-1.0 if crossed else 1.0) * 0.35 / 0.2
        yield coupled(seed, "pulley-crossed" if crossed else "pulley", "pulley", keys, revolutes(ratio), 1)
    terms = [dict(joint="j1.angle", factor=0.5), dict(joint="j1.displacement", factor=2.0), dict(joint="j2.angle", factor=-0.8)]
    both = {"slide": {6: -0.25, 7: 0.4}, "turn": {6: 1.0}}
    yield coupled(35, "linear", "linear", dict(terms=terms), [("cylindrical", both), ("revolute", {"turn": {7: 1.0}})], 2)
    yield coupled(36, "cam", "cam", dict(joints=["j1", "j2"], lift="0.25*q"), [rack[0], ("prismatic", {"slide": {6: 0.25}})], 1)
    yield rolling(41)
    yield rolling(42, "rolling-on-body", ground=False)
    for seed, function in [(9, spherical), (1, revolute), (1, cylindrical), (10, universal), (2, point_on_line)]:
        yield two_bodies(seed, function, function.__name__.replace("_", "-") + "-to-ground", ground=True)
    flat = [(flat_revolute, "revolute"), (flat_prismatic, "prismatic"), (fixed, "fixed")]
    flat += [(flat_point_on_line, "point-on-line")]
    for seed, (function, kind_name) in enumerate(flat, 61):
        yield two_bodies(seed, function, "planar-" + kind_name, kind_name, flat=True)
