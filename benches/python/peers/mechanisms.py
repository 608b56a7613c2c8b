"""What the programs are asked: the numbers of four mechanisms, and the energy of what they say that the bodies do.

Body frames are at the centres of mass and parallel to the ground's at the start. A state is an array (bodies, 18): position,
orientation as a matrix by rows, velocity and angular velocity, all in the axes of the ground.
"""

from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np

G = 9.81


@dataclass
class Body:
    name: str
    mass: float
    # Principal moments about the centre of mass, kg m².
    moments: tuple[float, float, float]
    position: tuple[float, float, float]


@dataclass
class Joint:
    """A hinge of two bodies, or of the ground (-1) and a body."""

    first: int
    second: int
    at: tuple[float, float, float]
    axis: tuple[float, float, float] = (0, 0, 1)


@dataclass
class Mechanism:
    title: str
    step: float
    end: float
    gravity: tuple[float, float, float]
    bodies: list[Body]
    joints: list[Joint]
    # Rates of the joints at the start, rad/s, where they are not zero; a joint that closes a loop has none.
    rates: tuple[float, ...] = ()

    def motions(self):
        """Velocity and angular velocity of each body at the start."""
        found = {-1: (np.zeros(3), np.zeros(3), np.zeros(3))}
        for joint, rate in zip(self.joints, self.rates):
            place, velocity, spin = found[joint.first]
            place_of_second = np.array(self.bodies[joint.second].position)
            turning = spin + rate * np.array(joint.axis)
            at_joint = velocity + np.cross(spin, np.subtract(joint.at, place))
            found[joint.second] = (place_of_second, at_joint + np.cross(turning, place_of_second - joint.at), turning)
        return [found[k][1:] if self.rates else (np.zeros(3), np.zeros(3)) for k in range(len(self.bodies))]

    def energy(self, states):
        """Of each of several states, J: without the work of what drives it, it stays."""
        states = np.asarray(states)
        total = np.zeros(len(states))
        for k, body in enumerate(self.bodies):
            place, velocity = states[:, k, :3], states[:, k, 12:15]
            turned = states[:, k, 3:12].reshape(-1, 3, 3)
            rate = np.einsum("nij,ni->nj", turned, states[:, k, 15:])
            total += body.mass * (0.5 * (velocity**2).sum(axis=1) - place @ np.array(self.gravity)) + 0.5 * rate**2 @ np.array(body.moments)
        return total + self.stored(states)

    def stored(self, states):
        return 0.0


def rod(name, start, end):
    """A thin uniform rod of 1 kg in the plane."""
    length = np.hypot(end[0] - start[0], end[1] - start[1])
    return Body(name, 1.0, (1 / 12, 1 / 12, length**2 / 12), ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, 0.0))


# Two points on massless rods of a metre, 120 and -10 degrees from hanging.
_M1 = (sin(2 * pi / 3), -cos(2 * pi / 3), 0.0)
_M2 = (_M1[0] + sin(-pi / 18), _M1[1] - cos(-pi / 18), 0.0)
DOUBLE_PENDULUM = Mechanism(
    "double pendulum",
    step=1e-3,
    end=10.0,
    gravity=(0, -G, 0),
    bodies=[Body("m1", 1.0, (0, 0, 0), _M1), Body("m2", 1.0, (0, 0, 0), _M2)],
    joints=[Joint(-1, 0, (0, 0, 0)), Joint(0, 1, _M1)],
)

# A square of three rods of 1 kg and a metre, which passes through the line of its rods twice a turn.
FOUR_BAR = Mechanism(
    "four-bar",
    step=1e-3,
    end=10.0,
    gravity=(0, -G, 0),
    bodies=[rod("left", (0, 0), (0, 1)), rod("top", (0, 1), (1, 1)), rod("right", (1, 1), (1, 0))],
    joints=[Joint(-1, 0, (0, 0, 0)), Joint(0, 1, (0, 1, 0)), Joint(-1, 2, (1, 0, 0)), Joint(1, 2, (1, 1, 0))],
    rates=(-1.0, 1.0, -1.0),
)


class Andrews(Mechanism):
    """The spring is from `spring_from` of the ground to `spring_to` of the plate; a constant torque turns the crank."""

    stiffness, rest_length, torque = 4530.0, 0.07785, 0.033
    spring_from = (0.014, 0.072, 0.0)
    plate = 2

    def stored(self, states):
        turned = states[:, self.plate, 3:12].reshape(-1, 3, 3)
        arm = np.subtract(self.spring_to, self.bodies[self.plate].position)
        length = np.linalg.norm(states[:, self.plate, :3] + turned @ arm - self.spring_from, axis=1)
        angle = np.unwrap(np.arctan2(states[:, 0, 6], states[:, 0, 3]))
        return 0.5 * self.stiffness * (length - self.rest_length) ** 2 - self.torque * (angle - angle[0])


