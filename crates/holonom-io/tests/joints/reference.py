#!/usr/bin/env python3
"""Reference motions of bodies on joints, computed in minimal coordinates: the origin of reference.json beside this file.

    python3 -m venv venv && venv/bin/pip install numpy scipy
    venv/bin/python reference.py            # checks, prints a table and writes reference.json; --check writes nothing

Method. Every body hangs on a chain of elementary motions (slides, turns, a motion along a curve) whose coordinates q are
independent: six for the first body, then those that the joint leaves. With the twist Jacobians J of the centres of mass,
the equations of motion are Kane's,

    Σ Jv'·m·(Jv·u̇ + bv - g) + Jw'·(I·(Jw·u̇ + bw) + w × I·w) = 0,

b being what remains of the accelerations at u̇ = 0. u = q̇ but for rolling, where q̇ = N(q)·u. No constraint is solved and
no multiplier appears, so that nothing drifts off the joints. Reactions follow from Newton-Euler on the second body.

Axes. All bodies' reference axes are parallel to the world at the start; a body's own axes are turned against them by its
orientation at the start. So every vector of a joint in a model text serves in a chain as it stands.

Checks, all of which must hold: a second integrator (extrapolation in fixed steps beside DOP853); the energy; the joint's
equations as the model file format states them, evaluated on the bodies; the balance of all reactions (the joint alone acts
between the bodies); rolling also: velocity at the contact, and no moment about it.

A case is {name, kind, freedom, method, note?, model, end, bodies, coordinates, reaction or reactions}: `freedom` counts
relative velocities, `model` is a model text, `bodies` and `coordinates` are those at the end. A reaction is that of the joint
on its second body, moment about the joint's place on that body, world axes, before and after the motion. Cases with a coupler
have the reactions of both hinges, and with the coupler's part added.
"""

import json
import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

END = 0.5
X, Y, Z = np.eye(3)
TOLERANCE = 1e-11  # of every check

# Directions of the joints: perpendicular to each other without rounding, neither unit nor along world axes.
U, V, W = np.array([1.0, 2.0, -1.0]), np.array([2.0, 0.0, 2.0]), np.array([4.0, -4.0, -4.0])


def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def unit(a):
    return np.asarray(a, float) / np.linalg.norm(a)


# --- chains -------------------------------------------------------------------------------------------------------------


class Frame:
    """Pose of a point and axes, its velocity, the Jacobians to q̇ and the accelerations at q̈ = 0."""

    def __init__(self, n):
        self.R, self.p = np.eye(3), np.zeros(3)
        self.Jw, self.Jv = np.zeros((3, n)), np.zeros((3, n))
        self.w, self.v, self.bw, self.bv = (np.zeros(3) for _ in range(4))

    def after(self, chain, q, qd):
        frame = Frame(len(q))
        frame.__dict__.update({key: value.copy() for key, value in self.__dict__.items()})
        for link in chain:
            link(frame, q, qd)
        return frame

    def shift(self, r, rate, bias):
        """To a point at r, moving at `rate` and with acceleration `bias` as seen from the frame's axes; in world axes."""
        spin, along = skew(self.w), skew(self.w) @ r
        self.p = self.p + r
        self.Jv -= skew(r) @ self.Jw
        self.bv = self.bv + skew(self.bw) @ r + spin @ (along + 2.0 * rate) + bias
        self.v = self.v + along + rate


NONE = np.zeros(3)


def move(r):
    r = np.array(r, float)
    return lambda frame, q, qd: frame.shift(frame.R @ r, NONE, NONE)


def slide(axis, k, factor=1.0):
    axis = factor * unit(axis)

    def link(frame, q, qd):
        e = frame.R @ axis
        frame.shift(q[k] * e, qd[k] * e, NONE)
        frame.Jv[:, k] += e

    return link


def along(curve, start, k):
    """Along curve(start + q) from curve(start)."""
    first, second, origin = curve.derivative(1), curve.derivative(2), curve(start)

    def link(frame, q, qd):
        s = start + q[k]
        tangent = frame.R @ first(s)
        frame.shift(frame.R @ (curve(s) - origin), qd[k] * tangent, qd[k] ** 2 * (frame.R @ second(s)))
        frame.Jv[:, k] += tangent

    return link


