"""The first table: CPU time of a step, at equal steps."""

from programs import Failed


def measure(problems, rounds, limit, peers, say):
    """An entry for every program on every problem; rounds are interleaved, and the least time counts."""
    return [entry for problem in problems for entry in measure_problem(problem, rounds, limit, peers, say)]


def measure_problem(problem, rounds, limit, peers, say):
    entries = [entry_of(problem, program) for program in problem.programs]
    for k in range(-1, rounds):
        for entry, program in zip(entries, problem.programs, strict=True):
            if entry["failed"] is None:
                take(entry, program, k < 0, limit, peers)
        say(f"{problem.title}: " + ("compared with the reference" if k < 0 else f"round {k + 1} of {rounds}"))
    return entries


def entry_of(problem, program):
    return {
        "problem": problem.name,
        "title": problem.title,
        "bodies": problem.bodies,
        "step": problem.step,
        "end": problem.end,
        "program": program.program,
        "setting": program.setting,
        "us": None,
        "failed": None,
    }


def take(entry, program, trace, limit, peers):
    """A run; the first tells error, drift and violations, the others are timed."""
    try:
        result = program.run(entry["step"], trace, limit, peers)
    except Failed as failure:
        entry["failed"] = str(failure)
        return
    if trace:
        entry.update({name: result[name] for name in ("error", "drift", "position", "velocity", "iterations") if name in result})
        return
    us = 1e6 * result["cpu"] / result["steps"]
    entry["us"] = us if entry["us"] is None else min(us, entry["us"])
