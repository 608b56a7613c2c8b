"""Where the runs of a study are made: in threads here, or in pieces by Ray or Dask, whose workers call the same function of the engine."""

from __future__ import annotations

import contextlib
import functools
import pickle
import threading
from collections.abc import Callable, Iterator
from typing import Any

from . import _engine
from ._errors import needed

#: Times that a piece is tried again when its worker dies.
RETRIES = 5

#: Most runs of a piece, and pieces for each worker at least, so that workers end at about the same time.
MOST = 200
PIECES = 8

#: Pieces for each worker that are under way at a time: more would only fill the driver's memory.
AHEAD = 3


@functools.lru_cache(maxsize=2)
def _sweep(given: bytes) -> _engine.Sweep:
    """The study of a worker: read once, and kept for its next pieces."""
    parts, changes, vary, is_grid, method, columns, identity = pickle.loads(given)
    sweep = _engine.Sweep(_engine.Draft.of_parts(parts), changes, vary, is_grid, method, columns)
    if sweep.identity() != identity:
        raise RuntimeError("a worker has another version of holonom, or other files that the model names, than the program that asks it")
    return sweep


#: Held while functions are called that need the interpreter: what they raise is that of one run.
_ALONE = threading.Lock()


def lines(given: bytes, first: int, last: int) -> str:
    """The lines of some runs, as a worker makes them."""
    sweep = _sweep(given)
    with _ALONE if sweep.is_serial() else contextlib.nullcontext():
        return sweep.lines(first, last)


def pieces(sweep: _engine.Sweep, workers: int) -> list[tuple[int, int]]:
    """First and last runs of the pieces that are missing."""
    return sweep.missing(max(1, min(MOST, sweep.runs() // (PIECES * workers))))


def ray(sweep: _engine.Sweep, given: tuple[Any, ...], ended: Callable[[str], None]) -> None:
    """Makes the runs by Ray: on the cluster that the program is connected to, or one that is started here."""
    with needed('engine="ray"', "Ray", "ray"):
        import ray
    if not ray.is_initialized():
        ray.init(log_to_driver=False)
    workers = max(1, int(ray.cluster_resources().get("CPU", 1)))
    task = ray.remote(max_retries=RETRIES, num_cpus=1)(lines)
    shared = ray.put(ray.cloudpickle.dumps(given))
    rest: Iterator[tuple[int, int]] = iter(pieces(sweep, workers))
    under_way = [task.remote(shared, *piece) for _, piece in zip(range(AHEAD * workers), rest)]
    try:
        while under_way:
            (done,), under_way = ray.wait(under_way, num_returns=1)
            ended(ray.get(done))
            under_way += [task.remote(shared, *piece) for _, piece in zip(range(1), rest)]
    finally:
        for piece in under_way:
            ray.cancel(piece)


def dask(sweep: _engine.Sweep, given: tuple[Any, ...], ended: Callable[[str], None]) -> None:
    """Makes the runs by Dask: on the cluster of the present client, or on processes that are started here."""
    with needed('engine="dask"', "Dask", "dask"):
        import cloudpickle
        import distributed
    try:
        client, own = distributed.get_client(), None
    except ValueError:
        client = own = distributed.Client(threads_per_worker=1, dashboard_address=None)
    try:
        workers = max(1, sum(client.nthreads().values()))
        # A task of its own, which is done again where the worker that has it dies.
        shared = client.submit(bytes, cloudpickle.dumps(given), pure=False)
        rest = iter(pieces(sweep, workers))

        def submit(piece: tuple[int, int]) -> Any:
            return client.submit(lines, shared, *piece, pure=False, retries=RETRIES)

        running = distributed.as_completed([submit(piece) for _, piece in zip(range(AHEAD * workers), rest)])
        for done in running:
            ended(done.result())
            done.release()
            for _, piece in zip(range(1), rest):
                running.add(submit(piece))
    finally:
        if own is not None:
            own.close()


ENGINES: dict[str, Callable[[_engine.Sweep, tuple[Any, ...], Callable[[str], None]], None]] = {"ray": ray, "dask": dask}
