#!/usr/bin/env python3
"""Times holonom and its peers on the same problems, interleaved, one thread each: cost at equal steps, work against precision.

    cargo build --release
    python3 benches/side-by-side/run.py --peers FOLDER

FOLDER holds the peers' scripts (peer_exudyn.py, …), their references (refs.json) and a virtual environment `venv`; every
script prints one JSON line. Nothing here is part of the product or of its tests. Times are CPU time of the solution alone,
the least of all rounds. `cargo xtask performance --peers FOLDER` runs this and writes the chapter from its results.
"""

import argparse
import csv
import json
import os
import pathlib
import platform

import cost
import precision
import problems
from programs import ROOT, Peers, Progress, holonom_binary

RESULTS = ROOT / "benches" / "side-by-side" / "results.json"
TABLES = ROOT / "target" / "side-by-side"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peers", type=pathlib.Path, required=True, help="folder with the peers' scripts, refs.json and venv")
    parser.add_argument("--rounds", type=int, default=5, help="runs of which the fastest counts (default 5)")
    parser.add_argument("--precision-rounds", type=int, default=3, help="the same, for work against precision (default 3)")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="only problems of this name; may be given several times")
    parser.add_argument("--table", choices=["cost", "precision"], help="only one of the tables")
    parser.add_argument("--limit", type=float, default=180.0, help="a run that takes longer has failed, s (default 180)")
    parser.add_argument("--out", type=pathlib.Path, default=RESULTS, help="results, as JSON; both tables go to target/side-by-side as CSV")
    return parser.parse_args()


def processor():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def chosen(found, names):
    return [problem for problem in found if not names or problem.name in names]


def write_csv(path, time, entries):
    names = ["title", "program", "setting", "step", time, "error", "drift", "position", "velocity", "failed"]
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(entries)


def main():
    given = arguments()
    known = {problem.name for problem in [*problems.of_costs(), *problems.of_precision()]}
    unknown = [name for name in given.only if name not in known]
    if unknown:
        raise SystemExit(f"there is no problem {', '.join(unknown)}; there are: {', '.join(sorted(known))}")
    if not holonom_binary().exists():
        raise SystemExit(f"{holonom_binary()} is not there: cargo build --release")
    peers, progress = Peers(given.peers), Progress()
    results = json.loads(given.out.read_text()) if given.out.exists() else {"cost": [], "precision": []}
    results["machine"] = {"processor": processor(), "cores": os.cpu_count(), "load": round(os.getloadavg()[0], 1)}
    results["goals"] = precision.GOALS
    tables = {"cost": (cost, problems.of_costs, given.rounds), "precision": (precision, problems.of_precision, given.precision_rounds)}
    for name, (table, found, rounds) in tables.items():
        if given.table in (None, name):
            results.setdefault("rounds", {})[name] = rounds
            for problem in chosen(found(), given.only):
                entries = table.measure([problem], rounds, given.limit, peers, progress.say)
                results[name] = merged(results[name], entries, [problem.title for problem in found()])
                results.setdefault("versions", {}).update(peers.versions)
                given.out.write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n")
    write_csv(TABLES / "cost.csv", "us", results["cost"])
    points = [{**entry, **point} for entry in results["precision"] for point in entry["points"]]
    write_csv(TABLES / "precision.csv", "cpu", points)


def merged(old, new, order):
    """New entries in place of the old ones of the same problems, in the order of the tables."""
    titles = {entry["title"] for entry in new}
    kept = [entry for entry in old if entry["title"] not in titles and entry["title"] in order]
    return sorted([*kept, *new], key=lambda entry: order.index(entry["title"]))


if __name__ == "__main__":
    main()
