//! `[parameters]`: named numbers that every expression of a model may use, and that may use each other.

use std::collections::{HashMap, HashSet};

use super::bodies::NoFiles;
use super::entry::Entry;
use super::expression::{self, Scope, Value as Known};
use super::fault::{Read, Sink};
use super::fields::{Field, Number};
use super::value::{Table, Value};

/// Values of all parameters, where those that cannot be read are there as faulty, and which have the unit `deg` in their formulas or in those of parameters
/// that they are made of.
pub fn read(table: &Table, sink: &Sink) -> (HashMap<String, Known>, HashSet<String>) {
    let needs: HashMap<&str, Vec<String>> = table.iter().map(|(name, value)| (name, needed(table, value))).collect();
    let order = sorted(table, &needs);
    let circular = report_cycles(table, &needs, &order, sink);
    let (mut known, mut degrees) = (HashMap::new(), HashSet::new());
    // What is part of a cycle, or behind one, is there but faulty, so that no second fault comes of it.
    known.extend(circular.iter().map(|name| (name.to_string(), Known::Faulty)));
    for name in order {
        let entry = Entry {
            name: "",
            path: "parameters",
            written: table,
            scope: Scope { parameters: Some(&known), degrees: Some(&degrees), ..Scope::default() },
            sink,
            files: &NoFiles,
        };
        let valid = require_name(&entry, name).is_ok();
        let number = Number::read(&entry, name.into(), table.get(name).expect("a name of the table"));
        let number = number.and_then(|number| number.number(&entry, name));
        let value = if valid { number.map_or(Known::Faulty, Known::Known) } else { Known::Faulty };
        let is_in_degrees = entry.is_in_degrees(name, 0);
        known.insert(name.to_string(), value);
        if is_in_degrees {
            degrees.insert(name.to_string());
        }
    }
    (known, degrees)
}

/// The parameters of a file that nothing outside `[parameters]` names, neither by itself nor through other parameters.
///
/// Words are compared and formulas are not read, as references such as `m[N]` and ranges of `repeat` hold formulas, too. So a parameter
/// that has the name of something else counts as used.
pub fn unused(file: &Value) -> Vec<&str> {
    let Value::Table(file) = file else { return Vec::new() };
    let Some(Value::Table(parameters)) = file.get("parameters") else { return Vec::new() };
    let mut open: Vec<&str> = Vec::new();
    file.iter().filter(|(key, _)| !["parameters", "title"].contains(key)).for_each(|(_, value)| words(value, &mut open));
    let mut used: HashSet<&str> = HashSet::new();
    while let Some(word) = open.pop() {
        if let Some(value) = parameters.get(word)
            && used.insert(word)
        {
            words(value, &mut open);
        }
    }
    parameters.keys().filter(|name| !used.contains(name)).collect()
}

/// Adds every word of the texts in a value.
fn words<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
    match value {
        Value::Text(text) => found.extend(text.split(|c: char| !(c.is_alphanumeric() || c == '_'))),
        Value::List(items) => items.iter().for_each(|item| words(item, found)),
        Value::Table(table) => table.iter().for_each(|(_, value)| words(value, found)),
        Value::Number(_) | Value::Bool(_) => (),
    }
}

/// Refuses a key that could not be written as a name in expressions.
pub fn require_name(entry: &Entry<'_>, name: &str) -> Read<()> {
    unfit(name).map_or(Ok(()), |[message, cure]| Err(entry.refuse_key(name, message, cure)))
}

/// The same of the name of an entry.
pub fn require_own_name(entry: &Entry<'_>) -> Read<()> {
    let base = entry.name.split('[').next().unwrap_or(entry.name);
    unfit(base).map_or(Ok(()), |[message, cure]| Err(entry.refuse_all(message, cure)))
}

/// Refuses an input or a measure with the name of a constant or a unit, which would be one number in some expressions and another in others.
pub fn require_no_number(entry: &Entry<'_>) -> Read<()> {
    let base = entry.name.split('[').next().unwrap_or(entry.name);
    let refused = |what| Err(entry.refuse_all(format!("`{base}` is a {what} of every expression"), "give it another name"));
    expression::number_called(base).map_or(Ok(()), refused)
}

/// Refuses a table or a function with the name of a function of places or of a whole run, which it would hide.
pub fn require_no_function(entry: &Entry<'_>) -> Read<()> {
    match expression::is_of_what_moves(entry.name) {
        true => Err(entry.refuse_all(format!("`{}` is a function of every expression", entry.name), "give it another name")),
        false => Ok(()),
    }
}

/// Why something cannot be a name in expressions, and the cure.
fn unfit(name: &str) -> Option<[String; 2]> {
    let starts = name.chars().next().is_some_and(|c| c.is_alphabetic() || c == '_');
    if !starts || !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
        let message = format!("`{name}` cannot be used as a name in expressions");
        return Some([message, "use letters, digits and _, and a letter first".into()]);
    }
    let message = || format!("`{name}` is a constant or a function of every expression");
    expression::is_reserved(name).then(|| [message(), "give it another name".into()])
}

/// The parameters that a parameter is made of.
fn needed(table: &Table, value: &Value) -> Vec<String> {
    match value {
        Value::Text(text) => expression::names_in(text).into_iter().filter(|name| table.get(name).is_some()).collect(),
        _ => Vec::new(),
    }
}

/// Names in an order in which each comes after all it needs; those in or behind cycles are left out.
fn sorted<'a>(table: &'a Table, needs: &HashMap<&'a str, Vec<String>>) -> Vec<&'a str> {
    let mut open: HashMap<&str, usize> = HashMap::new();
    let mut users: HashMap<&str, Vec<&str>> = HashMap::new();
    for name in table.keys() {
        let distinct: HashSet<&str> = needs[name].iter().map(String::as_str).collect();
        open.insert(name, distinct.len());
        for need in distinct {
            users.entry(need).or_default().push(name);
        }
    }
    let mut order: Vec<&str> = table.keys().filter(|name| open[name] == 0).collect();
    let mut next = 0;
    while let Some(&name) = order.get(next) {
        next += 1;
        for &user in users.get(name).map_or(&[][..], Vec::as_slice) {
            let count = open.get_mut(user).expect("every user is a parameter");
            *count -= 1;
            if *count == 0 {
                order.push(user);
            }
        }
    }
    order
}

/// Records one fault for each cycle and hands back all names that have no value for it.
fn report_cycles<'a>(table: &'a Table, needs: &HashMap<&'a str, Vec<String>>, order: &[&str], sink: &Sink) -> Vec<&'a str> {
    let fine: HashSet<&str> = order.iter().copied().collect();
    let left: Vec<&str> = table.keys().filter(|name| !fine.contains(name)).collect();
    let mut seen: HashSet<&str> = HashSet::new();
    let entry = Entry { name: "", path: "parameters", written: table, scope: Scope::default(), sink, files: &NoFiles };
    for &start in &left {
        let mut way: Vec<&str> = Vec::new();
        let mut name = start;
        while seen.insert(name) {
            way.push(name);
            // Each of these needs another one of them, or it would have been in the order.
            name = needs[name].iter().map(String::as_str).find(|need| !fine.contains(need)).expect("a cycle goes on");
        }
        if let Some(first) = way.iter().position(|&on_way| on_way == name) {
            let round: Vec<&str> = way[first..].iter().copied().chain([name]).collect();
            entry.refuse(name, format!("parameters go round in a circle: {}", round.join(" → ")), "give one of them a number");
        }
    }
    left
}
