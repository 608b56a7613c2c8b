//! Sections of named entries, `[point.P]`, `[bar.b]`, …: names, repetitions, and one call for each entry they make.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use super::assembly::GROUND;
use super::bodies::Meshes;
use super::entry::Entry;
use super::expression::{Scope, Value as Known};
use super::fault::{Fault, Read, Refused, Sink};
use super::repeat::{self, Repetition};
use super::value::{Table, Value, key_path};

/// What all sections of a model share.
pub struct Sections<'a> {
    pub sink: &'a Sink,
    pub meshes: &'a dyn Meshes,
    pub parameters: &'a HashMap<String, Known>,
    /// Names so far: they are unique over all sections.
    names: HashSet<String>,
    /// Entries that repetitions may still make.
    room: Cell<usize>,
}

impl<'a> Sections<'a> {
    /// Nothing read so far.
    pub fn new(sink: &'a Sink, meshes: &'a dyn Meshes, parameters: &'a HashMap<String, Known>) -> Self {
        Self { sink, meshes, parameters, names: HashSet::new(), room: Cell::new(repeat::MOST) }
    }

    /// Goes through the entries of a section. `check` sees each table once, `each` all that a repetition makes of it.
    /// Hands back the names of entries in which something was wrong.
    pub fn read(
        &mut self,
        root: &Table,
        section: &str,
        mut check: impl FnMut(&Entry<'_>) -> Read<()>,
        mut each: impl FnMut(&Entry<'_>) -> Read<()>,
    ) -> HashSet<String> {
        let mut faulty = HashSet::new();
        let entries = match root.get(section) {
            None => return faulty,
            Some(Value::Table(entries)) => entries,
            Some(other) => {
                let message = format!("`{section}` is {}, and a table of named entries is wanted", other.type_name());
                self.sink.report(|| Fault::new(section, other.quoted(), message, format!("write [{section}.NAME]")));
                faulty.insert(section.to_string());
                return faulty;
            }
        };
        for (name, value) in entries.iter() {
            let path = key_path(section, name);
            let valid = self.check_name(&path, name);
            let Value::Table(table) = value else {
                let message = format!("`{path}` is {}, and a table is wanted", value.type_name());
                self.sink.report(|| Fault::new(&*path, value.quoted(), message, format!("write [{section}.NAME] and its keys below")));
                faulty.insert(name.to_string());
                continue;
            };
            let scope = Scope { parameters: Some(self.parameters), indices: &[] };
            let entry = Entry { name, path: &path, table, scope, sink: self.sink, meshes: self.meshes };
            let checked = check(&entry);
            if valid.and(checked).and(self.instances(&entry, &mut each)).is_err() {
                faulty.insert(name.to_string());
            }
        }
        faulty
    }

    /// Calls `each` for what an entry makes, up to the first in which something is wrong: the others would repeat it.
    fn instances(&self, entry: &Entry<'_>, each: &mut impl FnMut(&Entry<'_>) -> Read<()>) -> Read<()> {
        if !entry.has("repeat") {
            return each(entry);
        }
        let text = entry.text("repeat")?;
        let repetition =
            Repetition::read(text, &entry.scope, self.room.get()).map_err(|mistake| entry.mistaken("repeat".into(), mistake))?;
        self.room.set(self.room.get().saturating_sub(repetition.len()));
        let mut indices: Vec<(String, f64)> = repetition.names.iter().map(|name| (name.clone(), 0.0)).collect();
        let mut name = String::new();
        for values in repetition.iter() {
            name.clear();
            name.push_str(entry.name);
            for (index, &value) in indices.iter_mut().zip(values) {
                index.1 = value;
                name.push_str(&format!("[{value}]"));
            }
            each(&Entry { name: &name, scope: Scope { indices: &indices, ..entry.scope }, ..*entry })?;
        }
        Ok(())
    }

    fn check_name(&mut self, path: &str, name: &str) -> Read<()> {
        let report = |message: String, cure: &str| -> Refused { self.sink.report(|| Fault::new(path, name, message, cure)) };
        if name == GROUND {
            return Err(report(format!("`{GROUND}` is the name of the origin"), "give it another name"));
        }
        if name.is_empty() || !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
            return Err(report(format!("\"{name}\" cannot be a name"), "use letters, digits, _ and -"));
        }
        if !self.names.insert(name.to_string()) {
            return Err(report(
                format!("the name `{name}` is used twice"),
                "give one of them another name: points, bars, bodies, constraints, joints, drives and forces share their names",
            ));
        }
        Ok(())
    }
}
