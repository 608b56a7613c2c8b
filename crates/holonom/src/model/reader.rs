//! Tables of a file while the structs of a description are read from them.

use std::ops::Deref;

use super::bodies::NoFiles;
use super::entry::{Entry, Spot};
use super::expression::Scope;
use super::fault::{Fault, Read, Sink, suggest};
use super::fields::{Field, Keys};
use super::key::Key;
use super::value::{Table, Value, key_path};

/// Keys of a model that are no tables: behind the head of a table a file gives them to that.
const OF_MODEL: [&str; 4] = ["schema", "title", "plane", "gravity"];

/// A table while it is read, and where its faults go.
#[derive(Clone, Copy)]
pub struct Reader<'a> {
    /// Its keys, as far as they are written.
    pub table: &'a Table,
    entry: Entry<'a>,
}

impl<'a> Deref for Reader<'a> {
    type Target = Entry<'a>;

    fn deref(&self) -> &Entry<'a> {
        &self.entry
    }
}

impl<'a> Reader<'a> {
    /// A table called `name` that stands at `path`.
    pub(super) fn new(name: &'a str, path: &'a str, table: &'a Table, sink: &'a Sink) -> Self {
        Self { table, entry: Entry { name, path, written: table, scope: Scope::default(), sink, files: &NoFiles } }
    }

    /// The value of a key that must be there.
    ///
    /// # Errors
    /// A key that is missing, or a value of another shape; the fault is recorded.
    pub fn must_have<T: Field>(&self, key: &str) -> Read<T> {
        self.may_have(key)?.ok_or_else(|| self.missing(key))
    }

    /// The value of a key that may be left out.
    ///
    /// # Errors
    /// A value of another shape; the fault is recorded.
    pub fn may_have<T: Field>(&self, key: &str) -> Read<Option<T>> {
        self.table.get(key).map(|value| T::read(self, key.into(), value)).transpose()
    }

    /// Records every key that is not among the known ones.
    pub(super) fn refuse_unknown_keys<'k>(&self, what: &str, known: impl Iterator<Item = &'k Key> + Clone) {
        self.refuse_keys_but(what, known, |_| None);
    }

    /// The same, where there is another cure for some of them.
    pub(super) fn refuse_keys_but<'k>(
        &self,
        what: &str,
        known: impl Iterator<Item = &'k Key> + Clone,
        cure: impl Fn(&str) -> Option<String>,
    ) {
        for key in self.table.keys() {
            if self.sink.is_full() {
                // What is not shown need not be put into words.
                self.sink.report(|| unreachable!("a full sink makes no fault"));
            } else if !known.clone().any(|known| known.name == key) {
                let of_model = || OF_MODEL.contains(&key).then(|| "it is a key of the model: write it above the first table".to_string());
                let cure = cure(key).or_else(of_model).unwrap_or_else(|| suggest(key, known.clone().map(|known| known.name)));
                let fault =
                    || Fault { on_key: true, ..Fault::new(key_path(self.path, key), key, format!("{what} has no key `{key}`"), cure) };
                self.sink.report(fault);
            }
        }
    }
}

impl Entry<'_> {
    /// Reads a table inside of this one, which messages call `what`.
    ///
    /// # Errors
    /// What is missing in it or of another shape; the faults are recorded.
    pub fn read_inside<T: Keys>(&self, what: &str, spot: Spot<'_>, table: &Table) -> Read<T> {
        let path = self.path_of(spot);
        let inner = Reader { table, entry: Entry { path: &path, written: table, ..*self } };
        inner.refuse_unknown_keys(what, T::KEYS.iter());
        T::read(&inner)
    }

    /// Refuses a value that is no table.
    pub fn refuse_no_table(&self, spot: Spot<'_>, value: &Value) -> super::Refused {
        self.wanted(spot, "a table", value)
    }
}
