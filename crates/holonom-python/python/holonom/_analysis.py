"""What is asked of a model or of several runs."""

from __future__ import annotations

import copy
import json
import os
import threading
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _engine
from ._errors import list_of, refuse, texts_of
from ._run import Run, write_page

if TYPE_CHECKING:
    from ._model import Model


class Check(dict[str, Any]):
    """What a model is made of: what ``holonom check --json`` prints, by its keys; its text is that of the command."""

    def __init__(self, answer: tuple[str, str]) -> None:
        super().__init__(json.loads(answer[0]))
        self._text = answer[1]

    def __repr__(self) -> str:
        return self._text


class Modes(dict[str, Any]):
    """Small vibrations about the start: what ``holonom modes --json`` prints of them, by its keys; its text is that of the command."""

    def __init__(self, model: Model, changes: dict[str, Any]) -> None:
        # The model may be another one when the report is asked for.
        self._model = copy.copy(model)
        self._changes = changes
        value, self._text = _engine.modes(model._draft, changes)
        super().__init__(json.loads(value))

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes the report: one HTML file on which the mechanism swings in the mode that is chosen."""
        write_page(path, _engine.modes_report(self._model._draft, self._changes))

    def __repr__(self) -> str:
        return self._text


class Stability(dict[str, dict[str, Any]]):
    """Of each method, by its name, the largest step that ``completes`` and the least that ``fails``, s; its text is that of the command."""

    def __init__(self, answer: tuple[str, str]) -> None:
        super().__init__({found["method"]: found for found in json.loads(answer[0])})
        self._text = answer[1]

    def __repr__(self) -> str:
        return self._text


class Comparison:
    """Runs side by side; the first is what the others are compared with."""

    def __init__(self, runs: Mapping[str, Run], columns: Sequence[str]) -> None:
        self.runs: dict[str, Run] = dict(runs)
        """By their labels."""
        self._columns = list(columns)
        self._recorded = [(label, run._recorded) for label, run in self.runs.items()]
        self._json, self._text = _engine.compare(self._recorded, self._columns)
        self.summaries: dict[str, dict[str, Any]] = dict(zip(self.runs, json.loads(self._json)))
        """What ``summary.json`` has, by the labels of the runs."""
        others = list(self.summaries.items())[1:]
        self.differences: dict[str, dict[str, Any]] = {label: summary.get("differences", {}) for label, summary in others}
        """By label and column: the ``largest`` difference to the first run, ``at`` which time (s), and its ``rms`` over time."""

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes the report of all runs, curves overlaid."""
        write_page(path, _engine.compared_report(self._recorded, self._columns, self._json))

    def __repr__(self) -> str:
        return self._text


def compare(runs: Sequence[Run | Model] | Mapping[str, Run | Model], *, columns: Sequence[str] = (), **keys: Any) -> Comparison:
    """Puts runs side by side: those of a list, or of a dictionary by their labels. Models are run, with `keys` as ``simulate`` takes them. Of
    `columns` it tells how far they are from those of the first."""
    from ._model import Model

    given = list(runs.items()) if isinstance(runs, Mapping) else [(None, run) for run in list_of("runs", runs)]
    if not given:
        raise refuse("runs", "`runs` is empty", "give the runs to compare")
    made: dict[str, Run] = {}
    for label, run in given:
        if not isinstance(run, (Run, Model)):
            raise refuse("runs", f"`runs` has something of type {type(run).__name__}", "give runs, or models that are to be run")
        run = _run(run, **keys) if isinstance(run, Model) else run
        label = str(label) if label is not None else f"{run._recorded.title()}, {run.summary['method']['name']}"
        made[_free(label, made)] = run
    return Comparison(made, texts_of("columns", columns))


def of_model(
    model: Model,
    methods: Sequence[str],
    steps: Sequence[Any],
    variants: Sequence[Mapping[str, Any]],
    columns: Sequence[str],
    keys: Mapping[str, Any],
) -> Comparison:
    """The runs of one model by every method with every step and every variant."""
    made: dict[str, Run] = {}
    changes = dict(keys.get("set") or {})
    rest = {key: value for key, value in keys.items() if key != "set"}
    named: list[str | None] = [*texts_of("methods", methods)] or [None]
    lengths: list[Any] = list_of("steps", steps) or [rest.pop("step", None)]
    for variant in [{}, *list_of("variants", variants)]:
        if not isinstance(variant, Mapping):
            kind = type(variant).__name__
            raise refuse("variants", f"`variants` has something of type {kind}", 'write variants=[{"parameters.k": 100}]')
        for step in lengths:
            for method in named:
                run = _run(model, method=method, step=step, set={**changes, **variant}, **rest)
                parts = [", ".join(f"{key}={value}" for key, value in variant.items()) or ("as it is" if variants else "")]
                parts += [method or (run.summary["method"]["name"] if not variants else "")]
                parts += [f"{step} s" if len(lengths) > 1 else ""]
                made[_free(", ".join(part for part in parts if part), made)] = run
    return Comparison(made, texts_of("columns", columns))


def _run(model: Model, **keys: Any) -> Run:
    """A run of a comparison, which Ctrl-C ends as a whole."""
    run = model.simulate(**keys)
    if run.reason == "interrupted":
        raise KeyboardInterrupt("the comparison was interrupted")
    return run


def of_check(model: Model, projection: bool, changes: dict[str, Any]) -> Check:
    """What a model is made of."""
    return Check(_engine.check(model._draft, changes, projection))


def of_stability(model: Model, methods: Sequence[str], changes: dict[str, Any]) -> Stability:
    """The largest steps of methods."""
    is_main = threading.current_thread() is threading.main_thread()
    return Stability(_engine.stability(model._draft, changes, texts_of("methods", methods), is_main))


def _free(label: str, taken: Mapping[str, Any]) -> str:
    """A label that no other run has."""
    number, free = 2, label
    while free in taken:
        free, number = f"{label} ({number})", number + 1
    return free
