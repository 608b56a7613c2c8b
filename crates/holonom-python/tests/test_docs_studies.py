"""The programs of the chapter on studies do what it says."""

import re

import numpy as np
import pytest
from test_docs import BOOK, run_blocks

import holonom as hm

CHAPTER = (BOOK / "studies.md").read_text(encoding="utf-8")


def test_the_programs_run_one_after_the_other(tmp_path, monkeypatch):
    pytest.importorskip("scipy")
    monkeypatch.chdir(tmp_path)
    names, printed = run_blocks(CHAPTER, "study.py")
    assert len(printed) == 5 and "8 completed" in printed[0]
    mean, deviation = map(float, printed[1].split())
    assert mean == pytest.approx(1 - 20 * 9.81 / 2000, abs=2e-3)
    assert deviation == pytest.approx(20 * 9.81 / 2000 * np.hypot(0.02, 0.005), rel=0.05)
    assert names["fit"].x == pytest.approx([2000, 50], rel=1e-3)
    assert float(printed[3]) == pytest.approx(0.3 / 1.8, abs=3e-4)
    assert printed[4].startswith("3\n")


def test_names_of_the_chapter_are_there():
    assert {name for name in re.findall(r"hm\.(\w+)", CHAPTER)} <= set(hm.__all__)
    study = hm.sweep(hm.load("example:four-bar"), {"simulation.end": [0.1]})
    assert {name for name in re.findall(r"`(?:study)?\.(\w+)[(`\[]", CHAPTER)} <= set(dir(study))
