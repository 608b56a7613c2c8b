"""Steps by accuracy at singular places, stiff stops, friction and short pulses, against motions that holonom has no part in.

    cargo build --release
    python3 benches/accuracy/run.py [--family NAME] [--only NAME] [--method NAME] [--accuracy A] [--all] [--end S] [--truths]

A run that completes is right when its error is within ten times the accuracy. The error is the largest of all rows and columns: of
places over the size of the mechanism, the diagonal of the box around the origin and all parts at the start, of angles in rad, as a
direction has the length of the mechanism. Velocities are shown, over the largest speed, and not judged. The growth of a mechanism is
what its motion makes of a small change of the start: errors beyond ten times the accuracy, but not beyond that times the growth, are
counted apart. --truths compares the truths with runs of small equal steps instead. The variable HOLONOM names another binary.
Needs numpy and scipy.
"""

import argparse
import collections
import math
import os
import pathlib
import sys
import tempfile

# Small matrices are not worth a second thread.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import families  # noqa: E402
import judge  # noqa: E402

METHODS = ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "generalized-alpha", "radau", "ggl/bdf",
           "lagrange-3/bdf", "ode/dopri5", "ode/dop853"]

# What a hundredth of the error costs in steps, by the order of the method; others are of order 2.
ORDER = {"radau": 5, "ggl/bdf": 4, "lagrange-3/bdf": 4, "ode/dopri5": 5, "ode/dop853": 8}

ACCURACIES, ALL = [1e-3, 1e-5, 1e-7, 1e-9], [10.0**-k for k in range(3, 10)]

# CPU time a run may take, s. One that is sure to take longer, by what the accuracy before took, is left out.
LIMIT = 20.0

VERDICTS = ["within", "grown", "worse", "stopped", "refused", "timeout", "left out"]


def line(case, method, accuracy, verdict, found, place, speed, reason):
    head = f"{case.family:14} {case.name:38} {method:21} {accuracy:7.0e} {verdict:8}"
    factors = " ".join(f"{'' if x is None else f'{x:.2g}':>8}" for x in (place, speed))
    work = f"{found['work']['steps_taken']:9} {found['work']['rejected_steps']:7} {found['time']['cpu_s']:7.2f}" if found else f"{'':25}"
    return f"{head} {factors} {work} {reason}".rstrip()


def compare_truths(selected, given, folder):
    for case in selected:
        method, step = case.probe
        end = min(given.end or case.end, case.until)
        step = end / judge.ROWS / math.ceil(end / judge.ROWS / step - 1e-9)
        try:
            _, place, speed = judge.run(case, method, end, 10 * given.limit, folder, step=step)
            print(f"{case.family:14} {case.name:38} {method:21} {step:9.2g} {place:9.1e} {speed:9.1e}", flush=True)
        except judge.Ended as ended:
            print(f"{case.family:14} {case.name:38} {method:21} {step:9.2g} {ended.args[0]}: {ended.args[2]}", flush=True)


def table(title, counts):
    print(f"\n{title:22} " + " ".join(f"{verdict:>8}" for verdict in VERDICTS))
    for name, found in [*counts.items(), ("all", sum(counts.values(), collections.Counter()))]:
        print(f"{name:22} " + " ".join(f"{found[verdict]:8}" for verdict in VERDICTS))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--family", action="append", default=[], help="only families with this in their name")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="only mechanisms with this in their name")
    parser.add_argument("--method", action="append", default=[], help="only this method, any that chooses steps")
    parser.add_argument("--accuracy", action="append", default=[], type=float, help="only this accuracy")
    parser.add_argument("--all", action="store_true", help="all accuracies 1e-3, 1e-4, …, 1e-9 in place of every other one")
    parser.add_argument("--end", type=float, help="end of all runs, s")
    parser.add_argument("--limit", type=float, default=LIMIT, help="CPU time a run may take, s")
    parser.add_argument("--truths", action="store_true", help="compare the truths with runs of small equal steps")
    given = parser.parse_args()

    def is_chosen(case):
        return all(any(part in name for part in parts or [""]) for parts, name in ((given.family, case.family), (given.only, case.name)))

    selected = [case for case in families.cases() if is_chosen(case)]
    accuracies = sorted(given.accuracy or (ALL if given.all else ACCURACIES), reverse=True)
    by_family, by_method = {}, {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        if given.truths:
            return compare_truths(selected, given, folder)
        for case in selected:
            end = given.end or case.end
            grows = judge.growth(case, end)
            print(f"\n{case.family}: {case.name}, {end:g} s, growth {grows:.2g}")
            print(f"{'family':14} {'mechanism':38} {'method':21} {'acc.':>7} {'verdict':8} {'error/a.':>8} {'speed/a.':>8} "
                  f"{'steps':>9} {'rejec.':>7} {'CPU s':>7}")
            for method in given.method or METHODS:
                took, before = 0.0, None
                for accuracy in accuracies:
                    needs = took * (before / accuracy) ** (1 / ORDER.get(method, 2)) if before else 0.0
                    if needs > given.limit:
                        cell = ("left out", {}, None, None, f"would take {needs:.0f} s")
                    else:
                        cell = judge.judged(case, method, accuracy, end, grows, given.limit, folder)
                    if cell[1]:
                        took, before = cell[1]["time"]["cpu_s"], accuracy
                    by_family.setdefault(case.family, collections.Counter())[cell[0]] += 1
                    by_method.setdefault(method, collections.Counter())[cell[0]] += 1
                    print(line(case, method, accuracy, *cell), flush=True)
    table("family", by_family)
    table("method", by_method)
    sys.exit(any(found["worse"] or found["timeout"] for found in by_family.values()))


if __name__ == "__main__":
    main()
