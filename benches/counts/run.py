"""Counts that do not depend on the machine's speed: iterations, factorisations and instructions of a step.

    cargo build --release
    python3 benches/counts/run.py [--only NAME]

Every example of the gallery runs at its own step and method, mechanisms of the benches at 1 ms. Instructions are counted by
valgrind (3.20 or later: 3.19 does not know all that compilers write for vectors) over two lengths of a run; their difference
over the difference in steps is what a step takes, without start and end.
Results are written as JSON; `cargo xtask performance` puts them into the chapter.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS = ROOT / "benches" / "counts" / "results.json"
HOLONOM = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "holonom"
VALGRIND = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]

# Valgrind counts a repeated instruction once a byte, so the C library is asked to fill and copy without any.
PLAIN = "glibc.cpu.x86_rep_stosb_threshold=1000000000:glibc.cpu.x86_rep_movsb_threshold=1000000000"

# Steps of the two runs under valgrind.
SHORT, LONG = 50, 150

DEFAULT = "conserving-ggl"
CONSERVING = ["conserving", DEFAULT]


def of_the_gallery():
    """Name, model, keys, method and step of every example, over all of its run."""
    for path in sorted((ROOT / "examples").glob("*.toml")):
        simulation = tomllib.loads(path.read_text())["simulation"]
        yield path.stem, str(path), [], simulation.get("method", DEFAULT), simulation["step"], simulation["end"]


def of_the_benches():
    """The same of mechanisms of many bodies."""
    folder = ROOT / "benches" / "models"
    four_bar = str(ROOT / "examples" / "four-bar.toml")
    yield from ((f"four-bar, N = 40, {method}", four_bar, ["parameters.N=40"], method, 1e-2, 10.0) for method in CONSERVING)
    mechanisms = [
        *((f"chain, N = {n}", str(ROOT / "examples" / "chain.toml"), f"parameters.N={n}") for n in (10, 100, 1000)),
        *((f"tree, N = {(2 << n) - 1}", str(folder / "tree.toml"), f"parameters.L={n}") for n in (3, 6, 9)),
        *((f"ladder, N = {2 * n + 1}", four_bar, f"parameters.N={n}") for n in (5, 50, 500)),
        *((f"grid, N = {3 * n * n}", str(folder / "grid.toml"), f"parameters.n={n}") for n in (2, 6)),
        ("random mechanism, n = 30", str(folder / "graph.toml"), "parameters.n=30"),
        *((f"spatial chain, N = {n}", str(folder / "spatial-chain.toml"), f"parameters.N={n}") for n in (10, 40)),
    ]
    for name, model, size in mechanisms:
        yield from ((f"{name}, {method}", model, [size], method, 1e-3, 0.2) for method in CONSERVING)


# Unlike `run`, `compare` saves nothing on the way, which would depend on the clock.
def command(model, keys, method, step, end, out):
    sets = [part for key in keys for part in ("--set", key)]
    steps = ["--step", repr(step), "--end", repr(end), "--every", "1000000000"]
    return [HOLONOM, "compare", model, *sets, "--method", method, *steps, "--json", "--no-report", "--force", "--out", out]


def summary(*run):
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run(command(*run, out), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)[0]


def instructions(model, keys, method, step):
    """Instructions a step, from runs of two lengths."""

    environment = dict(os.environ, GLIBC_TUNABLES=PLAIN)

    def counted(steps):
        with tempfile.TemporaryDirectory() as out:
            run = command(model, keys, method, step, steps * step, out)
            done = subprocess.run([*VALGRIND, *run], capture_output=True, text=True, check=True, env=environment)
        return int(re.search(r"I\s+refs:\s+([\d,]+)", done.stderr).group(1).replace(",", ""))

    return (counted(LONG) - counted(SHORT)) / (LONG - SHORT)


def measure(name, model, keys, method, step, end):
    found = summary(model, keys, method, step, end)
    work = found["work"]
    return {
        "name": name.split(f", {method}")[0],
        "method": found["method"]["name"],
        "step": step,
        "iterations": work["iterations_per_step"],
        "factorizations": work["factorizations"] / max(1, work["steps_taken"]),
        "rejected": work["rejected_steps"],
        "instructions": instructions(model, keys, method, step),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="only mechanisms whose name starts so; prints and writes nothing")
    given = parser.parse_args()
    tables = {"gallery": of_the_gallery(), "benches": of_the_benches()}
    results = {}
    for table, mechanisms in tables.items():
        results[table] = []
        for mechanism in mechanisms:
            if given.only and not any(mechanism[0].startswith(name) for name in given.only):
                continue
            entry = measure(*mechanism)
            results[table].append(entry)
            print(f"{entry['name']:32} {entry['method']:16} {entry['step']:8.2g} s  {entry['iterations']:6.2f} iterations "
                  f"{entry['factorizations']:6.2f} factorisations {entry['instructions']:12.0f} instructions", flush=True)
    if not given.only:
        RESULTS.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
