"""The error of a run of holonom: the largest distance of its key quantities from the reference, at the reference's times.

The peers' scripts take the same quantities at the same times.
"""

import csv
import math

# Times of rows and references agree to this, s.
SAME_TIME = 1e-9


def read(path):
    """Rows of a trajectory as dictionaries of numbers."""
    with open(path) as file:
        return [{name: float(cell) for name, cell in row.items() if cell} for row in csv.DictReader(file)]


def largest(name, key, trajectory, end, references):
    """The largest error up to the end of the run, m or rad."""
    reference = references[name]
    times = [row["t"] for row in trajectory]
    found = []
    at = 0
    for k, time in enumerate(reference["t"]):
        if time > end + SAME_TIME:
            break
        while at + 1 < len(times) and abs(times[at + 1] - time) <= abs(times[at] - time):
            at += 1
        if abs(times[at] - time) > SAME_TIME:
            continue
        here, there = key(trajectory[at], reference, k)
        distance = max(abs(a - b) for a, b in zip(here, there, strict=True))
        found.append(distance if math.isfinite(distance) else math.inf)
    if not found:
        raise ValueError(f"the run has no row at a time of the reference `{name}`")
    return max(found)


def pendulum(row, reference, k):
    direction = reference["d"][k]
    return [row[f"{point}.{axis}"] for point in ("m1", "m2") for axis in "xyz"], [*direction, *(2 * d for d in direction)]


def pendulum_rod(row, reference, k):
    return [row[f"m2.{axis}"] for axis in "xyz"], [2 * d for d in reference["d"][k]]


def four_bar(row, reference, k):
    angle = reference["th"][k]
    return [row["P[0].x"], row["P[0].y"]], [math.cos(angle), math.sin(angle)]


def andrews(row, reference, k):
    beta, gamma, delta, epsilon = (row[f"{body}.angle"] for body in ("crank", "plate", "arm-ag", "arm-ah"))
    theta = row["rod.angle"] - beta
    return [beta, theta, gamma, row["link-eg.angle"] - delta, delta, row["link-eh.angle"] - epsilon, epsilon], reference["q"][k]


def bricard(row, reference, k):
    """The end of the third rod, half a metre along its z axis."""
    w, x, y, z = (row[f"rod3.q{part}"] for part in "wxyz")
    axis = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    return [row[f"rod3.{name}"] + 0.5 * part for name, part in zip("xyz", axis)], reference["P3"][k]


def governor(row, reference, k):
    return [row["slider.z"]], [reference["z"][k]]


def chain(row, reference, k):
    """Middles of the rods, between their ends."""
    there = [part for middle in reference["com"][k] for part in middle]
    rods = len(there) // 2
    ends = [(0.0, 0.0)] + [(row[f"P[{i}].x"], row[f"P[{i}].y"]) for i in range(1, rods + 1)]
    here = [0.5 * (a[c] + b[c]) for a, b in zip(ends, ends[1:]) for c in range(2)]
    return here, there


def spatial_chain(row, reference, k):
    there = [part for middle in reference["com"][k] for part in middle]
    return [row[f"rod[{i}].{axis}"] for i in range(1, len(there) // 2 + 1) for axis in "xy"], there
