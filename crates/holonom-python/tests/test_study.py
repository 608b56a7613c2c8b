"""Studies: their tables against closed forms, whatever the threads, the engine and the interruptions."""

import subprocess
import sys
import threading

import numpy as np
import pytest

import holonom as hm

G = 9.81
COLUMNS = ["ball.x", "min(ball.z)", "rms(ball.vx)"]


def throw():
    """A ball that is thrown: x = v t, z = −g t²/2."""
    m = hm.Model(title="Throw", gravity=[0, 0, -G])
    m.parameter("v", 1)
    m.parameter("k", 1)
    m.point("ball", mass="k", position=[0, 0, 0], velocity=["v", 0, 0])
    m.simulation(end=1, step=0.1)
    return m


def test_a_grid_is_every_value_with_every_other():
    study = hm.sweep(throw(), {"parameters.v": np.linspace(1, 3, 3), "simulation.end": [0.5, 1]}, columns=COLUMNS)
    v, end = np.repeat([1.0, 2, 3], 2), np.tile([0.5, 1], 3)
    assert study["run"].tolist() == [1, 2, 3, 4, 5, 6] and len(study) == 6 and study.whole
    assert (study["parameters.v"] == v).all() and (study["simulation.end"] == end).all()
    assert np.allclose(study["ball.x"], v * end, rtol=1e-13)
    assert np.allclose(study["min(ball.z)"], -G * end**2 / 2, rtol=1e-12)
    assert np.allclose(study["rms(ball.vx)"], v, rtol=1e-12)
    assert set(study["status"]) == {"completed"} and not study.failed
    assert not study["ball.x"].flags.writeable and study.columns[0] == "run" and "ball.x" in study
    assert "6 completed, 0 stopped, 0 refused" in repr(study)


def test_a_measure_that_is_called_as_a_column_of_all_tables_is_asked_for_by_a_function():
    m = throw()
    m.measure("steps", value="2*ball.x")
    study = hm.sweep(m, {"parameters.v": [1, 2]}, columns=["last(steps)"])
    assert study["last(steps)"] == pytest.approx([2, 4]) and study["steps"].tolist() == [10, 10]


@pytest.mark.parametrize("make", [dict, lambda rows: [dict(zip(rows, row)) for row in zip(*rows.values())], hm.Table])
def test_rows_are_those_of_a_table(make):
    rows = {"parameters.v": [1, 2, 5], "simulation.end": [1, 0.5, 0.2]}
    study = hm.sweep(throw(), rows=make(rows), columns=COLUMNS)
    assert np.allclose(study["ball.x"], 1, rtol=1e-13) and len(study) == 3


def test_tables_of_pandas_have_rows_wherever_they_are_given():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"parameters.v": [1.0, 2.0], "simulation.end": [1.0, 0.5]})
    assert len(hm.sweep(throw(), frame, columns=COLUMNS)) == len(hm.sweep(throw(), rows=frame, columns=COLUMNS)) == 2
    table = hm.sweep(throw(), frame, columns=COLUMNS).to_dataframe()
    assert list(table.columns[:3]) == ["run", "parameters.v", "simulation.end"] and np.allclose(table["ball.x"], 1)


def written(study, tmp_path):
    study.write(tmp_path / "table.csv")
    return (tmp_path / "table.csv").read_bytes()


def test_the_table_is_that_of_the_command_and_the_same_for_any_threads(tmp_path):
    (tmp_path / "throw.toml").write_text(throw().to_toml())
    words = ["sweep", str(tmp_path / "throw.toml"), "--vary", "parameters.v=1..3:9", "--vary", "parameters.k=-1,1", "--quiet"]
    words += ["--columns", ",".join(COLUMNS), "--out", str(tmp_path / "out")]
    subprocess.run([sys.executable, "-m", "holonom", *words], check=True)
    command = (tmp_path / "out" / "sweep.csv").read_bytes()
    vary = {"parameters.v": np.linspace(1, 3, 9), "parameters.k": [-1, 1]}
    tables = {written(hm.sweep(throw(), vary, columns=COLUMNS, threads=threads), tmp_path) for threads in (1, 2, 5)}
    assert tables == {command} and command.count(b"\n") == 19
    assert written(hm.sweep(throw(), rows=hm.grid(vary), columns=COLUMNS), tmp_path) == command


