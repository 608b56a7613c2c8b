"""How far a rotor on a hinge lags behind after 1000 turns, by method and step.

    python3 benches/rotor/run.py [FOLDER]

prints the table of docs/methods.md, "Fast rotors", after runs of some minutes, or from the results that an earlier call
left in FOLDER. The truth is ωt; the figure is the error of the angle over the angle itself, positive where the scheme
lags behind. The command is `holonom`, or what HOLONOM says.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

MODEL = Path(__file__).resolve().parent.parent / "models" / "rotor.toml"
STEPS = ["0.05", "0.1", "0.2", "0.5"]
METHODS = [
    "conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "trapezoidal", "generalized-alpha",
    "radau", "ggl/conserving-ggl-4", "ggl/conserving-ggl-6", "lagrange-3/rattle", "lagrange-3/hht", "ggl/bdf-2",
    "lagrange-1/gauss-6", "ode/rk4",
]
TURNS = 1000
ENERGY = 1.0  # J, of the rotor at the start


def run(folder):
    command = [os.environ.get("HOLONOM", "holonom"), "compare", str(MODEL), "--every", "100", "--no-report", "--quiet", "--force", "--out", folder]
    command += [f"--method={method}" for method in METHODS] + [f"--step={step}" for step in STEPS]
    # Runs that stop are part of the table.
    subprocess.run(command, check=False)


def cell(path, stopped_at):
    if stopped_at is not None:
        return f"stops at {stopped_at:.1f} s"
    with open(path, newline="") as file:
        rows = [{key: float(row[key]) for key in ("t", "energy", "hinge.angle")} for row in csv.DictReader(file)]
    last = rows[-1]
    lag = 1.0 - last["hinge.angle"] / last["t"]
    lost = 1.0 - min(row["energy"] for row in rows) / ENERGY
    return f"{lag:.1e}" if lost < 0.5 else f"{lag:.1e}, spin lost"


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()
    if not any(Path(folder).glob("*.csv")):
        run(folder)
    stopped = {summary["label"]: summary["stopped_at"] for summary in json.loads((Path(folder) / "summary.json").read_text())}
    print("| method | " + " | ".join(f"ωh = {step}" for step in STEPS) + " |")
    print("|---" * (len(STEPS) + 1) + "|")
    for method in METHODS:
        cells = []
        for step in STEPS:
            file = Path(folder) / f"{method.replace('/', '-')}-{step}s.csv"
            cells.append(cell(file, stopped[f"{method}, {step} s"]))
        print(f"| `{method}` | " + " | ".join(cells) + " |")


main()
