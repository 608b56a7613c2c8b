//! What builders are made of: all kinds with their keys, as the reader of model files has them.

use holonom::model::{
    Bar, Beam, Body, Curve, Event, Input, Key, Keys, Kind, Kinds, Measure, ModelKeys, OutputKeys, Point, REPEAT, Shape, SimulationKeys,
    Solid, Start,
};
use pyo3::prelude::*;

/// A key: name, type, whether it must be given, what is taken otherwise, unit, and what it is for.
type KeyParts = (&'static str, &'static str, bool, &'static str, &'static str, &'static str);

/// What one builder is made of: section, kind where the section has kinds, documentation, equations, keys.
type Definition = (&'static str, Option<&'static str>, &'static str, &'static str, Vec<KeyParts>);

/// Sections of entries without kinds, and what an entry is.
const PLAIN: [(&str, &str, &[Key]); 9] = [
    ("table", "a curve, which formulas call as a function", Curve::KEYS),
    ("input", "a number from outside, which is set while the model runs", Input::KEYS),
    ("point", "a particle, a place that stays, or a driven support", Point::KEYS),
    ("body", "a rigid body", Body::KEYS),
    ("bar", "a uniform rigid rod between two points", Bar::KEYS),
    ("beam", "an elastic beam", Beam::KEYS),
    ("start", "where a joint is at the start: the mechanism is moved there before it runs", Start::KEYS),
    ("measure", "a formula of what the mechanism does, recorded as a column and read by other formulas", Measure::KEYS),
    ("event", "a condition whose time is found, and what happens then", Event::KEYS),
];

/// Sections without entries, the model itself, and the shapes of bodies.
const SETTINGS: [(&str, &str, &[Key]); 4] = [
    ("", "the model itself", ModelKeys::KEYS),
    ("simulation", "how the model is run", SimulationKeys::KEYS),
    ("output", "what is recorded", OutputKeys::KEYS),
    ("shape", "the shape of a body", Solid::KEYS),
];

/// What all builders are made of.
#[pyfunction]
pub fn definitions() -> Vec<Definition> {
    let Kinds { joints, constraints, drives, forces, functions: _ } = Kinds::default();
    let sections = [("joint", joints), ("constraint", constraints), ("drive", drives), ("force", forces)];
    let kinds = sections.into_iter().flat_map(|(section, kinds)| kinds.into_iter().map(move |kind| of_kind(section, &kind)));
    let plain = PLAIN.iter().map(|&(section, doc, keys)| {
        // A curve is no entry that could be repeated.
        let repeat = (section != "table").then_some(&REPEAT);
        (section, None, doc, "", keys.iter().chain(repeat).map(parts).collect())
    });
    let settings = SETTINGS.iter().map(|&(section, doc, keys)| (section, None, doc, "", keys.iter().map(parts).collect()));
    kinds.chain(plain).chain(settings).collect()
}

fn of_kind(section: &'static str, kind: &Kind) -> Definition {
    (section, Some(kind.name), kind.doc, kind.equations, kind.keys.iter().chain([&REPEAT]).map(parts).collect())
}

fn parts(key: &Key) -> KeyParts {
    (key.name, python_type(key.shape), key.required, key.default, key.unit, key.doc)
}

/// What an argument may be, by the names of types in `_types.py`.
fn python_type(shape: Shape) -> &'static str {
    match shape {
        Shape::Number | Shape::Whole | Shape::Formula(_) => "Number",
        Shape::Text | Shape::Choice(_) | Shape::Repeat | Shape::Point => "str",
        Shape::Flag => "bool",
        Shape::Vector | Shape::Formulas(_) | Shape::Numbers(..) => "Numbers",
        Shape::End => "Place",
        Shape::Ends(..) | Shape::Curve => "Sequence[Place]",
        Shape::Inertia => "Number | Numbers | Rows",
        Shape::Spin | Shape::Torque(_) => "Number | Numbers",
        Shape::Places => "Mapping[str, Numbers]",
        Shape::Rows | Shape::Pairs => "Rows",
        Shape::Profile(_) => "Number | Mapping[str, Any]",
        Shape::Named => "Mapping[str, str]",
        Shape::Members | Shape::Coordinates | Shape::Words(_) | Shape::Points => "Sequence[str]",
        Shape::Site | Shape::Direction => "Place | Sequence[Place]",
        Shape::Directions => "Sequence[Place]",
        Shape::Tables(_) => "Sequence[Mapping[str, Any]]",
        Shape::Table(_) => "Mapping[str, Any]",
        Shape::Weights => "Mapping[str, Number]",
    }
}
