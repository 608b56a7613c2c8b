//! The sections of a model file and the keys of their entries.

use holonom::model::{Bar, Beam, Body, Key, Keys, Kind, Point, Table, Value, constraints, drives, forces, joints};

/// Sections of named entries.
pub const SECTIONS: [&str; 8] = ["point", "body", "bar", "beam", "joint", "constraint", "drive", "force"];

/// What `type` of an entry says.
pub fn kind(entry: &Table) -> &str {
    match entry.get("type") {
        Some(Value::Text(kind)) => kind,
        _ => "",
    }
}

/// The keys that an entry of a section may have, beside `type` and `repeat`.
pub fn keys(section: &str, entry: &Table) -> &'static [Key] {
    let find = |kinds: Vec<&'static Kind>| {
        let found = kinds.into_iter().find(|known| known.name == kind(entry));
        found.unwrap_or_else(|| panic!("there is no {section} of type {}", kind(entry))).keys
    };
    match section {
        "point" => Point::KEYS,
        "body" => Body::KEYS,
        "bar" => Bar::KEYS,
        "beam" => Beam::KEYS,
        "joint" => find(joints::kinds().collect()),
        "constraint" => find(constraints::KINDS.iter().collect()),
        "drive" => find(drives::KINDS.iter().collect()),
        _ => find(forces::KINDS.iter().collect()),
    }
}

/// The table at a key, or an empty one.
pub fn table(of: &Table, key: &str) -> Table {
    match of.get(key) {
        Some(Value::Table(table)) => table.clone(),
        _ => Table::default(),
    }
}

/// All entries: section, name and keys.
pub fn entries(description: &Table) -> Vec<(&'static str, String, Table)> {
    let of = |section: &'static str| {
        let table = table(description, section);
        let entry = |(name, value): (&str, &Value)| match value {
            Value::Table(entry) => (section, name.to_string(), entry.clone()),
            _ => panic!("{section}.{name} is no table"),
        };
        table.iter().map(entry).collect::<Vec<_>>()
    };
    SECTIONS.into_iter().flat_map(of).collect()
}

/// The description with its sections made of these entries, in their order.
pub fn with_entries(description: &Table, entries: impl IntoIterator<Item = (&'static str, String, Table)>) -> Table {
    let mut out: Table = description.iter().filter(|(key, _)| !SECTIONS.contains(key)).map(|(key, value)| (key, value.clone())).collect();
    for (section, name, entry) in entries {
        if out.get(section).is_none() {
            out.push(section, Value::Table(Table::default()));
        }
        let Some(Value::Table(table)) = out.get_mut(section) else { unreachable!("it was put there as a table") };
        table.push(name, Value::Table(entry));
    }
    out
}

/// Numbers as a list.
pub fn list(numbers: &[f64]) -> Value {
    Value::List(numbers.iter().map(|&number| Value::Number(number)).collect())
}

/// The number of a value that is one.
pub fn number(value: &Value) -> f64 {
    match value {
        Value::Number(number) => *number,
        other => panic!("{} is no number", other.quoted()),
    }
}

/// The items of a list.
pub fn items(value: &Value) -> &[Value] {
    match value {
        Value::List(items) => items,
        other => panic!("{} is no list", other.quoted()),
    }
}

/// The numbers of a list.
pub fn numbers(value: &Value) -> Vec<f64> {
    items(value).iter().map(number).collect()
}