def _andrews():
    """As the IVP test set has it, with the letters that it uses; its angles at the start are b, c, d, p, w, e here."""
    A, B = (-0.06934, -0.00227), (-0.03635, 0.03273)
    b, c, d, p, w, e = -0.0617138900142764, 0.45527981916307, 0.487364979543843, 0.222668390165886, -0.222668390165886, 1.23054744454982
    F = 0.007 * cos(b), 0.007 * sin(b)
    E = B[0] + 0.035 * sin(c), B[1] - 0.035 * cos(c)
    GG = A[0] + 0.04 * cos(d), A[1] + 0.04 * sin(d)
    H = A[0] + 0.04 * sin(e), A[1] - 0.04 * cos(e)

    def body(name, mass, moment, x, y):
        return Body(name, mass, (moment, moment, moment), (x, y, 0.0))

    bodies = [
        body("crank", 0.04325, 2.194e-6, 0.00092 * cos(b), 0.00092 * sin(b)),
        body("rod", 0.00365, 4.410e-7, F[0] - 0.0115 * cos(b), F[1] - 0.0115 * sin(b)),
        body("plate", 0.02373, 5.255e-6, B[0] + 0.01874 * sin(c) + 0.01043 * cos(c), B[1] - 0.01874 * cos(c) + 0.01043 * sin(c)),
        body("link-eg", 0.00706, 5.667e-7, GG[0] + 0.00579 * sin(p + d), GG[1] - 0.00579 * cos(p + d)),
        body("arm-ag", 0.07050, 1.169e-5, A[0] + 0.02308 * cos(d) - 0.00916 * sin(d), A[1] + 0.02308 * sin(d) + 0.00916 * cos(d)),
        body("link-eh", 0.00706, 5.667e-7, H[0] + 0.00579 * cos(w + e), H[1] + 0.00579 * sin(w + e)),
        body("arm-ah", 0.05498, 1.912e-5, A[0] + 0.01228 * sin(e) - 0.00449 * cos(e), A[1] - 0.01228 * cos(e) - 0.00449 * sin(e)),
    ]
    hinges = [(-1, 0, (0, 0)), (0, 1, F), (-1, 2, B), (-1, 4, A), (4, 3, GG), (-1, 6, A), (6, 5, H), (2, 1, E), (2, 3, E), (2, 5, E)]
    found = Andrews("Andrews' mechanism", 1e-5, 0.05, (0, 0, 0), bodies, [Joint(i, j, (*at, 0.0)) for i, j, at in hinges])
    found.spring_to = (B[0] + 0.018 * sin(c) + 0.02 * cos(c), B[1] - 0.018 * cos(c) + 0.02 * sin(c), 0.0)
    return found


ANDREWS = _andrews()


def _cylinder(mass, radius, height):
    across = mass * (3 * radius**2 + height**2) / 12
    return across, across, 0.5 * mass * radius**2


def _box(mass, x, y, z):
    return mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12, mass * (x * x + y * y) / 12


ROBOT_ARM = Mechanism(
    "robot arm",
    step=1e-3,
    end=1.0,
    gravity=(0, 0, -G),
    bodies=[
        Body("turntable", 40.0, _cylinder(40, 0.2, 0.4), (0, 0, 0.2)),
        Body("upper-arm", 20.0, _box(20, 0.14, 0.14, 0.7), (0, 0, 0.75)),
        Body("forearm", 10.0, _box(10, 0.1, 0.1, 0.3), (0, 0, 1.25)),
        Body("forearm-roll", 6.0, _cylinder(6, 0.04, 0.3), (0, 0, 1.55)),
        Body("wrist", 2.0, _box(2, 0.06, 0.06, 0.12), (0, 0, 1.76)),
        Body("hand", 3.0, _box(3, 0.16, 0.06, 0.1), (0, 0, 1.87)),
    ],
    joints=[
        Joint(k - 1, k, (0, 0, height), axis)
        for k, (height, axis) in enumerate(zip((0, 0.4, 1.1, 1.4, 1.7, 1.82), [(0, 0, 1), (0, 1, 0), (0, 1, 0), (0, 0, 1), (0, 1, 0), (0, 0, 1)]))
    ],
    # Without motors, upright and turning about all axes.
    rates=(1.0, 0.5, 0.3, 2.0, -1.0, 1.5),
)

# A tree of hinges comes first in every list of joints, then what closes loops.
MECHANISMS = {"double_pendulum": DOUBLE_PENDULUM, "four_bar": FOUR_BAR, "andrews": ANDREWS, "robot_arm": ROBOT_ARM}


def with_body(mechanism, index, **changes):
    """The mechanism with one body changed."""
    bodies = list(mechanism.bodies)
    bodies[index] = replace(bodies[index], **changes)
    return replace(mechanism, bodies=bodies)


# What people get wrong, beside names: the builder, the mechanism and the step.
MISTAKES = {
    "a mass of -1 kg": ("four_bar", with_body(FOUR_BAR, 1, mass=-1.0), 1e-3),
    "moments of inertia of 1, 1 and 5 kg m²": ("robot_arm", with_body(ROBOT_ARM, 5, moments=(1.0, 1.0, 5.0)), 1e-3),
    "rates that the loop does not allow": ("four_bar", replace(FOUR_BAR, rates=(-1.0, 0.0, 0.0)), 1e-3),
    "a step of 0.3 s": ("four_bar", FOUR_BAR, 0.3),
}
