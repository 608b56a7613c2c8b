//! Entries of a description by name, and what repetitions make of them.

use super::value::Value;

/// Entries of one sort, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Entries<T>(Vec<Named<T>>);

/// An entry with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T> {
    /// As in `[section.NAME]`, unique among all sections.
    pub name: String,
    /// Makes `NAME[0]`, `NAME[1]`, …: `"i = 0 to N"`, also nested: `"i = 0 to N, j = 1 to M"`.
    pub repeat: Option<String>,
    /// What its table says.
    pub entry: T,
}

impl<T> Default for Entries<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Entries<T> {
    /// Adds an entry.
    pub fn add(&mut self, name: impl Into<String>, entry: impl Into<T>) -> &mut Named<T> {
        self.0.push(Named { name: name.into(), repeat: None, entry: entry.into() });
        self.0.last_mut().expect("it was just added")
    }

    /// Adds as many entries as a repetition has values of its indices.
    pub fn add_repeated(&mut self, name: impl Into<String>, repeat: impl Into<String>, entry: impl Into<T>) -> &mut Named<T> {
        let named = self.add(name, entry);
        named.repeat = Some(repeat.into());
        named
    }

    /// The entry of a name, to be changed.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut T> {
        self.0.iter_mut().find(|named| named.name == name).map(|named| &mut named.entry)
    }

    /// All in order.
    pub fn iter(&self) -> impl Iterator<Item = &Named<T>> {
        self.0.iter()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The table of all as it would be written, if there are any.
    pub(super) fn write(&self, of: impl Fn(&T) -> super::value::Table) -> Option<Value> {
        let table = |named: &Named<T>| {
            let mut table = of(&named.entry);
            if let Some(repeat) = &named.repeat {
                table.push("repeat", Value::text(repeat));
            }
            (named.name.clone(), Value::Table(table))
        };
        (!self.is_empty()).then(|| Value::Table(self.iter().map(table).collect()))
    }
}
