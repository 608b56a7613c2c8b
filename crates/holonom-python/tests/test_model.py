"""Models: builders, handles, copies, and where faults are."""

import copy
import inspect
import pickle
import threading

import numpy as np
import pytest

import holonom as hm
from holonom._builders import DEFINITIONS, builder_name


def door():
    m = hm.Model(title="Door", gravity=[0, 0, -9.81])
    leaf = m.body("door", mass=20, shape=hm.Box(1, 0.05, 2), position=[0.5, 0, 1], points={"handle": [0.4, 0, 0]})
    hinge = m.revolute("hinge", m.ground, leaf, at=[0, 0, 1], axis=[0, 0, 1])
    m.torsion("closer", joint=hinge, stiffness=5, angle=1.57)
    return m


def test_a_door_turns_as_its_equation_says():
    run = door().simulate(end=1, step=1e-3)
    # J φ̈ = c (1.57 − φ) with J = m (b² + t²)/12 + m b²/4.
    exact = 1.57 * (1 - np.cos(np.sqrt(5 / 6.670833) * run.t))
    assert np.abs(run["hinge"].angle - exact).max() < 1e-6
    assert run["hinge"].force[0, 2] == pytest.approx(20 * 9.81, abs=1e-9)


def test_every_kind_has_a_builder_with_its_own_name():
    entries = [(section, kind) for section, kind, *_ in DEFINITIONS if section not in ("", "simulation", "output", "shape")]
    names = [builder_name(*entry) for entry in entries]
    assert len(set(names)) == len(names) > 40
    others = {name for name in vars(hm.Model) if not name.startswith("_")} - set(names)
    parts = {"ground", "parameter", "simulation", "output", "set", "get", "entries", "title", "to_toml", "notes", "copy", "function"}
    assert others == parts | {"simulate", "check", "modes", "stability", "compare"}
    for name in names:
        builder = getattr(hm.Model, name)
        assert name.isidentifier() and builder.__name__ == name
        for parameter in list(inspect.signature(builder).parameters.values())[1:]:
            if parameter.kind is inspect.Parameter.KEYWORD_ONLY:
                assert f"\n{parameter.name}: " in builder.__doc__, (name, parameter)


def test_arrays_lists_and_formulas_mean_the_same():
    models = [hm.Model() for _ in range(4)]
    models[3].parameter("h", 0.5)
    for m, position in zip(models, [[1, 0, 0.5], (1.0, 0.0, 0.5), np.array([1, 0, 0.5]), ["2*h", 0, "h"]]):
        m.point("p", mass=np.float32(2), position=position)
    ends = [m.simulate(end=0.1, step=np.float64(0.01))["p"].position for m in models]
    assert all((end == ends[0]).all() for end in ends)


def test_handles_are_names():
    m = door()
    hinge = m["hinge"]
    assert hinge == "hinge" and (hinge.section, hinge.kind) == ("joint", "revolute")
    assert m["door"]["handle"] == "door.handle" and m["door"][3] == "door[3]"
    assert pickle.loads(pickle.dumps(hinge)).kind == "revolute"
    with pytest.raises(KeyError, match="hinge, closer"):
        m["hing"]
    del m["closer"]
    assert "closer" not in m and len(m) == 2
    m.torsion("closer", joint=hinge, stiffness=1)


def test_an_entry_may_name_what_comes_later():
    m = hm.Model()
    m.revolute("hinge", m.ground, "door", at=[0, 0, 0], axis=[0, 0, 1])
    m.body("door", mass=1, inertia=[1, 1, 1], position=[1, 0, 0])
    assert m.simulate(end=0.1, step=0.01).completed


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, hm.Model.copy, lambda m: pickle.loads(pickle.dumps(m))])
@pytest.mark.parametrize("original", [door, lambda: hm.load("example:four-bar"), hm.Model])
def test_copies_are_models_of_their_own(original, again):
    m = original()
    other = again(m)
    assert (other.to_toml(), repr(other)) == (m.to_toml(), repr(m))
    other.point("new", position=[0, 0, 0])
    assert "new" not in m and other.to_toml() != m.to_toml()


