"""The mechanisms for Exudyn: coordinates of each body and multipliers of each joint, and the arm as a tree of its joints."""

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Force, MarkerBodyPosition, NodeRigidBody2D, ObjectGround, RevoluteJoint2D, RigidBody2D, SensorKinematicTree
from exudyn.utilities import HTtranslate, RigidBodyInertia, TreeLink
from mechanisms import ANDREWS, DOUBLE_PENDULUM, FOUR_BAR, ROBOT_ARM

SETTING = "generalized-α"
SAID = exu.OutputVariableType


def double_pendulum(step):
    mbs = exu.SystemContainer().AddSystem()
    items = [mbs.AddObject(ObjectGround())]
    for body in DOUBLE_PENDULUM.bodies:
        items.append(mbs.CreateMassPoint(referencePosition=list(body.position), physicsMass=body.mass, gravity=list(DOUBLE_PENDULUM.gravity)))
        mbs.CreateDistanceConstraint(itemNumbers=items[-2:])
    mbs.Assemble()
    return OfBodies(mbs, items[1:], step)


def planar(mechanism):
    """Bodies and hinges of a mechanism in the plane."""
    mbs = exu.SystemContainer().AddSystem()
    ground, items = mbs.AddObject(ObjectGround()), []
    for body, (velocity, rate) in zip(mechanism.bodies, mechanism.motions()):
        node = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[*body.position[:2], 0], initialVelocities=[*velocity[:2], rate[2]]))
        items.append(mbs.AddObject(RigidBody2D(physicsMass=body.mass, physicsInertia=body.moments[2], nodeNumber=node)))
        at = mbs.AddMarker(MarkerBodyPosition(bodyNumber=items[-1]))
        mbs.AddLoad(Force(markerNumber=at, loadVector=body.mass * np.array(mechanism.gravity)))
    for joint in mechanism.joints:
        first = (ground, (0, 0, 0)) if joint.first < 0 else (items[joint.first], mechanism.bodies[joint.first].position)
        second = items[joint.second], mechanism.bodies[joint.second].position
        ends = [MarkerBodyPosition(bodyNumber=item, localPosition=np.subtract(joint.at, origin)) for item, origin in (first, second)]
        mbs.AddObject(RevoluteJoint2D(markerNumbers=[mbs.AddMarker(end) for end in ends]))
    return mbs, items, ground


def four_bar(step, mechanism=FOUR_BAR):
    mbs, items, _ = planar(mechanism)
    mbs.Assemble()
    return OfBodies(mbs, items, step)


def andrews(step):
    mbs, items, ground = planar(ANDREWS)
    plate = ANDREWS.bodies[ANDREWS.plate]
    mbs.CreateTorque(itemNumber=items[0], loadVector=[0, 0, ANDREWS.torque])
    mbs.CreateSpringDamper(itemNumbers=[ground, items[ANDREWS.plate]], localPosition0=list(ANDREWS.spring_from),
                           localPosition1=np.subtract(ANDREWS.spring_to, plate.position),
                           referenceLength=ANDREWS.rest_length, stiffness=ANDREWS.stiffness)  # fmt: skip
    mbs.Assemble()
    return OfBodies(mbs, items, step)


def robot_arm(step, mechanism=ROBOT_ARM):
    mbs = exu.SystemContainer().AddSystem()
    links, last = [], np.zeros(3)
    for body, joint in zip(mechanism.bodies, mechanism.joints):
        inertia = RigidBodyInertia(mass=body.mass, inertiaTensor=np.diag(body.moments), com=np.subtract(body.position, joint.at), inertiaTensorAtCOM=True)
        kind = exu.JointType.RevoluteZ if joint.axis[2] else exu.JointType.RevoluteY
        links.append(TreeLink(linkInertia=inertia, jointType=kind, jointHT=HTtranslate(np.subtract(joint.at, last))))
        last = np.array(joint.at)
    tree = mbs.CreateKinematicTree(listOfTreeLinks=links, initialCoordinates_t=list(mechanism.rates), gravity=list(mechanism.gravity))
    return OfTree(mbs, tree, mechanism, step)


def misspelt():
    """Items have numbers here, not names."""
    mbs, items, ground = planar(FOUR_BAR)
    wrong = exu.ObjectIndex(77)
    mbs.CreateRevoluteJoint(itemNumbers=[ground, wrong], position=[0, 0, 0], axis=[0, 0, 1])


class Running:
    def __init__(self, mbs, step):
        self.mbs, self.step = mbs, step

    def run(self, steps, samples=1):
        """Takes steps from the start; states at the start and after each of the samples."""
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = steps * self.step
        settings.solutionSettings.writeSolutionToFile = False
        settings.timeIntegration.verboseMode = 0
        states, taken = [], 0

        def note(mbs, time):
            nonlocal taken
            if taken % (steps // samples) == 0:
                states.append(self.states())
            taken += 1
            return True

        if samples > 1:
            self.mbs.SetPreStepUserFunction(note)
        self.mbs.SolveDynamic(settings)
        return [*states, self.states()]


class OfBodies(Running):
    def __init__(self, mbs, items, step):
        super().__init__(mbs, step)
        self.items = items

    def states(self):
        return np.array([self.of_body(item) for item in self.items])

    def of_body(self, item):
        say = lambda what: np.ravel(self.mbs.GetObjectOutputBody(item, what))
        points = "Mass" in self.mbs.GetObject(item)["objectType"]
        turned, rates = (np.eye(3).ravel(), np.zeros(3)) if points else (say(SAID.RotationMatrix), say(SAID.AngularVelocity))
        return [*say(SAID.Position), *turned, *say(SAID.Velocity), *rates]


class OfTree(Running):
    def __init__(self, mbs, tree, mechanism, step):
        super().__init__(mbs, step)
        self.sensors = []
        for k, (body, joint) in enumerate(zip(mechanism.bodies, mechanism.joints)):
            centre = np.subtract(body.position, joint.at)
            wanted = (SAID.Position, SAID.RotationMatrix, SAID.Velocity, SAID.AngularVelocity)
            self.sensors.append([mbs.AddSensor(SensorKinematicTree(objectNumber=tree, linkNumber=k, localPosition=centre, writeToFile=False,
                                                                   outputVariableType=what)) for what in wanted])  # fmt: skip
        mbs.Assemble()

    def states(self):
        return np.array([np.concatenate([np.ravel(self.mbs.GetSensorValues(sensor)) for sensor in of_body]) for of_body in self.sensors])
