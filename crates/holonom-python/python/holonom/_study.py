"""Studies: many runs of a model that differ in some of its keys, in one table."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _engine
from ._builders import text_of
from ._engines import ENGINES
from ._errors import needed, refuse, texts_of, warn
from ._model import Model, changes_of
from ._run import Run
from ._samplers import Table, mapping, values_of, whole
from ._types import Number

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray

#: What tables are written as.
_FORMATS = ("csv", "parquet")

#: Failures that the text of a study has.
_TOLD = 5


class Failed(NamedTuple):
    """A run that did not complete."""

    row: int
    """Its row in the table."""
    settings: dict[str, Any]
    """Its values by their keys."""
    status: str
    """``stopped``, or ``refused``: the model or the method cannot have these values."""
    stopped_at: float
    """s; NaN where it did not start."""
    reason: str


class Study:
    """What many runs have left: a table with a row for each. Arrays are read-only: copy what is to be changed."""

    def __init__(self, model: Model, sweep: _engine.Sweep, given: dict[str, Any]) -> None:
        self._model, self._sweep, self._given = model, sweep, given
        self.table: dict[str, np.ndarray] = {}
        """All columns by their names, in the order of the table."""
        for name, cells in sweep.table():
            array = np.asarray(cells) if isinstance(cells, np.ndarray) else np.array(cells, dtype=object)
            array.flags.writeable = False
            self.table[name] = array

    def __getitem__(self, name: str) -> np.ndarray:
        """A column of the table by its name."""
        if name not in self.table:
            raise KeyError(f"the study has no column `{name}`; it has: {', '.join(self.table)}")
        return self.table[name]

    def __contains__(self, name: object) -> bool:
        return name in self.table

    def __iter__(self) -> Iterator[str]:
        """Over the names of all columns."""
        return iter(self.table)

    def __len__(self) -> int:
        return len(self.table["run"])

    def __reduce__(self) -> tuple[Any, ...]:
        raise refuse("study", "a study can be neither copied nor pickled", "keep its table, which is plain arrays, or write() it to a file")

    @property
    def columns(self) -> list[str]:
        """Names of all columns."""
        return list(self.table)

    @property
    def whole(self) -> bool:
        """Whether all runs have ended: Ctrl-C ends a study before."""
        return self._sweep.is_whole()

    @property
    def notes(self) -> list[str]:
        """What looks like a slip, and what is not sure of the results, as the command says it: they were warned of."""
        return self._sweep.notes()

    @property
    def failed(self) -> list[Failed]:
        """Runs that did not complete."""
        keys, table = self._given["keys"], self.table
        rows = np.flatnonzero(table["status"] != "completed").tolist()
        settings = [{key: table[key][row] for key in keys} for row in rows]
        return [
            Failed(row, values, table["status"][row], float(table["stopped_at"][row]), table["reason"][row] or "")
            for row, values in zip(rows, settings)
        ]

    def run(self, row: int, *, method: str | None = None, set: Mapping[str, Any] | None = None, **keys: Any) -> Run:
        """Makes the run of a row of the table again, with its trajectory. What else is given is as in ``simulate``, and counts in place of what the
        row has."""
        row = whole("row", row, 0, "count rows from 0")
        if row >= len(self):
            raise refuse("row", f"`row` is {row}, and the study has {len(self)} rows", "count rows from 0")
        settings = self._sweep.settings(int(self.table["run"][row]))
        changes = {**self._given["changes"], **settings, **changes_of({}, set)}
        return self._model.simulate(method=self._given["method"] if method is None else method, set=changes, **keys)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the table: CSV, or Parquet where the name ends so; or the report where it ends with html."""
        ending = os.path.splitext(os.fspath(path))[1].lower().lstrip(".")
        if ending == "html":
            content = self._sweep.report().encode()
        elif ending in _FORMATS:
            content = bytes(self._sweep.written(ending))
        else:
            raise refuse("path", f"`path` ends with `{ending}`", "let it end with .csv, .parquet or .html")
        with open(path, "wb") as file:
            file.write(content)

    def to_dataframe(self) -> pandas.DataFrame:
        """The table for pandas."""
        with needed("to_dataframe", "pandas", "pandas"):
            import pandas

        return pandas.DataFrame(self.table)

    def to_polars(self) -> polars.DataFrame:
        """The table for polars."""
        with needed("to_polars", "polars", "polars"):
            import polars

        return polars.DataFrame({name: cells.tolist() if cells.dtype == object else cells for name, cells in self.table.items()})

    def to_xarray(self) -> xarray.Dataset:
        """The columns of a grid over its keys, for xarray; of other studies over the rows."""
        with needed("to_xarray", "xarray", "xarray"):
            import xarray

        keys = self._given["keys"]
        if not (self._given["grid"] and self.whole):
            return xarray.Dataset({name: ("row", cells) for name, cells in self.table.items()})
        axes = {key: self.table[key][np.sort(np.unique(self.table[key].astype(str), return_index=True)[1])] for key in keys}
        shape = [self._given["lengths"][key] for key in keys]
        if [len(axis) for axis in axes.values()] != shape:
            raise refuse("vary", "a key of the grid has a value twice, and xarray wants different ones", "take study.to_dataframe()")
        variables = {name: (keys, cells.reshape(shape)) for name, cells in self.table.items() if name not in keys}
        return xarray.Dataset(variables, coords=axes)

    def __repr__(self) -> str:
        completed, stopped, refused = self._sweep.counts()
        rest = self._sweep.runs() - len(self)
        text = f"<Study of {self._sweep.runs()} runs: {completed} completed, {stopped} stopped, {refused} refused"
        text += f", {rest} not made" if rest else ""
        failures = self._sweep.failures()
        lines = [f"{text}; columns: {', '.join(list(self.table)[1:])}>", *failures[:_TOLD]]
        if len(failures) > _TOLD:
            lines.append(f"and {len(failures) - _TOLD} more: study.failed has all")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        import html

        page = html.escape(self._sweep.report(), quote=True)
        return f'<iframe title="Study" srcdoc="{page}" style="width: 100%; height: 720px; border: 0"></iframe>'


