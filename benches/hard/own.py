"""Light trolleys, wheels and gears under heavy loads, steep and flat screws, stiff springs, mass ratios of 1e9, mixed units."""

import math

import numpy as np

import truth
from case import Case, plane, revolute, rod, space, with_reactions

GRAVITY = 9.81


def trolley(light, end, judged=True):
    """A heavy pendulum of 1 m and 1 kg, 1 rad from hanging, under a light trolley on a level rail: it falls nearly upright."""
    model = plane(point={"car": {"mass": light, "position": [0, 0]}, "bob": {"mass": 1.0, "position": [math.sin(1), -math.cos(1)]}},
                  constraint={"rail": {"type": "point-on-line", "point": "car", "direction": [1, 0], "through": [0, 0]},
                              "rope": rod("car", "bob")})
    share = 1 / (1 + light)

    def f(y):
        s, c = math.sin(y[0]), math.cos(y[0])
        return np.array([y[1], (-share * s * c * y[1] ** 2 - GRAVITY * s) / (1 - share * c * c)])

    def places(times):
        angles = [y[0] for y in truth.integrate(f, [1.0, 0.0], times)]
        cars = [share * (math.sin(1) - math.sin(a)) for a in angles]
        return [[x, x + math.sin(a), -math.cos(a)] for x, a in zip(cars, angles)]

    return Case(f"trolley of {light:.0e} kg, to {end:g} s", model, 0.005, end, places if judged else None, ("car.x", "bob.x", "bob.y"),
                length=1.0, energy=GRAVITY, weight=GRAVITY, speed=4.0, ratio=1 / light, expect={"dof": 2, "redundant": 0})


def light_wheel(light, reactions):
    """A cart of 10 kg on a slope, with a light wheel that rolls on the ground beside its rail: the acceleration is constant."""
    slope, radius = 0.3, 0.2
    gravity = [GRAVITY * math.sin(slope), 0, -GRAVITY * math.cos(slope)]
    cart = {"mass": 10.0, "inertia": [0.2, 0.4, 0.5], "position": [0, 1, radius]}
    wheel = {"mass": light, "inertia": [0.25 * light * radius**2, 0.5 * light * radius**2, 0.25 * light * radius**2],
             "position": [0, 0, radius], "axes": {"axle": [0, 1, 0]}}
    joint = {"rail": {"type": "prismatic", "between": ["ground", "cart"], "axis": [1, 0, 0]},
             "axle": revolute("cart", "wheel", [0, 0, radius], [0, 1, 0]),
             "road": {"type": "rolling", "between": ["ground", "wheel"], "at": [0, 0, radius], "axis": "wheel.axle", "normal": [0, 0, 1],
                      "radius": radius}}
    model = {"gravity": gravity, "body": {"cart": cart, "wheel": wheel}, "joint": joint}
    a = GRAVITY * math.sin(slope) * (10 + light) / (10 + 1.5 * light)
    return Case(f"wheel of {light:.0e} kg" + (", reactions" if reactions else ""), with_reactions(model) if reactions else model, 0.005,
                0.4, lambda times: [[0.5 * a * t * t, 0.5 * a * t * t / radius] for t in times], ("cart.x", "axle.angle"), length=1.0,
                energy=100.0, weight=100.0, speed=2.0, ratio=10 / light, expect={"dof": 1})


