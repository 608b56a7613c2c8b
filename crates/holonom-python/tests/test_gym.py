"""Environments of Gymnasium."""

import math
import warnings

import numpy as np
import pytest

import holonom as hm

gymnasium = pytest.importorskip("gymnasium")


def pendulum():
    m = hm.Model(title="Pendulum", plane="xz")
    arm = m.body("arm", mass=2, inertia=0.3, position=[0, -0.4])
    pin = m.revolute("pin", m.ground, arm, at=[0, 0])
    m.input("torque", unit="N*m")
    m.effort("motor", joint=pin, effort="torque")
    m.measure("effort", value="-0.1*torque^2")
    m.measure("above", value="arm.z - 0.3")
    return m


def environment(model=None, **keys):
    keys = {"actions": {"torque": (-10, 10)}, "step": 0.01, "substeps": 5, "reward": "effort", "end": 2, **keys}
    keys.setdefault("observations", {"pin.angle": (-20, 20), "pin.angle_rate": (-50, 50)})
    return hm.gym.Environment(pendulum() if model is None else model, **keys)


def rollout(env, seed, count=30):
    first, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    seen = [first.tobytes()]
    for _ in range(count):
        observed, reward, *_ = env.step(env.action_space.sample())
        seen.append(observed.tobytes() + np.float64(reward).tobytes())
    return seen


def test_gymnasium_finds_nothing_wrong():
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*not within the observation space.*|.*symmetric and normalized.*|.*spec.*")
        check_env(environment(), skip_render_check=True)


def test_an_action_sets_the_inputs_for_its_steps():
    env = environment(observations=["pin.angle", "torque"])
    env.reset(seed=0)
    observed, reward, terminated, truncated, _ = env.step(np.array([2.0]))
    # J = 0.3 + 2·0.4², and for a short time φ = τ t²/2J, as gravity has no arm at first.
    assert observed[0] == pytest.approx(2 * 0.05**2 / 2 / 0.62, rel=0.05) and observed[1] == 2
    assert (reward, terminated, truncated) == (-0.4, False, False)
    assert env.simulation.time == pytest.approx(0.05)
    # A motor gives no more than it can.
    assert env.step(np.array([1e3]))[0][1] == 10


def test_a_seed_gives_the_same_bits():
    fixed = environment()
    assert rollout(fixed, 1) == rollout(fixed, 1) == rollout(environment(), 1) != rollout(fixed, 2)
    env = environment(start=lambda rng: {"body.arm.mass": rng.uniform(1, 3)})
    one = rollout(env, 5)
    assert rollout(env, 6) != one and rollout(env, 5) == one
    env.reset(seed=5)
    masses = [env.simulation["kinetic"] for _ in range(2)]
    assert masses[0] == masses[1]


def test_episodes_end_by_time_event_condition_and_failure():
    env = environment()
    env.reset()
    flags = [env.step(np.zeros(1))[2:4] for _ in range(40)]
    assert flags[:39] == [(False, False)] * 39 and flags[39] == (False, True)

    def until_over(env, torque=10.0):
        env.reset()
        for _ in range(400):
            *_, terminated, truncated, info = env.step(np.array([torque]))
            if terminated or truncated:
                return terminated, truncated, info, env.simulation["arm.z"]
        raise AssertionError("it never ends")

    spun = {"actions": {"torque": (-30, 30)}, "end": None}
    terminated, truncated, info, height = until_over(environment(terminated="above", **spun), 30)
    assert (terminated, truncated, info) == (True, False, {}) and height > 0.3
    assert until_over(environment(terminated=lambda sim: sim["arm.z"] > 0.3, **spun), 30)[3] == height
    model = pendulum()
    model.event("up", when="arm.z - 0.3", stop=True)
    terminated, truncated, info, height = until_over(environment(model, **spun), 30)
    assert (terminated, truncated) == (True, False) and "`up`" in info["ended"]
    assert height == pytest.approx(0.3, abs=1e-9)
    # A pull that grows beyond all bounds stops the solver.
    model = hm.Model(gravity=[0, 0, 0])
    model.input("torque")
    model.point("p", mass=1, position=[1, 0, 0], velocity=[-1, 0, 0])
    model.expression("pull", point="p", force=["-1/x^3 + torque", 0, 0])
    env = environment(model, observations=["p.x"], reward="p.vx", end=None)
    env.reset()
    for _ in range(100):
        *_, terminated, truncated, info = env.step(np.zeros(1))
        if terminated or truncated:
            break
    assert (terminated, truncated) == (False, True) and "event" not in info["ended"]


