#!/usr/bin/env python3
"""Times holonom and Exudyn on the same problems in one run, interleaved, one thread each.

    cargo build --release
    python3 benches/side-by-side/run.py --peers FOLDER

FOLDER holds peer_exudyn.py and a virtual environment `venv` with exudyn and numpy; every script prints one JSON line.
Nothing here is part of the product or of its tests. Times are CPU microseconds a step, the minimum of all rounds;
energy drift and both violations stand beside each.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOLONOM = ROOT / "target" / "release" / "holonom"

PENDULUM = ["example:spherical-compound-pendulum", "--end", "100"]
FOUR_BAR_40 = ["example:four-bar", "--set", "parameters.N=40", "--step", "1e-3"]

# Problem, holonom's model and methods, the peer's options.
PROBLEMS = [
    ("pendulum, h = 0.025, 100 s", PENDULUM, ["conserving", "conserving-ggl"],
     ["--problem", "scp", "--model", "coords", "--ignore_dup", "--h", "0.025", "--tend", "100", "--solver", "trap"]),
    ("four-bar N = 40, h = 1e-3", FOUR_BAR_40, ["conserving", "conserving-ggl"],
     ["--problem", "fourbar", "--n", "40", "--solver", "ga", "--linear", "sparse", "--h", "1e-3", "--k", "1"]),
    ("Andrews, h = 1e-5, 0.05 s", ["example:andrews", "--step", "1e-5", "--end", "0.05"], ["conserving", "conserving-ggl"],
     ["--problem", "andrews", "--h", "1e-5", "--tend", "0.05", "--solver", "ga"]),
    ("Bricard, h = 1e-3, 10 s", ["example:bricard", "--step", "1e-3", "--end", "10"], ["conserving", "conserving-ggl"],
     ["--problem", "bricard", "--model", "full", "--linear", "eigendense", "--ignore", "--solver", "ga", "--h", "1e-3", "--tend", "10"]),
    ("governor, h = 1e-3, 10 s", ["example:flyball-governor", "--step", "1e-3", "--end", "10"], ["conserving", "conserving-ggl"],
     ["--problem", "flyball", "--h", "1e-3", "--tend", "10", "--solver", "ga"]),
]


def holonom(model, method):
    with tempfile.TemporaryDirectory() as folder:
        command = [HOLONOM, "run", *model, "--method", method, "--json", "--no-report", "--every", "1000000", "--out", folder]
        summary = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return {
        "us": summary["time"]["us_per_step"],
        "drift": summary["energy"]["max_drift"],
        "position": summary["violation"]["position"],
        "velocity": summary["violation"]["velocity"],
    }


def exudyn(folder, options):
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    command = [folder / "venv" / "bin" / "python", folder / "peer_exudyn.py", *options]
    out = subprocess.run(command, check=True, capture_output=True, text=True, cwd=folder, env=environment).stdout
    result = json.loads([line for line in out.splitlines() if line.startswith("{")][-1])
    return {
        "us": 1e6 * result["cpu_s"] / result["steps"],
        "drift": result.get("edrift_abs", float("nan")),
        "position": result.get("pos_viol", float("nan")),
        "velocity": result.get("vel_viol", float("nan")),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peers", type=pathlib.Path, required=True, help="folder with peer_exudyn.py and venv")
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    folder = arguments.peers.resolve()
    print(f"{'problem':28} {'program':24} {'µs/step':>9} {'ratio':>6} {'drift J':>9} {'‖Φ‖':>8} {'‖Φ̇‖':>8}")
    for problem, model, methods, options in PROBLEMS:
        best = {}
        for _ in range(arguments.rounds):
            runs = {f"holonom {method}": lambda method=method: holonom(model, method) for method in methods}
            for name, run in {"exudyn": lambda: exudyn(folder, options), **runs}.items():
                result = run()
                if name not in best or result["us"] < best[name]["us"]:
                    best[name] = result
        reference = best["exudyn"]["us"]
        for name, result in best.items():
            print(f"{problem:28} {name:24} {result['us']:9.2f} {result['us'] / reference:6.2f} "
                  f"{result['drift']:9.1e} {result['position']:8.1e} {result['velocity']:8.1e}")


if __name__ == "__main__":
    main()
