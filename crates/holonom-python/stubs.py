"""Writes what type checkers see of the builders, ``python/holonom/_builders.pyi``, from the definitions of all kinds."""

from __future__ import annotations

import inspect
import pathlib

from holonom import _builders

HEAD = '''# Written by stubs.py from the definitions of all kinds.
from collections.abc import Mapping, Sequence
from typing import Any

from . import _engine
from ._types import Number, Numbers, Place, Rows

DEFINITIONS: list[tuple[str, str | None, str, str, list[tuple[str, str, bool, str, str, str]]]]
KEYS: dict[str, list[str]]
SHAPES: dict[str, Any]

class Entry(str):
    section: str
    kind: str | None
    def __new__(cls, name: str, section: str, kind: str | None = None) -> Entry: ...
    def __getitem__(self, part: Any) -> str: ...

def line() -> str: ...
def text_of(path: str, given: Any) -> str: ...
def builder_name(section: str, kind: str | None) -> str: ...
'''


def indented(text: str, by: str) -> str:
    return "\n".join(by + line if line else "" for line in text.splitlines())


def written(parameter: inspect.Parameter) -> str:
    annotation = "" if parameter.annotation is inspect.Parameter.empty else f": {parameter.annotation}"
    return parameter.name + annotation + ("" if parameter.default is inspect.Parameter.empty else " = None")


def method(name: str) -> str:
    builder = getattr(_builders.Builders, name)
    parameters = inspect.signature(builder).parameters.values()
    positional = [written(parameter) for parameter in parameters if parameter.kind is inspect.Parameter.POSITIONAL_ONLY]
    keywords = [written(parameter) for parameter in parameters if parameter.kind is inspect.Parameter.KEYWORD_ONLY]
    lines = ",\n".join(f"        {argument}" for argument in [*positional, "/", "*", *keywords])
    documentation = indented(f'"""{builder.__doc__}\n"""', "        ")
    return f"    def {name}(\n{lines},\n    ) -> Entry:\n{documentation}\n"


def stub() -> str:
    """The text of the stub."""
    methods = [name for name in vars(_builders.Builders) if not name.startswith("_")]
    shapes = [f'def {name}(*sizes: Any) -> dict[str, Any]:\n    """{make.__doc__}"""\n' for name, make in _builders.SHAPES.items()]
    parts = [HEAD, "__all__ = " + repr(list(_builders.SHAPES)).replace("'", '"') + "\n", *shapes]
    return "\n".join([*parts, "class Builders:\n    _draft: _engine.Draft\n", *map(method, methods)])


if __name__ == "__main__":
    (pathlib.Path(__file__).parent / "python" / "holonom" / "_builders.pyi").write_text(stub(), encoding="utf-8")
