"""The second table: CPU time against error, with steps swept by factors of two."""

import math
import time

from programs import Failed

# Errors that are asked for, m or rad.
GOALS = [1e-2, 1e-3, 1e-4, 1e-5]

MOST_HALVINGS = 14

# Accuracies are swept by this factor.
FINER_ACCURACY = 0.1
FIRST_ACCURACY = 1e-2

# A run that takes longer than this is not repeated with half its step, s.
LONGEST = 10.0

# Runs that take longer than this are timed once: what disturbs them is a small share, s.
LONG = 3.0


def measure(problems, rounds, limit, peers, say):
    """An entry with its points for every program on every problem."""
    return [entry for problem in problems for entry in measure_problem(problem, rounds, limit, peers, say)]


def measure_problem(problem, rounds, limit, peers, say):
    entries = []
    for program in problem.programs:
        entries.append(sweep(problem, program, limit, peers))
        say(f"{problem.title}, {program.program} {program.setting}: {len(entries[-1]['points'])} points")
    for k in range(rounds):
        for entry, program in zip(entries, problem.programs, strict=True):
            for point in entry["points"]:
                time_again(point, program, k, limit, peers)
        say(f"{problem.title}: round {k + 1} of {rounds}")
    for entry in entries:
        entry["to"] = [time_to(entry["points"], goal) for goal in GOALS]
    return entries


def sweep(problem, program, limit, peers):
    """Runs with smaller and smaller steps until the least error is reached or a run takes too long."""
    points, failed = [], None
    step = FIRST_ACCURACY if program.by_accuracy else problem.step
    for _ in range(MOST_HALVINGS + 1):
        start = time.monotonic()
        try:
            result = program.run(step, True, limit, peers)
        except Failed as failure:
            failed = str(failure)
        else:
            names = ("error", "drift", "position", "velocity")
            points.append({"step": step, "cpu": None, "first": result["cpu"], **{name: result.get(name) for name in names}})
            if result["error"] < GOALS[-1]:
                break
        if time.monotonic() - start > LONGEST:
            break
        step *= FINER_ACCURACY if program.by_accuracy else 0.5
    return {
        "problem": problem.name,
        "title": problem.title,
        "program": program.program,
        "setting": program.setting,
        "by_accuracy": program.by_accuracy,
        "points": points,
        "failed": None if points else failed,
    }


def time_again(point, program, k, limit, peers):
    if k > 0 and point["first"] > LONG:
        return
    try:
        cpu = program.run(point["step"], False, limit, peers)["cpu"]
    except Failed:
        return
    point["cpu"] = cpu if point["cpu"] is None else min(cpu, point["cpu"])


def time_to(points, goal):
    """Least CPU time to an error, s: of a run that is as good, or between two runs around it, straight in logarithms."""
    points = [point for point in points if point["cpu"] is not None]
    times = [point["cpu"] for point in points if point["error"] <= goal]
    times += [between(a, b, goal) for a, b in zip(points, points[1:]) if a["error"] > goal > b["error"]]
    return min(times, default=None)


def between(a, b, goal):
    share = math.log(goal / a["error"]) / math.log(b["error"] / a["error"])
    return a["cpu"] * (b["cpu"] / a["cpu"]) ** share
