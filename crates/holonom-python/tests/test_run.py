"""Runs: what they leave, and how they end."""

import copy
import json
import os
import pickle
import subprocess
import sys
import threading

import numpy as np
import pytest

import holonom as hm

PENDULUM = "example:double-pendulum"


@pytest.fixture(scope="module")
def run():
    return hm.load("example:free-body").simulate(end=0.1)


def test_columns_and_vectors(run):
    body = next(iter(hm.load("example:free-body")))
    assert run.t[0] == 0 and run.t[-1] == 0.1 and len(run) == len(run.t)
    assert run[body].position.shape == (len(run), 3) and run[body].orientation.shape == (len(run), 4)
    assert (run[body].position[:, 1] == run[f"{body}.y"]).all()
    assert np.allclose(np.linalg.norm(run[body].orientation, axis=1), 1)
    assert (run.energy.total == run["energy"]).all() and (run.violation.velocity == run["phi_dot"]).all()
    assert (run.unit(f"{body}.vx"), run.unit("energy")) == ("m/s", "J")
    assert "velocity" in run.meaning(f"{body}.vx")
    assert "position" in dir(run[body])
    assert all(len(run[name]) == len(run) for name in run.columns)


def test_arrays_cannot_be_changed_by_mistake(run):
    with pytest.raises(ValueError, match="read-only"):
        run.t[0] = 1


def test_the_plane_has_two_coordinates():
    run = hm.load(PENDULUM).simulate(end=0.1)
    assert run["m1"].position.shape == (len(run), 2)


def test_the_command_gives_the_same_run(tmp_path):
    text = hm.load(PENDULUM).to_toml()
    (tmp_path / "models").mkdir()
    path = tmp_path / "models" / "pendulum.toml"
    path.write_text(text)
    command = [sys.executable, "-m", "holonom", "run", str(path), "--end", "0.5", "--no-report", "--format", "npz", "--out", "of-command"]
    subprocess.run([*command, "--quiet"], cwd=tmp_path, check=True)
    run = hm.load(path).simulate(end=0.5)
    run.write(tmp_path / "of-python", formats=["npz"], report=False)
    summaries = [json.loads((tmp_path / name / "summary.json").read_text()) for name in ("of-command", "of-python")]
    tables = [np.load(tmp_path / name / "trajectory.npz") for name in ("of-command", "of-python")]
    assert tables[0].files == tables[1].files == run.columns
    for name in run.columns:
        assert tables[0][name].tobytes() == tables[1][name].tobytes() == run[name].tobytes()
    for summary in (*summaries, run.summary):
        del summary["time"]
        summary["provenance"] = {key: value for key, value in summary["provenance"].items() if key not in ("date", "command")}
    assert summaries[0] == summaries[1] == run.summary


def test_results_of_another_run_are_not_overwritten(tmp_path):
    model = hm.load(PENDULUM)
    model.simulate(end=0.1).write(tmp_path)
    assert {"summary.json", "trajectory.csv", "columns.json", "report.html"} <= set(os.listdir(tmp_path))
    assert "checkpoint.json" not in os.listdir(tmp_path)
    model.simulate(end=0.1).write(tmp_path)
    with pytest.raises(hm.ModelError, match="another run"):
        model.simulate(end=0.2).write(tmp_path)
    model.simulate(end=0.2).write(tmp_path, force=True)