def test_what_is_not_sure_is_warned_of_and_kept():
    m = throw()
    m.parameter("idle", 2)
    m.expression("floor", point="ball", force=[0, 0, "1e6*max(0, -0.5 - z)"])
    with pytest.warns(hm.ModelWarning) as warned:
        study = hm.sweep(m, {"simulation.step": [1e-2, 1e-4]}, columns=COLUMNS, end=0.4)
    # In contact for pi*sqrt(m/k) = 3.1 ms, from 0.3193 s on.
    assert "`floor`" in study["notes"][0] and not study["notes"][1]
    assert study.notes[0] == "nothing uses the parameter `idle`" and study.notes[1].startswith("1 of 2 runs has this note")
    assert [str(one.message) for one in warned] == study.notes


def test_runs_that_fail_are_rows():
    m = throw()
    study = hm.sweep(m, {"parameters.k": [1, -1, 2]}, columns=COLUMNS)
    (failed,) = study.failed
    assert failed.row == 1 and failed.status == "refused" and failed.settings == {"parameters.k": -1} and "mass" in failed.reason
    assert np.isnan(study["ball.x"][1]) and np.isfinite(study["ball.x"][[0, 2]]).all() and "run 2" in repr(study)


def test_a_row_is_run_again_to_the_same_numbers():
    study = hm.sweep(throw(), {"parameters.v": [1, 2, 3]}, columns=COLUMNS, end=0.7, set={"parameters.k": 3})
    run = study.run(1)
    assert run["ball.x"][-1] == study["ball.x"][1] == pytest.approx(1.4)
    assert run.t[-1] == 0.7 and len(run) == 8
    # What is given beside it counts in place of what the row has.
    other = study.run(1, method="radau", set={"parameters.v": 4}, end=0.5)
    assert other.summary["method"]["name"] == "radau" and other["ball.x"][-1] == pytest.approx(2) and other.t[-1] == 0.5


def test_a_study_in_a_folder_goes_on(tmp_path):
    def make(**keys):
        return hm.sweep(throw(), {"parameters.v": [1, 2, 3]}, columns=COLUMNS, out=tmp_path / "out", **keys)

    study = make(formats=["parquet"])
    table, journal = (tmp_path / "out" / "sweep.csv").read_bytes(), (tmp_path / "out" / "sweep.journal").read_bytes()
    assert {path.name for path in (tmp_path / "out").iterdir()} >= {"sweep.csv", "sweep.parquet", "report.html"}
    # As a kill leaves it: half a line, and no table.
    (tmp_path / "out" / "sweep.csv").unlink()
    (tmp_path / "out" / "sweep.journal").write_bytes(journal[:-20])
    assert (make()["ball.x"] == study["ball.x"]).all() and (tmp_path / "out" / "sweep.csv").read_bytes() == table
    with pytest.raises(hm.ModelError, match="differs in: vary") as told:
        hm.sweep(throw(), {"parameters.v": [1, 2, 4]}, columns=COLUMNS, out=tmp_path / "out")
    assert "force=True" in str(told.value)
    hm.sweep(throw(), {"parameters.v": [1, 2, 4]}, columns=COLUMNS, out=tmp_path / "out", force=True)


def test_functions_of_python_are_called_and_what_they_raise_is_a_row():
    m = throw()

    def wind(v):
        if v > 4:
            raise ValueError("too fast")
        return 2.0

    m.parameter("w", 0)
    wind = m.function("wind", wind)
    m.expression("wind_force", point="ball", force=[wind("v"), 0, 0])
    study = hm.sweep(m, {"parameters.v": [1, 5, 3]}, columns=COLUMNS)
    assert np.allclose(study["ball.x"][[0, 2]], [2, 4], rtol=1e-12)
    (failed,) = study.failed
    assert failed.row == 1 and "too fast" in failed.reason and "wind" in failed.reason
    with pytest.raises(hm.ModelError, match="`threads`"):
        hm.sweep(m, {"parameters.v": [1, 2]}, threads=2)
    with pytest.raises(hm.ModelError, match="`out`"):
        hm.sweep(m, {"parameters.v": [1, 2]}, out="nowhere")


