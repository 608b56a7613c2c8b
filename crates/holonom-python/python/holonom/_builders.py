"""The methods of a model that add entries, and the shapes of bodies, made of the keys that the reader of model files has.

What type checkers see of them is in ``_builders.pyi``, which ``stubs.py`` writes."""

from __future__ import annotations

import inspect
import keyword
import sys
from collections.abc import Callable, Sequence
from typing import Any

from . import _engine
from ._errors import refuse

#: Section, kind, documentation, equations and keys of all entries.
DEFINITIONS = _engine.definitions()

#: Names of the keys of sections without kinds.
KEYS = {section: [key[0] for key in keys] for section, kind, _, _, keys in DEFINITIONS if kind is None}


class Entry(str):
    """An entry of a model: its name, which stands wherever a name does. ``entry["tip"]`` is the name of a place of a body,
    ``entry[3]`` that of one of repeated entries."""

    section: str
    kind: str | None

    # What is set of a name would change nothing in the model.
    __slots__ = ("kind", "section")

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in Entry.__slots__:
            raise AttributeError(f'`{self}` is the name of an entry and keeps nothing: write m.set("{self.section}.{self}.{name}", …)')
        super().__setattr__(name, value)

    def __new__(cls, name: str, section: str, kind: str | None = None) -> Entry:
        entry = super().__new__(cls, name)
        entry.section = section
        entry.kind = kind
        return entry

    def __getitem__(self, part: Any) -> str:
        return f"{self}.{part}" if isinstance(part, str) else f"{self}[{part}]"

    def __repr__(self) -> str:
        return f"<{self.kind or self.section} {self}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Entry, (str(self), self.section, self.kind))


def line() -> str:
    """File and line of the program that has called a method of the model."""
    frame = sys._getframe(2)
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"


def text_of(path: str, given: Any) -> str:
    """An argument that is to be a text."""
    if not isinstance(given, str):
        raise refuse(path, f"`{path}` is of type {type(given).__name__}, and a text is wanted", f'write {path}="…"')
    return str(given)


class Builders:
    """What adds entries to a model: a method for each kind."""

    __slots__ = ("_draft",)

    _draft: _engine.Draft


def builder_name(section: str, kind: str | None) -> str:
    """Name of the method that adds an entry: joints and forces have that of their kind, constraints and drives say what they are."""
    name = (kind or section).replace("-", "_")
    return f"{section}_{name}" if section in ("constraint", "drive") else name


def argument(key: str) -> str:
    """A key as a keyword argument: a word of Python has an underscore behind it."""
    return f"{key}_" if keyword.iskeyword(key) else key


def documentation(section: str, kind: str | None, doc: str, equations: str, keys: Sequence[tuple[Any, ...]]) -> str:
    """The docstring of a builder."""
    what = f"Adds a {section} of the kind ``{kind}``: {doc}." if kind else f"Adds an entry of ``[{section}.NAME]``: {doc}."
    lines = [what, ""]
    if equations:
        lines += [f"Equations: {equations}", ""]
    for name, _, required, default, unit, meaning in keys:
        of = f" [{unit}]" if unit else ""
        otherwise = "" if required else f"; default: {default}"
        lines.append(f"{argument(name)}: {meaning}{of}{otherwise}")
    return "\n".join(lines)


def parameters(keys: Sequence[tuple[Any, ...]]) -> list[inspect.Parameter]:
    """The arguments of a builder."""
    has_pair = any(key[0] == "between" for key in keys)
    found = [
        inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY),
        inspect.Parameter("name", inspect.Parameter.POSITIONAL_ONLY, annotation="str"),
    ]
    if has_pair:
        side = {"default": None, "annotation": "Place | None"}
        found += [inspect.Parameter(name, inspect.Parameter.POSITIONAL_ONLY, **side) for name in ("first", "second")]
    for key, of, required, *_ in keys:
        is_needed = required and key != "between"
        default = inspect.Parameter.empty if is_needed else None
        annotation = of if is_needed else f"{of} | None"
        found.append(inspect.Parameter(argument(key), inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation))
    return found


def _builder(section: str, kind: str | None, doc: str, equations: str, keys: Sequence[tuple[Any, ...]]) -> Callable[..., Entry]:
    has_pair = any(key[0] == "between" for key in keys)

    def build(self: Builders, name: str, /, *pair: Any, **given: Any) -> Entry:
        name = text_of("name", name)
        if pair:
            if not has_pair or len(pair) != 2:
                wanted = "the two that it is between, or neither" if has_pair else "none"
                message = f"`{build.__name__}` was given {len(pair)} positional arguments beside the name, and {wanted} is wanted"
                raise refuse(f"{section}.{name}", message, "give the others as keyword=value")
            if given.get("between") is not None:
                raise refuse(f"{section}.{name}.between", "`between` is given twice", "give the two before the keywords, or between=[…]")
            given = {"between": list(pair), **given}
        self._draft.add(section, name, kind, given, line())
        return Entry(name, section, kind)

    build.__name__ = builder_name(section, kind)
    build.__qualname__ = f"Model.{build.__name__}"
    build.__doc__ = documentation(section, kind, doc, equations, keys)
    build.__signature__ = inspect.Signature(parameters(keys), return_annotation="Entry")  # type: ignore[attr-defined]
    return build


def _shape(name: str, of: str, unit: str, meaning: str) -> Callable[..., dict[str, Any]]:
    def make(*sizes: Any) -> dict[str, Any]:
        return {name: list(sizes) if of == "Numbers" else sizes[0] if len(sizes) == 1 else list(sizes)}

    make.__name__ = make.__qualname__ = name.capitalize()
    make.__doc__ = f"The shape `{name}` of a body: {meaning}" + (f" [{unit}]." if unit else ".")
    return make


#: Functions that make the shapes of bodies, by their names.
SHAPES: dict[str, Callable[..., dict[str, Any]]] = {}

for _section, _kind, _doc, _equations, _keys in DEFINITIONS:
    if _section == "shape":
        SHAPES |= {name.capitalize(): _shape(name, of, unit, meaning) for name, of, _, _, unit, meaning in _keys}
    elif _section not in ("", "simulation", "output"):
        setattr(Builders, builder_name(_section, _kind), _builder(_section, _kind, _doc, _equations, _keys))

globals().update(SHAPES)

__all__ = list(SHAPES)