def test_the_report_is_a_page(tmp_path):
    hm.load(PENDULUM).simulate(end=0.1).report(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and "Double pendulum" in page


def test_a_run_that_stops_is_a_result():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", mass=1, position=[1, 0, 0], velocity=[-1, 0, 0])
    m.expression("pull", point="p", force=["-1/x^3", 0, 0])
    run = m.simulate(end=10, step=0.01)
    assert run.status == "stopped" and not run.completed and run.reason
    # It falls into the centre at t = 0.5.
    assert run.t[-1] <= run.summary["stopped_at"] <= 0.5 + 1e-3 and run.t[-1] > 0.4
    assert "stopped at" in repr(run)


def test_the_interpreter_goes_on_while_a_run_does():
    counted, done = [], threading.Event()

    def count():
        while not done.wait(0.001):
            counted.append(1)

    thread = threading.Thread(target=count)
    thread.start()
    hm.load(PENDULUM).simulate(end=200, step=1e-3, every=1000)
    seen = len(counted)
    done.set()
    thread.join()
    assert seen > 10


def test_runs_in_threads_have_the_same_bits():
    model, runs = hm.load("example:four-bar"), [None] * 8

    def simulate(k):
        runs[k] = model.simulate(end=0.2)

    threads = [threading.Thread(target=simulate, args=(k,)) for k in range(len(runs))]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    alone = model.simulate(end=0.2)
    assert all(run[name].tobytes() == alone[name].tobytes() for run in runs for name in alone.columns)


def test_errors_of_files_are_those_of_the_system(run, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        run.write(tmp_path / "file" / "folder")
    with pytest.raises(FileNotFoundError):
        hm.load(tmp_path / "none.toml")


def test_a_dataframe_has_all_columns_over_the_times(run):
    table = run.to_dataframe()
    assert list(table.columns) == [name for name in run.columns if name != "t"]
    assert (table.index.to_numpy() == run.t).all() and table.index.name == "t"
    assert all((table[name].to_numpy() == run[name]).all() for name in ("energy", "phi"))
    assert table.attrs["units"]["energy"] == "J"
    assert list(run.to_dataframe(["energy", "work"]).columns) == ["energy", "work"]
    with pytest.raises(KeyError, match="enrgy.*energy"):
        run.to_dataframe(["enrgy"])


def test_a_plot_has_axes_for_each_unit(run):
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    first, second = run.plot("energy", "phi", "kinetic")
    assert [line.get_label() for line in first.get_lines()] == ["energy", "kinetic"]
    assert first.get_ylabel() == "[J]" and second.get_xlabel() == "t [s]"
    assert (first.get_lines()[1].get_ydata() == run["kinetic"]).all()
    assert run.plot("energy", "phi", ax=first) == [first] and len(first.get_lines()) == 4
    with pytest.raises(TypeError, match="name one"):
        run.plot()
    with pytest.raises(KeyError, match="enrgy.*energy"):
        run.plot("enrgy")
    pyplot.close("all")


def test_a_notebook_shows_the_report(run):
    cell = run._repr_html_()
    assert cell.startswith("<iframe") and cell.count("<iframe") == 1
    import html

    page = html.unescape(cell.split('srcdoc="')[1].split('" style=')[0])
    assert page.startswith("<!DOCTYPE html>") or page.startswith("<!doctype html>")
    assert 'id="holonom-data"' in page


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda run: pickle.loads(pickle.dumps(run))])
def test_a_run_is_copied_and_pickled(run, again, tmp_path):
    other = again(run)
    assert repr(other) == repr(run) and other.columns == run.columns and other.summary == run.summary
    assert all(other[name].tobytes() == run[name].tobytes() for name in run.columns)
    assert [(other.unit(name), other.meaning(name)) for name in run.columns] == [(run.unit(name), run.meaning(name)) for name in run.columns]
    assert other._repr_html_() == run._repr_html_()
    run.write(tmp_path / "one", report=False)
    other.write(tmp_path / "one", report=False)


def test_a_pickled_run_is_of_the_model_as_it_was():
    m = hm.load(PENDULUM)
    m.measure("height", value="m2.y", unit="m")
    run = m.simulate(end=0.1, set={"point.m2.mass": 3}, method="radau")
    m.set("point.m1.mass", 7)
    del m["height"]
    other = pickle.loads(pickle.dumps(run))
    assert repr(other) == repr(run) and "radau" in repr(other) and (other["height"] == run["height"]).all()


