//! Models written out: no parameters, no repetitions, no expressions but formulas, and what has a default with a unit said.

use holonom::model::{GRAVITY, Key, Shape, Table, Value};

use super::expression::{self, number};
use super::sections::{entries, keys, kind, list, table, with_entries};

/// What names stand for in an entry: parameters and indices.
struct Scope<'a> {
    known: Table,
    /// Bodies by the names that they have before their indices.
    bodies: &'a [String],
    /// Beams, whose bodies keep their indices.
    beams: &'a [String],
}

/// A description written out.
pub fn out(description: &Table) -> Table {
    let parameters = table(description, "parameters");
    let all = entries(description);
    let of = |section: &str| -> Vec<String> { all.iter().filter(|entry| entry.0 == section).map(|entry| entry.1.clone()).collect() };
    let (bodies, beams) = (of("body"), of("beam"));
    let mut written = Vec::new();
    for (section, name, entry) in &all {
        for indices in repetitions(entry, &parameters) {
            let mut scope = Scope { known: parameters.clone(), bodies: &bodies, beams: &beams };
            let mut full = name.clone();
            for (index, value) in indices {
                full.push_str(&format!("_{value}"));
                scope.known.push(index, Value::Number(value));
            }
            written.push((*section, full, scope.entry(section, entry)));
        }
    }
    let scope = Scope { known: parameters, bodies: &bodies, beams: &beams };
    let mut plain = Table::default();
    for key in ["title", "plane"] {
        description.get(key).into_iter().for_each(|value| plain.push(key, value.clone()));
    }
    plain.push("gravity", gravity(description, &scope));
    let simulation = table(description, "simulation");
    let times = ["end", "step"].into_iter().filter_map(|key| simulation.get(key).map(|value| (key, scope.evaluated(value))));
    plain.push("simulation", Value::Table(times.collect()));
    with_entries(&plain, written)
}

/// Letters of the axes of a model.
pub fn letters(description: &Table) -> &str {
    match description.get("plane") {
        Some(Value::Text(plane)) => plane,
        _ => "xyz",
    }
}

/// In the axes of the model, as the reader takes it.
fn gravity(description: &Table, scope: &Scope<'_>) -> Value {
    let given = description.get("gravity").map_or_else(|| list(&GRAVITY), |given| scope.evaluated(given));
    let numbers = super::sections::numbers(&given);
    let of_world = |letter| numbers["xyz".find(letter).expect("an axis")];
    if numbers.len() == 3 { list(&letters(description).chars().map(of_world).collect::<Vec<_>>()) } else { given }
}

/// The values of the indices of each entry that a repetition makes.
fn repetitions(entry: &Table, parameters: &Table) -> Vec<Vec<(String, f64)>> {
    let Some(Value::Text(repeat)) = entry.get("repeat") else { return vec![Vec::new()] };
    let mut made: Vec<Vec<(String, f64)>> = vec![Vec::new()];
    for range in repeat.split(',') {
        let (name, bounds) = range.split_once('=').expect("an index and its range");
        let (low, high) = bounds.split_once(" to ").expect("two bounds");
        let further = |indices: Vec<(String, f64)>| {
            let mut known = parameters.clone();
            indices.iter().for_each(|(name, value)| known.push(name, Value::Number(*value)));
            let [low, high] = [low, high].map(|bound| number(bound, &known) as i64);
            (low..=high).map(move |k| indices.iter().cloned().chain([(name.trim().to_string(), k as f64)]).collect())
        };
        made = made.into_iter().flat_map(further).collect();
    }
    made
}

