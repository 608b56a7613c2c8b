"""The mechanisms with holonom's builders."""

import holonom as hm
import numpy as np
from mechanisms import ANDREWS, DOUBLE_PENDULUM, FOUR_BAR, ROBOT_ARM

SETTING = "conserving-ggl"


def double_pendulum(step):
    m = hm.Model(plane="xy", gravity=DOUBLE_PENDULUM.gravity[:2])
    last = m.ground
    for body in DOUBLE_PENDULUM.bodies:
        point = m.point(body.name, mass=body.mass, position=body.position[:2])
        m.constraint_distance(f"{body.name}-rod", last, point)
        last = point
    return InPlane(m, step, ["m1", "m2"])


def planar(mechanism):
    """Bodies and hinges of a mechanism in the plane."""
    m = hm.Model(plane="xy", gravity=mechanism.gravity[:2])
    for body, (velocity, rate) in zip(mechanism.bodies, mechanism.motions()):
        m.body(body.name, mass=body.mass, inertia=body.moments[2], position=body.position[:2], velocity=velocity[:2], angular_velocity=rate[2])
    names = [body.name for body in mechanism.bodies] + ["ground"]
    for k, joint in enumerate(mechanism.joints):
        m.revolute(f"hinge{k}", names[joint.first], names[joint.second], at=joint.at[:2])
    return m


def four_bar(step, mechanism=FOUR_BAR):
    return InPlane(planar(mechanism), step, [body.name for body in mechanism.bodies])


def andrews(step):
    m = planar(ANDREWS)
    m.effort("motor", joint="hinge0", effort=ANDREWS.torque)
    arm = np.subtract(ANDREWS.spring_to, ANDREWS.bodies[ANDREWS.plate].position)
    m.set("body.plate.points.D", arm[:2])
    m.spring("spring", ANDREWS.spring_from[:2], "plate.D", stiffness=ANDREWS.stiffness, rest_length=ANDREWS.rest_length)
    return InPlane(m, step, [body.name for body in ANDREWS.bodies])


def robot_arm(step, mechanism=ROBOT_ARM):
    m = hm.Model(gravity=mechanism.gravity)
    last = m.ground
    for body, joint, (velocity, rate) in zip(mechanism.bodies, mechanism.joints, mechanism.motions()):
        link = m.body(body.name, mass=body.mass, inertia=body.moments, position=body.position, velocity=velocity, angular_velocity=rate)
        m.revolute(f"axis-{body.name}", last, link, at=joint.at, axis=joint.axis)
        last = link
    return InSpace(m, step, [body.name for body in mechanism.bodies])


def misspelt():
    m = planar(FOUR_BAR)
    m.revolute("more", "topp", "left", at=[0, 0])
    return InPlane(m, 1e-3, [])


class Running:
    """A simulation that is stepped, and what its bodies do."""

    def __init__(self, model, step, names):
        self.simulation, self.names = hm.Simulation(model, step=step), names

    def run(self, steps, samples=1):
        """Takes steps from the start; states at the start and after each of the samples."""
        states = [self.states()]
        for _ in range(samples):
            self.simulation.step(steps // samples)
            states.append(self.states())
        return states

    def states(self):
        return np.array([self.of_body(lambda *ends: [self.simulation[f"{name}.{end}"] for end in ends]) for name in self.names])


class InPlane(Running):
    def of_body(self, get):
        try:
            (angle, rate) = get("angle", "angle_rate")
        except KeyError:
            angle, rate = 0, 0
        c, s = np.cos(angle), np.sin(angle)
        return [*get("x", "y"), 0, c, -s, 0, s, c, 0, 0, 0, 1, *get("vx", "vy"), 0, 0, 0, rate]


class InSpace(Running):
    def of_body(self, get):
        w, *v = get("qw", "qx", "qy", "qz")
        skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
        turned = np.eye(3) + 2 * w * skew + 2 * skew @ skew
        return [*get("x", "y", "z"), *turned.ravel(), *get("vx", "vy", "vz"), *get("wx", "wy", "wz")]
