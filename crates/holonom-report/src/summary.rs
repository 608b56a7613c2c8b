//! `summary.json` as a table: one line per key, and one column per run where the runs differ.

use crate::comparison::abreast;
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

/// Keys that say nothing beside the heading of a column.
const HEADINGS: [&str; 2] = ["label", "table"];

/// Beginnings of the keys that stand elsewhere on the page: at the top, and above the model.
const ELSEWHERE: [&str; 4] = ["peaks.", "work_by.", "events", "provenance."];

/// The summary of one run in two halves side by side; of several, what is the same in all of them so, and a column of the
/// rest for each run.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let columns: Vec<Vec<(String, &Value)>> = runs.iter().map(|run| flatten(run.summary)).collect();
    let mut keys = union_of_keys(&columns);
    keys.retain(|key| !ELSEWHERE.iter().any(|begin| key.starts_with(begin)));
    if runs.len() < 2 {
        // The notes of a single run are at the top of the page.
        keys.retain(|key| *key != "notes");
        return halves(&columns, &keys, out);
    }
    keys.retain(|key| !HEADINGS.contains(key));
    // What was asked comes before how the solver did.
    keys.sort_by_key(|key| !key.starts_with("differences."));
    let (shared, differing): (Vec<&str>, Vec<&str>) = keys.into_iter().partition(|key| is_shared(&columns, key));
    if !shared.is_empty() {
        writeln!(out, "<h3>The same in all runs</h3>")?;
        halves(&columns[..1], &shared, out)?;
    }
    if !differing.is_empty() {
        writeln!(out, "<h3>Of each run</h3>")?;
        side_by_side(runs, &columns, &differing, out)?;
    }
    Ok(())
}

/// The first column of values, which is narrow: two halves side by side.
fn halves(columns: &[Vec<(String, &Value)>], keys: &[&str], out: &mut dyn io::Write) -> io::Result<()> {
    let (first, second) = keys.split_at(keys.len().div_ceil(2));
    writeln!(out, r#"<div class="scroll halves">"#)?;
    for keys in [first, second].into_iter().filter(|keys| !keys.is_empty()) {
        writeln!(out, r#"<table class="summary"><tbody>"#)?;
        for key in keys {
            let cells: String = columns.iter().map(|column| cell(column, key)).collect();
            writeln!(out, r#"<tr><th scope="row">{}</th>{cells}</tr>"#, html(key))?;
        }
        writeln!(out, "</tbody></table>")?;
    }
    writeln!(out, "</div>")
}

/// One column for each run: short numbers, and units once in a line.
fn side_by_side(runs: &[Run], columns: &[Vec<(String, &Value)>], keys: &[&str], out: &mut dyn io::Write) -> io::Result<()> {
    for some in abreast(runs.len()) {
        let heads: String = runs[some.clone()].iter().map(|run| format!("<th scope=\"col\">{}</th>", html(run.label))).collect();
        writeln!(out, r#"<div class="scroll"><table class="summary compact"><thead><tr><th></th>{heads}</tr></thead><tbody>"#)?;
        for key in keys {
            let cells: String = columns[some.clone()].iter().map(|column| short_cell(column, key)).collect();
            writeln!(out, r#"<tr><th scope="row">{} <small>{}</small></th>{cells}</tr>"#, html(key), unit(key))?;
        }
        writeln!(out, "</tbody></table></div>")?;
    }
    Ok(())
}

fn is_shared(columns: &[Vec<(String, &Value)>], key: &str) -> bool {
    let first = value(&columns[0], key);
    columns.iter().all(|column| value(column, key) == first)
}

fn value<'a>(column: &[(String, &'a Value)], key: &str) -> Option<&'a Value> {
    column.iter().find(|(name, _)| name == key).map(|(_, value)| *value)
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
    let Some(value) = value(column, key) else {
        return "<td></td>".to_owned();
    };
    let text = html(&format::value(value));
    match value {
        // The title holds every digit.
        Value::Number(n) => format!(r#"<td class="number" title="{n}">{text} <small>{}</small></td>"#, unit(key)),
        _ => format!("<td>{text}</td>"),
    }
}

fn short_cell(column: &[(String, &Value)], key: &str) -> String {
    match value(column, key) {
        Some(Value::Number(n)) if n.is_f64() => {
            format!(r#"<td class="number" title="{n}">{}</td>"#, format::answer(n.as_f64().unwrap_or(f64::NAN)))
        }
        Some(value) => format!("<td>{}</td>", html(&format::value(value))),
        None => "<td></td>".to_owned(),
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
