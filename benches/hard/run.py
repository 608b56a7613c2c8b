"""Hard mechanisms by every named method: right, wrong, refused or stopped, against motions that holonom has no part in.

    cargo build --release
    python3 benches/hard/run.py [--only NAME] [--method NAME]

Light parts, dead centres, ranks, thin rods, places far away and mixed units. A run that completes must be right: what its method promises
is kept to round-off, and against the truth the error falls with the order of the method. The variable HOLONOM names another binary.
The exit status is 1 when a run is completed and wrong or takes too long. Needs numpy.
"""

import argparse
import collections
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import models

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOLONOM = os.environ.get("HOLONOM") or pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "holonom"

METHODS = ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "trapezoidal", "generalized-alpha", "radau"]

# What a method keeps besides Φ: the energy, an energy that never rises, Φ̇ and Φ̈.
ENERGY = {"conserving-ggl": "max_drift", "conserving": "max_drift", "conserving-projected": "max_rise"}
VELOCITY = {"conserving-ggl", "conserving-projected", "trapezoidal-projected", "radau"}
ACCELERATION = {"trapezoidal-projected"}

# Shares of energy, length² and so on that are round-off.
KEPT, ON_POSITION, ON_VELOCITY, ON_ACCELERATION = 1e-10, 1e-11, 1e-10, 1e-9
EPSILON = 2.0**-52

# Digits that a number loses on its way, where the mechanism is far from the origin.
FAR = 50 * EPSILON

# A run may take so long, s; the paper's unstable method is judged over so many steps.
LIMIT, SHORT = 60.0, 10

# Order of the error, and what halving the step divides it by, at least. Light parts tremble faster than any step, which hides the order;
# then errors must stay below this share of (step · rate)^order. One beyond the last share of the length is no motion at all.
ORDER, RATIO, SHARE, LOST = {"radau": 5}, {2: 3.0, 5: 10.0}, 0.1, 0.3

# Steps are halved so often before an error is said not to fall with the order; once where smaller steps only mean more of them.
HALVINGS, UNSTABLE = 3, {"trapezoidal"}

VERDICTS = ["right", "wrong", "refused", "stopped", "timeout"]


class Ended(Exception):
    """A run without results: its verdict, and why."""


