"""Functions of Python that formulas call."""

from __future__ import annotations

import ctypes
import importlib
import inspect
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._errors import refuse
from ._types import Number, is_whole

#: Vectors that may be arguments by their names, and the endings of their columns.
VECTORS = {"position": "", "velocity": "v", "angular_velocity": "w"}

#: Most arguments of compiled functions that take them as numbers.
MOST = 8


class Parts(NamedTuple):
    """What the engine calls of a function."""

    callable: Callable[..., Any]
    gradient: Callable[..., Any] | None
    sizes: list[int]
    values: int
    native: tuple[int, bool] | None


class Function(str):
    """A function that formulas may call: its name, so that a formula may be ``f"2*{pid}(hinge.angle, 1)"``. Calling it gives the text of a
    formula, or of several values a list of formulas: ``pid("hinge.angle", "hinge.angle_rate")``. An argument is a formula or a number,
    which the function is given as a float; a list of these, or a vector such as ``"tip.position"`` with ``velocity`` and
    ``angular_velocity``, which it is given as an array."""

    callable: Callable[..., Any]
    values: int

    def __new__(
        cls,
        name: str,
        callable: Callable[..., Any],
        arguments: int | Sequence[int] | None,
        values: int,
        derivative: Callable[..., Any] | str | None,
        axes: str,
    ) -> Function:
        function = super().__new__(cls, name)
        function.callable = callable
        function.values = values
        function._derivative = derivative
        function._axes = axes
        function._sizes = None if arguments is None else ((1,) * arguments if isinstance(arguments, int) else tuple(arguments))
        function._native = _native(name, callable, values)
        if function._native is not None and not function._native[1]:
            count = function._native[2]
            if function._sizes is not None and sum(function._sizes) != count:
                message = f"`{name}` is compiled for {count} arguments, and `arguments` says {sum(function._sizes)}"
                raise refuse(f"function.{name}.arguments", message, "leave `arguments` out")
            function._sizes = function._sizes or (1,) * count
        return function

    _derivative: Callable[..., Any] | str | None
    _axes: str
    _sizes: tuple[int, ...] | None
    _native: tuple[int, bool, int] | None

    def __call__(self, *arguments: Number | Sequence[Number] | npt.NDArray[Any]) -> Any:
        parts = [self._expand(argument) for argument in arguments]
        sizes = tuple(map(len, parts))
        if self._sizes is None or (self._native is not None and self._sizes != sizes and sum(self._sizes) == sum(sizes)):
            self._sizes = sizes
        if sizes != self._sizes:
            message = f"`{self}` is called with arguments of {_list(sizes)} numbers, and takes {_list(self._sizes)}"
            raise refuse(f"function.{self}", message, "give it the same arguments wherever it is called, or add the callable under another name")
        inside = ", ".join(text for part in parts for text in part)
        if self.values == 1:
            return f"{self}({inside})"
        return [f"{self}[{k}]({inside})" for k in range(self.values)]

    def _expand(self, argument: Any) -> list[str]:
        """Formulas of the numbers of an argument."""
        if isinstance(argument, str):
            owner, _, vector = str(argument).rpartition(".")
            if owner and vector in VECTORS:
                if vector == "angular_velocity" and len(self._axes) == 2:
                    return [_quoted(f"{owner}.angle_rate")]
                return [_quoted(f"{owner}.{VECTORS[vector]}{axis}") for axis in self._axes]
            return [str(argument)]
        if isinstance(argument, (list, tuple, np.ndarray)):
            return [text for item in argument for text in self._expand(item)]
        try:
            return [repr(float(argument))]
        except (TypeError, ValueError) as error:
            message = f"an argument of `{self}` is of type {type(argument).__name__}"
            raise refuse(f"function.{self}", message, "give formulas, numbers, or lists of these") from error

    def parts(self) -> Parts:
        """What the engine calls."""
        sizes = self._sizes if self._sizes is not None else (1,) * self._count()
        if not sizes or min(sizes) < 1:
            raise refuse(f"function.{self}", f"`{self}` has no arguments", "let it depend on something that moves, or on t")
        if self._native is not None:
            return Parts(self.callable, None, list(sizes), self.values, self._native[:2])
        if self._derivative == "jax":
            return Parts(*_by_jax(self.callable, sizes, self.values), list(sizes), self.values, None)
        return Parts(self.callable, self._gradient(sum(sizes)), list(sizes), self.values, None)

    def _count(self) -> int:
        try:
            known = inspect.signature(self.callable).parameters.values()
        except (TypeError, ValueError):
            known = None
        positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        if known is None or any(one.kind is inspect.Parameter.VAR_POSITIONAL for one in known):
            message = f"how many arguments `{self}` takes cannot be seen"
            raise refuse(f"function.{self}.arguments", message, "give arguments=2, or the numbers of each where some are arrays: arguments=[3, 1]")
        return sum(one.kind in positional and one.default is inspect.Parameter.empty for one in known)

    def _gradient(self, count: int) -> Callable[..., npt.NDArray[np.float64]] | None:
        derivative, shape = self._derivative, (self.values, count)
        if derivative is None or isinstance(derivative, str):
            return None

        def gradient(*arguments: Any) -> npt.NDArray[np.float64]:
            given = np.asarray(derivative(*arguments))
            if np.iscomplexobj(given):
                raise TypeError(f"`derivative` of `{self}` gave complex numbers, and real ones are wanted")
            given = given.astype(float, copy=False)
            if given.size != shape[0] * shape[1]:
                raise ValueError(f"`derivative` of `{self}` gave an array of the shape {given.shape}, and {shape} is wanted")
            return np.ascontiguousarray(given.reshape(shape))

        return gradient

    def __repr__(self) -> str:
        return f"<function {self}>"

    def __reduce__(self) -> tuple[Any, ...]:
        sizes = None if self._sizes is None else list(self._sizes)
        return (Function, (str(self), self.callable, sizes, self.values, self._derivative, self._axes))


