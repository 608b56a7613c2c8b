"""Motions that holonom has no part in: minimal coordinates, closed forms, and bodies with accelerations of least squares.

All are integrated by extrapolation (Gragg, Bulirsch and Stoer) to twelve digits or so. A truth is a function of a list of times that
returns one row of numbers for each.
"""

import functools
import math
import os

# Small matrices are not worth a second thread.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402

GRAVITY = 9.81

# Substeps of the modified midpoint rule in a step of the extrapolation.
SUBSTEPS = (2, 4, 6, 8, 10, 12, 14, 16)


# Share of the largest singular value below which rows of bodies are redundant: what they are apart by integration is not.
REDUNDANT = 1e-9


def midpoint(f, y, h, n):
    """The modified midpoint rule with Gragg's last step, whose error is a series in h²."""
    d = h / n
    before, here = y, y + d * f(y)
    for _ in range(n - 1):
        before, here = here, before + 2 * d * f(here)
    return 0.5 * (here + before + d * f(here))


def extrapolated(f, y, h):
    """A step of the extrapolation, and an estimate of its error."""
    row = []
    for k, n in enumerate(SUBSTEPS):
        new = [midpoint(f, y, h, n)]
        for j in range(k):
            new.append(new[j] + (new[j] - row[j]) / ((n / SUBSTEPS[k - j - 1]) ** 2 - 1))
        row, best = new, row[-1] if row else new[0]
    return row[-1], np.abs(row[-1] - best)


def integrate(f, y, times, tolerance=1e-13):
    """States of y' = f(y) at rising times, from y at time 0."""
    y = np.array(y, dtype=float)
    t, h, found = 0.0, 1e-3, []
    scale = np.maximum(np.abs(y), 1.0)
    for goal in times:
        while goal - t > 1e-14 * max(1.0, abs(goal)):
            step = min(h, goal - t)
            new, error = extrapolated(f, y, step)
            worst = float(np.max(error / np.maximum(scale, np.abs(new)))) / tolerance
            if not math.isfinite(worst) or worst > 1 and step > 1e-9:
                h = 0.4 * step
                continue
            y, t = new, t + step
            grown = step * (2.0 if worst < 0.1 else 0.9 * worst ** (-1 / 15))
            h = max(grown, h) if step < h else grown
        found.append(y.copy())
    return found


def remembered(at):
    """The same function of times, which computes nothing twice."""
    kept = functools.cache(at)
    return lambda times: kept(tuple(times))


def chain(links, angles, rates=None, gravity=GRAVITY, tolerance=1e-13):
    """Links in a row from the origin in the plane, by absolute angles from the first axis; gravity is against the second.

    A link is length, place of its centre along it, mass, and moment about its centre. Returns the function of times to states (angles,
    then rates).
    """
    length, centre, mass, moment = (np.array(column, dtype=float) for column in zip(*links))
    n = len(length)
    beyond = np.array([mass[k + 1:].sum() for k in range(n)])
    first = mass * centre + length * beyond
    coupling = np.array([[length[min(i, j)] * first[max(i, j)] for j in range(n)] for i in range(n)])
    np.fill_diagonal(coupling, moment + mass * centre**2 + length**2 * beyond)

    def f(y):
        q, v = y[:n], y[n:]
        turn = q[:, None] - q[None, :]
        torque = -(coupling * np.sin(turn)) @ (v * v) - gravity * first * np.cos(q)
        return np.concatenate([v, np.linalg.solve(coupling * np.cos(turn), torque)])

    start = np.concatenate([np.array(angles, dtype=float), np.zeros(n) if rates is None else np.array(rates, dtype=float)])
    return remembered(lambda times: integrate(f, start, times, tolerance))


def ends(states, lengths):
    """Places of the ends of links, x1, y1, x2, y2, …, for each state of a chain."""
    rows = []
    for y in states:
        q = y[:len(lengths)]
        x, z = np.cumsum(np.cos(q) * lengths), np.cumsum(np.sin(q) * lengths)
        rows.append([float(c) for pair in zip(x, z) for c in pair])
    return rows


