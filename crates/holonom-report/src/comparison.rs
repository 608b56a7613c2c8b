//! The top of a page that compares runs: what they have in common, and a table of what they differ in.

use crate::escape::html;
use crate::figures::{badge, figure, known, reason};
use crate::outcome::{Outcome, completed, outcomes};
use crate::{Run, format};
use serde_json::Value;
use std::io;

/// One column of the table.
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

/// A line of what all runs share, the table, and how to read it.
pub fn write(runs: &[Run], out: &mut dyn io::Write) -> io::Result<()> {
    let shared: Vec<String> =
        FACTS.iter().filter(|fact| is_shared(runs, fact)).filter_map(|fact| say(runs.first()?.summary, fact)).collect();
    let count = format!("{} runs compared", runs.len());
    writeln!(out, r#"<p class="method">{}</p>"#, [vec![count], shared].concat().join(" · "))?;
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

/// Label with the sample of its curve, which the viewer draws, over what the method is made of.
fn name_cell(runs: &[Run], index: usize) -> String {
    let run = &runs[index];
    // How many steps a run took follows from its step and its end.
    let own = FACTS.iter().filter(|fact| fact.0 != "/steps" && !is_shared(runs, fact)).filter_map(|fact| say(run.summary, fact));
    let parts: Vec<String> = parts_of_method(run.summary).into_iter().chain(own).collect();
    let label = html(run.label);
    format!(r#"<th scope="row"><span class="swatch" data-run="{index}"></span>{label}<small>{}</small></th>"#, parts.join(" · "))
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
