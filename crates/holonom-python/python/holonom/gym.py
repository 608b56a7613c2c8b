"""An environment of Gymnasium made of a model with inputs: ``pip install ".[gymnasium]"``."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import gymnasium
import numpy as np
import numpy.typing as npt

from ._errors import limits_of, refuse
from ._model import Model
from ._simulation import Simulation
from ._types import is_whole

#: What is asked of a simulation: a function of it, or the name of a column, measures among them.
Asked = Union[str, Callable[[Simulation], Any]]

Array = npt.NDArray[np.float64]

#: Limits of a number that has none.
FREE = (-math.inf, math.inf)


class Environment(gymnasium.Env[Array, Array]):
    """A model that an agent moves by its inputs.

    actions: inputs with their least and greatest value; what an agent gives beyond these is cut off there.
    observations: names of columns, or columns with their least and greatest value where these are known.
    step: nominal step (s), of which an action takes `substeps`.
    reward: what an action has earned at its end: a measure or another column by its name, or a function of the simulation.
    terminated: whether the task is over: the name of a column, when it is above 0, or a function of the simulation. An event that stops
    the run ends the task, too.
    end: time (s) at which an episode is cut off.
    start: other values of keys of the model for each episode, such as ``lambda rng: {"body.arm.mass": rng.uniform(1, 2)}``: a function of the
    generator that ``reset(seed=…)`` seeds.

    `method` and other keywords are keys of ``[simulation]``. A simulation that cannot go on cuts the episode off, and ``info["ended"]``
    says why."""

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        model: Model,
        *,
        actions: Mapping[str, tuple[float, float]],
        observations: Sequence[str] | Mapping[str, tuple[float, float]],
        step: float,
        substeps: int = 1,
        reward: Asked,
        terminated: Asked | None = None,
        end: float | None = None,
        start: Callable[[np.random.Generator], Mapping[str, Any]] | None = None,
        method: str | None = None,
        **keys: Any,
    ) -> None:
        if not is_whole(substeps) or substeps < 1:
            raise refuse("substeps", f"`substeps` is {substeps!r}", "say how many steps an action takes: 1 or more")
        if not isinstance(actions, Mapping):
            cure = 'give the inputs with their limits: actions={"torque": (-10, 10)}'
            raise refuse("actions", f"`actions` is of type {type(actions).__name__}, and a dictionary is wanted", cure)
        if isinstance(observations, str) or not isinstance(observations, (Mapping, Sequence)):
            cure = 'give the names of columns: observations=["pin.angle", "pin.angle_rate"]'
            raise refuse("observations", f"`observations` is of type {type(observations).__name__}, and a list is wanted", cure)
        self._keys: dict[str, Any] = {"step": step, "method": method, **keys}
        self.simulation = Simulation(model, **self._keys)
        """The simulation of this episode."""
        # Of its own, as the program may go on to change the model.
        self._model = model.copy()
        self._first = self.simulation.state()
        self._substeps = int(substeps)
        self._end = math.inf if end is None else _number("end", end)
        self._start = start
        self._inputs = {name: limits_of(f"actions.{name}", limits) for name, limits in actions.items()}
        self.action_space = _box("actions", self._inputs)
        limits = observations if isinstance(observations, Mapping) else dict.fromkeys(observations, FREE)
        columns = {str(name): limits_of(f"observations.{name}", of) for name, of in limits.items()}
        self.observation_space = _box("observations", columns)
        self._columns = list(columns)
        self._reward = _question("reward", reward)
        self._terminated = _question("terminated", terminated) if terminated is not None else lambda _: False
        # Names that there are not are told here.
        for name in self._inputs:
            self.simulation.inputs[name]
        self._observed()
        for asked in (reward, terminated):
            if isinstance(asked, str):
                self.simulation[asked]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Goes back to the start. The same seed gives the same episodes, to the bit."""
        super().reset(seed=seed)
        if self._start is None:
            self.simulation.set_state(self._first)
        else:
            self.simulation = Simulation(self._model, set=self._start(self.np_random), **self._keys)
        return self._observed(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Sets the inputs and takes the steps of an action."""
        values = np.asarray(action, dtype=float)
        if values.shape != (len(self._inputs),):
            message = f"`action` has the shape {values.shape}, and ({len(self._inputs)},) is wanted"
            raise refuse("action", message, f"give a number for each of: {', '.join(self._inputs)}")
        sim = self.simulation
        for (name, (low, high)), value in zip(self._inputs.items(), values.tolist()):
            # What is no number stays so, and is refused.
            sim.inputs[name] = low if value < low else high if value > high else value
        sim.step(self._substeps)
        reward = _number("reward", self._reward(sim))
        terminated = sim.event is not None or bool(self._terminated(sim))
        is_over = sim.time > self._end - sim.nominal_step / 2
        truncated = is_over or (sim.ended is not None and not terminated)
        return self._observed(), reward, terminated, truncated, {} if sim.ended is None else {"ended": sim.ended}

    def _observed(self) -> Array:
        return np.array([self.simulation[name] for name in self._columns])


def _number(path: str, given: Any) -> float:
    try:
        return float(given)
    except (TypeError, ValueError) as error:
        raise refuse(path, f"`{path}` is of type {type(given).__name__}, and a number is wanted", "give a float") from error


def _box(path: str, limits: Mapping[str, tuple[float, float]]) -> gymnasium.Space[Array]:
    if not limits:
        raise refuse(path, f"`{path}` is empty", "name at least one")
    low, high = np.array(list(limits.values())).T
    space: Any = gymnasium.spaces.Box(low, high, dtype=np.float64)
    return space  # type: ignore[no-any-return]


def _question(path: str, asked: Any) -> Callable[[Simulation], Any]:
    """A function of the simulation. Of a column, how far it is above 0 says yes."""
    if isinstance(asked, str):
        return (lambda sim: sim[asked] > 0) if path == "terminated" else lambda sim: sim[asked]
    if not callable(asked):
        message = f"`{path}` is of type {type(asked).__name__}, and the name of a column or a function is wanted"
        raise refuse(path, message, f"give {path}=lambda sim: …")
    return asked  # type: ignore[no-any-return]
