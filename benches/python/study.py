"""A study by Ray and by Dask, each with two workers of which one is killed in the middle, beside the same study in threads and by the command: whether
the tables are the same, what a run costs, and the memory of the program that asks.

    python benches/python/study.py [--runs 100000]

needs the package as `pip install ".[ray,dask]"` makes it, psutil, and the command of the same sources: `holonom`, or what HOLONOM says.
"""

import argparse
import contextlib
import hashlib
import os
import pathlib
import resource
import subprocess
import tempfile
import threading
import time

import numpy as np
import psutil

import holonom as hm

COLUMNS = ["max(m2.x)", "rms(m2.vy)", "at(m1.x, 0.5)"]
SETTINGS = {"end": 1, "step": 0.005}
RANGES = {"parameters.upper": (0.5, 2), "parameters.lower": (-1, 1)}

#: Workers of the clusters, and threads of the others.
WORKERS = 2


def lengths(runs):
    """Values of both angles at the start, whose pairs are the runs."""
    first = next(k for k in range(int(runs**0.5), 0, -1) if runs % k == 0)
    return first, runs // first


def by_command(runs, folder):
    """Seconds of the processor."""
    vary = [f"{key}={low}..{high}:{length}" for (key, (low, high)), length in zip(RANGES.items(), lengths(runs))]
    words = [os.environ.get("HOLONOM", "holonom"), "sweep", "example:double-pendulum", "--vary", vary[0], "--vary", vary[1]]
    words += ["--columns", ", ".join(COLUMNS), "--threads", str(WORKERS), "--no-report", "--quiet", "--out", str(folder / "command")]
    words += [word for key, value in SETTINGS.items() for word in (f"--{key}", str(value))]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def study(runs, folder, **how):
    """The SHA-256 of its table, and seconds of the processor here."""
    vary = {key: np.linspace(*ends, length) for (key, ends), length in zip(RANGES.items(), lengths(runs))}
    before = time.process_time()
    made = hm.sweep(hm.load("example:double-pendulum"), vary, columns=COLUMNS, **SETTINGS, **how)
    here = time.process_time() - before
    made.write(folder / "table.csv")
    return hashlib.sha256((folder / "table.csv").read_bytes()).hexdigest(), here


class Watch(threading.Thread):
    """Looks at the workers and at the memory here twice a second, and kills a worker when the study is half done."""

    def __init__(self, is_worker, journal, runs):
        super().__init__(daemon=True)
        self.is_worker, self.journal, self.runs = is_worker, journal, runs
        self.seconds, self.memory, self.killed, self.goes_on = {}, [], None, True

    def run(self):
        me = psutil.Process()
        while self.goes_on:
            time.sleep(0.5)
            done = self.done()
            self.memory.append((done, me.memory_info().rss / 2**20))
            for process in me.children(recursive=True):
                try:
                    if self.is_worker(process):
                        self.seconds[process.pid] = sum(process.cpu_times()[:2])
                        if self.killed is None and done > 0.5:
                            process.kill()
                            self.killed = process.pid
                except psutil.Error:
                    pass

    def done(self):
        """Share of the runs that the journal has."""
        return self.journal.read_bytes().count(b"\n") / self.runs if self.journal.exists() else 0.0

    def at(self, share):
        """Memory, MiB, when so much was done."""
        return next((size for done, size in self.memory if done >= share), self.memory[-1][1])


@contextlib.contextmanager
def ray_cluster():
    import ray

    ray.init(num_cpus=WORKERS, log_to_driver=False, include_dashboard=False)
    yield lambda process: process.name().startswith("ray::lines")
    ray.shutdown()


@contextlib.contextmanager
def dask_cluster():
    import distributed

    with distributed.Client(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None) as client:
        first = set(client.run(os.getpid).values())
        yield lambda process: process.pid in first or "spawn_main" in " ".join(process.cmdline())


def on_cluster(engine, cluster, runs, folder):
    """The digest of the table, and what it has cost."""
    with cluster as is_worker:
        # Workers are there, and have read the package, before anything is measured.
        study(WORKERS * 10, folder, engine=engine)
        watch = Watch(is_worker, folder / engine / "sweep.journal", runs)
        watch.start()
        begun = time.perf_counter()
        table, here = study(runs, folder, engine=engine, out=folder / engine)
        wall = time.perf_counter() - begun
        watch.goes_on = False
        watch.join()
    workers = sum(watch.seconds.values())
    sizes = ", ".join(f"{watch.at(share):.0f}" for share in (0.1, 0.5, 1.0))
    print(f"{engine}: a worker killed: {'yes' if watch.killed else 'NO'}; {wall:.1f} s; {1e3 * workers / runs:.3f} ms of a worker for a run")
    print(f"  here {1e3 * here / runs:.4f} ms a run; memory here when 10, 50 and 100 % were done: {sizes} MiB", flush=True)
    return table, workers / runs, here / runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=100_000, help="runs of the study (default 100000)")
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = by_command(runs, folder) / runs
        print(f"command: {1e3 * command:.3f} ms of the processor for a run", flush=True)
        local, seconds = study(runs, folder, threads=WORKERS)
        print(f"threads: {1e3 * seconds / runs:.3f} ms, {seconds / runs / command:.2f} of the command; SHA-256 {local}", flush=True)
        for engine, cluster in {"ray": ray_cluster, "dask": dask_cluster}.items():
            table, worker, here = on_cluster(engine, cluster(), runs, folder)
            same = "the same" if table == local else "NOT THE SAME"
            print(f"  table {same}; workers and this program {(worker + here) / command:.2f} of the command; one program keeps {worker / here:.0f} workers busy", flush=True)


if __name__ == "__main__":
    main()