def pendulum(inertia, moment, angle, rate, gravity=GRAVITY):
    """Angle from the horizontal of what has one freedom: inertia θ'' = −moment · gravity · cos θ."""

    def f(y):
        return np.array([y[1], -moment * gravity / inertia * math.cos(y[0])])

    return lambda times: [float(y[0]) for y in integrate(f, [angle, rate], times)]


def universal(tilts, rates, across, along, moment, gravity=GRAVITY):
    """A body that hangs along −z on a universal joint with axes x, then y of the body: its two angles and their rates.

    across and along are its moments about the joint, moment is mass times distance of the centre.
    """

    def f(y):
        a, b, u, v = y
        s, c = math.sin(b), math.cos(b)
        inertia = across * c * c + along * s * s
        turn = 2 * (along - across) * s * c
        first = (-turn * u * v - moment * gravity * math.sin(a) * c) / inertia
        second = (0.5 * turn * u * u - moment * gravity * math.cos(a) * s) / across
        return np.array([u, v, first, second])

    return lambda times: integrate(f, [*tilts, *rates], times)


def top(axis, rate, spin, across, along, moment, gravity=GRAVITY):
    """The axis of a symmetric body on a ball, from its rate and its spin about itself, which stays; moments are about the ball."""
    down = np.array([0.0, 0.0, -gravity])

    def f(y):
        n, dn = y[:3], y[3:]
        turning = moment * np.cross(n, down) - along * spin * dn
        return np.concatenate([dn, -np.cross(n, turning) / across - (dn @ dn) * n])

    return lambda times: [y[:3].tolist() for y in integrate(f, [*axis, *rate], times)]


def disc(radius, across, along, axle, spin, position, gravity=GRAVITY):
    """The centre of a disc of 1 kg with a sharp edge that rolls on the plane z = 0, from its axle and angular velocity."""
    up = np.array([0.0, 0.0, 1.0])

    def f(y):
        n, w = y[:3], y[3:6]
        raised = up - n[2] * n
        size = math.sqrt(raised @ raised)
        e = raised / size
        dn = np.cross(w, n)
        lifted = -dn[2] * n - n[2] * dn
        de = (lifted - (e @ lifted) * e) / size
        # v = R w × e, the force on the disc F = v' + g z at −R e from the centre.
        force = radius * np.cross(w, de) + gravity * up
        gyro = (along - across) * ((dn @ w) * n + (n @ w) * dn)
        cross = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
        # J w' + R e × (R w' × e) = −R e × force − gyro
        matrix = across * np.eye(3) + (along - across) * np.outer(n, n) - radius**2 * cross @ cross
        dw = np.linalg.solve(matrix, -radius * np.cross(e, force) - gyro)
        return np.concatenate([dn, dw, radius * np.cross(w, e)])

    start = np.concatenate([axle, spin, position])
    return lambda times: [y[6:].tolist() for y in integrate(f, start, times)]


def rotation(q):
    """The matrix of a quaternion (real part first)."""
    w, x, y, z = q / math.sqrt(q @ q)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


