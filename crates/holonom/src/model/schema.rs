//! The JSON Schema of the model file, made from the same tables that the reader uses.

use super::fields::Keys;
use super::key::{Key, Kind, Shape};
use super::value::{Table, Value};
use super::{
    Bar, Beam, Body, Curve, EQUILIBRIUM, Event, Input, Measure, ModelKeys, OutputKeys, Point, REPEAT, SimulationKeys, Start, constraints,
    drives, forces, joints,
};

/// JSON Schema (draft 2020-12) of the model file.
pub fn schema() -> Value {
    let mut properties: Table = ModelKeys::KEYS.iter().map(|key| (key.name, described(key))).collect();
    properties.push("parameters", table([("type", Value::text("object")), ("additionalProperties", shape(Shape::Number))]));
    properties.push("table", entries(object(Curve::KEYS, None)));
    properties.push("input", entries(named(Input::KEYS)));
    properties.push("point", entries(named(Point::KEYS)));
    properties.push("body", entries(named(Body::KEYS)));
    properties.push("bar", entries(named(Bar::KEYS)));
    properties.push("beam", entries(named(Beam::KEYS)));
    properties.push("joint", entries(one_of(joints::kinds())));
    properties.push("constraint", entries(one_of(constraints::KINDS)));
    properties.push("drive", entries(one_of(drives::KINDS)));
    properties.push("force", entries(one_of(forces::KINDS)));
    let Value::Table(mut starts) = entries(named(Start::KEYS)) else { unreachable!("entries are a table") };
    // A joint may have the same name.
    let of_all = table([("anyOf", Value::List(vec![described(&EQUILIBRIUM), named(Start::KEYS)]))]);
    starts.push("properties", table([(EQUILIBRIUM.name, of_all)]));
    properties.push("start", Value::Table(starts));
    properties.push("measure", entries(named(Measure::KEYS)));
    properties.push("event", entries(named(Event::KEYS)));
    properties.push("simulation", object(SimulationKeys::KEYS, None));
    properties.push("output", object(OutputKeys::KEYS, None));
    table([
        ("$schema", Value::text("https://json-schema.org/draft/2020-12/schema")),
        ("title", Value::text("holonom model")),
        ("type", Value::text("object")),
        ("properties", Value::Table(properties)),
        ("additionalProperties", Value::Bool(false)),
        ("$defs", table([("number", number()), ("end", end())])),
    ])
}

fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().collect())
}

fn texts(words: &[&str]) -> Value {
    Value::List(words.iter().map(|&word| Value::text(word)).collect())
}

/// Named entries of one shape.
fn entries(of: Value) -> Value {
    table([
        ("type", Value::text("object")),
        ("propertyNames", table([("pattern", Value::text("^[\\p{L}\\p{N}_-]+$"))])),
        ("additionalProperties", of),
    ])
}

fn one_of<'a>(kinds: impl IntoIterator<Item = &'a Kind>) -> Value {
    let each = |kind: &Kind| {
        let Value::Table(mut object) = object(kind.keys, Some(kind.name)) else { unreachable!("an object is a table") };
        object.push("description", Value::text(format!("{}: {}", kind.doc, kind.equations)));
        Value::Table(object)
    };
    table([("oneOf", Value::List(kinds.into_iter().map(each).collect()))])
}

/// A table with these keys and no others; of a kind, also `type` and `repeat`.
fn object<'a>(keys: impl IntoIterator<Item = &'a Key>, kind: Option<&str>) -> Value {
    let mut properties = Table::default();
    let mut required: Vec<Value> = Vec::new();
    if let Some(kind) = kind {
        properties.push("type", table([("const", Value::text(kind))]));
        properties.push(REPEAT.name, described(&REPEAT));
        required.push(Value::text("type"));
    }
    for key in keys {
        properties.push(key.name, described(key));
        required.extend(key.required.then(|| Value::text(key.name)));
    }
    table([
        ("type", Value::text("object")),
        ("properties", Value::Table(properties)),
        ("required", Value::List(required)),
        ("additionalProperties", Value::Bool(false)),
    ])
}

