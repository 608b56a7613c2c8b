"""The kinds of joints: what each leaves free, and its equations."""

import numpy as np
from scipy.interpolate import CubicSpline

from chains import X, Y, Z, along, move, other_two, slide, turn, turns, unit

# Directions of the joints: perpendicular to each other without rounding, neither unit nor along world axes.
U, V, W = np.array([1.0, 2.0, -1.0]), np.array([2.0, 0.0, 2.0]), np.array([4.0, -4.0, -4.0])

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


def revolute_spherical(k, at):
    """The rod turns about the axis, and the body behind it about the rod's end."""
    rod = 0.2 * V - 0.05 * W
    equations = lambda d, A, B: [d @ (A @ x), np.linalg.norm(d) - np.linalg.norm(rod)]
    return kind(at, dict(at=[at, at + rod], axis=U), [turn(U, k), move(rod)] + turns(k + 1), 4, equations, {"angle": {k: 1.0}})


def generic(k, at):
    """Free along y; rx locked means y_A·z_B = 0, which leaves turns about y_A and z_B."""
    equations = lambda d, A, B: [d @ (A @ x), d @ (A @ z), (A @ y) @ (B @ z)]
    links = [slide(V, k), turn(V, k + 1), turn(W, k + 2)]
    return kind(at, dict(at=at, locks=["x", "z", "rx"], axes=[U, V]), links, 3, equations)


def generic_all(k, at):
    keys = dict(at=at, locks=["x", "y", "z", "rx", "ry", "rz"], axes=[U, V])
    return kind(at, keys, [], 0, lambda d, A, B: [*d, *same_axes(d, A, B)])


def flat_revolute(k, at):
    return dict(revolute(k, at, Z), keys=dict(at=at))


def flat_prismatic(k, at):
    return prismatic(k, at, np.array([2.0, -1.0, 0.0]))


def flat_point_on_line(k, at):
    axis = np.array([2.0, -1.0, 0.0])
    equations = lambda d, A, B: [d @ (A @ np.cross(Z, axis))]
    return kind(at, dict(at=at, axis=axis), [slide(axis, k), turn(Z, k + 1)], 2, equations, {"displacement": {k: 1.0}})
