"""Ranks that must not depend on size and units: chains of boxes, milligrams, millimetres, tonnes, loops with redundant rows."""

import functools
import math
import random

import numpy as np

import truth
from case import Case, revolute, space, with_reactions

GRAVITY = 9.81


def box_moments(mass, edges):
    a, b, c = (edge * edge for edge in edges)
    return [mass * (b + c) / 12, mass * (a + c) / 12, mass * (a + b) / 12]


def boxes(n, alternate, mass=2.0, length=0.5, gravity=GRAVITY):
    """An open chain of boxes along x on hinges about y, or about y and z in turn, in space."""
    edges = [length, 0.2 * length, 0.2 * length]
    body, joint = {}, {}
    for k in range(n):
        body[f"b{k}"] = {"mass": mass, "shape": {"box": edges}, "position": [(k + 0.5) * length, 0, 0]}
        axis = [0, 0, 1] if alternate and k % 2 else [0, 1, 0]
        joint[f"j{k}"] = revolute("ground" if k == 0 else f"b{k - 1}", f"b{k}", [k * length, 0, 0], axis)
    return {**space(body=body, joint=joint), "gravity": [0, 0, -gravity]}


def chain_of_boxes(n, alternate, mass, length, gravity):
    """The motion of the centres of boxes: by angles in a plane, and otherwise, from rest, by all bodies."""
    tensor = box_moments(mass, [length, 0.2 * length, 0.2 * length])
    if not alternate:
        moving = truth.chain([(length, 0.5 * length, mass, tensor[1])] * n, [0.0] * n, gravity=gravity)
        return lambda times: [centres(row) for row in truth.ends(moving(times), [length] * n)]
    found = [(mass, np.diag(tensor), [(k + 0.5) * length, 0, 0], [0] * 3, [0] * 3) for k in range(n)]
    joints = [(k - 1, k, [k * length, 0, 0], [0, 0, 1] if k % 2 else [0, 1, 0]) for k in range(n)]
    moving = truth.bodies(found, joints, [0, 0, -gravity])
    return lambda times: [[part for k in range(n) for part in (row[3 * k], row[3 * k + 2])] for row in moving(times)]


def centres(row):
    """Middles of links from their ends, x and z of each."""
    joints = [(0.0, 0.0), *zip(row[::2], row[1::2])]
    return [0.5 * (a[c] + b[c]) for a, b in zip(joints, joints[1:]) for c in range(2)]


def open_chain(n, alternate, reactions, run=False):
    model = boxes(n, alternate)
    name = f"{n} boxes, {'alternate' if alternate else 'parallel'} axes" + (", reactions" if reactions else "")
    expect = {"dof": n, "redundant": 0}
    case = Case(name, with_reactions(model) if reactions else model, 0.005, 0.1, length=0.5 * n, energy=2.0 * n * GRAVITY * 0.5 * n,
                expect=expect, check=not run)
    if run and (n < 3 or not alternate):
        case.truth = chain_of_boxes(n, alternate, 2.0, 0.5, GRAVITY)
        case.columns = tuple(f"b{k}.{axis}" for k in range(n) for axis in "xz")
    return case


def in_units(name, mass, length, gravity, step, reactions):
    """Two boxes on parallel hinges, in whatever units."""
    model = boxes(2, False, mass, length, gravity)
    size = 2 * length
    return Case(name + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, step, 20 * step,
                chain_of_boxes(2, False, mass, length, gravity), ("b0.x", "b0.z", "b1.x", "b1.z"), length=size,
                energy=2 * mass * gravity * size, weight=2 * mass * gravity, speed=math.sqrt(gravity * size), floor=1e-9 * size,
                expect={"dof": 2, "redundant": 0})


def bricard_parts():
    """Rods of 1 m and 1 kg with square sections, and the hinges between them: A04."""
    places = [[0.5, 0, 0], [1, -0.5, 0], [1, -1, 0.5], [0.5, -1, 1], [0, -0.5, 1]]
    along = [0, 1, 2, 0, 1]
    hinges = [([0, 0, 0], 1), ([1, 0, 0], 2), ([1, -1, 0], 0), ([1, -1, 1], 1), ([0, -1, 1], 2), ([0, 0, 1], 0)]
    return places, along, hinges


def moments_along(axis, thin, across=1 / 12):
    return [thin * across if k == axis else across for k in range(3)]


@functools.cache
def bricard_truth(thin):
    places, along, hinges = bricard_parts()
    found = [(1.0, np.diag(moments_along(axis, thin)), place, [0] * 3, [0] * 3) for place, axis in zip(places, along)]
    joints = [(k - 1 if k else -1, k if k < 5 else -1, at, np.eye(3)[axis]) for k, (at, axis) in enumerate(hinges)]
    return truth.bodies(found, joints, [0, -GRAVITY, 0])


def bricard(name, thin, size=1.0, mass=1.0, reactions=False):
    """Bricard's mechanism with `thin` of the rods' moments about themselves, of any size and mass."""
    places, along, hinges = bricard_parts()
    body = {f"rod{k}": {"mass": mass, "inertia": [mass * size**2 * m for m in moments_along(axis, thin)],
                        "position": [size * x for x in place]} for k, (place, axis) in enumerate(zip(places, along))}
    joint = {}
    for k, (at, axis) in enumerate(hinges):
        first, second = "ground" if k == 0 else f"rod{k - 1}", "ground" if k == 5 else f"rod{k}"
        joint[f"p{k}"] = revolute(first, second, [size * x for x in at], [int(axis == a) for a in range(3)])
    model = {"gravity": [0, -GRAVITY, 0], "body": body, "joint": joint}
    moving = bricard_truth(thin)
    slower = math.sqrt(size)
    return Case(name + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, 0.01 * slower, 0.5 * slower,
                lambda times: [[size * x for x in row] for row in moving([round(t / slower, 12) for t in times])],
                tuple(f"rod{k}.{axis}" for k in range(5) for axis in "xyz"), length=2 * size, energy=5 * mass * GRAVITY * size,
                weight=5 * mass * GRAVITY, speed=4 * slower, floor=1e-8 * size, expect={"dof": 1, "redundant": 1})


