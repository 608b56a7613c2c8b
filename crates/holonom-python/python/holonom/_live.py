"""A simulation at work in a notebook: needs anywidget."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from . import _engine
from ._errors import limits_of, refuse

if TYPE_CHECKING:
    from ._simulation import Simulation

_BUNDLE = _engine.live()
if _BUNDLE is None:
    raise ImportError("this package was built without the viewer: build it with the feature `viewer`")
_SCRIPT, _STYLE = _BUNDLE

#: Seconds between two frames.
_FRAME = 1 / 30

#: Share of the time between two frames that steps may take: the rest is for the notebook.
_BUSY = 0.7


class Live(anywidget.AnyWidget):
    """What ``Simulation.live`` gives. ``playing``, ``speed`` and ``values`` of the inputs may be set here as well as in the notebook; ``ended``
    says why the simulation does not go on."""

    _esm = _SCRIPT
    _layout = traitlets.Unicode().tag(sync=True)
    _style = traitlets.Unicode().tag(sync=True)
    _frame = traitlets.Bytes().tag(sync=True)
    _inputs: traitlets.List[Any] = traitlets.List().tag(sync=True)
    _restarts = traitlets.Int(0).tag(sync=True)
    values = traitlets.Dict().tag(sync=True)
    playing = traitlets.Bool(False).tag(sync=True)
    speed = traitlets.Float(1.0).tag(sync=True)
    ended = traitlets.Unicode("").tag(sync=True)

    def __init__(self, simulation: Simulation, limits: Mapping[str, tuple[float, float]], speed: float) -> None:
        self._simulation = simulation
        self._begin = simulation.state()
        layout, self._places = simulation._simulator.layout()
        described = simulation._simulator.inputs()
        for name in limits:
            simulation.inputs[name]
        self._task: asyncio.Task[None] | None = None
        super().__init__(
            _layout=layout,
            _style=_STYLE,
            _frame=simulation._simulator.frame(self._places),
            _inputs=[_slider(name, unit, meaning, simulation.inputs[name], limits.get(name)) for name, unit, meaning in described],
            values=dict(simulation.inputs),
            speed=speed,
            ended=simulation.ended or "",
        )

    @property
    def simulation(self) -> Simulation:
        """What is shown."""
        return self._simulation

    @traitlets.validate("speed")
    def _check_speed(self, proposal: Any) -> float:
        speed = float(proposal["value"])
        if not (speed > 0 and math.isfinite(speed)):
            raise refuse("speed", f"`speed` is {speed}", "say how many simulated seconds a second has: more than 0")
        return speed

    @traitlets.observe("values")
    def _set_values(self, _: Any = None) -> None:
        for name, value in self.values.items():
            if self._simulation.inputs[name] != value:
                self._simulation.inputs[name] = value

    @traitlets.observe("_restarts")
    def _restart(self, _: Any) -> None:
        self._simulation.set_state(self._begin)
        self._set_values()
        self._show()

    @traitlets.observe("playing")
    def _play(self, change: Any) -> None:
        if not change["new"] or self._task is not None:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError as error:
            self.playing = False
            raise RuntimeError("a simulation plays where an event loop runs, as in a notebook: elsewhere take steps with step()") from error
        self._task = loop.create_task(self._go_on())

    async def _go_on(self) -> None:
        """Takes the steps that are due, frame by frame, or as many as there is time for."""
        try:
            step = self._simulation.nominal_step
            due, cost, last = 0.0, 0.0, time.perf_counter()
            while self.playing:
                await asyncio.sleep(_FRAME)
                now = time.perf_counter()
                due += (now - last) * self.speed / step
                last = now
                most = max(int(_BUSY * _FRAME / cost), 1) if cost > 0 else 1
                count = min(int(due), most)
                if count == 0:
                    continue
                goes_on = self._simulation.step(count)
                cost = (time.perf_counter() - now) / count
                # What there was no time for is left out: the simulation is slow, and does not run after the clock.
                due = due - count if count < most else 0.0
                self._show()
                if not goes_on:
                    break
        except Exception as error:  # what a function of the model raised is told where it is looked at
            self.ended = str(error)
        finally:
            self._task = None
            self.playing = False

    def _show(self) -> None:
        simulation = self._simulation
        self._frame = simulation._simulator.frame(self._places)
        self.values = dict(simulation.inputs)
        self.ended = simulation.ended or ""


def _slider(name: str, unit: str, meaning: str, value: float, limits: tuple[float, float] | None) -> dict[str, Any]:
    if limits is None:
        reach = 2 * abs(value) or 1.0
        limits = (-reach, reach)
    low, high = limits_of(f"limits.{name}", limits)
    return {"name": name, "unit": unit, "meaning": meaning, "low": low, "high": high}