def gears(light, idlers):
    """A heavy pendulum geared to a heavy wheel by light ones between."""
    n = idlers + 2
    body = {"w0": {"mass": 5.0, "inertia": [1, 1, 2.0], "position": [0.3, 0, 0]}}
    joint = {"axle0": revolute("ground", "w0", [0, 0, 0], [0, 0, 1])}
    for k in range(1, n):
        mass, moment = (20.0, 0.5) if k == n - 1 else (light, 0.005 * light)
        body[f"w{k}"] = {"mass": mass, "inertia": [0.5 * moment, 0.5 * moment, moment], "position": [float(k), 0, 0]}
        joint[f"axle{k}"] = revolute("ground", f"w{k}", [k, 0, 0], [0, 0, 1])
        joint[f"mesh{k}"] = {"type": "gear", "joints": [f"axle{k}", f"axle{k - 1}"], "ratio": -1.5}
    speeds = [1.5**k for k in range(n)]
    inertia = 2.0 + 5 * 0.09 + 0.5 * speeds[-1] ** 2 + sum(0.005 * light * speeds[k] ** 2 for k in range(1, n - 1))
    moving = truth.pendulum(inertia, 1.5, 0.0, 0.0)
    return Case(f"gears of {light:.0e} kg, {idlers}", {"gravity": [0, -GRAVITY, 0], "body": body, "joint": joint}, 0.01, 0.5,
                lambda times: [[a, (-1.5) ** (n - 1) * a] for a in moving(times)], ("axle0.angle", f"axle{n - 1}.angle"), length=float(n),
                energy=15.0, weight=50.0, speed=4.0, rate=4.0, ratio=20 / light, expect={"dof": 1, "redundant": 0})


def screw(pitch, moment, stiffness):
    """A nut of 1 kg on an upright spindle and a linear spring: a harmonic oscillation along it."""
    lead, height = pitch / (2 * math.pi), 1.0
    nut = {"mass": 1.0, "inertia": [moment, moment, moment], "position": [0, 0, 0]}
    spring = {"type": "spring", "between": [[0, 0, height], "nut"], "stiffness": stiffness, "rest_length": height}
    model = space(body={"nut": nut}, joint={"spindle": {"type": "screw", "between": ["ground", "nut"], "at": [0, 0, 0], "axis": [0, 0, 1],
                                                       "pitch": pitch}}, force={"spring": spring})
    frequency, low = math.sqrt(stiffness / (1 + moment / lead**2)), GRAVITY / stiffness
    return Case(f"screw of {pitch:g} m, {moment:g} kg m²", model, 0.002, 0.2,
                lambda times: [[low * (math.cos(frequency * t) - 1), low * (math.cos(frequency * t) - 1) / lead] for t in times],
                ("nut.z", "spindle.angle"), length=1.0, energy=GRAVITY, weight=GRAVITY, speed=2.0,
                rate=max(2.0, frequency), floor=1e-8 * max(1.0, 0.01 / lead), expect={"dof": 1, "redundant": 0})


def stiff_spring(stiffness, step):
    """A rod with a bob, and a second bob on a stiff spring: nearly a double pendulum."""
    stretched = 1.0
    spring = {"type": "spring", "between": ["a", "b"], "stiffness": stiffness, "rest_length": stretched}
    model = plane(point={"a": {"mass": 1.0, "position": [0.6, -0.8]}, "b": {"mass": 1.0, "position": [1.6, -0.8]}},
                  constraint={"rod": rod("ground", "a")}, force={"spring": spring})
    slack = 10 * GRAVITY / stiffness
    moving = truth.chain([(1, 1, 1, 0)] * 2, [math.atan2(-0.8, 0.6), 0.0])
    return Case(f"spring of {stiffness:.0e} N/m, {step:g} s", model, step, 0.4, lambda times: truth.ends(moving(times), [1, 1]),
                ("a.x", "a.y", "b.x", "b.y"), length=2.0, energy=4 * GRAVITY, weight=2 * GRAVITY, speed=6.0, floor=max(1e-9, slack))


