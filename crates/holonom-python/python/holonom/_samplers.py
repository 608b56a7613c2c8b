"""Tables of values for the runs of a study: a row for each run, a column for each key."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from ._errors import needed, refuse
from ._types import is_whole

if TYPE_CHECKING:
    import numpy.typing as npt


class Table(dict[str, Any]):
    """Columns of equal length by the keys of a model: one run for each row."""

    def __repr__(self) -> str:
        length = len(next(iter(self.values()), ()))
        return f"<Table of {length} rows: {', '.join(self)}>"


class Uniform(NamedTuple):
    """Values that are equally likely between two ends; with `log`, equally likely ratios."""

    low: float
    high: float
    log: bool = False


class Normal(NamedTuple):
    """Values of a normal distribution, as of tolerances."""

    mean: float
    deviation: float


#: What a key is sampled from: ``(low, high)``, a distribution, or a list of values that are equally likely.
Values = Union[tuple[float, float], Uniform, Normal, Sequence[Any], "npt.NDArray[Any]"]


def grid(vary: Mapping[str, Any]) -> Table:
    """Every value of a key with every value of the others; the last key varies fastest. ``sweep`` with such values does the same."""
    columns = {key: values_of("vary", key, values) for key, values in mapping("vary", vary).items()}
    places = np.indices([len(values) for values in columns.values()]).reshape(len(columns), -1)
    return Table({key: [values[k] for k in row] for (key, values), row in zip(columns.items(), places.tolist())})


def random(vary: Mapping[str, Values], count: int, *, seed: int = 0) -> Table:
    """Independent samples: of ``(low, high)``, ``Uniform``, ``Normal``, or a list of values. The same seed gives the same samples."""
    keys = list(mapping("vary", vary))
    shares = np.random.default_rng(whole("seed", seed, 0)).random((whole("count", count, 1), len(keys)))
    return _table(vary, shares)


def latin_hypercube(vary: Mapping[str, Values], count: int, *, seed: int = 0) -> Table:
    """Samples of which each key has one in each of `count` equally likely pieces of its range. Needs SciPy."""
    qmc = _qmc("latin_hypercube")
    sampler = qmc.LatinHypercube(d=len(mapping("vary", vary)), rng=np.random.default_rng(whole("seed", seed, 0)))
    return _table(vary, sampler.random(whole("count", count, 1)))


def sobol(vary: Mapping[str, Values], count: int, *, seed: int = 0) -> Table:
    """Points of a scrambled Sobol sequence, which fill the space evenly; `count` is a power of two, as only so many are balanced.
    Needs SciPy."""
    count = whole("count", count, 1)
    if count & (count - 1):
        near = 1 << (count.bit_length() - 1)
        raise refuse("count", f"`count` is {count}, and a Sobol sequence is even for powers of two", f"give {near} or {2 * near}")
    sampler = _qmc("sobol").Sobol(d=len(mapping("vary", vary)), rng=np.random.default_rng(whole("seed", seed, 0)))
    return _table(vary, sampler.random_base2(count.bit_length() - 1))


def _qmc(name: str) -> Any:
    with needed(f"hm.{name}", "SciPy", "scipy", ", or take hm.random"):
        from scipy.stats import qmc
    return qmc


def _table(vary: Mapping[str, Values], shares: npt.NDArray[np.float64]) -> Table:
    return Table({key: _drawn(key, vary[key], shares[:, k]) for k, key in enumerate(vary)})


def _drawn(key: str, given: Values, shares: npt.NDArray[np.float64]) -> Any:
    """The values of a distribution below which these shares of it lie."""
    if isinstance(given, Normal):
        return _normal(key, given, shares)
    if isinstance(given, Uniform) or (isinstance(given, tuple) and len(given) == 2):
        uniform = Uniform(*given)
        low, high = (_number(key, end) for end in uniform[:2])
        if not low < high:
            raise refuse(key, f"the range of `{key}` goes from {low:g} to {high:g}", "give its lower end first, as (1, 2)")
        if uniform.log and low <= 0:
            raise refuse(key, f"the range of `{key}` has equal ratios and begins at {low:g}", "give ends above zero")
        return low * (high / low) ** shares if uniform.log else low + (high - low) * shares
    values = values_of("vary", key, given)
    return [values[k] for k in (shares * len(values)).astype(int).tolist()]


def _normal(key: str, normal: Normal, shares: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    from statistics import NormalDist

    mean, deviation = (_number(key, number) for number in normal)
    if deviation <= 0:
        raise refuse(key, f"the standard deviation of `{key}` is {deviation:g}", "give one above zero, as hm.Normal(1, 0.01)")
    quantile = NormalDist(mean, deviation).inv_cdf
    # The ends of 0 … 1 are infinitely far.
    inside = np.clip(shares, 2.0**-54, 1 - 2.0**-53)
    return np.array([quantile(share) for share in inside.tolist()])


def _number(key: str, given: Any) -> float:
    try:
        number = float(given)
    except (TypeError, ValueError):
        raise refuse(key, f"`{key}` is sampled from {given!r}", "give numbers, as (1, 2) or hm.Normal(1, 0.01)") from None
    if not math.isfinite(number):
        raise refuse(key, f"`{key}` is sampled from {number}", "give finite numbers")
    return number


def mapping(argument: str, given: Any) -> Mapping[str, Any]:
    """Keys with something for each, if it is that."""
    if not isinstance(given, Mapping):
        raise refuse(
            argument, f"`{argument}` is of type {type(given).__name__}, and a dictionary is wanted", 'write {"parameters.k": [1, 2, 3]}'
        )
    if not given:
        raise refuse(argument, f"`{argument}` has no keys", 'write {"parameters.k": [1, 2, 3]}')
    for key in given:
        if not isinstance(key, str):
            raise refuse(argument, f"`{argument}` has the key {key!r}, which is no text", 'name a key, as "parameters.k"')
    return given


def values_of(argument: str, key: str, given: Any) -> list[Any]:
    """The values of a key as a list, if they are one."""
    if hasattr(given, "tolist"):
        given = given.tolist()
    elif hasattr(given, "to_list"):
        given = given.to_list()
    elif isinstance(given, range):
        given = list(given)
    if not isinstance(given, (list, tuple)):
        kind = type(given).__name__
        raise refuse(key, f"`{key}` in `{argument}` is of type {kind}, and a list is wanted", "give its values, as [1, 2, 3] or an array")
    if not given:
        raise refuse(key, f"`{key}` in `{argument}` has no values", "give one value at least")
    return list(given)


def whole(argument: str, given: Any, least: int, cure: str = "") -> int:
    """A whole number, if it is one and large enough."""
    if not is_whole(given) or given < least:
        message = f"`{argument}` is {given!r}, and a whole number of at least {least} is wanted"
        raise refuse(argument, message, cure or f"give {argument}={max(least, 8)}")
    return int(given)
