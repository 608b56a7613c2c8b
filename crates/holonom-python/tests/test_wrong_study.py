"""Wrong studies and analyses: each raises an error that names the argument and says what to do."""

import inspect
import pickle

import numpy as np
import pytest

import holonom as hm

from test_study import throw

V = {"parameters.v": [1, 2]}

# A call, and words of the message.
CALLS = {
    "no model": (lambda m: hm.sweep("throw.toml", V), ["`model`", "str", "load"]),
    "nothing varied": (lambda m: hm.sweep(m), ["neither `vary` nor `rows` is given", "give one"]),
    "both": (lambda m: hm.sweep(m, V, rows=V), ["both `vary` and `rows` are given"]),
    "vary is a number": (lambda m: hm.sweep(m, 3), ["`vary`", "int", "dictionary"]),
    "vary has no keys": (lambda m: hm.sweep(m, {}), ["`vary`", "no keys"]),
    "a key is a number": (lambda m: hm.sweep(m, {3: [1]}), ["`vary`", "3", "no text"]),
    "a key has one value": (lambda m: hm.sweep(m, {"parameters.v": 3}), ["`parameters.v`", "int", "list"]),
    "a key has no values": (lambda m: hm.sweep(m, {"parameters.v": []}), ["`parameters.v`", "no values"]),
    "a key has a text": (lambda m: hm.sweep(m, {"parameters.v": "1..3:5"}), ["`parameters.v`", "str", "list"]),
    "no such parameter": (lambda m: hm.sweep(m, {"parameters.w": [1, 2]}), ["`w`", "cure"]),
    "no such key": (lambda m: hm.sweep(m, {"point.ball.mas": [1, 2]}), ["`mas`", "`mass`"]),
    "no such point": (lambda m: hm.sweep(m, {"point.bal.mass": [1, 2]}), ["bal"]),
    "a table": (lambda m: hm.sweep(m, {"point.ball": [1, 2]}), ["`point.ball`", "is a table", "point.ball."]),
    "NaN": (lambda m: hm.sweep(m, {"parameters.v": [1, np.nan]}), ["parameters.v[1]", "NaN", "finite"]),
    "infinite": (lambda m: hm.sweep(m, {"parameters.v": np.array([np.inf, 1])}), ["parameters.v[0]", "inf", "finite"]),
    "None": (lambda m: hm.sweep(m, {"parameters.v": [None, 1]}), ["parameters.v[0]", "NoneType"]),
    "columns of unequal length": (
        lambda m: hm.sweep(m, rows={"parameters.v": [1, 2], "parameters.k": [1]}),
        ["`rows`", "`parameters.v` 2", "`parameters.k` 1"],
    ),
    "no rows": (lambda m: hm.sweep(m, rows=[]), ["`rows`", "no rows"]),
    "a row is a number": (lambda m: hm.sweep(m, rows=[1, 2]), ["`rows[0]`", "int"]),
    "rows of other keys": (lambda m: hm.sweep(m, rows=[{"parameters.v": 1}, {"parameters.k": 1}]), ["`rows[1]`", "same keys"]),
    "too many runs": (lambda m: hm.sweep(m, {"parameters.v": range(2000), "parameters.k": range(1, 2000)}), ["1000000 runs", "fewer"]),
    "no such function": (lambda m: hm.sweep(m, V, columns=["maximum(ball.x)"]), ["`maximum`", "max"]),
    "no such column": (lambda m: hm.sweep(m, V, columns=["ball.q"]), ["`ball.q`", "did you mean"]),
    "column twice": (lambda m: hm.sweep(m, V, columns=["ball.x", "ball.x"]), ["`ball.x`", "twice"]),
    "an empty column": (lambda m: hm.sweep(m, V, columns=[""]), ["`columns`", "empty"]),
    "columns is a text": (lambda m: hm.sweep(m, V, columns="ball.x"), ["`columns`", "list", "write columns="]),
    "a measure called as a column of all tables": (
        lambda m: (m.measure("status", value="ball.x"), hm.sweep(m, V)),
        ["two columns `status`", "last(status)", "another name"],
    ),
    "column is a number": (lambda m: hm.sweep(m, V, columns=[3]), ["`columns`", "texts"]),
    "a late time": (lambda m: hm.sweep(m, V, columns=["at(ball.x, 7)"]), ["at(ball.x, 7)", "`end`"]),
    "no such engine": (lambda m: hm.sweep(m, V, engine="spark"), ["`engine`", "'spark'", "local"]),
    "engine is a number": (lambda m: hm.sweep(m, V, engine=3), ["`engine`", "3", "local"]),
    "threads of an engine": (lambda m: hm.sweep(m, V, engine="ray", threads=2), ["`threads`", "ray"]),
    "no threads": (lambda m: hm.sweep(m, V, threads=0), ["`threads`", "0", "at least 1"]),
    "threads is a text": (lambda m: hm.sweep(m, V, threads="2"), ["`threads`", "'2'"]),
    "set and varied": (lambda m: hm.sweep(m, V, set={"parameters.v": 1}), ["`parameters.v`", "set and varied"]),
    "method and varied": (lambda m: hm.sweep(m, {"simulation.method": ["radau"]}, method="bdf"), ["`simulation.method`", "`method`"]),
    "no such method": (lambda m: hm.sweep(m, V, method="conserving-gll"), ["`conserving-gll`"]),
    "no such argument": (lambda m: hm.sweep(m, V, stp=1), ["`stp`", "`step`"]),
    "no such format": (lambda m: hm.sweep(m, V, out="nowhere-else", formats=["xls"]), ["`formats`", "xls", "csv"]),
    "formats is a text": (lambda m: hm.sweep(m, V, out="nowhere-else", formats="csv"), ["`formats`", "str", "write formats=["]),
    "no such column of a study": (lambda m: hm.sweep(m, V)["ball.q"], ["`ball.q`", "ball.x"]),
    "no such row": (lambda m: hm.sweep(m, V).run(2), ["`row`", "2", "from 0"]),
    "a row from the end": (lambda m: hm.sweep(m, V).run(-1), ["`row`", "-1", "count rows from 0"]),
    "row is a text": (lambda m: hm.sweep(m, V).run("1"), ["`row`", "'1'"]),
    "no such ending": (lambda m: hm.sweep(m, V).write("table.xls"), ["`path`", "xls", ".csv"]),
    "a range backwards": (lambda m: hm.random({"a": (2, 1)}, 4), ["`a`", "2", "lower"]),
    "a range to itself": (lambda m: hm.random({"a": (1, 1)}, 4), ["`a`", "1"]),
    "a range of texts": (lambda m: hm.random({"a": ("1", "x")}, 4), ["`a`", "'x'"]),
    "a range without an end": (lambda m: hm.random({"a": (0, np.inf)}, 4), ["`a`", "inf", "finite"]),
    "ratios of zero": (lambda m: hm.random({"a": hm.Uniform(0, 1, log=True)}, 4), ["`a`", "0", "above zero"]),
    "no deviation": (lambda m: hm.random({"a": hm.Normal(1, 0)}, 4), ["`a`", "deviation", "Normal"]),
    "no samples": (lambda m: hm.random({"a": (0, 1)}, 0), ["`count`", "0", "at least 1"]),
    "half a sample": (lambda m: hm.random({"a": (0, 1)}, 1.5), ["`count`", "1.5"]),
    "a seed below zero": (lambda m: hm.random({"a": (0, 1)}, 4, seed=-1), ["`seed`", "-1"]),
    "a count that is uneven": (lambda m: hm.sobol({"a": (0, 1)}, 100), ["`count`", "100", "64 or 128"]),
    "samples of nothing": (lambda m: hm.random({}, 4), ["`vary`", "no keys"]),
    "nothing to compare": (lambda m: hm.compare([]), ["`runs`", "empty"]),
    "something else to compare": (lambda m: hm.compare([3]), ["`runs`", "int"]),
    "no such column to compare": (lambda m: m.compare(methods=["radau", "bdf"], columns=["ball.q"]), ["`ball.q`", "did you mean"]),
    "no such method to compare": (lambda m: m.compare(methods=["raddau"]), ["`raddau`"]),
    "methods is a text": (lambda m: m.compare(methods="radau"), ["`methods`", "str", "list"]),
    "a variant is a text": (lambda m: m.compare(variants=["parameters.v=2"]), ["`variants`", "str"]),
    "a study to pickle": (lambda m: pickle.dumps(hm.sweep(m, V)), ["neither copied nor pickled", "cure", "write()"]),
    "no such method to search": (lambda m: m.stability(methods=["raddau"]), ["`raddau`"]),
    "set of a check": (lambda m: m.check(set=["a"]), ["`set`", "list", "dictionary"]),
}


@pytest.mark.parametrize("call, words", CALLS.values(), ids=CALLS.keys())
def test_a_wrong_call_is_told_what_is_wrong(call, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((hm.ModelError, KeyError)) as error:
        call(throw())
    text = str(error.value)
    for word in words:
        assert any(choice in text for choice in word.split("|")), text


def test_what_is_wrong_with_the_model_of_a_study_is_told_in_the_lines_of_the_program():
    m = throw()
    line = inspect.currentframe().f_lineno + 1
    m.spring("s", "ground", "bal", stiffness="k", rest_length=1)
    m.expression("e", point="bll", force=[1, 0, 0])
    with pytest.raises(hm.ModelError) as alone:
        m.simulate()
    with pytest.raises(hm.ModelError) as error:
        hm.sweep(m, V)
    faults = error.value.faults
    assert faults == alone.value.faults and str(error.value) == str(alone.value)
    assert [fault.place for fault in faults] == [f"{__file__}:{line}", f"{__file__}:{line + 1}"]
    with pytest.raises(hm.ModelError) as error:
        hm.sweep(throw(), {"point.ball.mas": [1, 2]})
    assert [(fault.path, fault.cure) for fault in error.value.faults] == [("point.ball.mas", "did you mean `mass`?")]
