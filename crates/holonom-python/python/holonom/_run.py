"""Results of a run."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _engine
from ._errors import needed, texts_of

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

#: Endings of the columns that together are a vector of a point, a body or a joint.
_VECTORS = {
    "position": ("x", "y", "z"),
    "velocity": ("vx", "vy", "vz"),
    "acceleration": ("ax", "ay", "az"),
    "orientation": ("qw", "qx", "qy", "qz"),
    "angular_velocity": ("wx", "wy", "wz"),
    "angular_acceleration": ("alphax", "alphay", "alphaz"),
    "force": ("fx", "fy", "fz"),
    "moment": ("tx", "ty", "tz"),
}


class Columns:
    """The columns of one thing: each by its ending, as ``hinge.angle``, and vectors such as ``position`` (k, 3), of planar models (k, 2)."""

    def __init__(self, run: Run, name: str) -> None:
        self._run = run
        self._name = name

    def __getattr__(self, ending: str) -> np.ndarray:
        name = f"{self._name}.{ending}"
        if name in self._run:
            return self._run._column(name)
        parts = [f"{self._name}.{part}" for part in _VECTORS.get(ending, ())]
        parts = [part for part in parts if part in self._run]
        if not parts:
            raise AttributeError(f"`{self._name}` has no column `{ending}`; it has: {', '.join(dir(self))}")
        return self._run._vector(name, parts)

    def __dir__(self) -> list[str]:
        dot = f"{self._name}."
        endings = [name[len(dot) :] for name in self._run.columns if name.startswith(dot)]
        return endings + [name for name, parts in _VECTORS.items() if name not in endings and any(part in endings for part in parts)]

    def __repr__(self) -> str:
        return f"<{self._name}: {', '.join(dir(self))}>"


class Energy:
    """Energy over the run, J."""

    def __init__(self, run: Run) -> None:
        self.total = run._column("energy")
        self.kinetic = run._column("kinetic")
        self.potential = run._column("potential")
        self.work = run._column("work")


class Violation:
    """Norms of the violation of the constraints: of positions, velocities and accelerations."""

    def __init__(self, run: Run) -> None:
        self.position = run._column("phi")
        self.velocity = run._column("phi_dot")
        self.acceleration = run._column("phi_ddot")


class Run:
    """What a run has left. Arrays are read-only: copy what is to be changed."""

    def __init__(self, recorded: _engine.Recorded) -> None:
        self._recorded = recorded
        self._kept: dict[str, np.ndarray] = {}
        self.columns: list[str] = recorded.names()
        """Names of all columns, in the order of tables."""
        self._known = frozenset(self.columns)
        self._owners = frozenset(name.rsplit(".", 1)[0] for name in self.columns if "." in name)
        self.summary: dict[str, Any] = json.loads(recorded.summary())
        """What ``summary.json`` has."""

    def _column(self, name: str) -> np.ndarray:
        if name not in self._kept:
            column = self._recorded.column(name)
            column.flags.writeable = False
            self._kept[name] = column
        return self._kept[name]

    def _vector(self, name: str, parts: list[str]) -> np.ndarray:
        if name not in self._kept:
            vector = np.stack([self._column(part) for part in parts], axis=1)
            vector.flags.writeable = False
            self._kept[name] = vector
        return self._kept[name]

    @property
    def t(self) -> np.ndarray:
        """Times of the rows (k), s."""
        return self._column("t")

    def __getitem__(self, name: str) -> Any:
        """A column by its name, such as ``hinge.angle``, or all columns of a point, a body, a joint, …"""
        name = str(name)
        return Columns(self, name) if name in self._owners and name not in self._known else self._whole(name)

    def __contains__(self, name: object) -> bool:
        return name in self._known

    def __iter__(self) -> Iterator[str]:
        """Over the names of all columns."""
        return iter(self.columns)

    def __len__(self) -> int:
        return self._recorded.rows()

    @property
    def energy(self) -> Energy:
        """Energy over the run, J: ``total``, ``kinetic``, ``potential``, ``work`` done on the mechanism."""
        return Energy(self)

    @property
    def violation(self) -> Violation:
        """Violation of the constraints over the run: ``position``, ``velocity``, ``acceleration``."""
        return Violation(self)

    @property
    def status(self) -> str:
        """``completed``, or ``stopped`` with ``reason``."""
        return str(self.summary["status"])

    @property
    def completed(self) -> bool:
        """Whether the run reached its end."""
        return self.status == "completed"

    @property
    def reason(self) -> str | None:
        """Why the run stopped; ``interrupted`` by Ctrl-C."""
        reason: str | None = self.summary["reason"]
        return reason

    @property
    def notes(self) -> list[str]:
        """What looks like a slip in the model, and what was put right before the start."""
        notes: list[str] = self.summary["notes"]
        return notes

    def unit(self, name: str) -> str:
        """Unit of a column."""
        return self._recorded.heading(str(name))[0]

    def meaning(self, name: str) -> str:
        """What a column shows, in a line."""
        return self._recorded.heading(str(name))[1]

    def write(
        self,
        folder: str | os.PathLike[str],
        *,
        formats: list[str] | tuple[str, ...] = ("csv",),
        report: bool = True,
        force: bool = False,
    ) -> None:
        """Leaves the run in a folder as the command does: tables in some formats (csv, npz, parquet), summary and report, but no checkpoint
        to resume from. The results of another run are not overwritten, unless with `force`."""
        self._recorded.write(os.fspath(folder), texts_of("formats", formats), report, force)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes the report: one HTML file with the moving mechanism, which needs no network."""
        write_page(path, self._recorded.report())

    def to_dataframe(self, columns: Sequence[str] | None = None) -> pandas.DataFrame:
        """Columns, all without `columns`, as a pandas table over the times; ``attrs["units"]`` has their units. Needs pandas."""
        with needed("to_dataframe", "pandas", "pandas"):
            import pandas

        names = [name for name in self.columns if name != "t"] if columns is None else texts_of("columns", columns)
        index = pandas.Index(self.t, name="t")
        table = pandas.DataFrame({name: self._whole(name) for name in names}, index=index)
        table.attrs["units"] = {name: self.unit(name) for name in ["t", *names]}
        return table

    def plot(self, *names: str, ax: Axes | None = None) -> list[Axes]:
        """Plots columns over time with matplotlib, those of each unit on axes of their own, or all on `ax`. Gives the axes."""
        if not names:
            raise TypeError("plot was given no column: name one, as run.plot('hinge.angle')")
        curves = [(str(name), self._whole(name), self.unit(name)) for name in names]
        units = list(dict.fromkeys(unit for _, _, unit in curves))
        if ax is None:
            with needed("plot", "matplotlib", "plot"):
                from matplotlib import pyplot

            _, grid = pyplot.subplots(len(units), sharex=True, squeeze=False, layout="constrained")
            axes: dict[str, Axes] = dict(zip(units, grid[:, 0]))
        else:
            axes = dict.fromkeys(units, ax)
        for name, values, unit in curves:
            axes[unit].plot(self.t, values, label=name)
        used = list(dict.fromkeys(axes.values()))
        for one in used:
            one.set_ylabel(", ".join(f"[{unit}]" for unit in units if axes[unit] is one))
            one.legend()
        used[-1].set_xlabel("t [s]")
        return used

    def _whole(self, name: str) -> np.ndarray:
        """A column; the engine has the words for one that is not there."""
        name = str(name)
        return self._column(name) if name in self._known else self._recorded.column(name)

    def _repr_html_(self) -> str:
        """The report, for notebooks."""
        page = html.escape(self._recorded.report(), quote=True)
        title = html.escape(f"Report of {self._recorded.title()}", quote=True)
        return f'<iframe title="{title}" srcdoc="{page}" style="width: 100%; height: 720px; border: 0"></iframe>'

    def __reduce__(self) -> tuple[Any, ...]:
        return (_unpickle, (self._recorded.parts(),))

    def __str__(self) -> str:
        """What the command prints about it, notes first."""
        return "\n".join([*(f"note: {note}" for note in self.notes), self._recorded.describe()])

    def __repr__(self) -> str:
        summary = self.summary
        ended = "completed" if self.completed else f"stopped at {summary['stopped_at']:.6g} s: {self.reason}"
        return (
            f"<Run of {self._recorded.title()!r} by {summary['method']['name']}: {ended}; {len(self)} rows of {len(self.columns)} columns "
            f"to {self.t[-1]:.6g} s, energy drift {summary['energy']['max_drift']:.1e} J>"
        )


def write_page(path: str | os.PathLike[str], page: str) -> None:
    """Writes a report, as it is on every system."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(page)


def _unpickle(parts: Any) -> Run:
    return Run(_engine.Recorded.of_parts(parts))
