"""Wrong calls: each raises an error that names the argument and says what to do."""

import numpy as np
import pytest

import holonom as hm

NAN = float("nan")


class Bench:
    """A sound model to go wrong with."""

    def __init__(self):
        self.m = m = hm.Model(title="Bench")
        self.door = m.body("door", mass=20, inertia=[1, 1, 1], position=[0.5, 0, 0])
        self.hinge = m.revolute("hinge", m.ground, self.door, at=[0, 0, 0], axis=[0, 0, 1])
        m.input("push", default=0)
        m.torque("motor", body=self.door, torque=[0, 0, "push"])
        other = hm.Model()
        self.stranger = other.body("stranger", mass=1, inertia=[1, 1, 1], position=[0, 0, 0])

    def run(self, **keys):
        return self.m.simulate(**{"end": 0.1, "step": 0.01, **keys})


def nested():
    endless = []
    endless.append(endless)
    return endless


# A call, and words of the message.
CALLS = {
    # Names
    "name is a number": (lambda b: b.m.body(3, mass=1), ["`name`", "int", 'name="'],),
    "name is None": (lambda b: b.m.point(None), ["`name`", "NoneType"]),
    "name is empty": (lambda b: b.m.point("", position=[0, 0, 0]), ["cannot be a name", "letters"]),
    "name has a space": (lambda b: b.m.point("a b", position=[0, 0, 0]), ["`a b`|\"a b\"", "letters"]),
    "name has a dot": (lambda b: b.m.point("a.b", position=[0, 0, 0]), ["cannot be a name"]),
    "name is the ground": (lambda b: b.m.point("ground", position=[0, 0, 0]), ["`ground`", "another name"]),
    "name is taken": (lambda b: b.m.body("door", mass=1, inertia=[1, 1, 1], position=[0, 0, 0]), ["`door`", "another name"]),
    "name is that of a joint": (lambda b: b.m.point("hinge", position=[0, 0, 0]), ["`hinge`", "joint", "another name"]),
    # Keywords
    "keyword is misspelt": (lambda b: b.m.body("b", mas=1, inertia=[1, 1, 1], position=[0, 0, 0]), ["`mas`", "`mass`"]),
    "keyword is of another kind": (lambda b: b.m.spherical("s", "ground", b.door, at=[0, 0, 0], axis=[0, 0, 1]), ["`axis`"]),
    "keyword is unknown": (lambda b: b.m.torsion("t", joint=b.hinge, colour="red"), ["`colour`"]),
    "no joint": (lambda b: b.m.torsion("t", stiffness=1), ["`joint`", "add joint"]),
    "no place": (lambda b: b.m.revolute("r", "ground", b.door, axis=[0, 0, 1]), ["`at`", "add at"]),
    "no pair": (lambda b: b.m.revolute("r", at=[0, 0, 0], axis=[0, 0, 1]), ["`between`", "add between"]),
    "one of a pair": (lambda b: b.m.revolute("r", b.door, at=[0, 0, 0], axis=[0, 0, 1]), ["`revolute`", "1 positional", "between"]),
    "three of a pair": (lambda b: b.m.revolute("r", b.door, b.door, b.door, at=[0, 0, 0]), ["3 positional"]),
    "pair twice": (lambda b: b.m.revolute("r", "ground", b.door, between=["ground", b.door], at=[0, 0, 0]), ["`between`", "twice"]),
    "pair where there is none": (lambda b: b.m.torsion("t", "ground", b.door), ["2 positional", "keyword"]),
    "kind is misspelt": (lambda b: b.m.revolut("r"), ["revolut"]),
    # Types
    "parameter is None": (lambda b: b.m.parameter("L", None), ["`parameters.L`", "NoneType", "give a number"]),
    "mass is a list": (lambda b: b.m.point("p", mass=[1], position=[0, 0, 0]), ["`mass`", "a list", "number"]),
    "mass is an object": (lambda b: b.m.point("p", mass=object(), position=[0, 0, 0]), ["mass`", "object", "give a number"]),
    "mass is complex": (lambda b: b.m.point("p", mass=1j, position=[0, 0, 0]), ["mass`", "complex", "give a number"]),
    "mass is a set": (lambda b: b.m.point("p", mass={1}, position=[0, 0, 0]), ["mass`", "set", "give a number"]),
    "mass is True": (lambda b: b.m.point("p", mass=True, position=[0, 0, 0]), ["`mass`", "true or false"]),
    "mass is bytes": (lambda b: b.m.point("p", mass=b"1", position=[0, 0, 0]), ["mass`", "bytes"]),
    "position is a number": (lambda b: b.m.point("p", position=3), ["point.p.position", "a number", "list of coordinates"]),
    "position is a table": (lambda b: b.m.point("p", position={"x": 1}), ["point.p.position", "a table", "list of coordinates"]),
    "position is a function": (lambda b: b.m.point("p", position=lambda t: t), ["position`", "function", "give a number"]),
    "an item is None": (lambda b: b.m.point("p", position=[0, None, 0]), ["position[1]", "NoneType"]),
    "a flag is a text": (lambda b: b.m.output(reactions="yes"), ["`reactions`", "true or false"]),
    "a list without an end": (lambda b: b.m.point("p", position=nested()), ["position", "nested deeper"]),
    "a dictionary with numbers for keys": (lambda b: b.m.set("body.door.points", {1: [0, 0, 0]}), ["body.door.points", "no text"]),
    # Numbers
    "mass is no number": (lambda b: b.m.point("p", mass=NAN, position=[0, 0, 0]), ["mass`", "NaN", "finite"]),
    "mass is infinite": (lambda b: b.m.point("p", mass=float("inf"), position=[0, 0, 0]), ["mass`", "inf", "finite"]),
    "an item is no number": (lambda b: b.m.point("p", position=np.array([0, np.nan, 0])), ["position[1]", "NaN"]),
    "mass is too large": (lambda b: b.m.point("p", mass=10**400, position=[0, 0, 0]), ["mass`"]),
    "mass is negative": (lambda b: b.m.point("p", mass=-1, position=[0, 0, 0]) and b.run(), ["`mass`", "-1"]),
    "step is zero": (lambda b: b.run(step=0), ["`step`"]),
    "step is negative": (lambda b: b.run(step=-0.01), ["`step`"]),
    "step is no number": (lambda b: b.run(step=NAN), ["simulation.step", "NaN", "finite"]),
    "end is a list": (lambda b: b.run(end=[1]), ["`end`", "a list"]),
    "every is a half": (lambda b: b.run(every=0.5), ["`every`"]),
    # Shapes
    "position of two": (lambda b: b.m.point("p", mass=1, position=[0, 0]) and b.run(), ["`position`", "3"]),
    "position of rows": (lambda b: b.m.point("p", mass=1, position=np.eye(3)), ["position"]),
    "axis of two": (lambda b: b.m.revolute("r", "ground", b.door, at=[0, 0, 0], axis=[0, 1]) and b.run(), ["axis"]),
    "axis of zero": (lambda b: b.m.cylindrical("r", "ground", b.door, at=[0, 0, 0], axis=[0, 0, 0]) and b.run(), ["axis"]),
    "inertia of two": (lambda b: b.m.body("b", mass=1, inertia=[1, 1], position=[0, 0, 0]) and b.run(), ["`inertia`"]),
    "box of two": (lambda b: b.m.body("b", mass=1, shape=hm.Box(1, 1), position=[0, 0, 0]) and b.run(), ["`box`|shape"]),
    "two shapes": (
        lambda b: b.m.body("b", mass=1, shape={**hm.Box(1, 1, 1), **hm.Sphere(1)}, position=[0, 0, 0]) and b.run(),
        ["two shapes", "keep one"],
    ),
    # What is named
    "no such body": (lambda b: b.m.fixed("f", "ground", "dor") and b.run(), ["`dor`", "`door`"]),
    "no such joint": (lambda b: b.m.torsion("t", joint="hing", stiffness=1) and b.run(), ["`hing`", "`hinge`"]),
    "no such parameter": (lambda b: b.m.point("p", mass="m", position=[0, 0, 0]) and b.run(), ["`m`"]),
    "no such method": (lambda b: b.run(method="conserving-gll"), ["`conserving-gll`", "there are: conserving-ggl"]),
    "no such key to set": (lambda b: b.run(set={"body.door.mas": 1}), ["`mas`", "`mass`"]),
    "no such key in the model": (lambda b: b.m.set("body.door.mas", 1), ["`mas`", "`mass`"]),
    "no such key in the simulation": (lambda b: b.m.set("simulation.stepp", 0.1), ["`stepp`", "`step`"]),
    "no such section in the model": (lambda b: b.m.set("bodi.door.mass", 1), ["`bodi`", "`body`"]),
    "a key that is set to a list": (lambda b: b.m.set("body.door.mass", [1]), ["`mass`", "a list", "number"]),
    "no such parameter to set": (lambda b: b.run(set={"parameters.N": 1}), ["`N`"]),
    "no such argument": (lambda b: b.run(stp=1), ["`stp`", "`step`"]),
    "no such column": (lambda b: b.run()["hinge.angel"], ["`hinge.angel`", "`hinge.angle`"]),
    "no such column of a joint": (lambda b: b.run()["hinge"].angel, ["`angel`", "angle"]),
    "no such entry": (lambda b: b.m["hing"], ["`hing`", "hinge"]),
    "no such example": (lambda b: hm.load("example:fourbar"), ["`fourbar`", "four-bar"]),
    "no such format": (lambda b: b.run().write("nowhere", formats=["xls"]), ["`xls`", "csv"]),
    "formats is a text": (lambda b: b.run().write("nowhere", formats="csv"), ["`formats`", "str", "write formats=["]),
    "columns of a table is a text": (lambda b: b.run().to_dataframe("hinge.angle"), ["`columns`", "str", "write columns=["]),
    "no such input": (lambda b: hm.Simulation(b.m, step=0.01).inputs["pus"], ["`pus`", "`push`"]),
    "input is a text": (lambda b: hm.Simulation(b.m, step=0.01).inputs.__setitem__("push", "much"), ["`push`", "str", "number"]),
    "input is no number": (lambda b: hm.Simulation(b.m, step=0.01).inputs.__setitem__("push", NAN), ["`push`", "NaN", "finite"]),
    "input is complex": (lambda b: hm.Simulation(b.m, step=0.01).inputs.update(push=np.complex128(1 + 2j)), ["`push`", "complex128"]),
    "half a step": (lambda b: hm.Simulation(b.m, step=0.01).step(0.5), ["`count`", "whole"]),
    # What would be set beside the model, and change nothing
    "gravity as an attribute": (lambda b: setattr(b.m, "gravity", [0, 0, 0]), ["`gravity`", "m.set("]),
    "mass as an attribute": (lambda b: setattr(b.door, "mass", 25), ["`door`", 'm.set("body.door.mass"']),
    "mass with a unit": (lambda b: b.m.point("p", mass="5*kg", position=[0, 0, 0]) and b.run(), ["`kg`", "SI units"]),
    "force without a value at the start": (
        lambda b: b.m.expression("late", point=b.door, force=[b.m.function("none", lambda x: NAN)("door.x"), 0, 0]) and b.run(),
        ["`late`", "no value"],
    ),
    "no end": (lambda b: b.m.simulate(step=0.01), ["`end`", "end=10"]),
    "no step": (lambda b: b.m.simulate(end=1), ["`step`", "step=0.01"]),
    "no step of a simulation": (lambda b: hm.Simulation(b.m), ["`step`", "step=0.01"]),
    "set is a list": (lambda b: b.run(set=["a"]), ["`set`", "list", "dictionary"]),
    "set has a number for a key": (lambda b: b.run(set={3: 5}), ["`set`", "3"]),
    "method is a number": (lambda b: b.run(method=3), ["`method`", "int", "text"]),
    "no model": (lambda b: hm.simulate("model.toml"), ["`model`", "str", "load"]),
    "no model to step": (lambda b: hm.Simulation("model.toml"), ["`model`", "str", "load"]),
    "text is a number": (lambda b: hm.loads(3), ["`text`", "int"]),
    "text is no TOML": (lambda b: hm.loads("mass = "), ["model.toml:1"]),
    "an empty model": (lambda b: hm.Model().simulate(end=1, step=0.1), ["no entries", "add a point"]),
    # What is of another model
    "body of another model": (lambda b: b.m.fixed("f", "ground", b.stranger), ["between[1]", "`stranger`", "another model"]),
    "entry that was taken away": (
        lambda b: (b.m.__delitem__("hinge"), b.m.torsion("t", joint=b.hinge, stiffness=1)),
        ["joint`", "`hinge`", "another model"],
    ),
    "state of another model": (
        lambda b: hm.Simulation(b.m, step=0.01).set_state(hm.Simulation(hm.load("example:four-bar")).state()),
        ["state", "another model"],
    ),
    "state is a number": (lambda b: hm.Simulation(b.m, step=0.01).set_state(3), ["`state`", "int"]),
    # The model itself
    "gravity of two": (lambda b: hm.Model(gravity=[0, 1]).simulate(end=1, step=1), ["`gravity`", "3"]),
    "plane that there is not": (lambda b: hm.Model(plane="ab").simulate(end=1, step=1), ["`plane`", "xy, xz, yz"]),
    "title is a number": (lambda b: hm.Model(title=3), ["`title`", "text"]),
    "parameter is a list": (lambda b: b.m.parameter("p", [1]) and b.run(), ["`p`|parameters.p"]),
}


