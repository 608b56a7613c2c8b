//! Descriptions as JSON.

use holonom::model::Value;

/// The same value in JSON; whole numbers stay whole.
pub fn to_json(value: &Value) -> serde_json::Value {
    match value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => serde_json::json!(*number as i64),
        Value::Number(number) => serde_json::json!(number),
        Value::Text(text) => serde_json::json!(text),
        Value::Bool(flag) => serde_json::json!(flag),
        Value::List(items) => items.iter().map(to_json).collect(),
        Value::Table(table) => table.iter().map(|(key, value)| (key.to_string(), to_json(value))).collect::<serde_json::Map<_, _>>().into(),
    }
}
