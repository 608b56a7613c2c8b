"""Model texts."""

import json

import numpy as np

from motion import END, angle


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
