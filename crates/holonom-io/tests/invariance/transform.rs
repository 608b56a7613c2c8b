//! Models in other units and frames: every key by its shape and its unit.

use std::collections::HashMap;

use holonom::model::{Key, Shape, Table, Value};

use super::change::{Change, Matrix, apply};
use super::expression::written;
use super::formulas::Names;
use super::sections::{entries, items, keys, list, number, numbers, with_entries};
use super::special;
use super::units::{of_coordinate, powers};
use super::written::letters;

/// A coordinate of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Coordinate {
    pub is_angle: bool,
    /// Whether it changes sign in a mirror.
    pub is_odd: bool,
    /// Whether the axes that it is measured along are the engine's choice.
    pub is_free: bool,
}

impl Coordinate {
    /// New value over old one.
    pub fn factor(&self, change: &Change) -> f64 {
        let sign = if self.is_odd { change.parity() } else { 1.0 };
        if self.is_angle { sign } else { sign * change.length }
    }
}

/// The coordinates of joints by the names that couplers, drives and forces have for them.
pub type Coordinates = HashMap<String, Coordinate>;

/// What is known where the keys of an entry are changed.
pub struct Context<'a> {
    pub change: &'a Change,
    pub coordinates: &'a Coordinates,
    pub letters: &'a str,
    /// The coordinate that the entry names.
    pub coordinate: Option<Coordinate>,
    /// Whether its formulas are in body axes.
    in_body: bool,
    names: Names,
}

/// A model that is written out, changed.
pub fn changed(description: &Table, change: &Change, coordinates: &Coordinates) -> Table {
    let letters = letters(description);
    let changed = entries(description).into_iter().map(|(section, name, entry)| {
        let context = Context::new(change, coordinates, letters, &entry);
        let mut out: Table = entry.get("type").map(|kind| ("type", kind.clone())).into_iter().collect();
        for key in keys(section, &entry) {
            entry.get(key.name).into_iter().for_each(|value| out.push(key.name, context.value(key, value)));
        }
        special::finish(section, &entry, &mut out, &context);
        (section, name, out)
    });
    let mut out = with_entries(description, changed.collect::<Vec<_>>());
    let context = Context::new(change, coordinates, letters, &Table::default());
    let gravity = numbers(out.get("gravity").expect("gravity is written out"));
    out.set("gravity", list(&context.vector(&change.turn, &gravity, change.factor([1, 0, -2]))));
    if let Some(Value::Table(simulation)) = out.get_mut("simulation") {
        for key in ["end", "step"] {
            simulation.get_mut(key).into_iter().for_each(|value| *value = Value::Number(number(value) * change.time));
        }
    }
    out
}

impl<'a> Context<'a> {
    fn new(change: &'a Change, coordinates: &'a Coordinates, letters: &'a str, entry: &Table) -> Self {
        let coordinate = match entry.get("joint") {
            Some(Value::Text(name)) => Some(*coordinates.get(name).unwrap_or_else(|| panic!("no coordinate {name}"))),
            _ => None,
        };
        let in_body = entry.get("axes") == Some(&Value::text("body"));
        let names = Names::new(change, letters, coordinate, entry, coordinates);
        Self { change, coordinates, letters, coordinate, in_body, names }
    }

    pub fn dimension(&self) -> usize {
        self.letters.len()
    }

    fn value(&self, key: &Key, value: &Value) -> Value {
        let is_angle = self.coordinate.is_none_or(|coordinate| coordinate.is_angle);
        let factor = |unit| self.change.factor(powers(of_coordinate(unit, is_angle)));
        let each = |by: &dyn Fn(&Value) -> Value, value: &Value| Value::List(items(value).iter().map(by).collect());
        match key.shape {
            // Two units: the first half has the one, the second half the other.
            Shape::Numbers(..) if key.unit.contains(',') => special::halves(key.unit, &numbers(value), self),
            Shape::Number | Shape::Numbers(..) => scaled(value, factor(key.unit)),
            Shape::Inertia => special::inertia(&scaled(value, factor("kg·m²")), self.change),
            Shape::Vector => self.by_unit(key.unit, &numbers(value)),
            Shape::Spin => self.spin(value),
            Shape::Places => self.places(value, factor(key.unit)),
            Shape::Point | Shape::End => self.place(value),
            Shape::Ends(..) | Shape::Curve => each(&|item| self.place(item), value),
            Shape::Site => pair_or_one(value, &|item| self.place(item)),
            Shape::Direction | Shape::Directions => pair_or_one(value, &|item| self.direction(item)),
            Shape::Formula(_) => self.formula(value, factor(key.unit)),
            Shape::Profile(_) => special::profile(key.unit, value, self),
            Shape::Formulas(_) if key.unit == "m" => self.formulas(value, &self.change.turn, self.change.length, true),
            Shape::Formulas(_) => self.formulas(value, &self.axes(), factor(key.unit), false),
            Shape::Torque(_) if self.dimension() == 2 => self.formula(value, factor(key.unit) * self.change.parity()),
            Shape::Torque(_) => self.formulas(value, &self.axes(), factor(key.unit) * self.change.parity(), false),
            Shape::Flag | Shape::Text | Shape::Whole | Shape::Choice(_) | Shape::Words(_) | Shape::Members | Shape::Named => value.clone(),
            // What `special` does.
            Shape::Table(_) | Shape::Coordinates | Shape::Tables(_) => match key.name {
                "shape" => special::shape(value, self.change.length),
                "section" => special::section(value, self.change),
                _ => value.clone(),
            },
            _ => panic!("nothing is known of what becomes of the key {}", key.name),
        }
    }

