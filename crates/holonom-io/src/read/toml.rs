//! TOML to a description.

use std::ops::Range;

use holonom::model::{Table, Value, item_path, key_path};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::places::Places;

/// What is wrong with a file as TOML, and where.
pub(super) struct SyntaxError {
    pub message: String,
    pub bytes: Range<usize>,
    pub cure: String,
}

/// Parses a file and notes the place of everything in it.
pub(super) fn parse(text: &str, places: &mut Places) -> Result<Value, SyntaxError> {
    let table = DeTable::parse(text).map_err(|error| {
        let bytes = error.span().unwrap_or(0..0);
        let told = NO_VALUE.iter().any(|beginning| error.message().starts_with(beginning)).then(|| bare(text, bytes.start)).flatten();
        let (message, cure) = told.unwrap_or_else(|| (error.message().to_string(), cure(error.message()).into()));
        SyntaxError { message, bytes, cure }
    })?;
    convert_table("", table.get_ref(), places).map(Value::Table)
}

/// Beginnings of messages about TOML, and what then usually helps.
const CURES: &[(&str, &str)] = &[
    ("duplicate key", "a key or table may be there only once: remove one, or give it another name"),
    ("string values must be quoted", "write a value behind the =; texts and expressions stand in quotes"),
    ("unclosed table", "end the line with ]; a name has no index there: `repeat` makes many of one"),
    ("key with no value", "write KEY = VALUE, or [TABLE] above its keys"),
    ("missing comma", "put a comma between items, and end the list with ]"),
    ("unexpected key or value", "write one key a line; decimal numbers have a point: 1.5"),
    ("invalid mantissa", "a number has digits before its point: 0.5"),
    ("invalid fraction", "a number has digits behind its point: 5.0"),
    ("unexpected leading zero", "write the number without zeros before it"),
    ("unclosed array", "put a comma between items, and end the list with ]"),
    ("invalid basic string", "end the text with \" on the same line"),
];

/// Beginnings of messages about what is no value.
const NO_VALUE: &[&str] = &["string values must be quoted", "invalid float", "invalid boolean", "invalid integer"];

/// Longest formula that is written into a message, bytes.
const LONGEST: usize = 60;

/// What is wrong with a text or a formula without quotes that has the byte `at`, and the cure.
fn bare(text: &str, at: usize) -> Option<(String, String)> {
    let start = text.get(..at)?.rfind(['[', '{', '=', ',', '\n']).map_or(0, |before| before + 1);
    let mut depth = 0_i32;
    let ends = |c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        matches!(c, ']' | '}' | '#' | '\n') || c == ',' && depth == 0
    };
    let end = text[at..].find(ends).map_or(text.len(), |length| at + length);
    let word = text[start..end].trim();
    if word.is_empty() || word.len() > LONGEST || word.contains(|c: char| c.is_control() || matches!(c, '"' | '\'')) {
        return None;
    }
    let cure = match word.to_lowercase().as_str() {
        flag @ ("true" | "false") => format!("write {flag}"),
        _ if word.contains(char::is_whitespace) && word.split_whitespace().all(|number| number.parse::<f64>().is_ok()) => {
            "put commas between numbers".to_string()
        }
        _ => format!("texts and formulas stand in quotes: \"{word}\""),
    };
    Some((format!("`{word}` is neither a number nor a text in quotes"), cure))
}

fn cure(message: &str) -> &'static str {
    let known = CURES.iter().find(|(beginning, _)| message.trim_start().starts_with(beginning));
    known.map_or("see toml.io for how TOML is written; texts and expressions stand in quotes", |&(_, cure)| cure)
}

/// A single value as it stands behind an equals sign.
pub(super) fn value(text: &str) -> Option<Value> {
    let line = format!("value = {text}");
    match parse(&line, &mut Places::default()).ok()? {
        Value::Table(table) if table.len() == 1 => table.get("value").cloned(),
        _ => None,
    }
}

fn convert_table(path: &str, table: &DeTable<'_>, places: &mut Places) -> Result<Table, SyntaxError> {
    let mut converted = Table::default();
    for (key, value) in table {
        let path = key_path(path, key.get_ref());
        places.add_key(&path, key.span());
        converted.push(key.get_ref().as_ref(), convert(&path, value, places)?);
    }
    Ok(converted)
}

fn convert(path: &str, value: &Spanned<DeValue<'_>>, places: &mut Places) -> Result<Value, SyntaxError> {
    // The span of a table is its header or its braces; its name is the better place, and is noted with its key;
    // one in a list has no name.
    if !matches!(value.get_ref(), DeValue::Table(_)) || path.ends_with(']') {
        places.add_value(path, value.span());
    }
    let refuse = |message: &str, cure: &str| SyntaxError { message: message.into(), bytes: value.span(), cure: cure.into() };
    match value.get_ref() {
        DeValue::String(text) => Ok(Value::text(text.as_ref())),
        DeValue::Boolean(flag) => Ok(Value::Bool(*flag)),
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .map(|number| Value::Number(number as f64))
            .map_err(|_| refuse("the whole number is too large", "write it with a decimal point")),
        DeValue::Float(number) => {
            number.as_str().parse().map(Value::Number).map_err(|_| refuse("this is no number", "write it as 1.5 or 1e3"))
        }
        DeValue::Datetime(_) => Err(refuse("a model has no dates", "write times as numbers in s")),
        DeValue::Array(items) => {
            let items = items.iter().enumerate().map(|(k, item)| convert(&item_path(path, k), item, places));
            items.collect::<Result<_, _>>().map(Value::List)
        }
        DeValue::Table(table) => convert_table(path, table, places).map(Value::Table),
    }
}