def test_a_file_that_is_not_changed_keeps_its_text():
    text = '# mine\n[point.p]\nmass = 1 # kg\nposition = [0, 0, 0]\n[simulation]\nend = 1\nstep = 0.1\n'
    m = hm.loads(text)
    assert m.to_toml() == text
    m.set("point.p.mass", 2)
    assert m.get("point.p.mass") == 2 and "# mine" not in m.to_toml()


def test_what_is_set_for_a_run_is_set_for_that_run_only():
    m = door()
    stiff = m.simulate(end=1, step=0.01, set={"force.closer.stiffness": 50})
    assert stiff["hinge.angle"][-1] != m.simulate(end=1, step=0.01)["hinge.angle"][-1]
    m.set("force.closer.stiffness", 50)
    assert stiff["hinge.angle"].tobytes() == m.simulate(end=1, step=0.01)["hinge.angle"].tobytes()


def line_of_next():
    return inspect.currentframe().f_back.f_lineno + 1


def test_faults_have_the_line_of_the_entry():
    m = door()
    here = line_of_next()
    m.spherical("ball", "door", "dor", at=[0, 0, 0])
    m.torsion("spring", joint="hing", stiffness=1)
    with pytest.raises(hm.ModelError) as error:
        m.simulate(end=1, step=0.1)
    first, second = error.value.faults
    assert (first.place, first.path) == (f"{__file__}:{here}", "joint.ball.between[1]")
    assert second.place == f"{__file__}:{here + 1}"
    assert "`dor`" in first.message and "`door`" in first.cure
    assert "2 faults" in str(error.value) and pickle.loads(pickle.dumps(error.value)).faults == error.value.faults


