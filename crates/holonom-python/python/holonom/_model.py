"""Models: read from a file, or built entry by entry."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _analysis, _engine
from ._builders import KEYS, Builders, Entry, line, text_of
from ._errors import FunctionError, refuse, warn
from ._functions import Function, make
from ._run import Run
from ._types import Number, Numbers

def changes_of(keys: Mapping[str, Any], changes: Mapping[str, Any] | None) -> dict[str, Any]:
    """Keys of the model with other values, from the arguments of a run."""
    if changes is not None and not isinstance(changes, Mapping):
        raise refuse("set", f"`set` is of type {type(changes).__name__}, and a dictionary is wanted", 'write set={"body.door.mass": 25}')
    for key in changes or {}:
        if not isinstance(key, str):
            raise refuse("set", f"`set` has the key {key!r}, which is no text", 'write set={"body.door.mass": 25}')
    section = {key: "output" for key in KEYS["output"]}
    given = {f"{section.get(key, 'simulation')}.{key}": value for key, value in keys.items() if value is not None}
    return {**(changes or {}), **given}


class Model(Builders):
    """A model, with no entries at first. For each kind of joint, constraint, drive and force there is a method that adds one and gives
    its handle; entries may name others that come later. What is wrong with an entry by itself is raised at once, and all the rest when
    the model is run, with the lines of the program that made the entries."""

    # What is set of a model like an attribute would change nothing in it.
    __slots__ = ("__weakref__",)

    if not TYPE_CHECKING:

        def __setattr__(self, name: str, value: Any) -> None:
            try:
                super().__setattr__(name, value)
            except AttributeError as error:
                raise AttributeError(f'a model has no attribute `{name}` to set: write m.set("{name}", …) for a key of it') from error

    ground = "ground"
    """What never moves: its place is the origin."""

    def __init__(self, *, title: str | None = None, gravity: Numbers | None = None, plane: str | None = None) -> None:
        self._draft = _engine.Draft()
        self._draft.put("", {"title": title, "gravity": gravity, "plane": plane}, line())

    @classmethod
    def _of(cls, draft: _engine.Draft) -> Model:
        model = cls.__new__(cls)
        model._draft = draft
        return model

    def parameter(self, name: str, value: Any) -> str:
        """Sets a number that every formula may use by its name, or a formula of other parameters."""
        self._draft.put("parameters", {text_of("name", name): value}, line())
        return str(name)

    def function(
        self,
        name: str,
        callable: Callable[..., Any],
        *,
        arguments: int | Sequence[int] | None = None,
        values: int = 1,
        derivative: Callable[..., Any] | str | None = None,
    ) -> Function:
        """Adds a function that formulas call by its name: forces, measures, events, constraints, drives. Calling what this gives makes
        such a formula: ``m.effort("motor", joint=hinge, effort=pid("hinge.angle", "hinge.angle_rate"))``.

        It depends on its arguments alone, and is called as often as steps need it. It is given floats, and arrays where formulas give it
        vectors; with `values` above 1 it gives as many numbers. How many arguments it takes is seen, or said by `arguments`, which lists the
        numbers of each where some are arrays.

        Derivatives are central differences, over 6e-6 of each argument or of one. With `derivative` they are given: a callable with the same
        arguments, whose array has a row for each value and a column for each number of the arguments; or ``"jax"``, which has them made of a
        callable of JAX. In equations of constraints differences have an error of 1e-10, so give them there.

        Compiled functions, of ``numba.cfunc`` or of ``ctypes``, are called without the interpreter."""
        name = text_of("name", name)
        plane = self._draft.get("plane")
        function = make(name, callable, arguments, values, derivative, plane if isinstance(plane, str) else "xyz")
        self._draft.add_function(name, function, line())
        return function

    def simulation(self, **keys: Any) -> None:
        """Sets how the model is run where nothing else is said."""
        self._draft.put("simulation", keys, line())

    def output(self, **keys: Any) -> None:
        """Sets what is recorded of it."""
        self._draft.put("output", keys, line())

    def set(self, path: str, value: Any) -> None:
        """Sets the key with a path in the model file, such as ``body.door.mass``."""
        self._draft.set(text_of("path", path), value, line())

    def get(self, path: str) -> Any:
        """What stands at a path, such as ``body.door.mass``, as it was written; None where there is nothing."""
        return self._draft.get(text_of("path", path))

    @property
    def entries(self) -> dict[str, Entry]:
        """All entries by their names, section by section."""
        return {name: Entry(name, section, kind) for section, kind, name in self._draft.entries()}

    def __getitem__(self, name: str) -> Entry:
        entries = self.entries
        if name not in entries:
            raise KeyError(f"the model has no entry `{name}`; it has: {', '.join(entries) or 'none'}")
        return entries[name]

    def __delitem__(self, name: str) -> None:
        entry = self[name]
        self._draft.remove(entry.section, str(entry))

    def __contains__(self, name: object) -> bool:
        return name in self.entries

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries.values())

    def __len__(self) -> int:
        return len(self._draft.entries())

    @property
    def title(self) -> str:
        """One line for people; empty where it has none."""
        title = self._draft.get("title")
        return title if isinstance(title, str) else ""

    def to_toml(self) -> str:
        """The text of a model file with this model: what is read from it runs to the same bits. Of a model that was read and not
        changed it is the text of its file. Functions of Python are called in it, and are not part of it."""
        return self._draft.toml()

    def notes(self) -> list[str]:
        """What looks like a slip and was taken all the same. Raises what is wrong with the model."""
        return self._draft.notes()

    def simulate(
        self,
        *,
        end: Number | None = None,
        step: Number | None = None,
        method: str | None = None,
        set: Mapping[str, Any] | None = None,
        **keys: Any,
    ) -> Run:
        """Simulates the model. What is given here counts for this run and in place of what the model says: its end and its step (s), a
        method by name, any key of ``[simulation]`` and ``[output]``, and with `set` any key of the model by its path.

        A run that stops before its end, as by Ctrl-C, is a result, too: its ``status`` says so. Where a function of the model raises an
        exception, ``FunctionError`` is raised and has the run up to there."""
        method = None if method is None else text_of("method", method)
        is_main = threading.current_thread() is threading.main_thread()
        changes = changes_of({"end": end, "step": step, **keys}, set)
        recorded = _engine.simulate(self._draft, changes, method, is_main)
        run = Run(recorded)
        raised = recorded.trouble()
        if raised is not None:
            # Ctrl-C and sys.exit() come out as they are.
            if isinstance(raised, FunctionError):
                raised.run = run
            raise raised
        warn(run.notes)
        return run

    def check(self, *, projection: bool = False, set: Mapping[str, Any] | None = None) -> _analysis.Check:
        """Says what the model is made of: degrees of freedom, rank, redundant rows, what is near singular, what was corrected at the
        start. With `projection` also what that of its method can do to the energy."""
        return _analysis.of_check(self, bool(projection), changes_of({}, set))

    def modes(self, *, set: Mapping[str, Any] | None = None) -> _analysis.Modes:
        """Finds natural frequencies (Hz), damping and what moves in the small vibrations about the start, where the model is at rest, as
        ``start.equilibrium`` has it."""
        return _analysis.Modes(self, changes_of({}, set))

    def stability(
        self,
        *,
        methods: Sequence[str] = (),
        end: Number | None = None,
        step: Number | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> _analysis.Stability:
        """Searches the largest step with which each method completes, or each of all; `step` (s) is the first that is tried."""
        return _analysis.of_stability(self, methods, changes_of({"end": end, "step": step}, set))

    def compare(
        self,
        *,
        methods: Sequence[str] = (),
        steps: Sequence[Number] = (),
        variants: Sequence[Mapping[str, Any]] = (),
        columns: Sequence[str] = (),
        **keys: Any,
    ) -> _analysis.Comparison:
        """Runs the model by each method, with each step (s), as it is and in each variant, such as ``{"parameters.k": 100}``, and puts the
        runs side by side. Of `columns` it tells how far they are from those of the first. `keys` are those of ``simulate``."""
        return _analysis.of_model(self, methods, steps, variants, columns, keys)

    def __copy__(self) -> Model:
        return self._of(_engine.Draft.of_parts(self._draft.parts()))

    def __deepcopy__(self, memo: dict[int, Any]) -> Model:
        return self.__copy__()

    def copy(self) -> Model:
        """A model of its own with the same entries."""
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return (_unpickle, (type(self), self._draft.parts()))

    def __repr__(self) -> str:
        counts: dict[str, int] = {}
        for section, _, _ in self._draft.entries():
            counts[section] = counts.get(section, 0) + 1
        parts = [f"{count} {section}{'' if count == 1 else 's'}" for section, count in counts.items()]
        title = f" {self.title!r}" if self.title else ""
        return f"<Model{title}: {', '.join(parts) or 'empty'}>"


def _unpickle(kind: type[Model], parts: Any) -> Model:
    return kind._of(_engine.Draft.of_parts(parts))


def load(path: str | os.PathLike[str]) -> Model:
    """Reads a model file; ``example:NAME`` is one of the gallery."""
    path = os.fspath(path)
    if path.startswith("example:"):
        name = path.removeprefix("example:")
        return Model._of(_engine.Draft.read_file(f"{name}.toml", _engine.example(name).encode(), None))
    with open(path, "rb") as file:
        content = file.read()
    # Files beside it are found wherever the program goes.
    return Model._of(_engine.Draft.read_file(path, content, os.path.dirname(os.path.abspath(path))))


def loads(text: str) -> Model:
    """Reads the text of a model file."""
    return Model._of(_engine.Draft.read_file("model.toml", text_of("text", text).encode(), None))


def simulate(model: Model, **keys: Any) -> Run:
    """The same as ``model.simulate``."""
    if not isinstance(model, Model):
        raise refuse("model", f"`model` is of type {type(model).__name__}, and a model is wanted", "give what load or Model() gave")
    return model.simulate(**keys)
