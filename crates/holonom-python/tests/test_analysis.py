"""What is asked of models and of several runs, against closed forms and what the command says."""

import json
import pickle
import subprocess
import sys

import numpy as np
import pytest

import holonom as hm

from test_study import throw


def command(*words):
    return subprocess.run([sys.executable, "-m", "holonom", *words], check=True, capture_output=True, text=True).stdout


def test_a_check_says_what_the_command_says():
    check = hm.load("example:bricard").check(projection=True)
    assert check["dof"] == 1 and check["redundant"] >= 1
    assert dict(check) == json.loads(command("check", "example:bricard", "--projection", "--json"))
    assert repr(check) == command("check", "example:bricard", "--projection").rstrip("\n")


def test_modes_are_those_of_the_command(tmp_path):
    changes = {"start.equilibrium": True}
    found = hm.load("example:suspension").modes(set=changes)
    assert [mode["frequency"] > 0 for mode in found["modes"]] == [True] * 3
    words = ("modes", "example:suspension", "--set", "start.equilibrium=true", "--no-report", "--out", str(tmp_path / "modes"))
    told = json.loads(command(*words, "--json"))
    del told["provenance"]
    assert dict(found) == told
    assert repr(found) == command(*words).rsplit("\n\n", 1)[0]
    # The report is that of the model as it was.
    m = hm.load("example:suspension")
    found = pickle.loads(pickle.dumps(m.modes(set=changes)))
    m.set("title", "another")
    found.report(tmp_path / "modes.html")
    page = (tmp_path / "modes.html").read_text(encoding="utf-8")
    assert "another" not in page and all(f"mode {k}: " in page for k in (1, 2, 3))


def test_a_model_begins_at_equilibrium():
    m = hm.Model(plane="xz")
    m.point("bob", mass=2, position=[1, 0])
    m.constraint_distance("rod", between=["ground", "bob"])
    m.set("start.equilibrium", True)
    assert abs(m.modes()["modes"][0]["frequency"] - np.sqrt(9.81) / (2 * np.pi)) < 1e-12
    again = hm.loads(m.to_toml())
    assert abs(hm.simulate(again, end=0.1, step=0.01)["bob.z"][-1] + 1) < 1e-12


def test_a_check_tells_what_is_wrong_in_lines_of_the_program():
    m = throw()
    m.spring("s", between=["ground", "bal"], stiffness=1)
    with pytest.raises(hm.ModelError, match="`bal`.*|bal") as told:
        m.check()
    assert "test_analysis.py" in told.value.faults[0].place


def test_the_largest_step_is_that_of_the_command():
    found = hm.load("example:simple-pendulum").stability(methods=["trapezoidal", "conserving"], end=1)
    words = ["stability", "example:simple-pendulum", "--method", "trapezoidal", "--method", "conserving", "--end", "1", "--no-report", "--json"]
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        told = json.loads(command(*words, "--out", folder))
    assert [found[one["method"]]["completes"] for one in told] == [one["completes"] for one in told]
    assert "largest step that completes a run of 1 s" in repr(found)


def test_differences_are_those_by_hand():
    found = throw().compare(variants=[{"parameters.v": 3}], columns=["ball.x", "ball.z"])
    (difference,) = found.differences.values()
    # x = t and 3 t: 2 t apart, of which the mean square is 4/3.
    assert difference["ball.x"]["largest"] == pytest.approx(2) and difference["ball.x"]["at"] == pytest.approx(1)
    assert difference["ball.x"]["rms"] == pytest.approx(np.sqrt(4 / 3), rel=1e-9)
    assert difference["ball.z"]["largest"] == pytest.approx(0, abs=1e-12)
    assert list(found.runs) == ["as it is", "parameters.v=3"] and "difference" in repr(found)


def test_methods_steps_and_runs_are_compared(tmp_path):
    m = hm.load("example:simple-pendulum")
    found = m.compare(methods=["radau", "conserving"], steps=[0.01, 0.02], end=0.2)
    assert list(found.runs) == ["radau, 0.01 s", "conserving, 0.01 s", "radau, 0.02 s", "conserving, 0.02 s"]
    assert found.summaries["radau, 0.02 s"]["status"] == "completed" and "radau, 0.02 s" in repr(found)
    found.report(tmp_path / "report.html")
    assert "conserving, 0.02 s" in (tmp_path / "report.html").read_text(encoding="utf-8")
    run = m.simulate(end=0.2)
    again = hm.compare([run, run, m], end=0.2, columns=["energy"])
    assert len(again.runs) == 3 and [one["energy"]["largest"] for one in again.differences.values()] == [0, 0]
