"""The mechanisms for Drake: coordinates are those of the joints; where loops are closed, time is discrete and contacts solve them."""

import numpy as np

from mechanisms import ANDREWS, DOUBLE_PENDULUM, FOUR_BAR, ROBOT_ARM
from pydrake.math import RigidTransform
from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
from pydrake.multibody.tree import FixedOffsetFrame, LinearSpringDamper, RevoluteJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

SETTING = "RK3; loops: discrete, SAP"


def plant(mechanism, step):
    """Bodies, hinges and balls that close loops: those need discrete time."""
    closing = mechanism.joints[len(mechanism.bodies) :]
    found = MultibodyPlant(step if closing else 0.0)
    if closing:
        found.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
    found.mutable_gravity_field().set_gravity_vector(mechanism.gravity)
    bodies = []
    for body in mechanism.bodies:
        moments = np.array(body.moments) / body.mass
        bodies.append(found.AddRigidBody(body.name, SpatialInertia(body.mass, np.zeros(3), UnitInertia(*moments))))
    for joint in mechanism.joints:
        first, origin = (found.world_body(), np.zeros(3)) if joint.first < 0 else (bodies[joint.first], mechanism.bodies[joint.first].position)
        second, other = bodies[joint.second], mechanism.bodies[joint.second].position
        ends = np.subtract(joint.at, origin), np.subtract(joint.at, other)
        if joint in closing:
            found.AddBallConstraint(first, ends[0], second, ends[1])
        else:
            frames = [
                found.AddFrame(FixedOffsetFrame(f"{at.name()}-{second.name()}", at.body_frame(), RigidTransform(end)))
                for at, end in zip((first, second), ends)
            ]
            found.AddJoint(RevoluteJoint(f"of-{second.name()}", *frames, joint.axis))
    return found, bodies


def double_pendulum(step):
    return Running(*plant(DOUBLE_PENDULUM, step), DOUBLE_PENDULUM, step)


def four_bar(step, mechanism=FOUR_BAR):
    return Running(*plant(mechanism, step), mechanism, step)


def andrews(step):
    found, bodies = plant(ANDREWS, step)
    arm = np.subtract(ANDREWS.spring_to, ANDREWS.bodies[ANDREWS.plate].position)
    spring = LinearSpringDamper(found.world_body(), ANDREWS.spring_from, bodies[ANDREWS.plate], arm, ANDREWS.rest_length, ANDREWS.stiffness, 0)
    found.AddForceElement(spring)
    found.AddJointActuator("motor", found.GetJointByName("of-crank"))
    return Running(found, bodies, ANDREWS, step, ANDREWS.torque)


def robot_arm(step, mechanism=ROBOT_ARM):
    return Running(*plant(mechanism, step), mechanism, step)


def misspelt():
    found, _ = plant(FOUR_BAR, 1e-3)
    found.GetBodyByName("topp")


class Running:
    def __init__(self, plant, bodies, mechanism, step, torque=None):
        plant.Finalize()
        self.plant, self.bodies, self.step = plant, bodies, step
        self.simulator = Simulator(plant)
        self.context = self.simulator.get_mutable_context()
        for joint, rate in zip(mechanism.joints, mechanism.rates):
            plant.GetJointByName(f"of-{mechanism.bodies[joint.second].name}").set_angular_rate(self.context, rate)
        if torque is not None:
            plant.get_actuation_input_port().FixValue(self.context, [torque])
        fixed = SimulatorConfig(integration_scheme="runge_kutta3", max_step_size=step, use_error_control=False)
        ApplySimulatorConfig(fixed, self.simulator)
        self.simulator.Initialize()

    def run(self, steps, samples=1):
        """Takes steps from the start; states at the start and after each of the samples."""
        states = [self.states()]
        for k in range(1, samples + 1):
            self.simulator.AdvanceTo(k * (steps // samples) * self.step)
            states.append(self.states())
        return states

    def states(self):
        return np.array([self.of_body(body) for body in self.bodies])

    def of_body(self, body):
        pose = self.plant.EvalBodyPoseInWorld(self.context, body)
        rates = self.plant.EvalBodySpatialVelocityInWorld(self.context, body)
        return [*pose.translation(), *pose.rotation().matrix().ravel(), *rates.translational(), *rates.rotational()]
