"""The mechanisms for MuJoCo: coordinates are those of the joints, and loops are closed by soft constraints, here the stiffest."""

import mujoco
import numpy as np
from mechanisms import ANDREWS, DOUBLE_PENDULUM, FOUR_BAR, ROBOT_ARM

SETTING = "RK4"


def words(values):
    return " ".join(map(repr, map(float, values)))


def tree(mechanism, least=0.0):
    """Elements of the bodies, each in the one that it hangs on, with their origins at their centres of mass."""
    text = {k: "" for k in range(-1, len(mechanism.bodies))}
    for joint in reversed(mechanism.joints[: len(mechanism.bodies)]):
        body = mechanism.bodies[joint.second]
        origin = mechanism.bodies[joint.first].position if joint.first >= 0 else (0, 0, 0)
        text[joint.first] += (
            f'<body name="{body.name}" pos="{words(np.subtract(body.position, origin))}">'
            f'<joint name="{body.name}" axis="{words(joint.axis)}" pos="{words(np.subtract(joint.at, body.position))}"/>'
            f'<inertial pos="0 0 0" mass="{body.mass}" diaginertia="{words(np.maximum(body.moments, least))}"/>'
            f'<site name="{body.name}"/>{text[joint.second]}</body>'
        )
    return text[-1]


def loops(mechanism, step):
    """Hinges that close loops, as two points in one place, whose time constant is the shortest that is stable."""
    text = ""
    for joint in mechanism.joints[len(mechanism.bodies) :]:
        first, second = mechanism.bodies[joint.first], mechanism.bodies[joint.second]
        anchor = words(np.subtract(joint.at, first.position))
        text += f'<connect body1="{first.name}" body2="{second.name}" anchor="{anchor}" solref="{2 * step} 1"/>'
    return f"<equality>{text}</equality>"


def running(mechanism, step, world, more=""):
    option = f'<option timestep="{step}" gravity="{words(mechanism.gravity)}" integrator="RK4"/>'
    text = f"<mujoco>{option}<worldbody>{world}</worldbody>{loops(mechanism, step)}{more}</mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for joint, rate in zip(mechanism.joints, mechanism.rates):
        data.joint(mechanism.bodies[joint.second].name).qvel = rate
    return Running(model, data, [body.name for body in mechanism.bodies])


def double_pendulum(step):
    return running(DOUBLE_PENDULUM, step, tree(DOUBLE_PENDULUM, least=1e-9))


def four_bar(step, mechanism=FOUR_BAR):
    return running(mechanism, step, tree(mechanism))


def andrews(step):
    plate = ANDREWS.bodies[ANDREWS.plate]
    place = words(np.subtract(ANDREWS.spring_to, plate.position))
    world = tree(ANDREWS).replace('<site name="plate"/>', f'<site name="plate"/><site name="D" pos="{place}"/>')
    world += f'<site name="C" pos="{words(ANDREWS.spring_from)}"/>'
    spring = f'<spatial stiffness="{ANDREWS.stiffness}" springlength="{ANDREWS.rest_length}"><site site="C"/><site site="D"/></spatial>'
    andrews = running(ANDREWS, step, world, f'<tendon>{spring}</tendon><actuator><motor joint="crank"/></actuator>')
    andrews.data.ctrl[0] = ANDREWS.torque
    return andrews


def robot_arm(step, mechanism=ROBOT_ARM):
    return running(mechanism, step, tree(mechanism))


def misspelt():
    return running(FOUR_BAR, 1e-3, tree(FOUR_BAR), '<equality><connect body1="left" body2="topp" anchor="0 0 0"/></equality>')


class Running:
    """A simulation that is stepped, and what its bodies do."""

    def __init__(self, model, data, names):
        self.model, self.data, self.names = model, data, names

    def run(self, steps, samples=1):
        """Takes steps from the start; states at the start and after each of the samples."""
        states = [self.states()]
        for _ in range(samples):
            mujoco.mj_step(self.model, self.data, steps // samples)
            states.append(self.states())
        return states

    def states(self):
        mujoco.mj_forward(self.model, self.data)
        return np.array([self.of_body(self.data.body(name)) for name in self.names])

    def of_body(self, body):
        rates = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_BODY, body.id, rates, 0)
        return [*body.xipos, *body.xmat, *rates[3:], *rates[:3]]
