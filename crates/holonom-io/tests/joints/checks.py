"""A case, integrated, checked and written down."""

import numpy as np

from chains import FLAT, FLOATING, unit
from motion import END, angle, quaternion
from texts import text

TOLERANCE = 1e-11  # of every check


def case(name, kind, freedom, motion, start, joints, watched, equations, named=None, **more):
    """Integrates, checks and writes down. `watched`: (joint, body, place on the body at the start, freed, axis), see `wrench`;
    `equations`: of the frames of all bodies; `named`: the coordinates to write."""
    states = motion.solve(start)
    looks = [motion.evaluate(state) for state in states]
    frames = [look[2] for look in looks]
    first, last = frames[0], frames[-1]
    checks = {
        "integrators": differ(motion, last, motion.evaluate(motion.solve_again(start))[2]),
        "energy": np.ptp([sum(f[body.name].energy for body in motion.bodies) for f in frames]),
        "joint": max(np.max(np.abs(equations(f)), initial=0.0) for f in frames),
        "balance": max(unbalanced(motion, f) for f in frames),
    }
    condition = max(np.linalg.cond(look[3]) for look in looks)
    print(f"{name:28}" + "".join(f"{check:13.1e}" for check in checks.values()) + f"{condition:11.0f}")
    assert max(checks.values()) < TOLERANCE and condition < 1e3, name
    reactions = []
    for joint, body, place, freed, axis in watched:
        body = next(one for one in motion.bodies if one.name == body)
        ends = {when: wrench(motion, f, body, place, freed, axis) for when, f in (("start", first), ("end", last))}
        reactions.append({"joint": joint, "body": body.name, **ends})
    return {
        "name": name,
        "kind": kind,
        "freedom": freedom,
        "method": "minimal coordinates",
        **more,
        "model": text(name, motion, first, joints),
        "end": END,
        "bodies": {body.name: written(motion, body, last[body.name]) for body in motion.bodies},
        "coordinates": coordinates(named or {}, states[-1], motion.n),
        **({"reaction": reactions[0]} if len(reactions) == 1 else {"reactions": reactions}),
    }


def differ(motion, first, second):
    parts = [(body.name, part) for body in motion.bodies for part in ("p", "R", "v", "w", "force", "moment")]
    return max(np.max(np.abs(getattr(first[name], part) - getattr(second[name], part))) for name, part in parts)


def unbalanced(motion, frames):
    """Sum of all forces and moments about the origin but gravity's: none where nothing is joined to the ground."""
    if motion.bodies[0].chain not in (FLOATING, FLAT):
        return 0.0
    held = [frames[body.name] for body in motion.bodies]
    force, moment = sum(f.force for f in held), sum(f.moment + np.cross(f.p, f.force) for f in held)
    return np.max(np.abs([*force[:2], moment[2]] if motion.flat else [force, moment]))


def written(motion, body, frame):
    quat = quaternion(frame.R @ body.turned)
    if motion.flat:
        turned = np.arctan2(frame.R[1, 0], frame.R[0, 0])  # less than half a turn
        return {"position": frame.p[:2], "angle": angle(body.quat) + turned, "velocity": frame.v[:2], "omega": frame.w[2]}
    return {"position": frame.p, "quat_wxyz": quat, "velocity": frame.v, "angular_velocity": frame.w}


def wrench(motion, frames, body, place, freed, axis):
    """On the body, moment about the place. A hinge's is what remains without the part along the axis where the hinge is free to
    "turn" or "slide": that part is the coupler's."""
    frame = frames[body.name]
    force, moment = frame.force, frame.moment - np.cross(frame.R @ (place - body.position), frame.force)
    total = {"force": force[:2], "moment": moment[2]} if motion.flat else {"force": force, "moment": moment}
    if not freed:
        return total
    e = frames[body.parent].R @ unit(axis)
    force = force - (force @ e) * e if "slide" in freed else force
    moment = moment - (moment @ e) * e if "turn" in freed else moment
    return {"force": force, "moment": moment, "with_coupler": total}


def coordinates(named, state, n):
    """Values and rates of {joint.coordinate: {number: factor}}."""
    found = {}
    for name, parts in named.items():
        found[name] = sum(factor * state[k] for k, factor in parts.items())
        found[name + "_rate"] = sum(factor * state[n + k] for k, factor in parts.items())
    return found