def turned(choice):
    """A rotation at random."""
    q = np.array([choice.gauss(0, 1) for _ in range(4)])
    return truth.rotation(q)


def four_bar(seed, reactions):
    """A planar four-bar of random lengths and masses, somewhere in space on four hinges: three redundant rows."""
    choice = random.Random(seed)
    frame, place = turned(choice), np.array([choice.uniform(-1, 1) for _ in range(3)])
    angle, crank = choice.uniform(0.5, 1.2), choice.uniform(0.3, 0.6)
    corners = [(0, 0), (crank * math.cos(angle), crank * math.sin(angle)), (1.2 + choice.uniform(-0.1, 0.2), 0.9), (1.3, 0)]
    corners = [place + frame @ np.array([x, y, 0.0]) for x, y in corners]
    normal = frame[:, 2]
    body, found, joint, joints = {}, [], {}, []
    for k in range(3):
        mass, middle = choice.uniform(0.5, 3), 0.5 * (corners[k] + corners[k + 1])
        along = (corners[k + 1] - corners[k]) / np.linalg.norm(corners[k + 1] - corners[k])
        axes = np.column_stack([along, np.cross(normal, along), normal])
        moments = box_moments(mass, [np.linalg.norm(corners[k + 1] - corners[k]), 0.05, 0.08])
        body[f"b{k}"] = {"mass": mass, "inertia": moments, "position": middle.tolist(), "orientation": {"matrix": axes.tolist()}}
        found.append((mass, axes @ np.diag(moments) @ axes.T, middle, [0] * 3, [0] * 3))
    for k in range(4):
        first, second = "ground" if k == 0 else f"b{k - 1}", "ground" if k == 3 else f"b{k}"
        joint[f"j{k}"] = revolute(first, second, corners[k].tolist(), normal.tolist())
        joints.append((k - 1 if k else -1, k if k < 3 else -1, corners[k], normal))
    model = space(body=body, joint=joint)
    return Case(f"four-bar in space, {seed}" + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, 0.005,
                0.2, truth.bodies(found, joints, [0, 0, -GRAVITY]), tuple(f"b{k}.{axis}" for k in range(3) for axis in "xyz"), length=1.5,
                energy=30.0, weight=50.0, speed=3.0, floor=1e-8, expect={"dof": 1, "redundant": 3} if reactions else {"dof": 1})


def door(hinges, reactions, run=False):
    """A door on hinges in a row about a leaning axis, which lets it swing as a pendulum.

    Hinges on one axis share their nodes, so that only with reactions there are rows that can be redundant.
    """
    lean = 0.3
    gravity = [0, -GRAVITY * math.sin(lean), -GRAVITY * math.cos(lean)]
    body = {"door": {"mass": 20.0, "shape": {"box": [1, 0.05, 2]}, "position": [0.5, 0, 1]}}
    joint = {f"hinge{k}": revolute("ground", "door", [0, 0, 0.2 + 1.6 * k / (hinges - 1)], [0, 0, 1]) for k in range(hinges)}
    model = {"gravity": gravity, "body": body, "joint": joint}
    inertia = 20.0 * (1 + 0.05**2) / 12 + 5.0
    moving = truth.pendulum(inertia, 10.0, 0.0, 0.0, GRAVITY * math.sin(lean))
    return Case(f"door on {hinges} hinges" + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, 0.01, 0.4,
                lambda times: [[0.5 * math.cos(a), 0.5 * math.sin(a)] for a in moving(times)], ("door.x", "door.y"), length=2.0,
                energy=200.0, weight=200.0, speed=2.0, check=not run, expect={"dof": 1, "redundant": 5 * (hinges - 1) if reactions else 0})


def cases():
    for n in (2, 20, 250):
        yield from (open_chain(n, alternate, reactions) for alternate in (False, True) for reactions in (False, True))
    for n in (2, 20):
        yield from (open_chain(n, alternate, n == 2, run=True) for alternate in (False, True))
    for reactions in (False, True):
        yield in_units("boxes in mm, t, s", 2e-3, 500.0, 9810.0, 0.01, reactions)
        yield in_units("boxes in mm, kg, s", 2.0, 500.0, 9810.0, 0.01, reactions)
        yield in_units("boxes of 10 mm and 1 mg", 1e-6, 0.01, GRAVITY, 5e-4, reactions)
    for name, size, mass in (("mm", 1e-3, 1.0), ("km", 1e3, 1.0), ("1e-9 kg", 1.0, 1e-9)):
        yield from (bricard(f"Bricard of {name}", 0.1, size, mass, reactions) for reactions in (False, True))
    yield from (four_bar(seed, reactions) for seed in (1, 2, 3) for reactions in (False, True))
    for example in ("robot-arm", "slider-crank", "stewart-platform"):
        yield Case(f"{example} is not near singular", f"example:{example}", check=True, expect={"near_singular": None})
    yield from (door(5, reactions, run) for run in (False, True) for reactions in (False, True))
