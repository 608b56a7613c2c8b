//! `summary.json` as a table: one line per key, one column per run.

use crate::escape::html;
use crate::{Run, format};
use serde_json::Value;
use std::io;

/// Units of the keys that have one; the ending decides.
const UNITS: [(&str, &str); 13] = [
    ("energy.", "J"),
    ("step", "s"),
    ("end", "s"),
    ("stopped_at", "s"),
    ("momentum.linear_drift", "kg·m/s"),
    ("momentum.angular_drift", "kg·m²/s"),
    ("violation.position", "SI"),
    ("violation.velocity", "SI/s"),
    ("violation.acceleration", "SI/s²"),
    ("time.cpu_s", "s"),
    ("time.wall_s", "s"),
    ("time.us_per_step", "µs"),
    ("time.realtime_factor", "×"),
];

/// Writes the table.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let columns: Vec<Vec<(String, &Value)>> = runs.iter().map(|run| flatten(run.summary)).collect();
    let keys = union_of_keys(&columns);
    // The table of a single run is narrow: two halves side by side.
    let halves = if runs.len() == 1 { keys.split_at(keys.len().div_ceil(2)) } else { (&keys[..], &[][..]) };
    writeln!(out, r#"<div class="scroll halves">"#)?;
    for keys in [halves.0, halves.1] {
        if !keys.is_empty() {
            table(runs, &columns, keys, out)?;
        }
    }
    writeln!(out, "</div>")
}

fn table(runs: &[Run], columns: &[Vec<(String, &Value)>], keys: &[&str], out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<table class="summary">"#)?;
    if runs.len() > 1 {
        let heads: String = runs.iter().map(|run| format!("<th scope=\"col\">{}</th>", html(run.label))).collect();
        writeln!(out, "<thead><tr><th></th>{heads}</tr></thead>")?;
    }
    writeln!(out, "<tbody>")?;
    for key in keys {
        let cells: String = columns.iter().map(|column| cell(column, key)).collect();
        writeln!(out, r#"<tr><th scope="row">{}</th>{cells}</tr>"#, html(key))?;
    }
    writeln!(out, "</tbody></table>")
}

/// `{"energy": {"initial": 1}}` → `energy.initial`, 1; in the order of the file.
pub fn flatten(summary: &Value) -> Vec<(String, &Value)> {
    let mut leaves = Vec::new();
    collect(summary, String::new(), &mut leaves);
    leaves
}

fn collect<'a>(value: &'a Value, path: String, leaves: &mut Vec<(String, &'a Value)>) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                collect(field, path, leaves);
            }
        }
        leaf => leaves.push((path, leaf)),
    }
}

/// In order of first appearance.
fn union_of_keys<'a>(columns: &'a [Vec<(String, &Value)>]) -> Vec<&'a str> {
    let mut keys: Vec<&str> = Vec::new();
    for (key, _) in columns.iter().flatten() {
        if !keys.contains(&key.as_str()) {
            keys.push(key);
        }
    }
    keys
}

fn cell(column: &[(String, &Value)], key: &str) -> String {
    let Some((_, value)) = column.iter().find(|(name, _)| name == key) else {
        return "<td></td>".to_owned();
    };
    let text = html(&format::value(value));
    match value {
        // The title holds every digit.
        Value::Number(n) => format!(r#"<td class="number" title="{n}">{text} <small>{}</small></td>"#, unit(key)),
        _ => format!("<td>{text}</td>"),
    }
}

fn unit(key: &str) -> &'static str {
    let fits = |&&(pattern, _): &&(&str, &str)| key == pattern || (pattern.ends_with('.') && key.starts_with(pattern));
    UNITS.iter().find(fits).map_or("", |&(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn flattens_in_order() {
        let summary = json!({"b": {"y": 1, "x": {"deep": []}}, "a": null});
        let keys: Vec<String> = flatten(&summary).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["b.y", "b.x.deep", "a"]);
    }

    #[test]
    fn units_follow_keys() {
        assert_eq!((unit("energy.max_drift"), unit("end"), unit("steps")), ("J", "s", ""));
    }
}
