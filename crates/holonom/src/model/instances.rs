//! What the entries of a section make: one each, or as many as their repetition says.

use std::collections::HashSet;

use super::compile::Compiler;
use super::entries::{Entries, Named};
use super::entry::{Entry, Written};
use super::expression::Scope;
use super::fault::Read;
use super::repeat::Repetition;
use super::value::{Value, key_path};

impl Compiler<'_> {
    /// Calls `each` for all that the entries of a section make. Hands back the names of those in which something was wrong.
    pub(super) fn each<T: Written>(
        &self,
        section: &str,
        entries: &Entries<T>,
        each: impl FnMut(&Entry<'_>, &T) -> Read<()>,
    ) -> HashSet<String> {
        self.each_of(section, entries.iter(), each)
    }

    /// The same for some of the entries of a section.
    pub(super) fn each_of<'e, T: Written + 'e>(
        &self,
        section: &str,
        entries: impl Iterator<Item = &'e Named<T>>,
        mut each: impl FnMut(&Entry<'_>, &T) -> Read<()>,
    ) -> HashSet<String> {
        let mut faulty = HashSet::new();
        for named in entries {
            if self.instances(section, named, &mut each).is_err() {
                faulty.insert(named.name.clone());
            }
        }
        faulty
    }

    /// Calls `each` for what an entry makes, up to the first in which something is wrong: the others would repeat it.
    pub(super) fn instances<T: Written>(
        &self,
        section: &str,
        named: &Named<T>,
        each: &mut impl FnMut(&Entry<'_>, &T) -> Read<()>,
    ) -> Read<()> {
        let path = key_path(section, &named.name);
        let written = Repeated { written: &named.entry, repeat: named.repeat.as_deref() };
        let entry = self.entry(&named.name, &path, &written);
        let Some(text) = &named.repeat else { return each(&entry, &named.entry) };
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
            each(&Entry { name: &name, scope: Scope { indices: &indices, ..entry.scope }, ..entry }, &named.entry)?;
        }
        Ok(())
    }
}

/// An entry with its repetition.
struct Repeated<'a> {
    written: &'a dyn Written,
    repeat: Option<&'a str>,
}

impl Written for Repeated<'_> {
    fn value(&self, key: &str) -> Option<Value> {
        match key {
            "repeat" => self.repeat.map(Value::text),
            _ => self.written.value(key),
        }
    }
}