def make(
    name: str,
    callable: Any,
    arguments: Any,
    values: Any,
    derivative: Any,
    axes: str,
) -> Function:
    """A function, once its arguments are seen to be sound."""
    path = f"function.{name}"
    is_code = hasattr(callable, "address")
    if not is_code and not hasattr(callable, "__call__"):
        raise refuse(path, f"`{name}` is of type {type(callable).__name__}, and a callable is wanted", "give a function")
    if not is_whole(values) or values < 1:
        raise refuse(f"{path}.values", f"`values` is {values!r}", "say how many numbers it gives: 1 or more")
    counts = [1] * int(arguments) if is_whole(arguments) else list(arguments) if hasattr(arguments, "__iter__") else []
    if arguments is not None and not (counts and all(is_whole(count) and count > 0 for count in counts)):
        cure = "give how many numbers it takes, or the numbers of each argument where some are arrays: arguments=[3, 1]"
        raise refuse(f"{path}.arguments", f"`arguments` is {arguments!r}", cure)
    if not (derivative is None or derivative == "jax" or (not isinstance(derivative, str) and hasattr(derivative, "__call__"))):
        message = f"`derivative` is {derivative!r}"
        raise refuse(f"{path}.derivative", message, 'give a callable, "jax", or nothing for differences')
    return Function(name, callable, None if arguments is None else [int(count) for count in counts], int(values), derivative, axes)


def _list(sizes: Sequence[int]) -> str:
    return ", ".join(map(str, sizes)) or "no"


def _quoted(name: str) -> str:
    """A name as formulas write it."""
    return name if name.replace(".", "").replace("_", "").replace("[", "").replace("]", "").isalnum() else f"'{name}'"


def _native(name: str, callable: Any, values: int) -> tuple[int, bool, int] | None:
    """Address of compiled code, whether it takes pointers to arguments and to values, and how many arguments it takes otherwise."""
    if hasattr(callable, "argtypes"):
        if callable.argtypes is None:
            raise refuse(f"function.{name}", f"the types of `{name}` are not known", "set its argtypes and its restype")
        address = ctypes.cast(callable, ctypes.c_void_p).value or 0
        result, given = _word(callable.restype), [_word(one) for one in callable.argtypes]
    elif hasattr(callable, "address") and hasattr(callable, "_sig"):
        address, signature = callable.address, callable._sig
        result, given = str(signature.return_type), [str(one) for one in signature.args]
    else:
        return None
    of_numbers = result == "float64" and set(given) == {"float64"} and len(given) <= MOST and values == 1
    of_pointers = result == "none" and given == ["float64*", "float64*"]
    if of_numbers or of_pointers:
        return (address, of_pointers, len(given))
    message = f"`{name}` is compiled as {result}({', '.join(given)}), and has {values} value{'' if values == 1 else 's'}"
    cure = (
        f"compile it as float64(float64, …) with at most {MOST} arguments, or as void(CPointer(float64), CPointer(float64)) "
        "of the places of arguments and of values"
    )
    raise refuse(f"function.{name}", message, cure)


def _word(of: Any) -> str:
    """A type of ctypes as Numba calls it."""
    known: dict[Any, str] = {ctypes.c_double: "float64", ctypes.POINTER(ctypes.c_double): "float64*", None: "none"}
    return known[of] if of in known else str(getattr(of, "__name__", of))


def _by_jax(callable: Callable[..., Any], sizes: Sequence[int], values: int) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The callable and its derivatives, compiled by JAX in double precision."""
    jax: Any = importlib.import_module("jax")

    # Of older versions it is among what is tried out.
    in_double = jax.enable_x64 if hasattr(jax, "enable_x64") else importlib.import_module("jax.experimental").enable_x64
    ends = np.cumsum([0, *sizes])

    def flat(numbers: Any) -> Any:
        parts = [numbers[a] if b - a == 1 else numbers[a:b] for a, b in zip(ends[:-1], ends[1:])]
        return jax.numpy.reshape(jax.numpy.asarray(callable(*parts)), (values,))

    value, slope = jax.jit(flat), jax.jit(jax.jacfwd(flat))

    def joined(of: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any) -> npt.NDArray[np.float64]:
            with in_double(True):
                return np.array(of(np.hstack(arguments)), dtype=float)

        return call

    of_values = joined(value)
    return (of_values if values > 1 else lambda *arguments: of_values(*arguments)[0]), joined(slope)

