"""The programs of the book do what they say."""

import ast
import contextlib
import io
import json
import math
import pathlib
import re

import pytest

import holonom as hm

BOOK = pathlib.Path(__file__).parents[3] / "docs"
CHAPTER = (BOOK / "python.md").read_text(encoding="utf-8")
TUTORIALS = sorted((BOOK / "tutorials").glob("*.ipynb"))


def blocks(chapter):
    """Programs of a chapter."""
    return re.findall(r"```python\n(.*?)```\n", chapter, re.DOTALL)


def run_blocks(chapter, file):
    """Runs the programs of a chapter one after the other: their names, and what each has printed."""
    names, printed = {}, []
    for block in blocks(chapter):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile(block, file, "exec"), names)
        printed.append(out.getvalue())
    return names, printed


def cells(path):
    """Programs of the cells of a notebook."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run_cell(program, names):
    """Runs a cell as a notebook does: a value in its last line is shown."""
    tree = ast.parse(program)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    shown = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None
    return getattr(shown, "_repr_html_", lambda: repr(shown))()


def test_the_programs_run_one_after_the_other(tmp_path, monkeypatch):
    pytest.importorskip("gymnasium")
    monkeypatch.chdir(tmp_path)
    _, printed = run_blocks(CHAPTER, "door.py")
    assert len(printed) == 6
    assert "completed" in printed[0]
    shown = re.search(r"```\n(error: .*?)```", CHAPTER, re.DOTALL).group(1)
    without_line = re.compile(r"door\.py:\d+")
    assert without_line.sub("", printed[1]).startswith(without_line.sub("", shown))
    # The weight pulls the arm 0.2 rad below what the controller wants.
    assert float(printed[3]) == pytest.approx(0.5 * math.sin(5) - 0.2, abs=0.1)
    assert float(printed[4]) == pytest.approx(1, abs=0.5)
    # The arm is 0.4 m long and hardly moves in the first step.
    assert float(printed[5]) == pytest.approx(-0.4 - 1e-3 * 2**2, abs=1e-3)


def test_names_of_the_chapter_are_there():
    assert {name for name in re.findall(r"`m\.(\w+)", CHAPTER)} <= set(dir(hm.Model))
    assert {name for name in re.findall(r"hm\.(\w+)", CHAPTER)} <= {*hm.__all__, "gym"}
    run = hm.load("example:four-bar").simulate(end=0.1)
    assert {name for name in re.findall(r"`run\.(\w+)", CHAPTER)} <= set(dir(run))
    assert {name for name in re.findall(r"`sim\.(\w+)", CHAPTER)} <= set(dir(hm.Simulation(hm.load("example:four-bar"))))


def test_the_tutorials_are_there():
    contents = (BOOK / "README.md").read_text(encoding="utf-8")
    assert len(TUTORIALS) == 4 and all(f"tutorials/{path.name}" in contents for path in TUTORIALS)


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_runs_and_its_own_checks_hold(path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    notebook = json.loads(path.read_text(encoding="utf-8"))
    assert all(not cell.get("outputs") for cell in notebook["cells"]), "no outputs are stored"
    assert any("assert " in program for program in cells(path))
    names = {}
    with contextlib.redirect_stdout(io.StringIO()) as out:
        shown = [run_cell(program, names) for program in cells(path)]
    assert out.getvalue() and any("<" in one for one in shown)
    from matplotlib import pyplot

    pyplot.close("all")
