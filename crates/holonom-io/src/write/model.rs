//! Descriptions as text of a model file.

use std::fmt::Write;

use holonom::model::{Table, Value, key_path};

/// The text of a model file with this description: what is read from it is the same, to the bits of all numbers.
///
/// # Panics
/// When the description is no table.
pub fn model_text(description: &Value) -> String {
    let Value::Table(root) = description else { panic!("a description is a table") };
    let mut text = String::new();
    write_keys(&mut text, root.iter().filter(|(_, value)| !matches!(value, Value::Table(_))));
    for (section, value) in root.iter() {
        let Value::Table(table) = value else { continue };
        let is_of_entries = !table.is_empty() && table.iter().all(|(_, entry)| matches!(entry, Value::Table(_)));
        match is_of_entries {
            true => table.iter().for_each(|(name, entry)| write_table(&mut text, &key_path(section, name), entry)),
            false => write_table(&mut text, section, value),
        }
    }
    text
}

fn write_table(text: &mut String, path: &str, value: &Value) {
    let Value::Table(table) = value else { return };
    let gap = if text.is_empty() { "" } else { "\n" };
    writeln!(text, "{gap}[{path}]").expect("a String takes everything");
    write_keys(text, table.iter());
}

fn write_keys<'a>(text: &mut String, keys: impl Iterator<Item = (&'a str, &'a Value)>) {
    keys.for_each(|(key, value)| writeln!(text, "{} = {}", key_path("", key), inline(value)).expect("a String takes everything"));
}

/// Whole numbers from here on are not all different from each other.
const WHOLE: f64 = 9e15;

/// A value as it stands behind an equals sign.
fn inline(value: &Value) -> toml::Value {
    match value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() < WHOLE && !(*number == 0.0 && number.is_sign_negative()) => {
            toml::Value::Integer(*number as i64)
        }
        Value::Number(number) => toml::Value::Float(*number),
        Value::Text(text) => toml::Value::String(text.clone()),
        Value::Bool(flag) => toml::Value::Boolean(*flag),
        Value::List(items) => toml::Value::Array(items.iter().map(inline).collect()),
        Value::Table(table) => toml::Value::Table(inline_table(table)),
    }
}

fn inline_table(table: &Table) -> toml::Table {
    table.iter().map(|(key, value)| (key.to_string(), inline(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let numbers = [0.0, -0.0, 1.0, -3.0, 0.1, 1.0 / 3.0, 1e15, 9.007199254740993e15, 1e16, 1e300, -5e-324, 1.7976931348623157e308];
        let words = ["", "a \"b\" \\ c", "two\nlines", "2*pi*t", "Größe"];
        let inner: Table =
            [("a b", Value::Number(2.0)), ("list", Value::List(vec![Value::Bool(true), Value::text("x")]))].into_iter().collect();
        let entry: Table = [
            ("numbers", Value::List(numbers.map(Value::Number).to_vec())),
            ("words", Value::List(words.map(Value::text).to_vec())),
            ("table", Value::Table(inner)),
        ]
        .into_iter()
        .collect();
        let section: Table = [("name", Value::Table(entry)), ("Kurbel-ß", Value::Table(Table::default()))].into_iter().collect();
        let parameters: Table = [("L", Value::Number(0.5))].into_iter().collect();
        let root: Table =
            [("title", Value::text("x")), ("body", Value::Table(section)), ("parameters", Value::Table(parameters))].into_iter().collect();
        let root = Value::Table(root);
        let text = model_text(&root);
        let again = Source::read("model.toml", text.as_bytes()).unwrap_or_else(|fault| panic!("{fault}\n{text}"));
        // Also tells 0 from −0.
        assert_eq!(format!("{:?}", again.value()), format!("{root:?}"), "{text}");
        assert_eq!(again.value(), &root);
    }
}
