//! An entry of a model while it is read and compiled: where it is, what it may name, and where its faults go.
//!
//! Every reader hands back `Err(Refused)` after recording why, so that a kind first reads all its keys and only then
//! asks which of them there are: one look at a model finds everything.

use super::bodies::Files;
use super::expression::{Mistake, Scope, names_in};
use super::fault::{Fault, Read, Refused, Sink, suggest};
use super::key::REPEAT;
use super::value::{Table, Value, item_path, key_path};

/// A key of an entry, or an item of the list there.
#[derive(Clone, Copy, Debug)]
pub struct Spot<'a> {
    /// The key in the table of the entry.
    pub key: &'a str,
    /// Which item of the list there; `None` for the value as a whole.
    pub item: Option<usize>,
}

impl<'a> From<&'a str> for Spot<'a> {
    fn from(key: &'a str) -> Self {
        Self { key, item: None }
    }
}

/// What is written in a table, for messages.
pub trait Written {
    /// The value of a key as it would be written, if it is there.
    fn value(&self, key: &str) -> Option<Value>;
}

impl Written for Table {
    fn value(&self, key: &str) -> Option<Value> {
        self.get(key).cloned()
    }
}

/// An entry of the model, one of its repetitions, or a table inside of it.
#[derive(Clone, Copy)]
pub struct Entry<'a> {
    /// The name with its indices, e.g. `P[3]`.
    pub name: &'a str,
    /// Where the table is in the description, e.g. `point.P`.
    pub path: &'a str,
    /// What stands at its keys, to be quoted in faults.
    pub written: &'a dyn Written,
    pub(super) scope: Scope<'a>,
    pub(super) sink: &'a Sink,
    pub(super) files: &'a dyn Files,
}