def test_faults_of_a_file_have_its_line(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text('[point.p]\nmass = 1\nposition = [0, 0, 0]\n[constraint.rod]\ntype = "distance"\nbetween = ["ground", "q"]\n')
    m = hm.load(path)
    with pytest.raises(hm.ModelError) as error:
        m.notes()
    assert error.value.faults[0].place == f"{path}:6:22"
    here = line_of_next()
    m.point("other", mass=-1, position=[1, 0, 0])
    with pytest.raises(hm.ModelError) as error:
        m.notes()
    assert {fault.place for fault in error.value.faults} == {f"{path}:6:22", f"{__file__}:{here}"}


def test_repeated_entries_have_columns_each():
    m = hm.Model(gravity=[0, 0, 0])
    p = m.point("p", repeat="i = 0 to 3", mass=1, position=["i", 0, 0])
    run = m.simulate(end=0.1, step=0.01)
    assert [run[p[k]].position[0, 0] for k in range(4)] == [0, 1, 2, 3]


def test_what_is_refused_is_not_set():
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", mass=1, position=[0, 0, 0])
    m.spring("s", "ground", "p", stiffness=2)
    for path, value in [("point.p.mas", 3), ("point.p.mass", [3]), ("gravitation", 1), ("force.s.stifness", 1)]:
        with pytest.raises(hm.ModelError):
            m.set(path, value)
        assert m.get(path) in (None, 1)
    # Keys that are none of a file.
    before = m.to_toml()
    for path in ["", ".", ".title", "point.p.", "point..mass", "point.p.position[0]", " title", "simulation. end", "simulation .end"]:
        with pytest.raises(ValueError):
            m.set(path, 1)
        assert m.to_toml() == before
    # What changes in two steps may be wrong between them.
    m.set("force.s.type", "torsion")
    m.set("force.s.type", "spring")
    m.set("force.t", {"type": "constant", "point": "p", "force": [1, 0, 0]})
    assert m.simulate(end=0.1, step=0.1)["p.x"][1] > 0


def test_a_parameter_is_called_as_it_is_written():
    m = hm.Model(gravity=[0, 0, 0])
    names = [m.parameter("k", 1000), m.parameter("k_", 5), m.parameter("_", 2)]
    assert [m.get(f"parameters.{name}") for name in names] == [1000, 5, 2]
    m.point("p", mass="k", position=["k_", "_", 0])
    assert m.simulate(end=0.1, step=0.1)["p.x"][0] == 5


@pytest.mark.parametrize("work", ["simulate", "stability", "check", "simulation", "notes"])
def test_a_model_may_be_changed_within_its_own_functions(work):
    """As by another thread: what is under way is of the model as it was."""
    m = hm.Model(gravity=[0, 0, 0])
    m.point("p", mass=1, position=[0, 0, 0])

    def pull(t):
        m.set("point.p.mass", m.get("point.p.mass") + 1)
        return 1.0

    m.expression("f", point="p", force=[m.function("pull", pull)("t"), 0, 0])
    calls = {
        "simulate": lambda: m.simulate(end=1, step=0.1),
        "stability": lambda: m.stability(methods=["radau"], end=1, step=0.1),
        "check": lambda: m.check(),
        "simulation": lambda: hm.Simulation(m, step=0.1).step(10),
        "notes": lambda: m.notes(),
    }
    done = calls[work]()
    assert work == "notes" or m.get("point.p.mass") > 1
    if work == "simulate":
        assert done["p.vx"][-1] == pytest.approx(1)


def test_a_model_may_be_changed_while_a_thread_runs_it():
    m = hm.load("example:double-pendulum")
    thread = threading.Thread(target=lambda: m.simulate(end=30, step=1e-3, every=1000))
    thread.start()
    while thread.is_alive():
        m.set("gravity", [0, 0, -9.8])
        m.parameter("k", 1)
    thread.join()


BESIDE = """
gravity = [0, 0, 0]
[table.push]
file = "push.csv"
x = "t"
y = "F"
[point.p]
mass = 1
position = [0, 0, 0]
[force.f]
type = "expression"
point = "p"
force = ["push(t)", 0, 0]
"""


def test_files_beside_a_model_are_found_wherever_the_program_goes(tmp_path, monkeypatch):
    folder = tmp_path / "models"
    folder.mkdir()
    (folder / "m.toml").write_text(BESIDE)
    (folder / "push.csv").write_text("t,F\n0,2\n1,2\n")
    monkeypatch.chdir(tmp_path)
    m = hm.load("models/m.toml")
    run = m.simulate(end=1, step=0.1)
    assert run["p.vx"][-1] == pytest.approx(2)
    monkeypatch.chdir("/")
    for other in (m, m.copy(), pickle.loads(pickle.dumps(m))):
        assert (other.simulate(end=1, step=0.1)["p.vx"] == run["p.vx"]).all()
    assert (pickle.loads(pickle.dumps(run))["p.vx"] == run["p.vx"]).all()


def test_a_model_may_be_longer_than_a_file():
    """A table of measured data has more numbers than the text of a model file may have letters."""
    m = hm.Model(gravity=[0, 0, 0])
    t = np.linspace(0, 1, 200_000)
    push = m.table("push", points=np.stack([t, np.sin(9 * t)], axis=1))
    m.point("p", mass=1, position=[0, 0, 0])
    m.expression("f", point="p", force=[f"{push}(t)", 0, 0])
    assert len(m.to_toml()) > 4 * 1024 * 1024
    run = m.simulate(end=1, step=0.01)
    # v = (1 − cos 9t)/9, by steps of order 2: errors of (9 h)²/24.
    assert run["p.vx"][-1] == pytest.approx((1 - np.cos(9)) / 9, rel=1e-3)
    assert (pickle.loads(pickle.dumps(run))["p.vx"] == run["p.vx"]).all()
    with pytest.raises(hm.ModelError, match="larger than 4 MB"):
        hm.loads(m.to_toml())


def test_long_doubles_are_numbers():
    m = hm.Model(gravity=[np.longdouble(0), 0, 0])
    m.point("p", mass=np.longdouble(2), position=np.array([0.25, 0.5, 1], dtype=np.longdouble))
    run = m.simulate(end=0.01, step=0.01)
    assert [run[f"p.{axis}"][0] for axis in "xyz"] == [0.25, 0.5, 1]
    with pytest.raises(Exception, match="clongdouble|complex"):
        m.point("q", mass=np.clongdouble(2), position=[0, 0, 0])
