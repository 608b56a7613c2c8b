"""Bodies on chains and their motion."""

import numpy as np
from scipy.integrate import solve_ivp

from chains import Frame, skew, unit

END = 0.5
SHAPES = {
    "A": (2.3, [0.19, 0.24, 0.17, 0.021, -0.013, 0.017]),
    "B": (1.4, [0.11, 0.08, 0.12, -0.011, 0.009, 0.014]),
    "C": (1.1, [0.06, 0.09, 0.07, 0.008, 0.012, -0.007]),
}


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
        """`chain`: from the parent's centre of mass to this one's. `shape`: mass and [Ixx, Iyy, Izz, Ixy, Ixz, Iyz],
        body axes."""
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
