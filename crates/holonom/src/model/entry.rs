//! Typed access to the keys of one table of a model. What cannot be read is recorded as a fault.
//!
//! Every reader hands back `Err(Refused)` after recording why, so that a kind first reads all its keys and only then
//! asks which of them there are: one look at a file finds everything.

use super::bodies::Meshes;
use super::expression::{Mistake, Program, Scope};
use super::fault::{Fault, Read, Refused, Sink, suggest};
use super::key::Key;
use super::value::{Table, Value, item_path, key_path};

/// A key of an entry, or an item of the list there.
#[derive(Clone, Copy, Debug)]
pub struct Spot<'a> {
    pub key: &'a str,
    pub item: Option<usize>,
}

impl<'a> From<&'a str> for Spot<'a> {
    fn from(key: &'a str) -> Self {
        Self { key, item: None }
    }
}

/// One table while it is read: an entry of the file, or one of its repetitions.
#[derive(Clone, Copy)]
pub struct Entry<'a> {
    /// The name with its indices, e.g. `P[3]`.
    pub name: &'a str,
    /// Where the table is in the description, e.g. `point.P`.
    pub path: &'a str,
    pub table: &'a Table,
    pub scope: Scope<'a>,
    pub sink: &'a Sink,
    pub meshes: &'a dyn Meshes,
}

impl<'a> Entry<'a> {
    /// Whether a key is there.
    pub fn has(&self, key: &str) -> bool {
        self.table.get(key).is_some()
    }

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

    /// Records a mistake in an expression, unless it only follows from another fault.
    pub fn mistaken(&self, spot: Spot<'_>, mistake: Mistake) -> Refused {
        if mistake.known {
            return Refused;
        }
        self.fault(spot, Some(mistake.character), mistake.message, mistake.cure)
    }

    fn fault(&self, spot: Spot<'_>, character: Option<usize>, message: String, cure: String) -> Refused {
        let value = self.table.get(spot.key);
        let value = match (value, spot.item) {
            (Some(Value::List(items)), Some(k)) => items.get(k),
            (value, _) => value,
        };
        let path = key_path(self.path, spot.key);
        let path = spot.item.map_or(path.clone(), |k| item_path(&path, k));
        let offending = value.map_or_else(|| spot.key.to_string(), Value::quoted);
        self.sink.report(|| Fault { character, ..Fault::new(path, offending, self.told(message), cure) })
    }

    /// Of an entry that is one of many, the message also says which.
    fn told(&self, message: String) -> String {
        if self.scope.indices.is_empty() { message } else { format!("{message}, in `{}`", self.name) }
    }

    /// Records every key that no table knows.
    pub fn refuse_unknown_keys(&self, what: &str, keys: &[&Key]) {
        for key in self.table.keys() {
            if self.sink.is_full() {
                // What is not shown need not be put into words.
                self.sink.report(|| unreachable!("a full sink makes no fault"));
            } else if !keys.iter().any(|known| known.name == key) {
                let cure = suggest(key, keys.iter().map(|known| known.name));
                let fault =
                    || Fault { on_key: true, ..Fault::new(key_path(self.path, key), key, format!("{what} has no key `{key}`"), cure) };
                self.sink.report(fault);
            }
        }
    }

    pub(super) fn missing(&self, key: &str) -> Refused {
        let message = if self.name.is_empty() { format!("`{key}` is missing") } else { format!("`{}` has no `{key}`", self.name) };
        self.sink.report(|| Fault::new(self.path, self.name, message, format!("add {key} = …")))
    }

    pub(super) fn wanted(&self, spot: Spot<'_>, what: &str, value: &Value) -> Refused {
        let cure = match what {
            "a number" => "write a number such as 1.5, or an expression in quotes",
            "true or false" => "write true or false, without quotes",
            "a text" | "texts" => "put it in quotes",
            "a list" => "put the items in square brackets, with commas between them",
            _ => "write its keys in braces, or below a line with its name in square brackets",
        };
        self.refuse(spot, format!("`{}` wants {what}, and this is {}", spot.key, value.type_name()), cure)
    }

