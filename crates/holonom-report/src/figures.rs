//! The top of the page: which method, how it ended, and the figures a run is judged by.

use crate::escape::html;
use crate::outcome::{ended, is_measured};
use crate::{Run, comparison, digits, format, page, works};
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

/// Method, status and what was asked: a line and tables for one run, a table of the answers side by side for several.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    match runs {
        [run] => one(run, out),
        runs => comparison::write(runs, out),
    }
}

fn one(run: &Run, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<p class="method">{} {}{}</p>"#, badge(run.summary), method(run.summary), reason(run.summary))?;
    notes(run.summary, out)?;
    let mut tables = Vec::new();
    measures(run.summary, &mut tables)?;
    events(run.summary, &mut tables)?;
    peaks(run.summary, &mut tables)?;
    works(run.summary, &mut tables)?;
    if tables.is_empty() {
        return Ok(());
    }
    writeln!(out, r#"<div class="peaks">"#)?;
    out.write_all(&tables)?;
    writeln!(out, "</div>")
}

/// What the run was told to look out for. It stands beside how the run ended, as a run that completed may still be wrong.
fn notes(summary: &Value, out: &mut dyn io::Write) -> io::Result<()> {
    page::notes(list(summary, "/notes").iter().map(format::value), out)
}

/// Key figures of the solver: a list for one run, a table for several.
pub fn solver(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let [run] = runs else { return comparison::solver(runs, out) };
    writeln!(out, r#"<dl class="figures">"#)?;
    for (pointer, name, unit) in FIGURES.into_iter().filter(|(pointer, ..)| known(run.summary, pointer)) {
        let value = figure(run.summary, pointer);
        let unit = if unit.is_empty() { String::new() } else { format!(" <small>{unit}</small>") };
        writeln!(out, "<div><dt>{name}</dt><dd>{value}{unit}</dd></div>")?;
    }
    writeln!(out, "</dl>")
}

/// Sorts of what acts, as the summary has them, and what to call them.
const PEAKS: [(&str, &str); 3] = [("drives", "Drives"), ("forces", "Forces"), ("joints", "Joints")];

/// Peaks of a sort and a unit that are shown.
const ROWS: usize = 5;

/// The largest of what acts in the mechanism.
fn peaks(summary: &Value, out: &mut dyn io::Write) -> io::Result<()> {
    let of = |sort: &str| summary.pointer(&format!("/peaks/{sort}")).and_then(Value::as_array).filter(|peaks| !peaks.is_empty());
    for (k, (sort, name)) in PEAKS.into_iter().enumerate() {
        let Some(peaks) = of(sort) else { continue };
        writeln!(out, "<table><caption>{name}: the largest</caption><tbody>")?;
        let is_among_first = |k: usize| peaks[..k].iter().filter(|peak| peak.get("unit") == peaks[k].get("unit")).count() < ROWS;
        let size = |peak: &Value| peak.get("value").and_then(Value::as_f64).map_or(f64::INFINITY, f64::abs);
        let most = peaks.iter().map(size).fold(0.0, f64::max);
        let is_shown = |&k: &usize| is_among_first(k) && (most.is_infinite() || size(&peaks[k]) >= digits::ROUND_OFF * most);
        let shown: Vec<usize> = (0..peaks.len()).filter(is_shown).collect();
        let others = summary.pointer(&format!("/peaks/more/{k}")).and_then(Value::as_u64).unwrap_or(0);
        let are_more = (0..peaks.len()).filter(|k| !is_among_first(*k)).count() as u64 + others;
        for peak in shown.into_iter().map(|k| &peaks[k]) {
            let text = |key: &str| peak.get(key).map_or(String::new(), |value| html(&format::value(value)));
            let (value, at) = (number(peak, "value"), number(peak, "at"));
            writeln!(
                out,
                r#"<tr><th scope="row">{}</th><td class="number">{value}&nbsp;<small>{}</small></td><td class="number"><small>at {at} s</small></td></tr>"#,
                text("name"),
                text("unit"),
            )?;
        }
        if are_more > 0 {
            let plural = if are_more == 1 { "" } else { "s" };
            writeln!(
                out,
                r#"<tr><td colspan="3"><small>{are_more} smaller one{plural}: see the picker and <code>summary.json</code></small></td></tr>"#
            )?;
        }
        writeln!(out, "</tbody></table>")?;
    }
    Ok(())
}

/// Works that are shown.
const WORKS: usize = 8;

/// What put energy into the mechanism and what took it out.
fn works(summary: &Value, out: &mut dyn io::Write) -> io::Result<()> {
    let (shown, more) = works::largest(summary, WORKS);
    if shown.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        r#"<table><caption title="above zero what it put into the mechanism, below zero what it took out">Work in the run</caption><tbody>"#
    )?;
    for own in shown {
        let stored = own.stored.map_or(String::new(), |stored| {
            format!("<small>holds {}&nbsp;J {}</small>", format::answer(stored.abs()), if stored > 0.0 { "more" } else { "less" })
        });
        let (name, work) = (html(&own.name), format::answer(own.work));
        writeln!(
            out,
            r#"<tr><th scope="row">{name}</th><td class="number">{work}&nbsp;<small>J</small></td><td class="number">{stored}</td></tr>"#
        )?;
    }
    if more > 0 {
        let plural = if more == 1 { "" } else { "s" };
        writeln!(out, r#"<tr><td colspan="3"><small>{more} smaller one{plural}: see <code>summary.json</code></small></td></tr>"#)?;
    }
    writeln!(out, "</tbody></table>")
}

/// Measures that are shown at once; more would push the picture far down.
const MEASURES: usize = 12;

/// How far measures go: what the model was asked.
fn measures(summary: &Value, out: &mut dyn io::Write) -> io::Result<()> {
    let measures = list(summary, "/peaks/measures");
    if measures.is_empty() {
        return Ok(());
    }
    let (first, others) = measures.split_at(measures.len().min(MEASURES));
    measure_table("<caption>Measures</caption>", first, out)?;
    if !others.is_empty() {
        writeln!(out, "<details><summary>{} more measures</summary>", others.len())?;
        measure_table("", others, out)?;
        writeln!(out, "</details>")?;
    }
    Ok(())
}

fn measure_table(caption: &str, measures: &[Value], out: &mut dyn io::Write) -> io::Result<()> {
    let heads = ["smallest", "largest", "last"].map(|head| format!(r#"<th scope="col" class="number">{head}</th>"#)).concat();
    writeln!(out, r#"<table class="measures">{caption}<thead><tr><th></th>{heads}</tr></thead><tbody>"#)?;
    for measure in measures {
        let value = |key: &str| measure[key].as_f64().unwrap_or(f64::NAN);
        let cell = |key: &str, at: &str| {
            let at = if at.is_empty() { String::new() } else { format!(" <small>at {} s</small>", number(measure, at)) };
            let value = format::answer_between(value(key), [value("min"), value("max")]);
            format!(r#"<td class="number">{value}{at}</td>"#)
        };
        let unit = match words(measure, "unit") {
            unit if unit == "1" => String::new(),
            unit => format!(" <small>{unit}</small>"),
        };
        let cells = [cell("min", "min_at"), cell("max", "max_at"), cell("last", "")].concat();
        writeln!(out, r#"<tr><th scope="row">{}{unit}</th>{cells}</tr>"#, words(measure, "name"))?;
    }
    writeln!(out, "</tbody></table>")
}

/// Events that are listed.
const EVENTS: usize = 10;
/// Times that are listed of each.
const TIMES: usize = 4;

/// When events happen: a row for each, with its first times.
fn events(summary: &Value, out: &mut dyn io::Write) -> io::Result<()> {
    let all = list(summary, "/events");
    if all.is_empty() {
        return Ok(());
    }
    let mut names: Vec<String> = Vec::new();
    all.iter().map(|event| words(event, "event")).for_each(|name| {
        if !names.contains(&name) {
            names.push(name);
        }
    });
    writeln!(out, "<table><caption>Events</caption><tbody>")?;
    for name in names.iter().take(EVENTS) {
        let own: Vec<&Value> = all.iter().filter(|event| words(event, "event") == *name).collect();
        let mut times: Vec<String> = own.iter().take(TIMES).map(|event| number(event, "t")).collect();
        if own.len() > TIMES {
            times.push("…".to_owned());
        }
        let often = if own.len() > TIMES { format!(" <small>{} times</small>", own.len()) } else { String::new() };
        let is_end = own.iter().any(|event| event.get("stopped") == Some(&Value::Bool(true)));
        let end = if is_end { " <small>end of the run</small>" } else { "" };
        writeln!(out, r#"<tr><th scope="row">{name}{often}{end}</th><td>{} <small>s</small></td></tr>"#, times.join(", "))?;
    }
    if let more @ 1.. = names.len().saturating_sub(EVENTS) {
        writeln!(out, r#"<tr><td colspan="2">and {more} more, in summary.json</td></tr>"#)?;
    }
    writeln!(out, "</tbody></table>")
}

fn list<'a>(summary: &'a Value, pointer: &str) -> &'a [Value] {
    summary.pointer(pointer).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn number(of: &Value, key: &str) -> String {
    format::answer(of.get(key).and_then(Value::as_f64).unwrap_or(f64::NAN))
}

fn words(of: &Value, key: &str) -> String {
    html(of.get(key).and_then(Value::as_str).unwrap_or(""))
}

/// Whether a summary says anything there.
pub fn known(summary: &Value, pointer: &str) -> bool {
    summary.pointer(pointer).is_some_and(|v| !v.is_null())
}

/// A figure of a summary as HTML.
pub fn figure(summary: &Value, pointer: &str) -> String {
    match summary.pointer(pointer) {
        Some(Value::Number(n)) if n.is_f64() => format::figure(n.as_f64().unwrap_or(f64::NAN)),
        Some(value) => html(&format::value(value)),
        None => String::new(),
    }
}

/// Method name, step and number of steps as HTML. Where an accuracy chooses the steps it is told in place of the nominal one.
fn method(summary: &Value) -> String {
    let told = |pointer: &str, say: fn(String) -> String| {
        summary.pointer(pointer).filter(|value| !value.is_null()).map(|value| say(html(&format::value(value))))
    };
    let steps = match told("/method/accuracy", |accuracy| format!("accuracy {accuracy}")) {
        Some(accuracy) => [Some(accuracy), told("/work/steps_taken", |steps| format!("{steps} steps taken"))],
        None => [told("/step", |step| format!("step {step} s")), told("/steps", |steps| format!("{steps} steps"))],
    };
    let parts = std::iter::once(told("/method/name", |name| name)).chain(steps);
    parts.flatten().collect::<Vec<_>>().join(" · ")
}

/// How a run ended, as a mark.
pub fn badge(summary: &Value) -> String {
    let status = text(summary, "status").unwrap_or_else(|| "unknown".to_owned());
    if status == "completed" {
        return r#"<span class="badge completed">completed</span>"#.to_owned();
    }
    if is_measured(summary) {
        return r#"<span class="badge">measured</span>"#.to_owned();
    }
    let when = text(summary, "stopped_at").map_or(String::new(), |t| format!(" at {t} s"));
    format!(r#"<span class="badge stopped">{status}{when}</span>"#)
}

/// Why a run stopped, if it did, or which event ended it.
pub fn reason(summary: &Value) -> String {
    let by_event =
        |(event, t)| format!(r#"<span class="reason of-event">ended by the event {} at {} s</span>"#, html(event), format::answer(t));
    let of_stop = text(summary, "reason").map(|reason| format!(r#"<span class="reason">{reason}</span>"#));
    of_stop.or_else(|| ended(summary).map(by_event)).unwrap_or_default()
}

/// A key of the summary as HTML, unless it is null.
fn text(summary: &Value, key: &str) -> Option<String> {
    summary.get(key).filter(|v| !v.is_null()).map(|v| html(&format::value(v)))
}