def double_pendulum(name, masses, lengths, angles, step, end, floor):
    """Two points on rods, from rest."""
    first = [lengths[0] * math.cos(angles[0]), lengths[0] * math.sin(angles[0])]
    second = [first[0] + lengths[1] * math.cos(angles[1]), first[1] + lengths[1] * math.sin(angles[1])]
    model = plane(point={"a": {"mass": masses[0], "position": first}, "b": {"mass": masses[1], "position": second}},
                  constraint={"inner": rod("ground", "a"), "outer": rod("a", "b")})
    size = sum(lengths)
    moving = truth.chain([(length, length, mass, 0) for length, mass in zip(lengths, masses)], angles, tolerance=1e-11)
    lightest = masses[0] < 1e-6 * masses[1]
    columns = ("b.x", "b.y") if lightest else ("a.x", "a.y", "b.x", "b.y")
    places = lambda times: [row[-len(columns):] for row in truth.ends(moving(times), lengths)]
    if lightest:
        heavy = truth.pendulum(size * size, size, angles[0], 0.0)
        places = lambda times: [[size * math.cos(a), size * math.sin(a)] for a in heavy(times)]
    return Case(f"double pendulum, {name}", model, step, end, places, columns, length=size, energy=sum(masses) * GRAVITY * size,
                weight=sum(masses) * GRAVITY, speed=math.sqrt(2 * GRAVITY * size), rate=math.sqrt(GRAVITY / min(lengths)),
                ratio=max(masses) / min(masses), floor=floor, expect={"dof": 2, "redundant": 0})


def spinning_top(spin):
    """A fast top of 1 kg, half a metre from its ball, tilted."""
    tilt, across, along = 0.5, 0.1, 0.02
    axis = [math.sin(tilt), 0, math.cos(tilt)]
    body = {"top": {"mass": 1.0, "inertia": [across, across, along], "position": [0.5 * x for x in axis],
                    "orientation": {"axis": [0, 1, 0], "angle": tilt}, "angular_velocity": [spin * x for x in axis]}}
    joint = {"ball": {"type": "spherical", "between": ["ground", "top"], "at": [0, 0, 0]}}
    moving = truth.top(axis, [0, 0, 0], spin, across + 0.25, along, 0.5)
    return Case(f"top with spin {spin:g}", space(body=body, joint=joint), 0.002, 0.1,
                lambda times: [[0.5 * x for x in n] for n in moving(times)], ("top.x", "top.y", "top.z"), length=1.0,
                energy=max(GRAVITY, 0.5 * along * spin**2), weight=GRAVITY, speed=spin, expect={"dof": 3, "redundant": 0})


def cases():
    yield from (trolley(light, 0.25) for light in (1e-2, 1e-4, 1e-7))
    yield trolley(0.1, 0.5)
    yield from (trolley(light, 0.5, judged=False) for light in (1e-4, 1e-7))
    yield from (light_wheel(light, reactions) for light in (1e-6, 1e-9) for reactions in (False, True))
    yield from (gears(light, idlers) for light, idlers in ((1e-3, 1), (1e-6, 3), (1e-9, 3)))
    yield from (screw(*sizes) for sizes in ((0.1, 1e-3, 40.0), (0.1, 1e-9, 40.0), (1e-3, 1e-6, 1e4), (10.0, 1e-3, 40.0)))
    yield from (stiff_spring(stiffness, 0.005) for stiffness in (1e6, 1e9, 1e12))
    bent = (-1.0, -0.4)
    yield double_pendulum("1e9 kg and 1 kg", (1e9, 1.0), (1.0, 1.0), bent, 0.005, 0.5, 1e-8)
    yield double_pendulum("1 kg and 1e-9 kg", (1.0, 1e-9), (1.0, 1.0), bent, 0.005, 0.5, 1e-8)
    yield double_pendulum("1e-9 kg and 1 kg", (1e-9, 1.0), (1.0, 1.0), (0.0, 0.0), 0.01, 0.4, 1e-7)
    yield double_pendulum("1 kg and 1e9 kg", (1.0, 1e9), (1.0, 1.0), (0.0, 0.0), 0.01, 0.4, 1e-7)
    yield double_pendulum("1 m and 1 mm", (1.0, 1.0), (1.0, 1e-3), (-1.0, -1.2), 0.001, 0.1, 1e-9)
    yield double_pendulum("1 km and 1 m", (1.0, 1.0), (1e3, 1.0), (-1.0, -1.2), 0.01, 1.0, 1e-6)
    yield from (spinning_top(spin) for spin in (50.0, 500.0))
