"""Type checkers have nothing to say about the package, the programs of the book and the tutorials."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from test_docs import CHAPTER, TUTORIALS, blocks, cells

SETTINGS = pathlib.Path(__file__).parents[3] / "pyproject.toml"


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """A folder with the programs, where nothing but the installed package is found."""
    folder = tmp_path_factory.mktemp("programs")
    (folder / "chapter.py").write_text("\n\n".join(blocks(CHAPTER)), encoding="utf-8")
    for path in TUTORIALS:
        # The last line of a cell may be a value to show.
        (folder / f"{path.stem.replace('-', '_')}.py").write_text("\n\n".join(cells(path)), encoding="utf-8")
    return folder


def check(folder, *words):
    environment = {key: value for key, value in os.environ.items() if key != "MYPYPATH"}
    found = subprocess.run([sys.executable, "-m", *words], cwd=folder, env=environment, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


def test_mypy(programs):
    pytest.importorskip("mypy")
    modules = [f"--module={path.stem}" for path in programs.glob("*.py")]
    # What it knows of NumPy stays in the environment, as that takes it longest.
    said = check(programs, "mypy", "--strict", f"--config-file={SETTINGS}", f"--cache-dir={sys.prefix}/mypy", "--package=holonom", *modules)
    assert re.search(r"no issues found in (\d+)", said) and int(re.search(r"in (\d+)", said)[1]) > 10, said


@pytest.mark.skipif(shutil.which("node") is None, reason="pyright runs on Node")
def test_pyright(programs):
    pytest.importorskip("pyright")
    assert "0 errors" in check(programs, "pyright", "--pythonpath", sys.executable, str(programs))
