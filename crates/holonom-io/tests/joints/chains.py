"""Vectors, and chains of elementary motions with what they do to a frame."""

import numpy as np

X, Y, Z = np.eye(3)


def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def unit(a):
    return np.asarray(a, float) / np.linalg.norm(a)


def other_two(axis):
    e = unit(np.cross(axis, X))
    return e, unit(np.cross(axis, e))


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


FLOATING = [slide(X, 0), slide(Y, 1), slide(Z, 2)] + turns(3)  # a free body in space, and in the plane
FLAT = [slide(X, 0), slide(Y, 1), turn(Z, 2)]