impl<'a> Entry<'a> {
    /// Records a fault at a key or an item of its list.
    pub fn refuse<'s>(&self, spot: impl Into<Spot<'s>>, message: impl Into<String>, cure: impl Into<String>) -> Refused {
        let spot = spot.into();
        self.fault(spot, None, message.into(), cure.into())
    }

    /// Records a fault of a key itself, and not of its value.
    pub fn refuse_key(&self, key: &str, message: impl Into<String>, cure: impl Into<String>) -> Refused {
        let fault = || Fault { on_key: true, ..Fault::new(key_path(self.path, key), key, self.told(message.into()), cure) };
        self.sink.report(fault)
    }

    /// Records a fault of the entry as a whole.
    pub fn refuse_all(&self, message: impl Into<String>, cure: impl Into<String>) -> Refused {
        self.sink.report(|| Fault::new(self.path, self.name, self.told(message.into()), cure))
    }

    /// Records a `type` that a planar model does not have.
    pub(super) fn refuse_in_plane(&self, section: &str, name: &str, cure: &str) -> Refused {
        self.refuse("type", format!("there is no {name} {section} in a planar model"), cure)
    }

    /// Records what looks like a slip and is taken all the same; of an entry that is repeated for the first alone.
    pub fn note<'s>(&self, spot: impl Into<Spot<'s>>, message: impl Into<String>) {
        self.sink.note(&self.path_of(spot.into()), || self.told(message.into()));
    }

    /// Whether the number at a key, or the k-th of the list there, is written as a formula of the unit `deg`, or of parameters that are.
    pub(super) fn is_in_degrees(&self, key: &str, k: usize) -> bool {
        let is_one = |name: &String| name == "deg" || self.scope.degrees.is_some_and(|degrees| degrees.contains(name));
        let is_of_degrees = |value: &Value| matches!(value, Value::Text(text) if names_in(text).iter().any(is_one));
        match self.written.value(key) {
            Some(Value::List(items)) => items.get(k).is_some_and(is_of_degrees),
            value => value.is_some_and(|value| is_of_degrees(&value)),
        }
    }

    /// Whether something in it was wrong.
    pub fn has_fault(&self) -> bool {
        self.sink.has_fault_in(self.path)
    }

    /// Records a mistake in an expression, unless it only follows from another fault.
    pub fn mistaken(&self, spot: Spot<'_>, mistake: Mistake) -> Refused {
        if mistake.known {
            return Refused;
        }
        self.fault(spot, Some(mistake.character), mistake.message, mistake.cure)
    }

    /// The path of a key, or of an item of the list there.
    pub(super) fn path_of(&self, spot: Spot<'_>) -> String {
        let path = key_path(self.path, spot.key);
        match spot.item {
            Some(k) => item_path(&path, k),
            None => path,
        }
    }

    fn fault(&self, spot: Spot<'_>, character: Option<usize>, message: String, cure: String) -> Refused {
        let value = match (self.written.value(spot.key), spot.item) {
            (Some(Value::List(mut items)), Some(k)) => (k < items.len()).then(|| items.swap_remove(k)),
            (value, _) => value,
        };
        let path = self.path_of(spot);
        let offending = value.map_or_else(|| spot.key.to_string(), |value| value.quoted());
        self.sink.report(|| Fault { character, ..Fault::new(path, offending, self.told(message), cure) })
    }

    /// Of an entry that is one of many, the message also says which.
    pub(super) fn told(&self, message: String) -> String {
        if self.scope.indices.is_empty() { message } else { format!("{message}, in `{}`", self.name) }
    }

    pub(super) fn missing(&self, key: &str) -> Refused {
        if self.sink.has_taken_for(self.path, key) {
            return Refused;
        }
        let message = if self.name.is_empty() { format!("`{key}` is missing") } else { format!("`{}` has no `{key}`", self.name) };
        self.sink.report(|| Fault::new(self.path, self.name, message, format!("add {key} = …")))
    }

    pub(super) fn wanted(&self, spot: Spot<'_>, what: &str, value: &Value) -> Refused {
        let cure = match what {
            "a number" => "write a number such as 1.5, or an expression in quotes",
            "true or false" => "write true or false, without quotes",
            "a text" if spot.key == REPEAT.name => "write an index and its range, such as repeat = \"i = 1 to 4\"",
            "a text" | "texts" => "put it in quotes",
            "a list" | "a list of three numbers, or in a planar model one number" => {
                "put the items in square brackets, with commas between them"
            }
            _ => "write its keys in braces, or below a line with its name in square brackets",
        };
        self.refuse(spot, format!("`{}` wants {what}, and this is {}", spot.key, value.type_name()), cure)
    }

    /// Evaluates the value of a key, if it is there.
    pub fn optional<'k, T, U>(&self, key: &'k str, value: &Option<T>, read: impl FnOnce(&T, &Self, &'k str) -> Read<U>) -> Read<Option<U>> {
        value.as_ref().map(|value| read(value, self, key)).transpose()
    }

    /// The value of a key that may be left out in general, and not here.
    pub fn needed<'v, T>(&self, key: &str, value: &'v Option<T>) -> Read<&'v T> {
        value.as_ref().ok_or_else(|| self.missing(key))
    }

    /// The word that a text is, which must be one of some.
    pub fn choice(&self, key: &str, text: &str, words: &[&'static str]) -> Read<&'static str> {
        let word = words.iter().copied().find(|&word| word == text);
        word.ok_or_else(|| self.refuse(key, format!("`{key}` cannot be \"{text}\""), suggest(text, words.iter().copied())))
    }

    /// What is said of a table inside of this one, at a key or in a list there.
    pub fn within<'s, T>(&self, at: impl Into<Spot<'s>>, written: &dyn Written, read: impl FnOnce(&Entry<'_>) -> T) -> T {
        let path = self.path_of(at.into());
        read(&Entry { path: &path, written, ..*self })
    }
}

/// All values, or a refusal after every one of them has been read.
pub fn all<T>(values: impl Iterator<Item = Read<T>>) -> Read<Vec<T>> {
    let (mut read, mut refused) = (Vec::new(), None);
    for value in values {
        match value {
            Ok(value) => read.push(value),
            Err(fault) => refused = Some(fault),
        }
    }
    refused.map_or(Ok(read), Err)
}
