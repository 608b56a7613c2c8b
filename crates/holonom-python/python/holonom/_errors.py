"""What is wrong with a model."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from types import FrameType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from ._run import Run


class Fault(NamedTuple):
    """One thing that is wrong."""

    message: str
    """What is wrong, and what was expected."""
    place: str
    """File, line and column of a model file, or file and line of a program; empty where neither has it."""
    path: str
    """Where in the model, such as ``joint.hinge.axis[1]``; empty for the model as a whole."""
    cure: str
    """What to do about it; empty where the message says it all."""

    def __str__(self) -> str:
        lines = [f"error: {self.message}"]
        place = self.place + (f" ({self.path})" if self.place and self.path else self.path)
        if place:
            lines.append(f"  --> {place}")
        if self.cure:
            lines.append(f"  = cure: {self.cure}")
        return "\n".join(lines)


class ModelError(ValueError):
    """A model, or an argument, that cannot be; ``faults`` lists everything that is wrong."""

    faults: list[Fault]

    def __init__(self, faults: Sequence[Fault], text: str | None = None) -> None:
        super().__init__(faults, text)
        self.faults = list(faults)
        self._text = text

    def __str__(self) -> str:
        if self._text is not None:
            return self._text.rstrip()
        faults = "\n".join(map(str, self.faults))
        return f"{faults}\n{len(self.faults)} faults" if len(self.faults) > 1 else faults


class FunctionError(RuntimeError):
    """A function of a model has raised an exception, which is the cause of this one; ``run`` has what was simulated before, where there is
    some."""

    run: Run | None = None


class ModelWarning(UserWarning):
    """What looks like a slip in a model, or was put right before its start: velocities that its joints do not allow, a parameter that nothing
    uses. The ``notes`` of runs, simulations and studies have the same."""


def warn(notes: Sequence[str]) -> None:
    """Warns at the line of the program that called the package."""
    level = 2
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "holonom":
        level, frame = level + 1, frame.f_back
    for note in notes:
        warnings.warn(note, ModelWarning, stacklevel=level)


@contextlib.contextmanager
def needed(by: str, package: str, extra: str, instead: str = "") -> Iterator[None]:
    """Around an import of a package that comes with an extra: says who needs it, and how it is installed."""
    try:
        yield
    except ImportError as error:
        raise ImportError(f'{by} needs {package}: install it with pip install ".[{extra}]"{instead}') from error


def refuse(path: str, message: str, cure: str) -> ModelError:
    """The error of one argument."""
    return ModelError([Fault(message, "", path, cure)])


def limits_of(path: str, given: Any) -> tuple[float, float]:
    """The least and the greatest value of something."""
    try:
        low, high = map(float, given)
    except (TypeError, ValueError) as error:
        raise refuse(path, f"`{path}` is {given!r}, and two numbers are wanted", "give the least and the greatest value: (-10, 10)") from error
    if not low < high:
        raise refuse(path, f"`{path}` is {given!r}, where the first is not below the second", "give the least value first")
    return low, high


def list_of(argument: str, given: Any) -> list[Any]:
    """An argument that is to be a list: a text or a dictionary would be one of its letters or keys."""
    if isinstance(given, (str, Mapping)) or not hasattr(given, "__iter__"):
        raise refuse(argument, f"`{argument}` is of type {type(given).__name__}, and a list is wanted", f"write {argument}=[…]")
    return list(given)


def texts_of(argument: str, given: Any) -> list[str]:
    """An argument that is to be a list of texts."""
    texts = list_of(argument, given)
    for text in texts:
        if not isinstance(text, str):
            raise refuse(argument, f"`{argument}` has {text!r}, which is no text", f'write {argument}=["…"]')
    return texts
