"""The widget that shows a simulation while it goes on. What it draws is tested with the viewer, in ``crates/holonom-report/tests/live.rs``."""

import asyncio
import json
import math

import numpy as np
import pytest

import holonom as hm

pytest.importorskip("anywidget")


def arm():
    m = hm.Model(plane="xz", title="Arm")
    m.input("torque", default=2, unit="N*m", meaning="of the motor")
    body = m.body("arm", mass=2, inertia=0.3, position=[0.4, 0])
    pin = m.revolute("pin", m.ground, body, at=[0, 0])
    m.point("tip", mass=0.1, position=[3, 0])
    m.effort("motor", joint=pin, effort="torque")
    return m


def numbers(live):
    return np.frombuffer(live._frame)


def during(live, act, seconds=0.5):
    """What is left when the widget has played for a while and `act` was done in the middle."""

    async def main():
        live.playing = True
        await asyncio.sleep(seconds / 2)
        act()
        await asyncio.sleep(seconds / 2)
        live.playing = False
        await asyncio.sleep(0.1)

    asyncio.run(main())


def test_a_frame_has_what_the_picture_needs():
    sim = hm.Simulation(arm(), step=1e-3)
    live = sim.live(limits={"torque": (-5, 5)})
    layout = json.loads(live._layout)
    assert (layout["points"], layout["bodies"]) == (["tip"], ["arm"])
    assert [body["name"] for body in layout["scene"]["bodies"]] == ["arm"]
    assert numbers(live).tolist() == [sim[name] for name in ("t", "tip.x", "tip.z", "arm.x", "arm.z", "arm.angle")]
    assert live._inputs == [{"name": "torque", "unit": "N*m", "meaning": "of the motor", "low": -5.0, "high": 5.0}]
    assert live.values == {"torque": 2.0}


def test_without_limits_a_slider_goes_around_its_value():
    m = arm()
    m.input("brake")
    sliders = {one["name"]: (one["low"], one["high"]) for one in hm.Simulation(m, step=1e-3).live()._inputs}
    assert sliders == {"torque": (-4.0, 4.0), "brake": (-1.0, 1.0)}


def test_it_plays_in_real_time_and_inputs_count():
    sim = hm.Simulation(arm(), step=1e-3)
    live = sim.live()
    during(live, lambda: setattr(live, "values", {"torque": -1.5}))
    # A machine that is busy does less.
    assert 0.02 < sim.time <= 0.62
    assert sim.inputs["torque"] == -1.5 and live.values == {"torque": -1.5}
    assert numbers(live)[0] == sim.time
    assert not live.playing


def test_a_restart_begins_with_the_inputs_as_they_are():
    sim = hm.Simulation(arm(), step=1e-3)
    live = sim.live()
    sim.step(10)
    live.values = {"torque": 0.5}
    live._restarts += 1
    assert (sim.time, sim.inputs["torque"], numbers(live)[0]) == (0.0, 0.5, 0.0)


def test_other_cells_may_go_on_with_the_simulation():
    sim = hm.Simulation(arm(), step=1e-3)
    live = sim.live(speed=2)

    def act():
        sim.inputs["torque"] = 3.0

    during(live, act)
    assert live.values == {"torque": 3.0}


def test_what_ends_a_simulation_is_told():
    m = arm()
    m.event("down", when="pin.angle + 0.01", stop=True)
    sim = hm.Simulation(m, step=1e-3)
    live = sim.live(speed=10)
    during(live, lambda: None)
    assert live.ended == sim.ended and "down" in live.ended
    assert not live.playing


def test_what_a_function_raises_is_told():
    def late(t):
        if t > 0.01:
            raise ValueError("too late")
        return 0.0

    m = arm()
    m.effort("other", joint="pin", effort=m.function("late", late)("t"))
    live = hm.Simulation(m, step=1e-3).live(speed=10)
    during(live, lambda: None)
    assert "late" in live.ended and not live.playing


def test_without_an_event_loop_it_does_not_play():
    live = hm.Simulation(arm(), step=1e-3).live()
    with pytest.raises(RuntimeError, match="as in a notebook"):
        live.playing = True
    assert not live.playing


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"limits": {"tork": (0, 1)}}, "torque"),
        ({"limits": {"torque": (1, 0)}}, "limits.torque"),
        ({"limits": {"torque": 3}}, "limits.torque"),
        ({"speed": 0}, "speed"),
        ({"speed": math.nan}, "speed"),
    ],
)
def test_wrong_arguments_are_named(keys, said):
    with pytest.raises((hm.ModelError, KeyError), match=said):
        hm.Simulation(arm(), step=1e-3).live(**keys)
