//! The top of the page: which method, how it ended, and the figures a run is judged by.

use crate::escape::html;
use crate::{Run, format};
use serde_json::Value;
use std::io;

/// Pointer into `summary.json`, what to call it, unit. Drift and violations are the largest over the run.
const FIGURES: [(&str, &str, &str); 7] = [
    ("/energy/max_drift", "energy drift", "J"),
    ("/violation/position", "position violation", ""),
    ("/violation/velocity", "velocity violation", ""),
    ("/work/iterations_per_step", "iterations per step", ""),
    ("/time/us_per_step", "time per step", "µs"),
    ("/dof", "degrees of freedom", ""),
    ("/redundant", "redundant rows", ""),
];

/// Method, status and key figures: a line and tiles for one run, a table for several.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    match runs {
        [run] => one(run, out),
        runs => several(runs, out),
    }
}

fn one(run: &Run, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<p class="method">{} {}{}</p>"#, badge(run.summary), method(run, true), reason(run.summary))?;
    writeln!(out, r#"<dl class="figures">"#)?;
    for (pointer, name, unit) in shown(std::slice::from_ref(run)) {
        let value = figure(run.summary, pointer);
        let unit = if unit.is_empty() { String::new() } else { format!(" <small>{unit}</small>") };
        writeln!(out, "<div><dt>{name}</dt><dd>{value}{unit}</dd></div>")?;
    }
    writeln!(out, "</dl>")
}

fn several(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let figures = shown(runs);
    writeln!(out, r#"<div class="scroll"><table class="figures"><thead><tr><th scope="col">run</th><th scope="col">status</th>"#)?;
    for (_, name, unit) in &figures {
        let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
        writeln!(out, r#"<th scope="col">{name}{unit}</th>"#)?;
    }
    writeln!(out, "</tr></thead><tbody>")?;
    for (index, run) in runs.iter().enumerate() {
        // The viewer fills the swatch with the colour of the run.
        let name = format!(r#"<span class="swatch" data-run="{index}"></span>{}<small>{}</small>"#, html(run.label), method(run, false));
        write!(out, r#"<tr><th scope="row">{name}</th><td>{}{}</td>"#, badge(run.summary), reason(run.summary))?;
        for (pointer, ..) in &figures {
            write!(out, r#"<td class="number">{}</td>"#, figure(run.summary, pointer))?;
        }
        writeln!(out, "</tr>")?;
    }
    writeln!(out, "</tbody></table></div>")
}

/// The figures that at least one run has.
fn shown(runs: &[Run]) -> Vec<(&'static str, &'static str, &'static str)> {
    let known = |pointer: &str| runs.iter().any(|run| run.summary.pointer(pointer).is_some_and(|v| !v.is_null()));
    FIGURES.into_iter().filter(|(pointer, ..)| known(pointer)).collect()
}

fn figure(summary: &Value, pointer: &str) -> String {
    match summary.pointer(pointer) {
        Some(Value::Number(n)) if n.is_f64() => format::figure(n.as_f64().unwrap_or(f64::NAN)),
        Some(value) => html(&format::value(value)),
        None => String::new(),
    }
}

/// Method name, step and number of steps as HTML; no name where the label, which stands beside it, says the same.
fn method(run: &Run, always_name: bool) -> String {
    let text = |key: &str| run.summary.pointer(key).map(|v| html(&format::value(v)));
    let parts = [
        text("/method/name").filter(|name| always_name || *name != html(run.label)),
        text("/step").map(|step| format!("step {step} s")),
        text("/steps").map(|steps| format!("{steps} steps")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(" · ")
}

fn badge(summary: &Value) -> String {
    let status = text(summary, "status").unwrap_or_else(|| "unknown".to_owned());
    if status == "completed" {
        return r#"<span class="badge completed">completed</span>"#.to_owned();
    }
    let when = text(summary, "stopped_at").map_or(String::new(), |t| format!(" at {t} s"));
    format!(r#"<span class="badge stopped">{status}{when}</span>"#)
}

fn reason(summary: &Value) -> String {
    text(summary, "reason").map_or(String::new(), |reason| format!(r#"<span class="reason">{reason}</span>"#))
}

/// A key of the summary as HTML, unless it is null.
fn text(summary: &Value, key: &str) -> Option<String> {
    summary.get(key).filter(|v| !v.is_null()).map(|v| html(&format::value(v)))
}
