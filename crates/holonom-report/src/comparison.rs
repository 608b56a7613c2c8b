//! The top of a page that compares runs: what they have in common, and their answers side by side; and the table of how the solver did in each.

use crate::answers::{Answer, answers};
use crate::escape::html;
use crate::figures::{badge, figure, known, reason};
use crate::outcome::{Outcome, completed, ended, outcomes};
use crate::{Run, format};
use serde_json::Value;
use std::io;
use std::ops::Range;

/// One column of the table of the solver.
struct Figure {
    /// Where it is in `summary.json`.
    pointer: &'static str,
    name: &'static str,
    unit: &'static str,
    /// Values up to so many times the least count as best: of errors the size matters, of work every percent.
    tie: f64,
}

const fn figure_of(pointer: &'static str, name: &'static str, unit: &'static str, tie: f64) -> Figure {
    Figure { pointer, name, unit, tie }
}

const FIGURES: [Figure; 7] = [
    figure_of("/energy/max_drift", "energy drift", "J", 2.0),
    figure_of("/energy/max_rise", "largest rise in a step", "J", 2.0),
    figure_of("/violation/position", "position violation", "‖Φ‖", 2.0),
    figure_of("/violation/velocity", "velocity violation", "‖Φ\u{307}‖", 2.0),
    figure_of("/violation/acceleration", "acceleration violation", "‖Φ\u{308}‖", 2.0),
    figure_of("/work/iterations_per_step", "iterations per step", "", 1.05),
    figure_of("/time/us_per_step", "time per step", "µs", 1.05),
];

const EXPLANATION: &str = "Drift, rise and violations are the largest over the run. <strong class=\"best\">Best values</strong> are marked \
    among the runs that completed with their energy in bounds: all drifts, rises and violations up to twice the least, iterations and times \
    within 5\u{202f}% of it.";