def turn(axis, k, factor=1.0):
    axis = unit(axis)
    K = skew(axis)
    K2 = K @ K

    def link(frame, q, qd):
        e = frame.R @ axis
        angle, rate = factor * q[k], factor * qd[k]
        frame.bw = frame.bw + rate * (skew(frame.w) @ e)
        frame.w = frame.w + rate * e
        frame.Jw[:, k] += factor * e
        frame.R = frame.R @ (np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * K2)

    return link


def turns(k):
    """All rotations; the singular place, a quarter turn of the second angle, stays far away."""
    return [turn(X, k), turn(Y, k + 1), turn(Z, k + 2)]


# --- bodies and their motion --------------------------------------------------------------------------------------------


def rotation(quat):
    w, r = quat[0], np.asarray(quat[1:])
    return (w * w - r @ r) * np.eye(3) + 2.0 * np.outer(r, r) + 2.0 * w * skew(r)


def quaternion(R):
    """Through the greatest of the four (Shepperd)."""
    t = np.trace(R)
    four = np.array([t, R[0, 0], R[1, 1], R[2, 2]])
    i = int(np.argmax(four))
    if i == 0:
        quat = np.array([1.0 + t, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    else:
        a, b, c = i - 1, i % 3, (i + 1) % 3
        quat = np.empty(4)
        quat[0], quat[1 + a] = R[c, b] - R[b, c], 1.0 + 2.0 * R[a, a] - t
        quat[1 + b], quat[1 + c] = R[b, a] + R[a, b], R[c, a] + R[a, c]
    return unit(quat)


def angle(quat):
    return 2.0 * np.arctan2(quat[3], quat[0])


class Body:
    def __init__(self, name, parent, position, quat, chain, shape=None):
        """`chain`: from the parent's centre of mass to this one's. `shape`: mass and [Ixx, Iyy, Izz, Ixy, Ixz, Iyz], body axes."""
        self.name, self.parent, self.position, self.quat, self.chain = name, parent, np.array(position), quat, chain
        self.mass, self.inertia = shape or SHAPES[name]
        self.turned = rotation(quat)
        xx, yy, zz, xy, xz, yz = self.inertia
        self.I = self.turned @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ self.turned.T


class Motion:
    """`n` coordinates q; `rates`: of (q, u) gives N of q̇ = N·u and Ṅ·u, for rolling."""

    def __init__(self, bodies, n, rates=None, flat=False):
        self.bodies, self.n, self.flat = bodies, n, flat
        self.gravity = np.array([0.0, -9.81, 0.0] if flat else [0.0, 0.0, -9.81])
        self.rates = rates or (lambda q, u: (np.eye(n), np.zeros(n)))

    def frames(self, q, qd):
        frames = {None: Frame(len(q))}
        for body in self.bodies:
            frames[body.name] = frames[body.parent].after(body.chain, q, qd)
        return frames

    def evaluate(self, y):
        """q̇, u̇, frames with what acts on the bodies, mass matrix."""
        q, u = y[: self.n], y[self.n :]
        N, bias = self.rates(q, u)
        qd = N @ u
        frames = self.frames(q, qd)
        M, h, terms = 0.0, 0.0, []
        for body in self.bodies:
            frame = frames[body.name]
            I = frame.R @ body.I @ frame.R.T
            Jv, Jw = frame.Jv @ N, frame.Jw @ N
            bv, bw = frame.bv + frame.Jv @ bias, frame.bw + frame.Jw @ bias
            gyroscopic = skew(frame.w) @ (I @ frame.w)
            M = M + body.mass * Jv.T @ Jv + Jw.T @ I @ Jw
            h = h + body.mass * Jv.T @ (self.gravity - bv) - Jw.T @ (I @ bw + gyroscopic)
            terms.append((body, frame, I, Jv, Jw, bv, bw, gyroscopic))
        ud = np.linalg.solve(M, h)
        for body, frame, I, Jv, Jw, bv, bw, gyroscopic in terms:
            frame.force = body.mass * (Jv @ ud + bv - self.gravity)  # all but gravity on this body
            frame.moment = I @ (Jw @ ud + bw) + gyroscopic  # and its moment about the centre of mass
            frame.energy = 0.5 * frame.w @ I @ frame.w + body.mass * (0.5 * frame.v @ frame.v - self.gravity @ frame.p)
        return qd, ud, frames, M

    def slope(self, y):
        return np.concatenate(self.evaluate(y)[:2])

    def solve(self, y, parts=5):
        """States at equal distances, by DOP853."""
        states = [y]
        for _ in range(parts):
            step = solve_ivp(lambda _, y: self.slope(y), (0.0, END / parts), states[-1], "DOP853", rtol=1e-13, atol=1e-14)
            states.append(step.y[:, -1])
        return states

    def solve_again(self, y, steps=40):
        """State at the end, by extrapolation of the modified midpoint rule: order 14."""
        H = END / steps
        counts = [2 * j for j in range(1, 8)]
        for _ in range(steps):
            start, table = self.slope(y), []
            for j, count in enumerate(counts):
                h = H / count
                before, now = y, y + h * start
                for _ in range(count - 1):
                    before, now = now, before + 2.0 * h * self.slope(now)
                row = [0.5 * (now + before + h * self.slope(now))]
                for k in range(j):
                    row.append(row[k] + (row[k] - table[k]) / ((count / counts[j - k - 1]) ** 2 - 1.0))
                table = row
            y = table[-1]
        return y


# --- model texts --------------------------------------------------------------------------------------------------------


def toml(value):
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(toml(one) for one in value) + "]"
    return repr(float(value))


def text(name, motion, frames, joints):
    lines = ["schema = 1", f'title = "Reference: {name}"'] + (['plane = "xy"'] if motion.flat else [])
    lines.append(f"gravity = {toml(motion.gravity[:2] if motion.flat else motion.gravity)}")
    for body in motion.bodies:
        frame = frames[body.name]
        if motion.flat:
            shape = [body.inertia[2], body.position[:2], {"angle": angle(body.quat)}, frame.v[:2], frame.w[2]]
        else:
            shape = [body.inertia, body.position, {"quat_wxyz": body.quat}, frame.v, frame.w]
        keys = ["inertia", "position", "orientation", "velocity", "angular_velocity"]
        lines += ["", f"[body.{body.name}]", f"mass = {toml(body.mass)}"]
        lines += [f"{key} = {toml(value)}" for key, value in zip(keys, shape)]
    for joint, keys in joints.items():
        lines += ["", f"[joint.{joint}]"] + [f"{key} = {toml(value)}" for key, value in keys.items()]
    lines += ["", "[simulation]", f"end = {END}", "step = 0.01", "", "[output]", "reactions = true", ""]
    return "\n".join(lines)


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


SHAPES = {
    "A": (2.3, [0.19, 0.24, 0.17, 0.021, -0.013, 0.017]),
    "B": (1.4, [0.11, 0.08, 0.12, -0.011, 0.009, 0.014]),
    "C": (1.1, [0.06, 0.09, 0.07, 0.008, 0.012, -0.007]),
}
FLOATING = [slide(X, 0), slide(Y, 1), slide(Z, 2)] + turns(3)  # a free body in space, and in the plane
FLAT = [slide(X, 0), slide(Y, 1), turn(Z, 2)]


# --- kinds --------------------------------------------------------------------------------------------------------------
# A kind is a function of (k, at): the number of the joint's first coordinate and its place. It returns the keys of the
# model text, the links, how many coordinates they have, the joint's equations as functions of (d, A, B) — d = r_B - r_A at
# the place, A and B the turns since the start — and the coordinates that have a name, as {name: {number: factor}}.

x, y, z = unit(U), unit(V), unit(W)


def kind(place, keys, links, freedom, equations, named=None):
    return dict(place=place, keys=keys, links=links, freedom=freedom, equations=equations, named=named or {})


def coaxial(d, A, B):
    return [(A @ y) @ (B @ x), (A @ z) @ (B @ x)]


def off_axis(d, A, B):
    return [d @ (A @ y), d @ (A @ z)]


def same_axes(d, A, B):
    return [*coaxial(d, A, B), (A @ y) @ (B @ z)]


def spherical(k, at):
    return kind(at, dict(at=at), turns(k), 3, lambda d, A, B: d)


def revolute(k, at, axis=U):
    e, f = other_two(axis)
    equations = lambda d, A, B: [*d, (A @ e) @ (B @ unit(axis)), (A @ f) @ (B @ unit(axis))]
    return kind(at, dict(at=at, axis=axis), [turn(axis, k)], 1, equations, {"angle": {k: 1.0}})


def other_two(axis):
    e = unit(np.cross(axis, X))
    return e, unit(np.cross(axis, e))


def prismatic(k, at, axis=U):
    e, f = other_two(axis)
    equations = lambda d, A, B: [d @ (A @ e), d @ (A @ f), *same_axes(d, A, B)]
    return kind(at, dict(at=at, axis=axis), [slide(axis, k)], 1, equations, {"displacement": {k: 1.0}})


def cylindrical(k, at):
    equations = lambda d, A, B: [*off_axis(d, A, B), *coaxial(d, A, B)]
    named = {"displacement": {k: 1.0}, "angle": {k + 1: 1.0}}
    return kind(at, dict(at=at, axis=U), [slide(U, k), turn(U, k + 1)], 2, equations, named)


def universal(k, at):
    return kind(at, dict(at=at, axes=[U, V]), [turn(U, k), turn(V, k + 1)], 2, lambda d, A, B: [*d, (A @ x) @ (B @ y)])


def planar(k, at):
    equations = lambda d, A, B: [d @ (A @ x), *coaxial(d, A, B)]
    return kind(at, dict(at=at, axis=U), [slide(V, k), slide(W, k + 1), turn(U, k + 2)], 3, equations, {"angle": {k + 2: 1.0}})


def fixed(k, at):
    return kind(at, dict(at=at), [], 0, lambda d, A, B: [*d, *same_axes(d, A, B)])


def screw(k, at):
    pitch = 0.8
    slope = pitch / (2.0 * np.pi)

    def equations(d, A, B):
        angle = np.arctan2((A @ z) @ (B @ y), (A @ y) @ (B @ y))
        return [*off_axis(d, A, B), *coaxial(d, A, B), d @ (A @ x) - slope * angle]

    links = [slide(U, k, slope), turn(U, k)]
    return kind(at, dict(at=at, axis=U, pitch=pitch), links, 1, equations, {"angle": {k: 1.0}, "displacement": {k: slope}})


def constant_velocity(k, at):
    """Turned by φ about the first shaft, bent about the common normal, turned back by φ about the second shaft."""
    first, second = U, np.array([2.0, 0.0, -1.0])
    v = unit(np.cross(first, second))
    w1, w2 = np.cross(unit(first), v), np.cross(unit(second), v)
    links = [turn(first, k), turn(v, k + 1), turn(second, k, -1.0)]
    return kind(at, dict(at=at, axes=[first, second]), links, 2, lambda d, A, B: [*d, (A @ w1) @ (B @ v) - (A @ v) @ (B @ w2)])


def point_on_line(k, at):
    return kind(at, dict(at=at, axis=U), [slide(U, k)] + turns(k + 1), 4, off_axis, {"displacement": {k: 1.0}})


def point_on_plane(k, at):
    return kind(at, dict(at=at, axis=U), [slide(V, k), slide(W, k + 1)] + turns(k + 2), 5, lambda d, A, B: [d @ (A @ x)])


# Bent in space; the motion begins in the middle of the third part and stays in that part.
POINTS = [[-0.4, 0.3, 1.1], [-0.2, 0.6, 0.5], [0.1, -0.1, 0.2], [0.8, 0.2, 0.9], [1.4, -0.3, 0.7], [1.6, -0.8, 1.1]]


def point_on_curve(k, at, closed=False):
    """Natural spline, or a periodic one, over the length of the chords; a closed curve does not repeat its first point."""
    points = POINTS + POINTS[:1] if closed else POINTS
    lengths = np.cumsum([0.0, *np.linalg.norm(np.diff(points, axis=0), axis=1)])
    curve = CubicSpline(lengths, np.array(points), bc_type="periodic" if closed else "natural")
    start = 0.5 * (lengths[2] + lengths[3])

    def equations(d, A, B):
        """From the curve across its tangent, at the parameter nearest to the point."""
        s, r = start, curve(start) + A.T @ d
        for _ in range(30):
            miss, tangent = curve(s) - r, curve(s, 1)
            s -= miss @ tangent / (tangent @ tangent + miss @ curve(s, 2))
        assert lengths[2] < s < lengths[3], "the motion stays between two points of the curve"
        return [(curve(s) - r) @ e for e in other_two(curve(s, 1))]

    keys = dict(at=curve(start), curve=POINTS, closed=closed)
    return kind(at, keys, [along(curve, start, k)] + turns(k + 1), 4, equations)


def point_on_closed_curve(k, at):
    return point_on_curve(k, at, closed=True)


def parallel(k, at):
    return kind(at, dict(axis=U), [slide(X, k), slide(Y, k + 1), slide(Z, k + 2), turn(U, k + 3)], 4, coaxial)


def perpendicular(k, at):
    links = [slide(X, k), slide(Y, k + 1), slide(Z, k + 2), turn(U, k + 3), turn(V, k + 4)]
    return kind(at, dict(axes=[U, V]), links, 5, lambda d, A, B: [(A @ x) @ (B @ y)])


def orientation(k, at):
    return kind(at, {}, [slide(X, k), slide(Y, k + 1), slide(Z, k + 2)], 3, same_axes)


def distance(k, at):
    """Two angles for the direction of the rod, three for the body behind it."""
    rod = 0.15 * W - 0.1 * U
    e, f = other_two(rod)
    equations = lambda d, A, B: [np.linalg.norm(d) - np.linalg.norm(rod)]
    return kind(at, dict(at=[at, at + rod]), [turn(e, k), turn(f, k + 1), move(rod)] + turns(k + 2), 5, equations)


def generic(k, at):
    """Free along y; rx locked means y_A·z_B = 0, which leaves turns about y_A and z_B."""
    equations = lambda d, A, B: [d @ (A @ x), d @ (A @ z), (A @ y) @ (B @ z)]
    links = [slide(V, k), turn(V, k + 1), turn(W, k + 2)]
    return kind(at, dict(at=at, locks=["x", "z", "rx"], axes=[U, V]), links, 3, equations)


def generic_all(k, at):
    keys = dict(at=at, locks=["x", "y", "z", "rx", "ry", "rz"], axes=[U, V])
    return kind(at, keys, [], 0, lambda d, A, B: [*d, *same_axes(d, A, B)])


# --- cases --------------------------------------------------------------------------------------------------------------


def case(name, kind, freedom, motion, start, joints, watched, equations, named=None, **more):
    """Integrates, checks and writes down. `watched`: (joint, body, place on the body at the start, freed, axis), see `wrench`;
    `equations`: of the frames of all bodies; `named`: the coordinates to write."""
    states = motion.solve(start)
    looks = [motion.evaluate(state) for state in states]
    frames = [look[2] for look in looks]
    first, last = frames[0], frames[-1]
    checks = {
        "integrators": differ(motion, last, motion.evaluate(motion.solve_again(start))[2]),
        "energy": np.ptp([sum(f[body.name].energy for body in motion.bodies) for f in frames]),
        "joint": max(np.max(np.abs(equations(f)), initial=0.0) for f in frames),
        "balance": max(unbalanced(motion, f) for f in frames),
    }
    condition = max(np.linalg.cond(look[3]) for look in looks)
    print(f"{name:28}" + "".join(f"{check:13.1e}" for check in checks.values()) + f"{condition:11.0f}")
    assert max(checks.values()) < TOLERANCE and condition < 1e3, name
    reactions = []
    for joint, body, place, freed, axis in watched:
        body = next(one for one in motion.bodies if one.name == body)
        ends = {when: wrench(motion, f, body, place, freed, axis) for when, f in (("start", first), ("end", last))}
        reactions.append({"joint": joint, "body": body.name, **ends})
    return {
        "name": name,
        "kind": kind,
        "freedom": freedom,
        "method": "minimal coordinates",
        **more,
        "model": text(name, motion, first, joints),
        "end": END,
        "bodies": {body.name: written(motion, body, last[body.name]) for body in motion.bodies},
        "coordinates": coordinates(named or {}, states[-1], motion.n),
        **({"reaction": reactions[0]} if len(reactions) == 1 else {"reactions": reactions}),
    }


def differ(motion, first, second):
    parts = [(body.name, part) for body in motion.bodies for part in ("p", "R", "v", "w", "force", "moment")]
    return max(np.max(np.abs(getattr(first[name], part) - getattr(second[name], part))) for name, part in parts)


def unbalanced(motion, frames):
    """Sum of all forces and moments about the origin but gravity's: none where nothing is joined to the ground."""
    if motion.bodies[0].chain not in (FLOATING, FLAT):
        return 0.0
    held = [frames[body.name] for body in motion.bodies]
    force, moment = sum(f.force for f in held), sum(f.moment + np.cross(f.p, f.force) for f in held)
    return np.max(np.abs([*force[:2], moment[2]] if motion.flat else [force, moment]))


def written(motion, body, frame):
    quat = quaternion(frame.R @ body.turned)
    if motion.flat:
        turned = np.arctan2(frame.R[1, 0], frame.R[0, 0])  # less than half a turn
        return {"position": frame.p[:2], "angle": angle(body.quat) + turned, "velocity": frame.v[:2], "omega": frame.w[2]}
    return {"position": frame.p, "quat_wxyz": quat, "velocity": frame.v, "angular_velocity": frame.w}


def wrench(motion, frames, body, place, freed, axis):
    """On the body, moment about the place. A hinge's is what remains without the part along the axis where the hinge is free to
    "turn" or "slide": that part is the coupler's."""
    frame = frames[body.name]
    force, moment = frame.force, frame.moment - np.cross(frame.R @ (place - body.position), frame.force)
    total = {"force": force[:2], "moment": moment[2]} if motion.flat else {"force": force, "moment": moment}
    if not freed:
        return total
    e = frames[body.parent].R @ unit(axis)
    force = force - (force @ e) * e if "slide" in freed else force
    moment = moment - (moment @ e) * e if "turn" in freed else moment
    return {"force": force, "moment": moment, "with_coupler": total}


def coordinates(named, state, n):
    """Values and rates of {joint.coordinate: {number: factor}}."""
    found = {}
    for name, parts in named.items():
        found[name] = sum(factor * state[k] for k, factor in parts.items())
        found[name + "_rate"] = sum(factor * state[n + k] for k, factor in parts.items())
    return found


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


def flat_revolute(k, at):
    return dict(revolute(k, at, Z), keys=dict(at=at))


def flat_prismatic(k, at):
    return prismatic(k, at, np.array([2.0, -1.0, 0.0]))


def flat_point_on_line(k, at):
    axis = np.array([2.0, -1.0, 0.0])
    equations = lambda d, A, B: [d @ (A @ np.cross(Z, axis))]
    return kind(at, dict(at=at, axis=axis), [slide(axis, k), turn(Z, k + 1)], 2, equations, {"displacement": {k: 1.0}})


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
    return case(name, kind_name, freedom, Motion(bodies, n), started(draw, a, n, n), joints, watched, equations, named, note=note)


def pulley(keys, q):
    first, second = keys["radii"]
    return first * q["j1.angle"] + (second if keys["crossed"] else -second) * q["j2.angle"]


COUPLERS = {
    "gear": lambda keys, q: q["j1.angle"] - keys["ratio"] * q["j2.angle"],
    "rack-and-pinion": lambda keys, q: q["j2.displacement"] - keys["radius"] * q["j1.angle"],
    "pulley": pulley,
    "linear": lambda keys, q: sum(term["factor"] * q[term["joint"]] for term in keys["terms"]),
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
    kinds += [(10, screw), (2, constant_velocity), (12, point_on_line), (12, point_on_plane), (12, point_on_curve), (11, distance)]
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
    yield rolling(41)
    yield rolling(42, "rolling-on-body", ground=False)
    for seed, function in [(9, spherical), (1, revolute), (1, cylindrical), (10, universal), (2, point_on_line)]:
        yield two_bodies(seed, function, function.__name__.replace("_", "-") + "-to-ground", ground=True)
    flat = [(flat_revolute, "revolute"), (flat_prismatic, "prismatic"), (fixed, "fixed")]
    flat += [(flat_point_on_line, "point-on-line")]
    for seed, (function, kind_name) in enumerate(flat, 61):
        yield two_bodies(seed, function, "planar-" + kind_name, kind_name, flat=True)


def encoded(value, indent=""):
    """JSON with a list of numbers on one line."""
    inner = indent + " "
    if isinstance(value, dict) and value:
        rows = [f"{inner}{json.dumps(key)}: {encoded(one, inner)}" for key, one in value.items()]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(inner + encoded(one, inner) for one in value) + f"\n{indent}]"
    return json.dumps(value.tolist() if hasattr(value, "tolist") else value)


def main():
    print(f"{'case':28}{'integrators':>13}{'energy':>13}{'joint':>13}{'balance':>13}{'condition':>11}")
    cases = list(all_cases())
    if "--check" not in sys.argv[1:]:
        pathlib.Path(__file__).with_name("reference.json").write_text(encoded(cases) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