/// An entry without a `type`.
fn named(keys: &[Key]) -> Value {
    object(keys.iter().chain([&REPEAT]), None)
}

fn described(key: &Key) -> Value {
    let mut text = key.doc.to_string();
    if !key.unit.is_empty() {
        text.push_str(&format!(" [{}]", key.unit));
    }
    if !key.default.is_empty() {
        text.push_str(&format!("; default: {}", key.default));
    }
    let Value::Table(mut out) = shape(key.shape) else { unreachable!("a shape is a table") };
    out.push("description", Value::text(text));
    Value::Table(out)
}

fn shape(shape: Shape) -> Value {
    let reference = |name: &str| table([("$ref", Value::text(format!("#/$defs/{name}")))]);
    let list = |items: Value, least: usize, most: usize| {
        let Value::Table(mut out) = table([("type", Value::text("array")), ("items", items), ("minItems", Value::Number(least as f64))])
        else {
            unreachable!("made as a table")
        };
        if most != usize::MAX {
            out.push("maxItems", Value::Number(most as f64));
        }
        Value::Table(out)
    };
    let typed = |name: &str| table([("type", Value::text(name))]);
    let any = |shapes: Vec<Value>| table([("anyOf", Value::List(shapes))]);
    let rows = || list(list(reference("number"), 3, 3), 3, 3);
    let direction = || any(vec![typed("string"), list(reference("number"), 2, 3)]);
    match shape {
        Shape::Number | Shape::Formula(_) => reference("number"),
        Shape::Whole => reference("number"),
        Shape::Text | Shape::Point | Shape::Repeat => typed("string"),
        Shape::Inertia => any(vec![reference("number"), list(reference("number"), 3, 6), rows()]),
        Shape::Site => any(vec![reference("end"), list(reference("end"), 2, 2)]),
        Shape::Direction => any(vec![direction(), list(direction(), 2, 2)]),
        Shape::Profile(keys) => any(vec![reference("number"), object(keys, None)]),
        Shape::Pairs => list(list(reference("number"), 2, 2), 2, usize::MAX),
        Shape::Spin | Shape::Torque(_) => any(vec![reference("number"), list(reference("number"), 3, 3)]),
        Shape::Places => table([("type", Value::text("object")), ("additionalProperties", list(reference("number"), 2, 3))]),
        Shape::Curve => list(list(reference("number"), 2, 3), 3, usize::MAX),
        Shape::Named => table([("type", Value::text("object")), ("additionalProperties", typed("string"))]),
        Shape::Numbers(least, most) => list(reference("number"), least, most),
        Shape::Rows => rows(),
        Shape::Members | Shape::Coordinates => list(typed("string"), 2, 2),
        Shape::Directions => list(direction(), 2, 2),
        Shape::Tables(keys) => list(object(keys, None), 2, usize::MAX),
        Shape::Flag => typed("boolean"),
        Shape::Choice(words) => table([("enum", texts(words))]),
        Shape::Vector | Shape::Formulas(_) => list(reference("number"), 2, 3),
        Shape::End => reference("end"),
        Shape::Ends(least, most) => list(reference("end"), least, most),
        Shape::Words(words) => list(table([("enum", texts(words))]), 0, usize::MAX),
        Shape::Points => list(typed("string"), 0, usize::MAX),
        Shape::Table(keys) => object(keys, None),
        Shape::Weights => table([("type", Value::text("object")), ("additionalProperties", reference("number"))]),
    }
}

fn number() -> Value {
    table([
        ("description", Value::text("a number, or an expression over [parameters] and, where the key says so, variables")),
        ("type", texts(&["number", "string"])),
    ])
}

fn end() -> Value {
    let numbers = table([("$ref", Value::text("#/$defs/number"))]);
    let place =
        table([("type", Value::text("array")), ("items", numbers), ("minItems", Value::Number(2.0)), ("maxItems", Value::Number(3.0))]);
    table([
        ("description", Value::text("the name of a point, \"ground\" for the origin, or a fixed place")),
        ("anyOf", Value::List(vec![table([("type", Value::text("string"))]), place])),
    ])
}