    /// What the axes become in which formulas are written.
    fn axes(&self) -> Matrix {
        if self.in_body { self.change.over() } else { self.change.turn }
    }

    pub fn vector(&self, matrix: &Matrix, x: &[f64], factor: f64) -> Vec<f64> {
        let full = std::array::from_fn(|c| x.get(c).copied().unwrap_or(0.0));
        apply(matrix, full)[..x.len()].iter().map(|c| c * factor).collect()
    }

    fn by_unit(&self, unit: &str, x: &[f64]) -> Value {
        let (vector, change) = (self.vector(&self.change.turn, x, self.change.factor(powers(unit))), self.change);
        let more = match unit {
            "m" => change.shift,
            "m/s" => change.drift,
            _ => [0.0; 3],
        };
        list(&vector.iter().zip(more).map(|(c, more)| c + more).collect::<Vec<_>>())
    }

    fn spin(&self, value: &Value) -> Value {
        let factor = self.change.parity() / self.change.time;
        match value {
            Value::List(_) => list(&self.vector(&self.change.turn, &numbers(value), factor)),
            _ => scaled(value, factor),
        }
    }

    /// Places or directions in body axes.
    fn places(&self, value: &Value, factor: f64) -> Value {
        let Value::Table(table) = value else { panic!("places are a table") };
        let place = |(name, value): (&str, &Value)| (name.to_string(), list(&self.vector(&self.change.over(), &numbers(value), factor)));
        Value::Table(table.iter().map(place).collect())
    }

    /// A name, or a place of the ground.
    fn place(&self, value: &Value) -> Value {
        match value {
            Value::Text(name) if name == "ground" && self.change.shift != [0.0; 3] => list(&self.change.shift[..self.dimension()]),
            Value::Text(_) => value.clone(),
            _ => self.by_unit("m", &numbers(value)),
        }
    }

    fn direction(&self, value: &Value) -> Value {
        match value {
            Value::Text(_) => value.clone(),
            _ => self.by_unit("any", &numbers(value)),
        }
    }

    pub fn formula(&self, value: &Value, factor: f64) -> Value {
        match value {
            Value::Text(text) if factor == 1.0 => Value::Text(self.names.in_formula(text)),
            Value::Text(text) => Value::Text(format!("{}*({})", written(factor), self.names.in_formula(text))),
            _ => scaled(value, factor),
        }
    }

    fn formulas(&self, value: &Value, matrix: &Matrix, factor: f64, is_place: bool) -> Value {
        let old: Vec<Value> = items(value).iter().map(|item| self.formula(item, 1.0)).collect();
        let text = |value: &Value| match value {
            Value::Text(text) => text.clone(),
            _ => written(number(value)),
        };
        let component = |i: usize| {
            let mut sum: Vec<String> = Vec::new();
            for (j, value) in old.iter().enumerate().filter(|&(j, _)| matrix[i][j] != 0.0) {
                sum.push(format!("{}*({})", written(matrix[i][j] * factor), text(value)));
            }
            if is_place && self.change.shift[i] != 0.0 {
                sum.push(written(self.change.shift[i]));
            }
            if sum.is_empty() { Value::Number(0.0) } else { Value::Text(sum.join(" + ")) }
        };
        Value::List((0..old.len()).map(component).collect())
    }
}

/// All numbers of a value times a factor.
pub fn scaled(value: &Value, factor: f64) -> Value {
    match value {
        Value::List(items) => Value::List(items.iter().map(|item| scaled(item, factor)).collect()),
        Value::Number(number) => Value::Number(number * factor),
        other => panic!("{} is no number", other.quoted()),
    }
}

/// Each of two, or the only one.
fn pair_or_one(value: &Value, change: &dyn Fn(&Value) -> Value) -> Value {
    match value {
        Value::List(items) if !matches!(items[0], Value::Number(_)) => Value::List(items.iter().map(change).collect()),
        _ => change(value),
    }
}