/// Pointer into the summary, and how to say it.
type Fact = (&'static str, fn(&str) -> String);

/// What is said once where it is the same in all runs, and else of each run.
const FACTS: [Fact; 6] = [
    ("/end", |end| format!("{end} s")),
    ("/step", |step| format!("step {step} s")),
    ("/accuracy", |accuracy| format!("accuracy {accuracy}")),
    ("/steps", |steps| format!("{steps} steps")),
    ("/dof", |dof| format!("{dof} degree{} of freedom", plural(dof))),
    ("/redundant", |rows| format!("{rows} redundant row{}", plural(rows))),
];

/// A line of what all runs share, and a table of their answers.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let shared: Vec<String> =
        FACTS.iter().filter(|fact| is_shared(runs, fact)).filter_map(|fact| say(runs.first()?.summary, fact)).collect();
    let count = format!("{} runs compared", runs.len());
    writeln!(out, r#"<p class="method">{}</p>"#, [vec![count], shared].concat().join(" · "))?;
    answers_of(runs, out)
}

/// Rows of answers that are seen at once; more would push the picture far down.
const ROWS: usize = 15;

/// Runs for which a page is wide enough to have a column for each.
const ABREAST: usize = 8;

/// A row of a table with a column for each run: its heading, and its cells.
struct Row {
    heading: String,
    cells: Vec<String>,
}

/// Runs that stand side by side: all of them, or about as many in each of several tables.
pub fn abreast(runs: usize) -> impl Iterator<Item = Range<usize>> {
    let each = runs.div_ceil(runs.div_ceil(ABREAST).max(1)).max(1);
    (0..runs).step_by(each).map(move |first| first..(first + each).min(runs))
}

/// How each run ended, where one did not come to the end asked for, then a row for each answer, with its difference to that of the first run.
fn answers_of(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let summaries: Vec<&Value> = runs.iter().map(|run| run.summary).collect();
    let outcomes = outcomes(runs);
    let mut rows = Vec::new();
    if outcomes.iter().any(|outcome| *outcome != Outcome::Sound) || summaries.iter().any(|summary| ended(summary).is_some()) {
        let cells = runs.iter().zip(&outcomes).map(|(run, outcome)| status_cell(run.summary, *outcome)).collect();
        rows.push(Row { heading: "status".into(), cells });
    }
    rows.extend(columns_asked(runs));
    rows.extend(answers(&summaries).iter().map(answer_row));
    if rows.is_empty() {
        return Ok(());
    }
    let (first, others) = rows.split_at(rows.len().min(ROWS));
    answer_table(runs, first, out)?;
    if !others.is_empty() {
        writeln!(out, "<details><summary>{} more answers</summary>", others.len())?;
        answer_table(runs, others, out)?;
        writeln!(out, "</details>")?;
    }
    Ok(())
}

fn answer_table(runs: &[Run], rows: &[Row], out: &mut dyn io::Write) -> io::Result<()> {
    for some in abreast(runs.len()) {
        let head = |index: usize| format!(r#"<th scope="col" class="number">{}</th>"#, label(&runs[index], index));
        let heads: String = some.clone().map(head).collect();
        writeln!(out, r#"<div class="scroll"><table class="answers"><thead><tr><th></th>{heads}</tr></thead><tbody>"#)?;
        for Row { heading, cells } in rows {
            writeln!(out, r#"<tr><th scope="row">{heading}</th>{}</tr>"#, cells[some.clone()].concat())?;
        }
        writeln!(out, "</tbody></table></div>")?;
    }
    Ok(())
}

fn answer_row(answer: &Answer) -> Row {
    let cell = |(run, value): (usize, &Option<f64>)| {
        let value = value.map_or("–".to_owned(), |value| format::answer_beside(value, answer.size));
        let difference = answer.difference(run).map_or(String::new(), |text| format!(" <small>{}</small>", text.replace('-', "\u{2212}")));
        format!(r#"<td class="number">{value}{difference}</td>"#)
    };
    let heading = format!("{} {}{}", html(&answer.name), answer.what, in_unit(&answer.unit));
    Row { heading, cells: answer.values.iter().enumerate().map(cell).collect() }
}

/// How far the columns that were asked for are from those of the first run: the largest difference with its time.
fn columns_asked(runs: &[Run]) -> Vec<Row> {
    let differences = |run: &Run| run.summary.get("differences").and_then(Value::as_object).cloned().unwrap_or_default();
    let mut names: Vec<String> = Vec::new();
    for name in runs.iter().flat_map(|run| differences(run).into_iter().map(|(name, _)| name)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let row = |name: &String| {
        let unit = runs.iter().find_map(|run| Some(run.recording.find(name)?.heading.unit.clone())).unwrap_or_default();
        let cell = |run: &Run| {
            let own = differences(run);
            let number = |key: &str| own.get(name).and_then(|difference| difference[key].as_f64()).map(format::figure);
            match (number("largest"), number("at")) {
                (Some(largest), Some(at)) => format!(r#"<td class="number">{largest} <small>at {at} s</small></td>"#),
                _ => r#"<td class="number">–</td>"#.to_owned(),
            }
        };
        Row { heading: format!("{} largest difference{}", html(name), in_unit(&unit)), cells: runs.iter().map(cell).collect() }
    };
    names.iter().map(row).collect()
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() || unit == "1" { String::new() } else { format!(" <small>{}</small>", html(unit)) }
}

/// What a run is called, with the sample of its curve, which the viewer draws.
fn label(run: &Run, index: usize) -> String {
    format!(r#"<span class="swatch" data-run="{index}"></span>{}"#, html(run.label))
}

/// How the solver did in each run, and how to read that.
pub fn solver(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    if runs.is_empty() {
        return Ok(());
    }
    table(runs, out)?;
    writeln!(out, r#"<p class="note">{EXPLANATION}</p>"#)
}

fn table(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let figures: Vec<&Figure> = FIGURES.iter().filter(|figure| runs.iter().any(|run| known(run.summary, figure.pointer))).collect();
    let outcomes = outcomes(runs);
    let best: Vec<f64> = figures.iter().map(|figure| best_up_to(runs, &outcomes, figure)).collect();
    writeln!(out, r#"<div class="scroll"><table class="figures compared"><thead><tr><th scope="col">run</th><th scope="col">status</th>"#)?;
    for Figure { name, unit, .. } in &figures {
        let unit = if unit.is_empty() { String::new() } else { format!("<small>{unit}</small>") };
        writeln!(out, r#"<th scope="col" class="number">{name}{unit}</th>"#)?;
    }
    writeln!(out, "</tr></thead><tbody>")?;
    for (index, (run, outcome)) in runs.iter().zip(&outcomes).enumerate() {
        writeln!(out, "<tr>{}{}", name_cell(runs, index), status_cell(run.summary, *outcome))?;
        for (figure, &best) in figures.iter().zip(&best) {
            let cell = figure_cell(run.summary, figure.pointer, *outcome == Outcome::Sound, best);
            writeln!(out, "{cell}")?;
        }
        writeln!(out, "</tr>")?;
    }
    writeln!(out, "</tbody></table></div>")
}

/// Label over what the method is made of.
fn name_cell(runs: &[Run], index: usize) -> String {
    let run = &runs[index];
    // How many steps a run took follows from its step and its end.
    let own = FACTS.iter().filter(|fact| fact.0 != "/steps" && !is_shared(runs, fact)).filter_map(|fact| say(run.summary, fact));
    let parts: Vec<String> = parts_of_method(run.summary).into_iter().chain(own).collect();
    format!(r#"<th scope="row">{}<small>{}</small></th>"#, label(run, index), parts.join(" · "))
}

/// Formulation with its index, integrator with its order, and the levels that are projected.
fn parts_of_method(summary: &Value) -> Vec<String> {
    let text = |key: &str| summary.pointer(key).filter(|v| !v.is_null()).map(|v| html(&format::value(v)));
    let with = |name: &str, number: &str, word: &str| match (text(name), text(number)) {
        (Some(name), Some(number)) => Some(format!("{name}, {word}\u{a0}{number}")),
        (name, _) => name,
    };
    let levels = summary.pointer("/method/projection/levels").and_then(Value::as_array).filter(|levels| !levels.is_empty());
    let projected = levels.map(|levels| {
        let levels: Vec<String> = levels.iter().map(|level| html(&format::value(level))).collect();
        format!("projected {}", levels.join(" and "))
    });
    let formulation = with("/method/formulation", "/method/index", "index");
    [formulation, with("/method/integrator", "/method/order", "order"), projected].into_iter().flatten().collect()
}

fn status_cell(summary: &Value, outcome: Outcome) -> String {
    match outcome {
        // It ended as a run should, and yet nobody should trust it.
        Outcome::BlownUp if completed(summary) => {
            r#"<td><span class="badge stopped">completed</span><span class="reason">energy blew up</span></td>"#.to_owned()
        }
        _ => format!("<td>{}{}</td>", badge(summary), reason(summary)),
    }
}

fn figure_cell(summary: &Value, pointer: &str, sound: bool, best: f64) -> String {
    let value = summary.pointer(pointer).and_then(Value::as_f64);
    let text = figure(summary, pointer);
    let title = value.map_or(String::new(), |value| format!(r#" title="{value:e}""#));
    match value {
        Some(value) if sound && value <= best => format!(r#"<td class="number"{title}><strong class="best">{text}</strong></td>"#),
        _ => format!(r#"<td class="number"{title}>{text}</td>"#),
    }
}

/// The largest value that still counts as best.
fn best_up_to(runs: &[Run], outcomes: &[Outcome], figure: &Figure) -> f64 {
    let sound = runs.iter().zip(outcomes).filter(|(_, outcome)| **outcome == Outcome::Sound);
    let values = sound.filter_map(|(run, _)| run.summary.pointer(figure.pointer)?.as_f64());
    values.reduce(f64::min).map_or(f64::NAN, |least| figure.tie * least)
}

fn is_shared(runs: &[Run], (pointer, _): &Fact) -> bool {
    let mut values = runs.iter().map(|run| run.summary.pointer(pointer));
    let first = values.next();
    values.all(|value| Some(value) == first)
}

fn say(summary: &Value, (pointer, say): &Fact) -> Option<String> {
    summary.pointer(pointer).filter(|v| !v.is_null()).map(|v| say(&html(&format::value(v))))
}

fn plural(count: &str) -> &'static str {
    if count == "1" { "" } else { "s" }
}
