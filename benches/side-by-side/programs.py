"""How holonom and its peers are run, and what is kept of a run."""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

import errors

ROOT = pathlib.Path(__file__).resolve().parents[2]
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}

# Beyond this error, m or rad, a run has left the motion.
LOST = 0.2


class Failed(Exception):
    """A run that did not come to its end, in a few words."""


def holonom_binary():
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return target / "release" / "holonom"


def call(command, limit, **keywords):
    """Runs a command for `limit` seconds at most."""
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=limit, **keywords)
    except subprocess.TimeoutExpired:
        raise Failed(f"over {limit:.0f} s") from None


class Holonom:
    """One method of holonom on one model."""

    program = "holonom"

    def __init__(self, problem, method, accuracy=False):
        self.problem, self.method, self.by_accuracy = problem, method, accuracy
        self.setting = ", ".join([f"{method} by accuracy" if accuracy else method, *problem.form])

    def run(self, step, trace, limit, peers):
        """A run with a step, or an accuracy, s. With `trace` it is compared with the reference, and not timed."""
        problem = self.problem
        compared = trace and problem.reference in peers.references
        with tempfile.TemporaryDirectory() as folder:
            command = [holonom_binary(), "run", problem.model, "--method", self.method, "--end", repr(problem.end)]
            for entry in problem.set:
                command += ["--set", entry]
            every = 10**9
            if self.by_accuracy:
                command += ["--set", f"simulation.accuracy={step!r}", "--step", repr(problem.samples)]
                every = 1 if compared else every
            else:
                command += ["--step", repr(step)]
                every = max(1, round(problem.samples / step)) if compared else every
            command += ["--every", str(every), "--json", "--no-report", "--force", "--out", folder]
            done = call(command, limit)
            if not done.stdout.startswith("{"):
                raise Failed("does not start")
            summary = json.loads(done.stdout)
            if summary["status"] != "completed":
                raise Failed(f"stops at {summary['stopped_at']:.3g} s")
            result = {
                "cpu": summary["time"]["cpu_s"],
                "steps": summary["steps"],
                "drift": summary["energy"]["max_drift"],
                "position": summary["violation"]["position"],
                "velocity": summary["violation"]["velocity"],
                "iterations": summary["work"]["iterations_per_step"],
            }
            if compared:
                trajectory = errors.read(pathlib.Path(folder) / "trajectory.csv")
                result["error"] = errors.largest(problem.reference, problem.key, trajectory, problem.end, peers.references)
        return checked(result)


class Peer:
    """One setting of another program on the same problem."""

    def __init__(self, problem, program, setting, options, of_step=None):
        self.problem, self.program, self.setting, self.options = problem, program, setting, options
        # Options that depend on the step.
        self.of_step = of_step or (lambda step: [])
        self.by_accuracy = False

    def run(self, step, trace, limit, peers):
        problem = self.problem
        options = [*self.options, *self.of_step(step), "--h", repr(step), "--tend", repr(problem.end), "--k", "1"]
        if trace:
            options += ["--evals", "100"]
        else:
            options += ["--notrace"] if self.program == "Exudyn" else ["--evals", "1"]
        script = peers.folder / {"Exudyn": "peer_exudyn.py", "MuJoCo": "peer_mujoco.py", "Pinocchio": "peer_pinocchio.py"}[self.program]
        environment = dict(os.environ, PEER_RESULTS=os.devnull, **ONE_THREAD)
        command = [peers.folder / "venv" / "bin" / "python", script, *options]
        done = call(command, limit, cwd=peers.folder, env=environment)
        lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
        if done.returncode != 0 or not lines:
            raise Failed("breaks down")
        out = json.loads(lines[-1])
        if not out["success"]:
            raise Failed("diverges")
        peers.versions[self.program] = out["peer"].split()[-1]
        result = {"cpu": out["cpu_s"], "steps": out["steps"]}
        if trace:
            measured = problem.peers_measure
            keys = {"drift": "edrift_abs", "position": "pos_viol", "velocity": "vel_viol"} if measured else {}
            result.update({name: number(out[key]) for name, key in keys.items() if key in out})
            if problem.reference is not None and "err_max" in out:
                result["error"] = number(out["err_max"])
            if number(out.get("coupler_tilt", 0.0)) > LOST:
                raise Failed("leaves its branch")
        return checked(result)


class Peers:
    """The folder of the peers: their scripts, their environment and the references. Without its reference a problem has no errors."""

    def __init__(self, folder):
        self.folder = folder.resolve()
        self.versions = {}
        with open(self.folder / "refs.json") as file:
            self.references = json.load(file)


def number(value):
    """Numbers that are not finite come as texts."""
    return float(value)


def checked(result):
    error = result.get("error")
    if error is not None and not error < LOST:
        raise Failed(f"off by {error:.1g}" if math.isfinite(error) else "diverges")
    return {name: value for name, value in result.items() if math.isfinite(value)}


class Progress:
    """Says on standard error what is being run, and since when."""

    def __init__(self):
        self.start = time.monotonic()

    def say(self, text):
        print(f"{time.monotonic() - self.start:7.0f} s  {text}", flush=True)