def test_studies_run_in_threads_of_python():
    found = {}

    def work(k):
        found[k] = hm.sweep(throw(), {"parameters.v": [k, 2 * k]}, columns=COLUMNS)["ball.x"].tolist()

    threads = [threading.Thread(target=work, args=(k,)) for k in range(1, 5)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert {k: np.allclose(x, [k, 2 * k]) for k, x in found.items()} == dict.fromkeys(range(1, 5), True)


def test_samplers_have_their_distributions():
    rows = hm.random({"a": (1, 2), "b": hm.Normal(5, 0.1), "c": hm.Uniform(1, 100, log=True), "d": [3, 7]}, 4000, seed=1)
    assert 1 <= min(rows["a"]) and max(rows["a"]) <= 2 and np.mean(rows["a"]) == pytest.approx(1.5, abs=0.02)
    assert np.mean(rows["b"]) == pytest.approx(5, abs=0.01) and np.std(rows["b"]) == pytest.approx(0.1, rel=0.05)
    assert np.median(rows["c"]) == pytest.approx(10, rel=0.1) and set(rows["d"]) == {3, 7}
    assert (rows["a"] == hm.random({"a": (1, 2), "b": (0, 1), "c": (0, 1), "d": (0, 1)}, 4000, seed=1)["a"]).all()
    pytest.importorskip("scipy")
    pieces = np.floor(8 * hm.latin_hypercube({"a": (0, 1), "b": (0, 1)}, 8)["b"]).astype(int)
    assert sorted(pieces) == list(range(8))
    squares = hm.sobol({"a": (0, 1), "b": (0, 1)}, 16)
    assert {(int(4 * a), int(4 * b)) for a, b in zip(squares["a"], squares["b"])} == {(i, j) for i in range(4) for j in range(4)}


ENGINES = {"ray": "ray", "dask": "distributed"}


def cluster(engine, stack):
    """Two worker processes; how their numbers are found."""
    if engine == "ray":
        ray = pytest.importorskip("ray")
        ray.init(num_cpus=2, log_to_driver=False, include_dashboard=False)
        stack.append(ray.shutdown)
    else:
        distributed = pytest.importorskip("distributed")
        client = distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None)
        stack.append(client.close)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_engine_makes_the_same_table(engine, tmp_path):
    stack = []
    cluster(engine, stack)
    try:
        keys = {"rows": {"parameters.v": np.linspace(1, 3, 40), "parameters.k": [1, -1] * 20}, "columns": COLUMNS}
        local = written(hm.sweep(throw(), **keys), tmp_path)
        study = hm.sweep(throw(), **keys, engine=engine, out=tmp_path / "out")
        assert written(study, tmp_path) == local == (tmp_path / "out" / "sweep.csv").read_bytes()
    finally:
        [end() for end in stack]


def test_natural_frequencies_over_a_length_take_no_run():
    m = hm.Model(plane="xz")
    m.parameter("l", 1)
    m.point("bob", mass=2, position=[0, "-l"])
    m.constraint_distance("rod", between=["ground", "bob"])
    lengths = np.array([0.1, 1, 4])
    study = hm.sweep(m, {"parameters.l": lengths}, columns=["frequency(1)", "damping(1)", "growth(2)"])
    assert np.allclose(study["frequency(1)"], np.sqrt(G / lengths) / (2 * np.pi), rtol=1e-12)
    assert (study["damping(1)"] == 0).all() and np.isnan(study["growth(2)"]).all()
    assert study.notes == ["`growth(2)` has no value in 3 runs of 3, where mode 2 does not vibrate or there are fewer"]