def test_a_stopped_run_is_pickled():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", mass=1, position=[1, 0, 0], velocity=[-1, 0, 0])
    m.expression("pull", point="p", force=["-1/x^3", 0, 0])
    run = m.simulate(end=10, step=0.01)
    other = pickle.loads(pickle.dumps(run))
    assert (other.status, other.reason, len(other)) == (run.status, run.reason, len(run))


def test_what_was_put_right_before_the_start_is_said():
    m = hm.load("example:four-bar")
    m.set("point.P.velocity", [1, 0.3])
    m.parameter("spare", 4)
    with pytest.warns(hm.ModelWarning) as warned:
        run = m.simulate(end=0.1, step=0.01)
    assert [str(one.message) for one in warned] == run.notes == run.summary["notes"]
    assert run.notes[0] == "nothing uses the parameter `spare`"
    assert run.notes[1].endswith("start velocities were changed: `P[0]` by 0.3 m/s, `P[1]` by 0.3 m/s")
    assert all(one.filename == __file__ for one in warned)
    text = str(run)
    assert text.startswith("note: nothing uses") and "1 degree of freedom" in text
    with pytest.warns(hm.ModelWarning):
        assert hm.Simulation(m, step=0.01).notes == run.notes


def test_the_work_of_a_force_is_in_the_summary():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", position=[1, 0, 0], mass=0.5, velocity=[3, 0, 0])
    m.spring("oil", between=["ground", "p"], along=[1, 0, 0], damping=0.8)
    run = m.simulate(end=1, step=1e-3)
    (oil,) = run.summary["work_by"]["forces"]
    # What e^(−ct/m) leaves of the velocity is not lost.
    assert (oil["name"], oil["stored"]) == ("oil", 0) and abs(oil["work"] + 2.25 * (1 - np.exp(-3.2))) < 1e-5
    assert "work       oil  -2.15" in str(run)


def test_the_package_has_the_version_of_the_command():
    run = hm.load("example:four-bar").simulate(end=0.1, step=0.01)
    assert run.summary["provenance"]["version"] == hm.__version__


@pytest.mark.parametrize("call, package", [(lambda run: run.plot("energy"), "matplotlib"), (lambda run: run.to_dataframe(), "pandas")])
def test_a_package_that_is_missing_is_named_with_its_extra(run, call, package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=f"needs {package}: install it with pip install"):
        call(run)


def test_a_torque_and_its_reaction_keep_the_angular_momentum():
    m = hm.Model(gravity=[0, 0, 0])
    a = m.body("a", mass=2, inertia=[0.3, 0.4, 0.5], position=[0, 0, 0], angular_velocity=[0.3, 1, -0.5])
    b = m.body("b", mass=1, inertia=[0.1, 0.12, 0.15], position=[1.2, 0.2, 0.1], velocity=[0.1, -0.2, 0.3], angular_velocity=[1, 0, 2])
    m.torque("f", body=a, reaction=b, torque=[0.4, 0.2, "sin(t)"])
    run = m.simulate(end=2, step=0.01, method="conserving-ggl")

    def momentum(body, mass, inertia):
        w, *v = run[body].orientation.T
        v = np.array(v)
        k = np.zeros((len(w), 3, 3))
        k[:, 0, 1], k[:, 0, 2], k[:, 1, 2] = -v[2], v[1], -v[0]
        k -= np.swapaxes(k, 1, 2)
        turned = np.eye(3) + 2 * w[:, None, None] * k + 2 * k @ k
        spin = np.einsum("nij,j,nkj,nk->ni", turned, inertia, turned, run[body].angular_velocity)
        return spin + mass * np.cross(run[body].position, run[body].velocity)

    total = momentum(a, 2, [0.3, 0.4, 0.5]) + momentum(b, 1, [0.1, 0.12, 0.15])
    assert np.abs(total - total[0]).max() < 1e-12