def test_environments_in_a_vector_are_as_alone():
    many = gymnasium.vector.SyncVectorEnv([environment] * 3)
    first, _ = many.reset(seed=3)
    assert first.shape == (3, 2)
    actions = np.linspace(-8, 8, 3 * 20).reshape(20, 3, 1)
    together = [many.step(action)[0] for action in actions]
    for k in range(3):
        env = environment()
        env.reset(seed=3 + k)
        alone = [env.step(action[k])[0] for action in actions]
        assert all((a == b[k]).all() for a, b in zip(alone, together))


def test_it_can_be_registered():
    gymnasium.register("HolonomPendulum-v0", entry_point="holonom.gym:Environment")
    try:
        env = gymnasium.make(
            "HolonomPendulum-v0",
            model=pendulum(),
            actions={"torque": (-1, 1)},
            observations={"pin.angle": (-9, 9)},
            step=0.01,
            reward=lambda sim: math.cos(sim["pin.angle"]),
            max_episode_steps=3,
        )
        env.reset(seed=0)
        assert [env.step(np.zeros(1))[3] for _ in range(3)] == [False, False, True]
    finally:
        del gymnasium.registry["HolonomPendulum-v0"]


def test_the_program_may_change_its_model():
    model = pendulum()
    env = environment(model, start=lambda rng: {})
    model.set("body.arm.mass", 99)
    assert rollout(env, 1) == rollout(environment(), 1)


@pytest.mark.parametrize(
    "keys, words",
    [
        ({"actions": {"torqe": (-1, 1)}}, ["`torqe`", "`torque`"]),
        ({"actions": {"torque": (1, -1)}}, ["`actions.torque`", "least"]),
        ({"actions": {"torque": 3}}, ["`actions.torque`", "two numbers"]),
        ({"actions": ["torque"]}, ["`actions`", "list", "dictionary"]),
        ({"actions": {}}, ["`actions`", "at least one"]),
        ({"observations": "pin.angle"}, ["`observations`", "str", "list"]),
        ({"observations": ["pin.angel"]}, ["`pin.angel`", "`pin.angle`"]),
        ({"observations": []}, ["`observations`", "at least one"]),
        ({"reward": "efort"}, ["`efort`", "`effort`"]),
        ({"reward": 3}, ["`reward`", "int", "function"]),
        ({"terminated": "abov"}, ["`abov`", "`above`"]),
        ({"substeps": 0}, ["`substeps`", "1 or more"]),
        ({"step": None}, ["`step`"]),
        ({"end": "late"}, ["`end`", "str", "number"]),
        ({"model": "pendulum.toml"}, ["`model`", "str", "load"]),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_a_wrong_environment_is_told_what_is_wrong(keys, words):
    with pytest.raises((hm.ModelError, KeyError)) as error:
        environment(**keys)
    assert all(word in str(error.value) for word in words), str(error.value)


def test_substeps_may_be_a_number_of_numpy():
    env = environment(substeps=np.int64(5))
    env.reset()
    env.step(np.zeros(1))
    assert env.simulation.steps == 5


def test_a_wrong_action_is_told_what_is_wrong():
    env = environment()
    env.reset()
    for action, words in ((np.zeros(2), ["`action`", "(2,)", "torque"]), (np.array([np.nan]), ["`torque`", "finite"])):
        with pytest.raises(hm.ModelError) as error:
            env.step(action)
        assert all(word in str(error.value) for word in words)
    env = environment(reward=lambda sim: None)
    env.reset()
    with pytest.raises(hm.ModelError, match="`reward` is of type NoneType"):
        env.step(np.zeros(1))
