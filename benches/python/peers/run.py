"""Four mechanisms in holonom, Exudyn, MuJoCo and Drake, all from Python: lines of code, time from the import to the first result, cost of a step,
drift of the energy, and what each says to five mistakes.

    python benches/python/peers/run.py [--repeats 5]

needs holonom as `pip install .` makes it, and `pip install exudyn mujoco drake`. Every task is a process of its own; programs take turns, and the
least time counts.
"""

import argparse
import importlib.metadata
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from mechanisms import MECHANISMS, MISTAKES

WORK = pathlib.Path(__file__).resolve().with_name("work.py")
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
PROGRAMS = ["holonom", "exudyn", "mujoco", "drake"]


def ask(*words):
    """What a task gives, and what the program printed."""
    with tempfile.TemporaryDirectory() as folder:
        # MuJoCo leaves a file where it is.
        command = [sys.executable, WORK, *words]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600, env=os.environ | ONE_THREAD, cwd=folder)
    *printed, answer = done.stdout.splitlines() or [""]
    try:
        return json.loads(answer), "\n".join([*printed, done.stderr]).strip()
    except ValueError:
        return None, f"the process ends with {done.returncode}: {done.stdout}{done.stderr}"


def least(task, mechanism, repeats):
    found = {program: [] for program in PROGRAMS}
    for _ in range(repeats):
        for program in PROGRAMS:
            found[program].append(ask(task, program, mechanism)[0])
    return {program: min(times) for program, times in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5, help="runs of which the least time counts (default 5)")
    repeats = parser.parse_args().repeats
    for program in PROGRAMS:
        print(f"{program} {importlib.metadata.version(program)}: {ask('setting', program)[0]}")
    print("\n| mechanism | program | lines | import to first result, s | µs a step | drift, J |\n|---|---|---|---|---|---|")
    for key, mechanism in MECHANISMS.items():
        firsts, costs = least("first", key, repeats), least("cost", key, repeats)
        for program in PROGRAMS:
            (own, shared), drift = ask("lines", program, key)[0], ask("drift", program, key)[0]
            print(f"| {mechanism.title} | {program} | {own} + {shared} | {firsts[program]:.2f} | {costs[program]:.2f} | {drift:.1e} |", flush=True)
    for mistake in ["a name with a slip", *MISTAKES]:
        print(f"\n## {mistake}")
        for program in PROGRAMS:
            answer, printed = ask("mistake", program, mistake)
            print(f"\n### {program}\n{answer}\n{printed}".rstrip(), flush=True)


if __name__ == "__main__":
    main()