def test_an_input_that_is_called_as_a_variable_is_refused():
    m = hm.Model(plane="xy", gravity=[0, 0])
    m.input("x", default=5)
    point = m.point("p", mass=1, position=[1, 0])
    m.expression("f", point=point, force=["x", 0])
    with pytest.raises(hm.ModelError, match="could be the variable of this expression"):
        m.simulate(end=1, step=0.1)


HELD = """
plane = "xy"
gravity = [0, 0]
[input.u]
[input.s]
[point.p]
mass = 2
position = [1, 0]
[force.f]
type = "expression"
point = "p"
force = ["u - 3*x", 0]
[event.c]
every = 0.07
set = { u = "-4*p.x - 1.5*p.vx - 0.5*s", s = "s + 0.07*p.x" }
[measure.iu]
value = "integral(u)"
[measure.done]
value = "integral(u*p.vx)"
[measure.least]
value = "min(u)"
"""


def held_between_samples(end):
    """Integrals of u and of u ẋ, and the least u: between samples x = u/3 + a cos(wt) + b sin(wt)/w with w² = 1.5."""
    w, x, v, s, t, integral, work, least = np.sqrt(1.5), 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(int(end / 0.07 + 1e-9) + 1):
        u, s = -4 * x - 1.5 * v - 0.5 * s, s + 0.07 * x
        step = min(0.07 * (k + 1), end) - t
        a, c, sn = x - u / 3, np.cos(w * step), np.sin(w * step)
        after, v = u / 3 + a * c + v * sn / w, v * c - a * w * sn
        integral, work, least, x, t = integral + u * step, work + u * (after - x), min(least, u), after, t + step
    return np.array([integral, work, least])


def test_running_values_of_what_a_sampled_controller_sets_are_those_between_samples():
    exact = held_between_samples(3.0)
    errors = []
    for step in (0.02, 0.01):
        run = hm.loads(HELD).simulate(end=3, step=step)
        errors.append(np.abs([run["iu"][-1], run["done"][-1], run["least"][-1]] - exact).max())
        study = hm.sweep(hm.loads(HELD), {"point.p.mass": [2]}, columns=["min(u)", "last(iu)"], end=3, step=step)
        assert [study["min(u)"][0], study["last(iu)"][0]] == [run["least"][-1], run["iu"][-1]]
        sim = hm.Simulation(hm.loads(HELD), step=step)
        sim.step(round(3 / step))
        assert [sim["iu"], sim["done"], sim["least"]] == [run["iu"][-1], run["done"][-1], run["least"][-1]]
    assert errors[1] < 1e-3 and np.log2(errors[0] / errors[1]) > 1.7, errors


def test_forces_at_a_sample_are_those_of_the_inputs_there():
    m = hm.Model(gravity=[0, 0, 0])
    m.input("push", unit="N")
    cart = m.body("cart", mass=2, inertia=[1, 1, 1], position=[0, 0, 0], points={"middle": [0, 0, 0]})
    m.prismatic("rail", m.ground, cart, at=[0, 0, 0], axis=[1, 0, 0])
    m.expression("across", point=cart["middle"], force=[0, "push", 0])
    m.event("controller", every=0.1, set={"push": "1 + t"})
    run = m.simulate(end=1, step=0.05)
    assert run["rail.fy"] == pytest.approx(-run["push"], abs=1e-12)


def test_a_folder_that_is_there_is_told_in_words_of_python(tmp_path):
    run = hm.load("example:four-bar").simulate(end=0.02, step=0.01)
    run.write(tmp_path / "out", report=False)
    other = hm.load("example:double-pendulum").simulate(end=0.02, step=0.01)
    with pytest.raises(Exception, match="force=True") as refused:
        other.write(tmp_path / "out", report=False)
    assert "--" not in str(refused.value)
    other.write(tmp_path / "out", report=False, force=True)