impl Scope<'_> {
    fn entry(&self, section: &str, entry: &Table) -> Table {
        let mut out: Table = entry.get("type").map(|kind| ("type", kind.clone())).into_iter().collect();
        for (key, value) in self.keys(keys(section, entry), entry).iter().filter(|(key, _)| *key != "repeat") {
            out.push(key, value.clone());
        }
        if kind(entry) == "generic" && out.get("axes").is_none() {
            out.push("axes", Value::List(vec![list(&[1.0, 0.0, 0.0]), list(&[0.0, 1.0, 0.0])]));
        }
        out
    }

    fn keys(&self, keys: &[Key], table: &Table) -> Table {
        let known = |name: &str| keys.iter().find(|key| key.name == name);
        let keys = table.iter().filter_map(|(name, value)| known(name).map(|key| (name, self.value(key.shape, value))));
        keys.collect()
    }

    fn value(&self, shape: Shape, value: &Value) -> Value {
        let each = |shape: Shape, items: &[Value]| Value::List(items.iter().map(|item| self.value(shape, item)).collect());
        match (shape, value) {
            (Shape::Choice(_) | Shape::Words(_) | Shape::Flag | Shape::Repeat, _) => value.clone(),
            (Shape::Table(keys) | Shape::Profile(keys), Value::Table(table)) => Value::Table(self.keys(keys, table)),
            (Shape::Tables(keys), Value::List(items)) => each(Shape::Table(keys), items),
            (Shape::Formula(_) | Shape::Formulas(_) | Shape::Torque(_) | Shape::Profile(_), _) => self.formula(value),
            (Shape::Text | Shape::Point | Shape::End | Shape::Site | Shape::Direction | Shape::Directions, Value::Text(name)) => {
                Value::Text(self.renamed(name))
            }
            (Shape::Ends(..) | Shape::Members | Shape::Coordinates | Shape::Points, Value::List(items)) => each(Shape::End, items),
            (Shape::Site | Shape::Direction | Shape::Directions, Value::List(items)) if items.len() == 2 && self.are_two(items) => {
                each(Shape::End, items)
            }
            (Shape::Named, Value::Table(table)) => {
                Value::Table(table.iter().map(|(name, value)| (name, self.value(Shape::Text, value))).collect())
            }
            _ => self.evaluated(value),
        }
    }

    /// Whether a list has two places or directions, and not the numbers of one.
    fn are_two(&self, items: &[Value]) -> bool {
        let is_one = |item: &Value| match item {
            Value::List(_) => true,
            Value::Text(text) => text.split_once(['.', '[']).is_some_and(|(body, _)| self.bodies.iter().any(|known| known == body)),
            _ => false,
        };
        items.iter().any(is_one)
    }

    /// `P[i-1]` as `P_2`.
    fn renamed(&self, name: &str) -> String {
        let mut out = String::new();
        let is_of_beam = self.beams.iter().any(|beam| name.split('[').next() == Some(beam));
        for (k, part) in name.split('[').enumerate() {
            match part.split_once(']') {
                Some((index, behind)) if is_of_beam && k > 0 => {
                    out.push_str(&format!("[{}]{behind}", number(index, &self.known).round()));
                }
                Some((index, behind)) if k > 0 => out.push_str(&format!("_{}{behind}", number(index, &self.known).round())),
                _ => out.push_str(part),
            }
        }
        out
    }

    /// Numbers in place of all expressions.
    fn evaluated(&self, value: &Value) -> Value {
        match value {
            Value::Text(text) => Value::Number(number(text, &self.known)),
            Value::List(items) => Value::List(items.iter().map(|item| self.evaluated(item)).collect()),
            Value::Table(table) => Value::Table(table.iter().map(|(name, value)| (name, self.evaluated(value))).collect()),
            _ => value.clone(),
        }
    }

    /// Numbers in place of parameters and indices.
    fn formula(&self, value: &Value) -> Value {
        let known = |name: &str| self.known.get(name).map(|_| expression::written(number(name, &self.known)));
        match value {
            Value::Text(text) => Value::Text(expression::replaced(text, known)),
            Value::List(items) => Value::List(items.iter().map(|item| self.formula(item)).collect()),
            _ => value.clone(),
        }
    }
}
