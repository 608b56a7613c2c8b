"""Light parts between heavy ones, and redundant rows through a dead centre."""

import functools
import math

import truth
from case import Case, plane, revolute, rod, space, with_reactions

GRAVITY = 9.81


def heavy_end(n, end, light, link=1.0):
    """Energy, speed and size of a row of light links with a heavy end."""
    size, weight = n * link, end * GRAVITY
    return {"length": size, "energy": weight * size, "speed": math.sqrt(2 * GRAVITY * size), "weight": weight, "ratio": end / light}


def trembling(light, heavy):
    """What the unresolved trembling of light parts, released slack, does to the heavy end: its square over the length, m."""
    return min(1e-6, max(1e-9, 0.1 * light / heavy))


def digits(light):
    """The tolerance to which row of light points can be integrated with the digits that their accelerations have."""
    return max(1e-12, 1e-14 / light)


@functools.cache
def straight(light, centre, moment, angle, rate):
    """The motion of three links of a metre in a row, the last of 1 kg, that start straight."""
    links = [(1, centre, m, moment * m) for m in (light, light, 1.0)]
    return truth.chain(links, [angle] * 3, [rate] * 3, tolerance=digits(light))


def row(light, step, level=True):
    """Points of `light`, `light` and 1 kg on rods of a metre, released level; or hanging straight and pushed."""
    angle, rate = (0.0, 0.0) if level else (-0.5 * math.pi, 1.5)
    masses = [light, light, 1.0]
    places = [((k + 1) * math.cos(angle), (k + 1) * math.sin(angle)) for k in range(3)]
    speeds = [(-rate * y, rate * x) for x, y in places]
    points = {f"P{k + 1}": {"mass": m, "position": places[k], "velocity": speeds[k]} for k, m in enumerate(masses)}
    rods = {"r1": rod("ground", "P1"), "r2": rod("P1", "P2"), "r3": rod("P2", "P3")}
    moving = straight(light, 1, 0, angle, rate)
    return Case(f"light row, {light:.0e} kg, {step:g} s{'' if level else ', hanging'}", plane(point=points, constraint=rods), step, 0.4,
                lambda times: [r[4:] for r in truth.ends(moving(times), [1, 1, 1])], ("P3.x", "P3.y"),
                floor=trembling(light, 1.0), **heavy_end(3, 1.0, light))


def row_in_space(step, aside):
    """Four points of 3 g before 2 kg, released level; pushed aside they turn in the cone that straight rows turn in."""
    masses = [3e-3] * 4 + [2.0]
    points = {f"P{k + 1}": {"mass": m, "position": [k + 1, 0, 0], "velocity": [0, aside * (k + 1), 0]} for k, m in enumerate(masses)}
    rods = {f"r{k + 1}": rod("ground" if k == 0 else f"P{k}", f"P{k + 1}") for k in range(5)}
    model = space(point=points, constraint=rods)
    name = f"light row in space, {step:g} s" + (", aside" if aside else "")
    if aside:
        return Case(name, model, step, 0.4, **heavy_end(5, 2.0, 3e-3))
    moving = truth.chain([(1, 1, m, 0) for m in masses], [0.0] * 5, tolerance=1e-11)
    return Case(name, model, step, 0.4, lambda times: [r[8:] for r in truth.ends(moving(times), [1] * 5)], ("P5.x", "P5.z"),
                floor=1e-7, **heavy_end(5, 2.0, 3e-3))


def rigid_row(light, step):
    """Rigid links of a metre, the last of them heavy."""
    masses = [light, light, 1.0]
    body, joint = {}, {}
    for k, m in enumerate(masses):
        body[f"b{k}"] = {"mass": m, "inertia": m / 12, "position": [k + 0.5, 0]}
        joint[f"j{k}"] = revolute("ground" if k == 0 else f"b{k - 1}", f"b{k}", [k, 0])
    moving = straight(light, 0.5, 1 / 12, 0.0, 0.0)

    def centre(times):
        return [[0.5 * (r[2] + r[4]), 0.5 * (r[3] + r[5])] for r in truth.ends(moving(times), [1, 1, 1])]

    return Case(f"light rigid links, {light:.0e} kg, {step:g} s", plane(body=body, joint=joint), step, 0.4, centre, ("b2.x", "b2.y"),
                floor=trembling(light, 1.0), **heavy_end(3, 1.0, light))