class Bodies:
    """Rigid bodies on hinges and balls: accelerations from the equations of motion and the twice derived rows by least squares.

    A body is mass, tensor in world axes at the start, place, velocity, angular velocity. A joint is the numbers of two bodies (−1 is the
    ground), its place, and its axis or None for a ball.
    """

    def __init__(self, bodies, joints, gravity):
        self.n = len(bodies)
        self.mass = [body[0] for body in bodies]
        self.tensor = [np.array(body[1], dtype=float) for body in bodies]
        self.gravity = np.array(gravity, dtype=float)
        places = [np.array(body[2], dtype=float) for body in bodies]
        self.joints = [self.local(places, *joint) for joint in joints]
        identity = np.array([1.0, 0, 0, 0])
        self.start = np.concatenate([np.concatenate([places[k], identity, body[3], body[4]]) for k, body in enumerate(bodies)])

    @staticmethod
    def local(places, first, second, at, axis):
        """A joint with its arms and axes in the axes of the bodies."""
        at = np.array(at, dtype=float)
        arms = [at - places[k] if k >= 0 else at for k in (first, second)]
        if axis is None:
            return first, second, arms, None, ()
        u = np.array(axis, dtype=float) / np.linalg.norm(axis)
        v = np.cross(u, np.eye(3)[int(np.argmin(np.abs(u)))])
        v /= np.linalg.norm(v)
        return first, second, arms, u, (v, np.cross(u, v))

    def frames(self, y):
        parts = y.reshape(self.n, 13)
        turned = [rotation(part[3:7]) for part in parts]
        return parts, [*turned, np.eye(3)], [*(part[10:] for part in parts), np.zeros(3)]

    def rows(self, y):
        """The rows' matrix and right side: G a = c."""
        _, turned, spins = self.frames(y)
        matrix, right = [], []
        for first, second, arms, u, across in self.joints:
            block, side = np.zeros((3, 6 * self.n)), np.zeros(3)
            for k, sign, arm in ((first, -1, arms[0]), (second, 1, arms[1])):
                if k < 0:
                    continue
                r, w = turned[k] @ arm, spins[k]
                block[:, 6 * k:6 * k + 3] += sign * np.eye(3)
                block[:, 6 * k + 3:6 * k + 6] -= sign * skew(r)
                side -= sign * np.cross(w, np.cross(w, r))
            matrix.append(block)
            right.append(side)
            for v in across:
                a, b, wa, wb = turned[first] @ u, turned[second] @ v, spins[first], spins[second]
                normal, block = np.cross(a, b), np.zeros((1, 6 * self.n))
                rate = np.cross(np.cross(wa, a), b) + np.cross(a, np.cross(wb, b))
                for k, sign in ((first, 1), (second, -1)):
                    if k >= 0:
                        block[0, 6 * k + 3:6 * k + 6] += sign * normal
                matrix.append(block)
                right.append(np.array([-(wa - wb) @ rate]))
        return np.vstack(matrix), np.concatenate(right)

    def derivative(self, y):
        parts, turned, spins = self.frames(y)
        rows, right = self.rows(y)
        size = 6 * self.n
        matrix, side = np.zeros((size + len(right),) * 2), np.zeros(size + len(right))
        for k in range(self.n):
            tensor = turned[k] @ self.tensor[k] @ turned[k].T
            matrix[6 * k:6 * k + 3, 6 * k:6 * k + 3] = self.mass[k] * np.eye(3)
            matrix[6 * k + 3:6 * k + 6, 6 * k + 3:6 * k + 6] = tensor
            side[6 * k:6 * k + 3] = self.mass[k] * self.gravity
            side[6 * k + 3:6 * k + 6] = -np.cross(spins[k], tensor @ spins[k])
        matrix[size:, :size], matrix[:size, size:], side[size:] = rows, rows.T, right
        solved = np.linalg.lstsq(matrix, side, rcond=REDUNDANT)[0][:size].reshape(self.n, 6)
        out = np.empty_like(parts)
        for k, part in enumerate(parts):
            w, q = part[10:], part[3:7]
            out[k, :3], out[k, 7:10], out[k, 10:] = part[7:10], solved[k, :3], solved[k, 3:]
            out[k, 3] = -0.5 * w @ q[1:]
            out[k, 4:7] = 0.5 * (q[0] * w + np.cross(w, q[1:]))
        return out.ravel()

    def states(self, times):
        return integrate(self.derivative, self.start, times, 1e-10)


def bodies(found, joints, gravity):
    """The places of the centres of the bodies."""
    system = Bodies(found, joints, gravity)

    return remembered(lambda times: [y.reshape(system.n, 13)[:, :3].ravel().tolist() for y in system.states(times)])