    /// A value that must be there.
    pub fn value(&self, key: &str) -> Read<&'a Value> {
        self.table.get(key).ok_or_else(|| self.missing(key))
    }

    /// Reads a key with one of the readers below, if it is there.
    pub fn optional<T>(&self, key: &str, read: impl FnOnce(&Self, &str) -> Read<T>) -> Read<Option<T>> {
        if self.has(key) { read(self, key).map(Some) } else { Ok(None) }
    }

    /// A finite number.
    pub fn number(&self, key: &str) -> Read<f64> {
        self.number_in(key.into(), self.value(key)?)
    }

    /// A number of at least zero.
    pub fn not_negative(&self, key: &str) -> Read<f64> {
        let number = self.number(key)?;
        if number >= 0.0 { Ok(number) } else { Err(self.refuse(key, format!("`{key}` is negative: {number}"), "it must be at least 0")) }
    }

    /// A number above zero.
    pub fn positive(&self, key: &str) -> Read<f64> {
        let number = self.number(key)?;
        if number > 0.0 {
            Ok(number)
        } else {
            Err(self.refuse(key, format!("`{key}` is {number}, and must be above 0"), "give a number above 0"))
        }
    }

    /// A whole number of at least `least`.
    pub fn whole(&self, key: &str, least: u32) -> Read<u32> {
        let number = self.number(key)?;
        if number.fract() == 0.0 && number >= f64::from(least) && number <= f64::from(u32::MAX) {
            return Ok(number as u32);
        }
        Err(self.refuse(
            key,
            format!("`{key}` wants a whole number of at least {least}, and this is {number}"),
            format!("write {key} = {}, or more", least.max(1)),
        ))
    }

    /// A finite number from a number or an expression.
    pub fn number_in(&self, spot: Spot<'_>, value: &Value) -> Read<f64> {
        let number = match value {
            Value::Number(number) => *number,
            Value::Text(text) => {
                let program = Program::parse(text, &[], &self.scope).map_err(|mistake| self.mistaken(spot, mistake))?;
                program.as_constant().expect("an expression without variables is a constant")
            }
            other => return Err(self.wanted(spot, "a number", other)),
        };
        if number.is_finite() {
            return Ok(number);
        }
        let message = if number.is_nan() { "this is not a number (NaN)" } else { "this number is infinite" };
        let cure = match value {
            Value::Text(_) => "every number must be finite: look for a division by zero, or a function where it has no value",
            _ => "every number must be finite",
        };
        Err(self.refuse(spot, message, cure))
    }

    /// True or false.
    pub fn flag(&self, key: &str) -> Read<bool> {
        match self.value(key)? {
            Value::Bool(flag) => Ok(*flag),
            other => Err(self.wanted(key.into(), "true or false", other)),
        }
    }

    /// A text.
    pub fn text(&self, key: &str) -> Read<&'a str> {
        match self.value(key)? {
            Value::Text(text) => Ok(text),
            other => Err(self.wanted(key.into(), "a text", other)),
        }
    }

    /// One of some words.
    pub fn choice(&self, key: &str, words: &[&'static str]) -> Read<&'static str> {
        self.choice_of(key, self.text(key)?, words)
    }

    /// The items of a list.
    pub fn list(&self, key: &str) -> Read<&'a [Value]> {
        match self.value(key)? {
            Value::List(items) => Ok(items),
            other => Err(self.wanted(key.into(), "a list", other)),
        }
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Read<Vec<&'a str>> {
        let read = |(k, item): (usize, &'a Value)| match item {
            Value::Text(text) => Ok(text.as_str()),
            other => Err(self.wanted(Spot { key, item: Some(k) }, "texts", other)),
        };
        all(self.list(key)?.iter().enumerate().map(read))
    }

    /// A vector in space, a number about the normal in the plane.
    pub fn spin(&self, key: &str, dim: usize) -> Read<[f64; 3]> {
        if dim == 2 { self.number(key).map(|rate| [0.0, 0.0, rate]) } else { self.vector(key, 3) }
    }

    /// So many numbers above zero.
    pub fn sizes<const N: usize>(&self, key: &str) -> Read<[f64; N]> {
        let items = self.list(key)?;
        if items.len() != N {
            return Err(self.refuse(key, format!("`{key}` wants {N} numbers, and this has {}", items.len()), format!("give {N} numbers")));
        }
        let size = |(k, item)| {
            let spot = Spot { key, item: Some(k) };
            let size = self.number_in(spot, item)?;
            if size > 0.0 { Ok(size) } else { Err(self.refuse(spot, format!("`{key}` has a size of {size}"), "give sizes above 0")) }
        };
        let sizes = all(items.iter().enumerate().map(size))?;
        Ok(std::array::from_fn(|k| sizes[k]))
    }

    /// The tables of a list.
    pub fn tables(&self, key: &str) -> Read<Vec<&'a Table>> {
        let read = |(k, item): (usize, &'a Value)| match item {
            Value::Table(table) => Ok(table),
            other => Err(self.wanted(Spot { key, item: Some(k) }, "a table", other)),
        };
        all(self.list(key)?.iter().enumerate().map(read))
    }

    /// Reads a table inside this one, which is at `key`.
    pub fn inside<T>(&self, key: &str, table: &'a Table, read: impl FnOnce(&Entry<'_>) -> Read<T>) -> Read<T> {
        let path = format!("{}.{key}", self.path);
        read(&Entry { name: self.name, path: &path, table, ..*self })
    }

    /// The same of a table at a key or in a list there.
    pub(super) fn inside_at<T>(&self, spot: Spot<'_>, table: &'a Table, read: impl FnOnce(&Entry<'_>) -> T) -> T {
        let path = key_path(self.path, spot.key);
        let path = spot.item.map_or(path.clone(), |k| item_path(&path, k));
        read(&Entry { name: self.name, path: &path, table, ..*self })
    }

    /// What is said of a table inside of this one, at a key or in a list there.
    pub fn within<T>(&self, spot: Spot<'_>, read: impl FnOnce(&Entry<'_>) -> T) -> T {
        let value = match (self.table.get(spot.key), spot.item) {
            (Some(Value::List(items)), Some(k)) => items.get(k),
            (value, _) => value,
        };
        match value {
            Some(Value::Table(table)) => self.inside_at(spot, table, read),
            _ => unreachable!("a table was read there"),
        }
    }

    /// A table inside this one.
    pub fn table(&self, key: &str) -> Read<&'a Table> {
        match self.value(key)? {
            Value::Table(table) => Ok(table),
            other => Err(self.wanted(key.into(), "a table", other)),
        }
    }

    /// `size` finite numbers, zeros behind them.
    pub fn vector(&self, key: &str, size: usize) -> Read<[f64; 3]> {
        let items = self.sized(key, size, "numbers")?;
        self.numbers(key, items)
    }

    /// At most three finite numbers, zeros behind them.
    pub fn numbers(&self, key: &str, items: &[Value]) -> Read<[f64; 3]> {
        let numbers = all(items.iter().enumerate().map(|(k, item)| self.number_in(Spot { key, item: Some(k) }, item)))?;
        Ok(std::array::from_fn(|k| numbers.get(k).copied().unwrap_or(0.0)))
    }

    fn sized(&self, key: &str, size: usize, what: &str) -> Read<&'a [Value]> {
        let items = self.list(key)?;
        if items.len() == size {
            return Ok(items);
        }
        let kind = if size == 2 { "a planar model" } else { "a model in space" };
        Err(self.refuse(
            key,
            format!("`{key}` wants {size} {what} in {kind}, and this has {}", items.len()),
            "give one for each axis of the model",
        ))
    }

    /// A formula of some variables.
    pub fn formula(&self, key: &str, variables: &[&str]) -> Read<Program> {
        self.formula_in(key.into(), self.value(key)?, variables)
    }

    /// `size` formulas of some variables.
    pub fn formulas(&self, key: &str, size: usize, variables: &[&str]) -> Read<Vec<Program>> {
        let items = self.sized(key, size, "numbers or formulas")?;
        all(items.iter().enumerate().map(|(k, item)| self.formula_in(Spot { key, item: Some(k) }, item, variables)))
    }

    pub(super) fn formula_in(&self, spot: Spot<'_>, value: &Value, variables: &[&str]) -> Read<Program> {
        match value {
            Value::Text(text) => {
                let program = Program::parse(text, variables, &self.scope).map_err(|mistake| self.mistaken(spot, mistake))?;
                match program.as_constant() {
                    Some(_) => self.number_in(spot, value).map(Program::constant),
                    None => {
                        if let Some(t) = variables.iter().position(|name| *name == "t") {
                            self.sink.switches.borrow_mut().extend(program.switches(t));
                        }
                        Ok(program)
                    }
                }
            }
            _ => self.number_in(spot, value).map(Program::constant),
        }
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