def rope(light, level):
    """A chain of 100 light points of 5 cm with 1 kg at its end: what the methods promise, and when pushed, a heavy pendulum."""
    n, link, rate = 100, 0.05, 1.0
    size = n * link
    points = {}
    for k in range(n):
        at = link * (k + 1)
        start = {"position": [at, 0]} if level else {"position": [0, -at], "velocity": [rate * at, 0]}
        points[f"P{k + 1}"] = {"mass": 1.0 if k == n - 1 else light, **start}
    rods = {f"r{k + 1}": rod("ground" if k == 0 else f"P{k}", f"P{k + 1}") for k in range(n)}
    case = Case(f"rope of 100, {light:.0e} kg, {'level' if level else 'hanging'}", plane(point=points, constraint=rods), 0.005, 0.1,
                **heavy_end(n, 1.0, light, link))
    if not level:
        moving = truth.pendulum(size * size, size, -0.5 * math.pi, rate)
        case.truth = lambda times: [[size * math.cos(a), size * math.sin(a)] for a in moving(times)]
        case.columns, case.floor = (f"P{n}.x", f"P{n}.y"), 10 * n * light * size
    return case


def flattened(n, beam, step, angle=0.0, rate=3.0):
    """N uniform bars of 1 kg and 1 m beside each other under bars of `beam` kg, at the dead centre and going on through it."""
    c, s = math.cos(angle), math.sin(angle)
    point, bar = {}, {}
    for i in range(n):
        point[f"G{i}"] = {"position": [i, 0], "fixed": True}
        point[f"P{i}"] = {"position": [i + c, s], "velocity": [-rate * s, rate * c]}
        bar[f"link{i}"] = {"between": [f"G{i}", f"P{i}"], "mass": 1.0}
        if i:
            bar[f"beam{i}"] = {"between": [f"P{i - 1}", f"P{i}"], "mass": beam}
    return parallelogram(f"flattened, N = {n}, beams of {beam:g} kg", plane(point=point, bar=bar), n, (n - 1) * beam, step, angle, rate,
                         (f"P{n - 1}.x", f"P{n - 1}.y"), n - 1)


def flattened_bodies(n, beam, step, angle=0.0, rate=3.0, reactions=False):
    """The same of rigid bodies, with one beam on hinges."""
    c, s = math.cos(angle), math.sin(angle)
    middle = 0.5 * (n - 1)
    body = {"beam": {"mass": beam, "inertia": beam * (n - 1) ** 2 / 12, "position": [middle + c, s], "velocity": [-rate * s, rate * c]}}
    joint = {}
    for i in range(n):
        body[f"link{i}"] = {"mass": 1.0, "inertia": 1 / 12, "position": [i + 0.5 * c, 0.5 * s], "orientation": {"angle": angle},
                            "velocity": [-0.5 * rate * s, 0.5 * rate * c], "angular_velocity": rate}
        joint[f"foot{i}"] = revolute("ground", f"link{i}", [i, 0])
        joint[f"head{i}"] = revolute(f"link{i}", "beam", [i + c, s])
    model = plane(body=body, joint=joint)
    return parallelogram(f"flattened bodies, N = {n}, beam of {beam:g} kg" + (", reactions" if reactions else ""),
                         with_reactions(model) if reactions else model, n, beam, step, angle, rate, ("beam.x", "beam.y"), middle)


def parallelogram(name, model, n, beam, step, angle, rate, columns, aside):
    """All of its links are at one angle: one freedom."""
    moving = truth.pendulum(n / 3 + beam, 0.5 * n + beam, angle, rate)
    name += f", {step:g} s" + (", from before" if angle else "")
    return Case(name, model, step, 0.1 if angle == 0 else 0.2, lambda times: [[aside + math.cos(a), math.sin(a)] for a in moving(times)],
                columns, length=float(n), energy=(n + beam) * GRAVITY, speed=4.0, rate=4.0, weight=(n + beam) * GRAVITY, floor=1e-8)


def cases():
    for light in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        for step in (0.005, 0.01, 0.02):
            yield row(light, step)
    yield from (row(light, 0.01, False) for light in (1e-3, 1e-7))
    yield from (row_in_space(step, aside) for step in (0.005, 0.01) for aside in (0.0, 0.5))
    yield from (rigid_row(light, step) for light in (1e-3, 1e-5, 1e-7) for step in (0.005, 0.02))
    yield from (rope(light, level) for light in (1e-4, 1e-6, 1e-8) for level in (True, False))
    for n in (4, 8, 11, 12, 20, 24):
        yield from (flattened(n, 10.0, step) for step in (5e-4, 1e-3))
    yield from (flattened_bodies(n, 20.0, 1e-3) for n in (4, 8, 11, 12, 24))
    yield flattened_bodies(8, 20.0, 1e-3, reactions=True)
    yield from (flattened(n, 10.0, 1e-3, -0.3) for n in (4, 12))
