"""Every model of the gallery, read from its file and built by the builders: the same bits."""

import pathlib

import numpy as np
import pytest

import holonom as hm
from holonom._builders import builder_name

EXAMPLES = sorted((pathlib.Path(__file__).parents[3] / "examples").glob("*.toml"))
SECTIONS = ["table", "input", "point", "body", "bar", "beam", "constraint", "joint", "drive", "force", "start", "measure", "event"]


def built(tables):
    """The model of a file's tables, made by the builders."""
    model = hm.Model(**{key: tables[key] for key in ("title", "gravity", "plane") if key in tables})
    for name, value in tables.get("parameters", {}).items():
        model.parameter(name, value)
    for section in SECTIONS:
        for name, keys in tables.get(section, {}).items():
            kind = keys.pop("type", None)
            add = getattr(model, builder_name(section, kind))
            add(name, **{f"{key}_": value for key, value in keys.items()})
    for section in ("simulation", "output"):
        getattr(model, section)(**tables.get(section, {}))
    return model


def assert_same_bits(one, other):
    assert one.columns == other.columns
    assert len(one) == len(other) > 1
    for name in one.columns:
        assert one[name].tobytes() == other[name].tobytes(), name


def test_the_gallery_is_there():
    assert len(EXAMPLES) >= 20


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_builders_and_the_file_give_the_same_bits(path):
    of_file = hm.load(path)
    of_builders = built(of_file.get(""))
    assert [(entry, entry.section, entry.kind) for entry in of_builders] == [(entry, entry.section, entry.kind) for entry in of_file]
    step = of_file.get("simulation.step")
    end = {"end": 20 * step} if isinstance(step, float) else {}
    run = of_file.simulate(**end)
    assert_same_bits(run, of_builders.simulate(**end))
    again = hm.loads(of_builders.to_toml())
    assert again.get("") == of_builders.get("")
    assert_same_bits(run, again.simulate(**end))


def test_numbers_are_written_to_the_bit():
    numbers = np.random.default_rng(1).normal(size=200) * 10.0 ** np.random.default_rng(2).integers(-300, 300, size=200)
    model = hm.Model()
    model.table("t", points=np.stack([np.arange(200), numbers], axis=1))
    again = hm.loads(model.to_toml())
    assert np.array(again.get("table.t.points"))[:, 1].tobytes() == numbers.tobytes()
