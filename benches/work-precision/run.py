"""Work against precision of the conserving schemes of order 2, 4 and 6 on the chain of ten rods, 5 s.

Usage: python3 benches/work-precision/run.py [HOLONOM]
Prints, for each scheme and step, the error of the tip against a reference in 113-bit arithmetic, the CPU time and the
drift of the energy, and at last the time to 1e-6 with order 4 over the time to 1e-4 with order 2, in the same run.
"""

import json
import math
import subprocess
import sys
import tempfile

TIP = (7.52485983390996, -4.87211460925501)
SCHEMES = {
    "conserving-ggl": [1e-3, 5e-4, 2.5e-4, 1.25e-4],
    "ggl/conserving-ggl-4": [4e-3, 2e-3, 1e-3],
    "ggl/conserving-ggl-6": [8e-3, 4e-3, 2e-3],
    "conserving": [1e-3, 5e-4, 2.5e-4, 1.25e-4],
    "lagrange-3/conserving-4": [4e-3, 2e-3, 1e-3],
}


def run(holonom, method, step):
    """Error, m; CPU time, s, the least of three runs; drift, J."""
    times = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(3):
            command = [holonom, "run", "example:chain", "--method", method, "--step", str(step), "--end", "5"]
            command += ["--every", "1000000", "--force", "--out", folder, "--no-report", "--json"]
            summary = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
            times.append(summary["time"]["cpu_s"])
        with open(f"{folder}/checkpoint.json") as file:
            x = json.load(file)["x"]
    error = math.dist(x[18:20], TIP)
    return error, min(times), summary["energy"]["max_drift"]


def time_to(points, goal):
    """CPU time to an error, from the straight line through the nearest two points in logarithms."""
    (e0, t0), (e1, t1) = sorted(points, key=lambda point: abs(math.log(point[0] / goal)))[:2]
    share = math.log(goal / e0) / math.log(e1 / e0)
    return t0 * (t1 / t0) ** share


def main():
    holonom = sys.argv[1] if len(sys.argv) > 1 else "target/release/holonom"
    found = {}
    for method, steps in SCHEMES.items():
        for step in steps:
            error, cpu, drift = run(holonom, method, step)
            found.setdefault(method, []).append((error, cpu))
            print(f"{method:26} {step:9.2e} s  error {error:.1e} m  {cpu:7.3f} s  drift {drift:.1e} J", flush=True)
    for second, fourth in (("conserving-ggl", "ggl/conserving-ggl-4"), ("conserving", "lagrange-3/conserving-4")):
        ratio = time_to(found[fourth], 1e-6) / time_to(found[second], 1e-4)
        print(f"{fourth} to 1e-6 over {second} to 1e-4: {ratio:.2f} of the time")


main()
