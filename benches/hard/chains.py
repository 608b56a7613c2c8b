"""Chains of heavy and light links: iterations, promises and time beside a chain of equal links.

    cargo build --release
    python3 benches/hard/chains.py [--links 10]

Points on rods of a metre, released level, with light ones first, last or in turn with those of 1 kg; in space they are pushed aside, too. Iterations
of failed attempts and of steps that are halved count. The variable HOLONOM names another binary.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import case

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOLONOM = os.environ.get("HOLONOM") or pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "holonom"

# Which of n links are light.
LIGHT = {
    "light first": lambda i, n: i < n - 1,
    "light last": lambda i, n: i == n - 1,
    "alternating": lambda i, n: i % 2 == 0,
}

SIZES, RATIOS, STEPS, END = [3, 10, 100], [1e-3, 1e-6, 1e-9], [0.005, 0.02], 1.0


def chain(links, light, mass, in_space):
    """Rods of a metre with points that are light where `light` says so, and the energy that their weight has over their lengths, J."""
    masses = [mass if light(i, links) else 1.0 for i in range(links)]
    energy = sum(9.81 * m * (i + 1) for i, m in enumerate(masses))
    rest = [0, 0] if in_space else [0]
    points = {f"P{i + 1}": {"mass": m, "position": [i + 1, *rest]} for i, m in enumerate(masses)}
    if in_space:
        for i, point in enumerate(points.values()):
            point["velocity"] = [0, 0.3 * (i + 1), 0]
    rods = {f"r{i + 1}": case.rod("ground" if i == 0 else f"P{i}", f"P{i + 1}") for i in range(links)}
    return (case.space if in_space else case.plane)(point=points, constraint=rods), energy


def run(model, method, step, folder):
    """What the summary says of a run."""
    file = pathlib.Path(folder) / "chain.toml"
    file.write_text(case.toml(model))
    settings = {"method": f'"{method}"', "step": step, "end": END}
    keys = [word for key, value in settings.items() for word in ("--set", f"simulation.{key}={value}")]
    out = pathlib.Path(folder) / "results"
    subprocess.run([HOLONOM, "run", file, *keys, "--out", out, "--force"], capture_output=True)
    return json.loads((out / "summary.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--links", type=int, action="append", help="only chains of so many links")
    sizes = parser.parse_args().links or SIZES
    print(f"{'':42} {'step':>6} {'method':15} {'iterations':>10} {'halved':>6} {'drift/scale':>11} {'|Φ̇|, m/s':>9} {'CPU/equal':>9}")
    with tempfile.TemporaryDirectory() as folder:
        for links, in_space in ((links, in_space) for links in sizes for in_space in (False, True)):
            for step, method in ((step, method) for step in STEPS for method in ("conserving", "conserving-ggl")):
                equal = run(chain(links, lambda i, n: False, 1.0, in_space)[0], method, step, folder)
                for order, ratio in ((order, ratio) for order in LIGHT for ratio in RATIOS):
                    model, energy = chain(links, LIGHT[order], ratio, in_space)
                    found = run(model, method, step, folder)
                    name = f"{links} links {'in space' if in_space else 'in the plane'}, {order}, {ratio:.0e}"
                    drift = found["energy"]["max_drift"] / energy
                    work, time = found["work"], found["time"]["us_per_step"] / equal["time"]["us_per_step"]
                    status = "" if found["status"] == "completed" else found["status"]
                    numbers = f"{work['iterations_per_step']:10.1f} {work['rejected_steps']:6} {drift:11.1e} {found['violation']['velocity']:9.1e} {time:9.1f}"
                    print(f"{name:42} {step:6} {method:15} {numbers} {status}", flush=True)


if __name__ == "__main__":
    main()