@pytest.mark.parametrize("call, words", CALLS.values(), ids=CALLS.keys())
def test_a_wrong_call_is_told_what_is_wrong(call, words):
    bench = Bench()
    with pytest.raises((hm.ModelError, KeyError, AttributeError)) as error:
        call(bench)
    text = str(error.value)
    for word in words:
        assert any(choice in text for choice in word.split("|")), text
    if isinstance(error.value, hm.ModelError):
        assert all(fault.message for fault in error.value.faults)
        # What is read as a whole has its cures in its text.
        assert all(fault.cure or "cure: " in fault.message for fault in error.value.faults), text


def test_there_are_enough_of_them():
    assert len(CALLS) >= 60


def test_a_model_is_as_it_was_after_a_wrong_call():
    bench = Bench()
    before = bench.m.to_toml()
    for call, _ in CALLS.values():
        other = Bench()
        other.m = bench.m.copy()
        try:
            call(other)
        except (hm.ModelError, KeyError, AttributeError):
            pass
    assert bench.m.to_toml() == before
    assert bench.run().completed
    with pytest.raises(hm.ModelError):
        bench.m.point("p", mass=NAN)
    assert "p" not in bench.m and bench.m.to_toml() == before


def test_a_model_without_entries_is_told_in_words_of_python():
    with pytest.raises(hm.ModelError, match="no entries") as told:
        hm.Model().simulate(end=1, step=0.1)
    assert "body" in told.value.faults[0].cure


def test_steps_only_go_forward():
    simulation = hm.Simulation(hm.load("example:double-pendulum"), step=0.01)
    with pytest.raises(hm.ModelError, match="`count` is -1"):
        simulation.step(-1)
    assert simulation.steps == 0 and simulation.step(300) and simulation.steps == 300