def sweep(
    model: Model,
    vary: Any = None,
    *,
    rows: Any = None,
    columns: Sequence[str] = (),
    end: Number | None = None,
    step: Number | None = None,
    method: str | None = None,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    engine: str = "local",
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    formats: Sequence[str] = ("csv",),
    progress: bool = False,
    **keys: Any,
) -> Study:
    """Runs a model once for each of many values of its keys, and makes one table of it.

    ``vary={"parameters.k": [1, 2], "body.door.mass": [20, 25]}`` is a grid; `rows` is a table with a row for each run: from a sampler such as
    ``sobol``, a dictionary of lists of equal length, a list of dictionaries, or a table of pandas. `columns` are the columns that are asked for, as
    ``max(abs(strut.force))``; without any there are the last values of everything. The other keys are those of ``simulate``.

    The table is the same to the byte for any number of `threads`, and for each `engine`: ``local``, ``ray`` or ``dask``. A run that does not
    complete is a row, too. Ctrl-C ends the study and keeps the runs that have ended. With `out` they are kept in a folder as they end, where the
    same call goes on with them; other results there are not overwritten, unless with `force`. `progress` shows a bar of tqdm."""
    if not isinstance(model, Model):
        raise refuse("model", f"`model` is of type {type(model).__name__}, and a model is wanted", "give what load or Model() gave")
    if not isinstance(engine, str) or engine not in ("local", *ENGINES):
        raise refuse("engine", f"`engine` is {engine!r}", 'take one of: "local", "ray", "dask"')
    if isinstance(columns, str) or not hasattr(columns, "__iter__") or not all(isinstance(column, str) for column in columns):
        raise refuse("columns", "`columns` is no list of texts", 'write columns=["max(abs(strut.force))"]')
    formats = texts_of("formats", formats)
    for format in formats:
        if format not in _FORMATS:
            raise refuse("formats", f"`formats` has {format!r}", f"take some of: {', '.join(_FORMATS)}")
    if threads is not None and engine != "local":
        raise refuse("threads", f"`threads` is given, and the workers of {engine} decide that", "leave out `threads`")
    varied, is_grid = _varied(vary, rows)
    changes = changes_of({"end": end, "step": step, **keys}, set)
    method = None if method is None else text_of("method", method)
    model = model.copy()
    made = _engine.Sweep(model._draft, changes, varied, is_grid, method, list(columns))
    if made.is_serial() and threads is not None and threads != 1:
        raise refuse("threads", f"`threads` is {threads}, and functions of Python are called one after the other", "leave out `threads`")
    count = 1 if made.is_serial() else os.cpu_count() or 1 if threads is None else whole("threads", threads, 1)
    if out is not None:
        made.open(os.fspath(out), force)
    lengths = {key: len(values) for key, values in varied.items()}
    study = {"keys": list(varied), "lengths": lengths, "grid": is_grid, "changes": changes, "method": method}
    try:
        with _Bar(made, progress) as bar:
            if engine == "local":
                made.run(count, threading.current_thread() is threading.main_thread(), bar.update)
            else:
                parts = (model._draft.parts(), changes, varied, is_grid, method, list(columns), made.identity())
                with contextlib.suppress(KeyboardInterrupt):
                    ENGINES[engine](made, parts, lambda lines: bar.update(made.add(lines)))
        if out is not None and made.is_whole():
            made.finish(formats, True)
    finally:
        made.release()
    result = Study(model, made, study)
    warn(result.notes)
    return result


