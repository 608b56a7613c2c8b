//! A model as it was written: numbers, texts and tables, without places in a file and without meaning.

use std::collections::HashMap;

/// One value of a description.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Whole numbers, too.
    Number(f64),
    /// A name, a word or a formula.
    Text(String),
    /// `true` or `false`.
    Bool(bool),
    /// In square brackets, values of any sort.
    List(Vec<Value>),
    /// A section, or keys in braces.
    Table(Table),
}

/// Keys and values in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Table {
    entries: Vec<(String, Value)>,
    /// Where the keys are, kept for large tables only.
    index: HashMap<String, usize>,
}

/// Keys from which on a table is searched by its index.
const INDEXED: usize = 32;

/// Longest text quoted in a message, characters.
const QUOTED: usize = 60;

impl Value {
    /// A text value.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// The type as messages call it, e.g. `a text`.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Text(_) => "a text",
            Self::Bool(_) => "true or false",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }

    /// The value as a person would write it, shortened for messages.
    pub fn quoted(&self) -> String {
        let mut out = String::new();
        self.write(&mut out);
        match out.char_indices().nth(QUOTED) {
            Some((cut, _)) => format!("{}…", &out[..cut]),
            None => out,
        }
    }

    /// Writes values until `out` is longer than any quotation needs to be.
    fn write(&self, out: &mut String) {
        use std::fmt::Write;
        if out.len() > 4 * QUOTED {
            return;
        }
        match self {
            Self::Number(number) => write!(out, "{number}").expect("a String takes everything"),
            Self::Text(text) => {
                out.push('"');
                out.extend(text.chars().take(QUOTED + 1));
                out.push('"');
            }
            Self::Bool(flag) => out.push_str(if *flag { "true" } else { "false" }),
            Self::List(items) => {
                out.push('[');
                for (k, item) in items.iter().take(QUOTED).enumerate() {
                    out.push_str(if k > 0 { ", " } else { "" });
                    item.write(out);
                }
                out.push(']');
            }
            Self::Table(_) => out.push_str("{…}"),
        }
    }
}

impl Table {
    /// Adds a key, which must not be there yet.
    pub fn push(&mut self, key: impl Into<String>, value: Value) {
        self.entries.push((key.into(), value));
        let last = self.entries.len() - 1;
        let unindexed = if last < INDEXED { last + 1..last + 1 } else { self.index.len()..last + 1 };
        for k in unindexed {
            self.index.insert(self.entries[k].0.clone(), k);
        }
    }

    fn find(&self, key: &str) -> Option<usize> {
        match self.entries.len() <= INDEXED {
            true => self.entries.iter().position(|(name, _)| name == key),
            false => self.index.get(key).copied(),
        }
    }

    /// Replaces the value of a key, or adds it.
    pub fn set(&mut self, key: &str, value: Value) {
        match self.get_mut(key) {
            Some(old) => *old = value,
            None => self.push(key, value),
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.find(key).map(|k| &self.entries[k].1)
    }

    /// The value of a key, to be changed.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Value> {
        self.find(key).map(|k| &mut self.entries[k].1)
    }

    /// Keys and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.entries.iter().map(|(key, value)| (key.as_str(), value))
    }

    /// Keys in order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(key, _)| key.as_str())
    }

    /// Number of keys.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are no keys.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

impl<K: Into<String>> FromIterator<(K, Value)> for Table {
    fn from_iter<I: IntoIterator<Item = (K, Value)>>(entries: I) -> Self {
        let mut table = Self::default();
        entries.into_iter().for_each(|(key, value)| table.push(key, value));
        table
    }
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        self.entries == other.entries
    }
}

/// The path of a key in a table, e.g. `point.m1`; a key that would not be read back as one is put in quotes.
pub fn key_path(table: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_string() } else { format!("{key:?}") };
    if table.is_empty() { key } else { format!("{table}.{key}") }
}

/// The path of an item of a list, e.g. `point.m1.position[0]`.
pub fn item_path(list: &str, index: usize) -> String {
    format!("{list}[{index}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_and_large_tables_find_their_keys() {
        for size in [3, INDEXED, INDEXED + 1, 1000] {
            let mut table: Table = (0..size).map(|k| (format!("k{k}"), Value::Number(k as f64))).collect();
            table.set("k1", Value::Bool(true));
            table.set("new", Value::Bool(false));
            assert_eq!(table.get("k1"), Some(&Value::Bool(true)));
            assert_eq!(table.get(&format!("k{}", size - 1)), Some(&Value::Number(size as f64 - 1.0)));
            assert_eq!((table.get("new"), table.get("none"), table.len()), (Some(&Value::Bool(false)), None, size + 1));
        }
    }

    #[test]
    fn quotations_are_short() {
        let deep = Value::List(vec![Value::text("x".repeat(1000)); 1000]);
        assert_eq!(deep.quoted().chars().count(), QUOTED + 1);
        assert_eq!(Value::List(vec![Value::Number(0.1), Value::text("a")]).quoted(), "[0.1, \"a\"]");
        assert_eq!(item_path(&key_path("point.P", "a b"), 2), "point.P.\"a b\"[2]");
    }
}
