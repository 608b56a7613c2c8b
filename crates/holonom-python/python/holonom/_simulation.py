"""Simulations that a program steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from typing import TYPE_CHECKING, Any

from . import _engine
from ._errors import needed, refuse, warn
from ._builders import text_of
from ._model import Model, changes_of
from ._types import is_whole, real

if TYPE_CHECKING:
    from ._live import Live

State = _engine.State


class Inputs(MutableMapping[str, float]):
    """The inputs of a model, by their names. What is set counts from the next step on."""

    def __init__(self, simulator: _engine.Simulator) -> None:
        self._simulator = simulator

    def __getitem__(self, name: str) -> float:
        return self._simulator.input(name)

    def __setitem__(self, name: str, value: float) -> None:
        try:
            number = real(value)
        except (TypeError, ValueError) as error:
            message = f"the input `{name}` is set to something of type {type(value).__name__}, and a number is wanted"
            raise refuse(str(name), message, "set it to a finite number") from error
        self._simulator.set_input(name, number)

    def __delitem__(self, name: str) -> None:
        raise TypeError("an input cannot be taken away: set it to a number")

    def __iter__(self) -> Iterator[str]:
        return (name for name, _, _ in self._simulator.inputs())

    def __len__(self) -> int:
        return len(self._simulator.inputs())

    def __repr__(self) -> str:
        return f"<inputs: {', '.join(f'{name} = {value:.6g}' for name, value in self.items()) or 'none'}>"


class Simulation:
    """A model at its start, to be stepped: ``step()`` takes a nominal step, ``sim["hinge.angle"]`` reads a column of the present state,
    ``inputs`` are set between steps.

    Keywords are those of ``simulate``. An `end` is not heeded: the program decides how far it goes. An `accuracy` is that of each nominal step, so
    that errors of many add up: for 1e-6 at the time `end` give ``accuracy=1e-6*step/end``."""

    # What is misspelt, or set where it would hide a method, is refused.
    __slots__ = ("__weakref__", "_inputs", "_places", "_simulator", "notes")

    def __init__(
        self,
        model: Model,
        *,
        step: Any = None,
        method: str | None = None,
        set: Mapping[str, Any] | None = None,
        **keys: Any,
    ) -> None:
        if not isinstance(model, Model):
            raise refuse("model", f"`model` is of type {type(model).__name__}, and a model is wanted", "give what load or Model() gave")
        method = None if method is None else text_of("method", method)
        self._simulator = _engine.Simulator(model._draft, changes_of({"step": step, **keys}, set), method)
        self.notes: list[str] = self._simulator.notes
        """What looks like a slip in the model, and what was put right before the start."""
        warn(self.notes)
        self._places: dict[str, int] = {}
        self._inputs = Inputs(self._simulator)

    @property
    def inputs(self) -> Inputs:
        """Numbers from outside, by their names."""
        return self._inputs

    def step(self, count: int = 1) -> bool:
        """Takes nominal steps and says whether the simulation goes on; `ended` has why not."""
        try:
            return self._simulator.step(count)
        except TypeError as error:
            if is_whole(count):
                raise
            raise refuse("count", f"`count` is {count!r}, and a whole number is wanted", "give how many steps it is to take: step(100)") from error

    @property
    def time(self) -> float:
        """Time of the present state, s."""
        return self._simulator.time

    @property
    def steps(self) -> int:
        """Nominal steps taken."""
        return self._simulator.steps

    @property
    def ended(self) -> str | None:
        """Why the last step was the last; None while the simulation goes on."""
        return self._simulator.ended

    @property
    def event(self) -> str | None:
        """Name of the event that made the last step the last; None while the simulation goes on, and where something else ended it."""
        return self._simulator.event

    @property
    def nominal_step(self) -> float:
        """Nominal step, s."""
        return self._simulator.nominal_step

    @property
    def columns(self) -> list[str]:
        """Names of all columns."""
        return self._simulator.names()

    def __getitem__(self, name: str) -> float:
        """Value of a column at the present state."""
        place = self._places.get(name)
        if place is None:
            place = self._places[name] = self._simulator.place(str(name))
        return self._simulator.value(place)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __iter__(self) -> Iterator[str]:
        """Over the names of all columns."""
        return iter(self.columns)

    def state(self) -> State:
        """A copy of the present state, which can be pickled: all that the simulation goes on from, to the same bits."""
        return self._simulator.state()

    def set_state(self, state: State) -> None:
        """Goes on from a state of this model."""
        if not isinstance(state, State):
            raise refuse("state", f"`state` is of type {type(state).__name__}, and a state is wanted", "give what state() gave")
        self._simulator.set_state(state)

    def __reduce__(self) -> tuple[Any, ...]:
        raise refuse(
            "simulation",
            "a simulation can be neither copied nor pickled",
            "keep its state(), and set it in another Simulation of the model with set_state()",
        )

    def live(self, *, limits: Mapping[str, tuple[float, float]] | None = None, speed: float = 1.0) -> Live:
        """A widget of a notebook that shows the mechanism while it moves, with a slider for each input: `limits` are the ends of sliders,
        such as ``{"torque": (-10, 10)}``, and `speed` is how many simulated seconds a second has. Other cells may read, set and step the
        simulation meanwhile. Needs anywidget."""
        with needed("live", "anywidget", "notebook"):
            from ._live import Live

        return Live(self, {} if limits is None else limits, speed)

    def __repr__(self) -> str:
        ended = f"; {self.ended}" if self.ended else ""
        return f"<Simulation of {self._simulator.title!r} by {self._simulator.method} at {self.time:.6g} s{ended}>"
