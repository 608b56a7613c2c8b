"""A run of holonom, its errors against the truth, and what it is worth."""

import csv
import functools
import json
import math
import os
import pathlib
import resource
import signal
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Models become files as those of the hard mechanisms do.
sys.path.append(str(ROOT / "benches" / "hard"))

from case import toml  # noqa: E402

HOLONOM = os.environ.get("HOLONOM") or pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "holonom"

# Rows of a run besides the start, share of the accuracy that is right, and the change of the start that growth is measured with.
ROWS, WITHIN, NUDGE = 20, 10.0, 1e-7


class Ended(Exception):
    """A run without results: its verdict, what its summary says, and why."""


def call(command, limit):
    """Output of a command that may use so much CPU time, s."""
    bound = int(math.ceil(limit))
    confine = functools.partial(resource.setrlimit, resource.RLIMIT_CPU, (bound, bound + 1))
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=10 * limit, preexec_fn=confine)
    except subprocess.TimeoutExpired:
        raise Ended("timeout", {}, f"over {10 * limit:.0f} s") from None
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Ended("timeout", {}, f"over {limit:.0f} s of CPU")
    found = json.loads(done.stdout) if done.stdout.startswith("{") else {}
    if done.returncode != 0:
        verdict = {2: "refused", 3: "stopped"}.get(done.returncode, "stopped")
        text = (done.stderr or done.stdout).strip().splitlines()
        raise Ended(verdict, found, str(found.get("reason") or (text[0] if text else f"exit {done.returncode}")))
    return found


def run(case, method, end, limit, folder, **keys):
    """Summary of a run, and its largest errors of places and of speeds."""
    path = folder / "model.toml"
    path.write_text(toml(case.model))
    settings = [part for key, value in keys.items() for part in ("--set", f"simulation.{key}={value!r}")]
    command = [HOLONOM, "run", path, "--method", method, "--end", repr(end), *settings, "--json", "--no-report", "--force", "--out", folder / "out"]
    if "step" in keys:
        command += ["--every", str(round(end / ROWS / keys["step"]))]
    else:
        command += ["--step", repr(end / ROWS)]
    found = call(command, limit)
    with open(folder / "out" / "trajectory.csv") as file:
        rows = list(csv.DictReader(file))[1:]
    places, speeds = true_motion(case, tuple(end * (k + 1) / ROWS for k in range(ROWS)))
    if len(rows) != ROWS:
        raise Ended("stopped", found, f"{len(rows)} rows in place of {ROWS}")

    def error(columns, truth, unit):
        here = np.array([[float(row[name]) for name in columns] for row in rows])
        worst = float(np.max(np.abs(here - truth) / unit))
        return worst if math.isfinite(worst) else math.inf

    return found, error(case.columns, places, case.sizes()), error(case.rates(), speeds, max(float(np.max(np.abs(speeds))), 1e-300))


TRUTHS = {}


def true_motion(case, times):
    if (case.family, case.name, times) not in TRUTHS:
        TRUTHS[case.family, case.name, times] = case.truth(list(times))
    return TRUTHS[case.family, case.name, times]


def growth(case, end):
    """What the motion makes of a small change of the start, at most; 1 where the truth is not integrated."""
    times = [end * (k + 1) / ROWS for k in range(ROWS)]
    change = np.abs(case.truth(times, NUDGE)[0] - case.truth(times)[0]) / case.sizes()
    return max(float(np.max(change)) / NUDGE, 1.0)


def judged(case, method, accuracy, end, grows, limit, folder):
    """Verdict, summary, errors over the accuracy, and reason of a run."""
    try:
        found, place, speed = run(case, method, end, limit, folder, accuracy=accuracy)
    except Ended as ended:
        verdict, found, reason = ended.args
        return verdict, found, None, None, reason
    factor = place / accuracy
    verdict = "within" if factor <= WITHIN else "grown" if factor <= WITHIN * grows else "worse"
    return verdict, found, factor, speed / accuracy, ""
