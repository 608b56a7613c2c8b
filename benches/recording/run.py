"""What recording the forces of joints costs a run.

    python3 benches/recording/run.py [--rounds 7]

prints the table of docs/performance.md, "What recording costs": time by the clock of whole runs of the gallery with the
forces of joints and without them, the least of some rounds in which both take turns, each row of every step written as
CSV. On one processor (`taskset -c 0`) it tells what they cost where none is free for the thread that makes rows. The
command is `holonom`, or what HOLONOM says.
"""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

# Each with an end (s) of some ten thousand steps.
MODELS = {
    "double-pendulum": 60, "four-bar": 20, "chain": 20, "jansen-linkage": 100, "spatial-four-bar": 20,
    "flyball-governor": 20, "differential": 20, "suspension": 20, "stewart-platform": 20,
}


def run(model, end, with_forces):
    """Seconds of the whole run and of its steps, and how many these were."""
    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("HOLONOM", "holonom"), "run", f"example:{model}", "--end", str(end)]
        command += ["--quiet", "--no-report", "--out", folder, "--force"]
        command += [] if with_forces else ["--set", "output.reactions=false"]
        begun = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        whole = time.perf_counter() - begun
        summary = json.loads((Path(folder) / "summary.json").read_text())
        return whole, 1e-6 * summary["time"]["us_per_step"] * summary["steps"], summary["steps"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=7)
    rounds = parser.parse_args().rounds
    print("| model | steps | µs a step without forces of joints | with | ratio | ratio of whole runs |")
    print("|---|---:|---:|---:|---:|---:|")
    for model, end in MODELS.items():
        least = {}
        for _ in range(rounds):
            for with_forces in (False, True):
                whole, stepping, steps = run(model, end, with_forces)
                known = least.get(with_forces, (float("inf"), float("inf")))
                least[with_forces] = (min(whole, known[0]), min(stepping, known[1]))
        (whole, stepping), (whole_with, stepping_with) = least[False], least[True]
        each = [f"{1e6 * seconds / steps:.1f}" for seconds in (stepping, stepping_with)]
        print(f"| {model} | {steps} | {each[0]} | {each[1]} | {stepping_with / stepping:.2f} | {whole_with / whole:.2f} |", flush=True)


if __name__ == "__main__":
    main()
