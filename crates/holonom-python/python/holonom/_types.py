"""What arguments may be."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

#: A number, or a formula.
Number = Union[float, str, "np.floating[Any]", "np.integer[Any]"]

#: Several of these.
Numbers = Union[Sequence[Number], npt.NDArray[Any]]

#: Rows of numbers.
Rows = Union[Sequence[Numbers], npt.NDArray[Any]]

#: The name of a point or of a place of a body, an entry, or a place in the world.
Place = Union[str, Numbers]


def real(given: Any) -> float:
    """A number as a float. Of a complex one NumPy would leave out the imaginary part."""
    if type(given) is not float and np.iscomplexobj(given):
        raise TypeError("it is complex")
    return float(given)


def is_whole(given: Any) -> bool:
    """Whether it is a whole number, of Python or of NumPy."""
    return isinstance(given, (int, np.integer)) and not isinstance(given, bool)