def call(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise Ended("timeout", f"over {LIMIT:.0f} s") from None


def first_line(text):
    return next((line for line in text.splitlines() if line.strip()), "says nothing")


def result_of(done):
    """The JSON that a command has printed; a run that refuses or stops ends here."""
    found = json.loads(done.stdout) if done.stdout.startswith("{") else {}
    if done.returncode == 0:
        return found
    verdict = {2: "refused", 3: "stopped"}.get(done.returncode, "wrong")
    reason = str(found.get("reason") or first_line(done.stderr or done.stdout))
    if verdict == "stopped" and found.get("stopped_at") is not None:
        reason = f"at {found['stopped_at']:.3g} s: {reason}"
    raise Ended(verdict, reason if verdict != "wrong" else f"exit {done.returncode}: {reason}")


def samples(case, method):
    """Steps of the run, and how many rows of it are compared."""
    steps = round(case.end / case.step)
    if method == "trapezoidal":
        steps = min(steps, SHORT)
    return steps, max(d for d in range(1, 11) if steps % d == 0)


def rows(path, columns):
    with open(path) as file:
        return [[float(row[column]) for column in columns] for row in csv.DictReader(file)][1:]


def run(case, method, halvings, folder):
    """Summary of a run with the step halved so often, and its largest error or None."""
    steps, count = samples(case, method)
    step, end = case.step / 2**halvings, steps * case.step
    command = [HOLONOM, "run", model_of(case, folder), "--method", method, "--step", repr(step), "--end", repr(end),
               "--every", str((steps // count) * 2**halvings), "--json", "--no-report", "--force", "--out", str(folder / "out")]
    found = result_of(call(command))
    if case.truth is None:
        return found, None
    there = truth_of(case, tuple(end * (k + 1) / count for k in range(count)))
    here = rows(folder / "out" / "trajectory.csv", case.columns)
    if len(here) != len(there):
        raise Ended("wrong", f"{len(here)} rows in place of {len(there)}")
    error = max(abs(a - b) for x, y in zip(here, there) for a, b in zip(x, y, strict=True))
    return found, error if math.isfinite(error) else math.inf


def model_of(case, folder):
    if isinstance(case.model, str):
        return case.model
    path = folder / "model.toml"
    path.write_text(case.text())
    return str(path)


TRUTHS = {}


def truth_of(case, times):
    if (case.name, times) not in TRUTHS:
        TRUTHS[case.name, times] = case.truth(times)
    return TRUTHS[case.name, times]


def broken(case, method, found):
    """What a summary says against the method's promises or against what is known of the mechanism."""
    far, violation = FAR * case.offset, found["violation"]
    # Rows are lengths or products of two: the norm of both has the laxer limit.
    unit = max(case.length, 1.0)
    limits = [("Φ", violation["position"], (ON_POSITION * case.length + far) * unit)]
    if method in ENERGY:
        limits.append((ENERGY[method], found["energy"][ENERGY[method]], KEPT * case.energy + far * case.weight))
    if method in VELOCITY:
        limits.append(("Φ̇", violation["velocity"], (ON_VELOCITY * unit + far) * case.speed))
    if method in ACCELERATION:
        share = ON_ACCELERATION + 50 * EPSILON * case.ratio
        limits.append(("Φ̈", violation["acceleration"], (share * case.length + far) * case.speed * case.pace()))
    faults = [f"{name} {number:.1e} over {limit:.1e}" for name, number, limit in limits if not number <= limit]
    return faults + unexpected(case, found)


def unexpected(case, found):
    missing = object()
    return [f"{key} is {found.get(key)}, not {known}" for key, known in case.expect.items() if found.get(key, missing) != known]


def out_of_order(case, method, error, folder):
    """Whether errors fall with the order of the method as the step is halved; in words when they do not."""
    if error <= case.floor:
        return []
    if not error <= LOST * case.length:
        return [f"off by {error:.1e}"]
    order = ORDER.get(method, 2)
    size = SHARE * case.speed / case.pace()
    limits = [size * (case.step / 2**k * case.pace()) ** order for k in range(HALVINGS + 1)]
    errors = [error]
    for halvings in range(1, 2 if method in UNSTABLE else HALVINGS + 1):
        errors.append(run(case, method, halvings, folder)[1])
        if errors[-1] <= case.floor or errors[-2] >= RATIO[order] * errors[-1]:
            return []
    kept = [error <= limit for error, limit in zip(errors, limits)]
    if kept[0] if method in UNSTABLE else all(kept):
        return []
    return ["errors " + ", ".join(f"{error:.1e}" for error in errors) + f" from {case.step:g} s on"]


def judged(case, method, folder):
    """Verdict, summary, error and reasons of a cell."""
    found, error = {}, None
    try:
        found, error = run(case, method, 0, folder)
        faults = broken(case, method, found)
        if error is not None:
            faults += out_of_order(case, method, error, folder)
        return "wrong" if faults else "right", found, error, "; ".join(faults)
    except Ended as ended:
        verdict, reason = ended.args
        return verdict, found, error, reason + (" (with smaller steps)" if found else "")


def checked(case, folder):
    try:
        found = result_of(call([HOLONOM, "check", model_of(case, folder), "--json"]))
    except Ended as ended:
        return ended.args[0], {}, None, ended.args[1]
    faults = unexpected(case, found)
    return "wrong" if faults else "right", {}, None, "; ".join(faults)


def line(name, method, verdict, found, error, reason):
    if not found:
        return f"{name:52} {method:22} {verdict:8} {'':42} {reason}"
    kept, at = found["energy"], found["violation"]
    shown = "" if error is None else f"{error:8.1e}"
    numbers = f"{kept['max_drift']:8.1e} {at['position']:8.1e} {at['velocity']:8.1e} {found['work']['iterations_per_step']:6.2f} {shown:8}"
    return f"{name:52} {method:22} {verdict:8} {numbers:42} {reason}"


def cells(only, method):
    for case in models.cases():
        if not any(part in case.name for part in only or [""]):
            continue
        if case.check:
            yield case, "check"
        else:
            yield from ((case, name) for name in METHODS if method in (None, name))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="only mechanisms with this in their name")
    parser.add_argument("--method", choices=METHODS, help="only this method")
    given = parser.parse_args()
    counts = {}
    print(f"{'mechanism':52} {'method':22} {'verdict':8} {'drift':>8} {'Φ':>8} {'Φ̇':>9} {'iter.':>6} {'error':>8}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for case, method in cells(given.only, given.method):
            cell = checked(case, folder) if method == "check" else judged(case, method, folder)
            counts.setdefault(method, collections.Counter())[cell[0]] += 1
            print(line(case.name, method, *cell), flush=True)
    print(f"\n{'':22} " + " ".join(f"{verdict:>8}" for verdict in VERDICTS))
    for method, found in [*counts.items(), ("all", sum(counts.values(), collections.Counter()))]:
        print(f"{method:22} " + " ".join(f"{found[verdict]:8}" for verdict in VERDICTS))
    sys.exit(any(found["wrong"] or found["timeout"] for found in counts.values()))


if __name__ == "__main__":
    main()