class _Bar:
    """A bar of tqdm, or none."""

    def __init__(self, made: _engine.Sweep, is_shown: bool) -> None:
        self._bar: Any = None
        if is_shown:
            with needed("progress=True", "tqdm", "progress"):
                from tqdm.auto import tqdm
            missing = sum(last - first + 1 for first, last in made.missing(made.runs()))
            self._bar = tqdm(total=made.runs(), initial=made.runs() - missing, unit=" runs")

    def __enter__(self) -> _Bar:
        return self

    def update(self, count: int) -> None:
        if self._bar is not None:
            self._bar.update(count)

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def _varied(vary: Any, rows: Any) -> tuple[dict[str, list[Any]], bool]:
    """Values by their keys, and whether they make a grid."""
    if (vary is None) == (rows is None):
        raise refuse("vary", "neither `vary` nor `rows` is given" if vary is None else "both `vary` and `rows` are given", 'give one: vary={"parameters.k": [1, 2, 3]}')
    # A table has rows wherever it is given: as a grid it would be something else without a word.
    if rows is None and isinstance(vary, Mapping) and not isinstance(vary, Table):
        return {key: values_of("vary", key, values) for key, values in mapping("vary", vary).items()}, True
    name, table = ("vary", vary) if rows is None else ("rows", rows)
    if isinstance(table, (list, tuple)):
        table = _columns(name, table)
    elif hasattr(table, "columns") and hasattr(table, "shape"):
        table = {key: table[key] for key in table.columns}
    columns = {key: values_of(name, key, values) for key, values in mapping(name, table).items()}
    lengths = {key: len(values) for key, values in columns.items()}
    if len({*lengths.values()}) > 1:
        told = ", ".join(f"`{key}` {length}" for key, length in lengths.items())
        raise refuse(name, f"the columns of `{name}` are not equally long: {told}", f"give each a value for every run{', or vary= for a grid' * (name == 'rows')}")
    return columns, False


def _columns(name: str, rows: Sequence[Any]) -> dict[str, list[Any]]:
    """A list of dictionaries as columns."""
    if not rows:
        raise refuse(name, f"`{name}` has no rows", "give one row at least")
    for k, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise refuse(name, f"`{name}[{k}]` is of type {type(row).__name__}, and a dictionary is wanted", 'write [{"parameters.k": 1}]')
        if row.keys() != rows[0].keys():
            raise refuse(name, f"`{name}[{k}]` has other keys than the first row", "give all rows the same keys")
    return {key: [row[key] for row in rows] for key in rows[0]}
