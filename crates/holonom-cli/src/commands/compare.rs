//! `holonom compare`.

use std::collections::HashSet;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use holonom::record::Recording;
use holonom_io::Writer;
use holonom_report::{Answer, Report, Run, answers, ended};
use serde_json::{Map, Value, json};

use crate::columns::unknown;
use crate::comparison::{Difference, Entry, MEASURED, Of, Plan, difference};
use crate::failure::{Failure, STOPPED};
use crate::folder::{Folder, TABLE, file_stems, holds};
use crate::found::Found;
use crate::load::Loaded;
use crate::message::note;
use crate::options::CompareArguments;
use crate::output::{Finished, Order, simulate, writers};
use crate::progress::interrupt_flag;
use crate::table::{figures_beside, figures_between, short, table};

/// What is compared, after all runs.
struct Compared {
    label: String,
    /// Of a run that was made now, the index of its model.
    model: Option<usize>,
    recording: Recording,
    summary: Value,
}

/// Runs the models and puts their curves, those of earlier runs and what was measured into one report. A run that stops early is part of the
/// comparison, not a failure of the command.
pub fn compare(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    let output = &arguments.output;
    let writers = writers(&output.formats)?;
    let mut plan = Plan::new(arguments)?;
    if !output.to.quiet {
        plan.notes().iter().for_each(|text| note(text));
    }
    let summaries: Value = plan.entries.iter().map(Entry::identity).collect();
    let folder = Folder::claim(&output.to, &format!("{}-compare", plan.name), |path| holds(path, &summaries))?;
    let stems = file_stems(plan.entries.iter().map(|entry| entry.label.as_str()));
    let of_runs = plan.entries.iter().zip(&stems).filter(|(entry, _)| matches!(entry.of, Of::Run(..)));
    folder.refuse_foreign_tables(of_runs.map(|(_, stem)| stem), &writers)?;
    let interrupted = interrupt_flag();
    let mut compared: Vec<Compared> = Vec::new();
    for (Entry { label, of }, stem) in std::mem::take(&mut plan.entries).into_iter().zip(stems) {
        let (model, recording, mut summary) = match of {
            Of::Read(recording, summary) => (None, recording, summary),
            Of::Run(model, order) => {
                let order = Order { label: Some(label.clone()), ..*order };
                let mut run = simulate(&plan.models[model], order, &interrupted)?;
                run.summary[TABLE] = json!(stem);
                (Some(model), run.recording, run.summary)
            }
        };
        name(&mut summary, &label, model.map(|model| &plan.models[model]));
        compared.push(Compared { label, model, recording, summary });
    }
    tell_measured(&mut compared);
    tell_differences(&plan.columns, &mut compared);
    write(&folder, &plan, &compared, &writers, output.no_report)?;
    let summaries: Vec<&Value> = compared.iter().map(|one| &one.summary).collect();
    if output.to.json {
        println!("{}", serde_json::to_string_pretty(&summaries).expect("a summary is plain data"));
    } else if !output.to.quiet {
        println!("{}\n{}\n\nresults in {}", plan.title, describe(&plan.columns, &compared), folder.path.display());
    }
    Ok(if interrupted.load(Ordering::Relaxed) { ExitCode::from(STOPPED) } else { ExitCode::SUCCESS })
}

/// Finished runs side by side, for a program: their summaries with the differences of columns to the first, and the table of the command.
///
/// # Errors
/// Columns that the first run does not have.
pub fn side_by_side(runs: &[(String, &Loaded, &Finished)], columns: &[String]) -> Result<Found, Failure> {
    let mut compared: Vec<Compared> = Vec::new();
    for (label, loaded, finished) in runs {
        let (recording, mut summary) = (finished.recording.clone(), finished.summary.clone());
        name(&mut summary, label, Some(loaded));
        compared.push(Compared { label: label.clone(), model: None, recording, summary });
    }
    if let Some(first) = compared.first()
        && let Some(column) = columns.iter().find(|column| first.recording.find(column).is_none())
    {
        return Err(unknown(column, &first.recording));
    }
    tell_differences(columns, &mut compared);
    let summaries: Vec<&Value> = compared.iter().map(|one| &one.summary).collect();
    let text = describe(columns, &compared);
    Ok(Found { value: json!(summaries), text })
}

/// Writes the report of finished runs with the summaries that they have side by side.
///
/// # Errors
/// What cannot be written.
pub fn write_side_by_side(
    runs: &[(String, &Loaded, &Finished)],
    columns: &[String],
    summaries: &Value,
    out: &mut dyn std::io::Write,
) -> std::io::Result<()> {
    let shown = runs.iter().enumerate().map(|(k, (label, loaded, finished))| Run {
        label,
        recording: &finished.recording,
        scene: &loaded.model.scene,
        summary: &summaries[k],
    });
    let (shown, first) = (shown.collect::<Vec<_>>(), runs.first().expect("there are runs to compare").1);
    Report { title: first.title(), model_text: first.source.text(), runs: &shown, columns }.write(out)
}

/// Puts into a summary how the run is called, and the accuracy where its steps follow from one.
fn name(summary: &mut Value, label: &str, loaded: Option<&Loaded>) {
    summary["label"] = json!(label);
    if let Some(accuracy) = loaded.and_then(|loaded| loaded.model.settings.choice.accuracy) {
        summary["accuracy"] = json!(accuracy);
    }
}

/// Endings of the columns of what drives, forces and joints exert.
const EXERTED: [&str; 4] = ["effort", "force", "f", "t"];

/// Puts into the summaries of what was measured what it has of the answers of runs, by the names of their columns.
fn tell_measured(compared: &mut [Compared]) {
    let mut asked: Vec<(&str, Value)> = Vec::new();
    for sort in ["measures", "drives", "forces", "joints"] {
        for one in compared.iter().filter_map(|one| one.summary["peaks"][sort].as_array()).flatten() {
            if asked.iter().all(|(of, known)| *of != sort || known["name"] != one["name"] || known["unit"] != one["unit"]) {
                asked.push((sort, one.clone()));
            }
        }
    }
    for one in compared.iter_mut().filter(|one| one.summary["status"] == MEASURED) {
        for (sort, answer) in &asked {
            let name = text(answer, "name");
            let exerted = || EXERTED.iter().map(|ending| format!("{name}.{ending}"));
            let columns = if *sort == "measures" { vec![name.to_string()] } else { exerted().collect() };
            let column =
                columns.iter().filter_map(|column| one.recording.find(column)).find(|column| *column.heading.unit == answer["unit"]);
            let Some(column) = column else { continue };
            let times = one.recording.column("t").unwrap_or_default().iter();
            let rows: Vec<(f64, f64)> = times.copied().zip(column.values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
            let most = |of: fn(f64) -> f64| rows.iter().copied().reduce(|most, row| if of(row.1) > of(most.1) { row } else { most });
            let (Some(least), Some(most), Some(largest)) = (most(|value| -value), most(|value| value), most(f64::abs)) else { continue };
            let found = match *sort {
                "measures" => json!({
                    "name": name, "unit": answer["unit"], "min": least.1, "min_at": least.0, "max": most.1, "max_at": most.0,
                    "last": rows.last().map(|row| row.1),
                }),
                _ => json!({ "name": name, "what": answer["what"], "value": largest.1, "unit": answer["unit"], "at": largest.0 }),
            };
            let own = &mut one.summary["peaks"][*sort];
            match own.as_array_mut() {
                Some(own) => own.push(found),
                None => *own = json!([found]),
            }
        }
    }
}

/// Puts the differences to the first into the summaries of the others.
fn tell_differences(columns: &[String], compared: &mut [Compared]) {
    let Some((first, others)) = compared.split_first_mut().filter(|_| !columns.is_empty()) else { return };
    for other in others {
        let of = |column: &String| {
            let Difference { largest, at, rms } = difference(&first.recording, &other.recording, column)?;
            Some((column.clone(), json!({ "largest": largest, "at": at, "rms": rms })))
        };
        let differences: Map<String, Value> = columns.iter().filter_map(of).collect();
        other.summary["differences"] = Value::Object(differences);
    }
}

/// Writes the summary first, as it says which tables belong to it.
fn write(folder: &Folder, plan: &Plan, compared: &[Compared], writers: &[&Writer], no_report: bool) -> Result<(), Failure> {
    let summaries: Vec<&Value> = compared.iter().map(|one| &one.summary).collect();
    folder.write("summary.json", |out| holonom_io::write_json(&json!(summaries), out))?;
    let (mut columns, mut names) = (Vec::new(), HashSet::new());
    for one in compared {
        let (Some(model), Some(stem)) = (one.model, one.summary[TABLE].as_str()) else { continue };
        folder.write_trajectory(stem, writers, &plan.models[model], &one.recording)?;
        columns.extend(one.recording.columns().iter().filter(|column| names.insert(column.heading.name.as_str())));
    }
    if plan.models.len() > 1 {
        folder.write("columns.json", |out| holonom_io::write_json(&holonom_io::headings(columns), out))?;
    }
    if no_report {
        return Ok(());
    }
    let runs: Vec<Run<'_>> = compared.iter().map(|one| run(one, plan)).collect();
    let report = Report { title: &plan.title, model_text: &plan.text, runs: &runs, columns: &plan.columns };
    folder.write("report.html", |out| report.write(out))
}

/// What the report is told of one curve.
fn run<'a>(one: &'a Compared, plan: &'a Plan) -> Run<'a> {
    let scene = one.model.map_or(&plan.blank, |model| &plan.models[model].model.scene);
    Run { label: &one.label, recording: &one.recording, scene, summary: &one.summary }
}

/// What was asked, the answers of all runs, and how the solver did.
fn describe(columns: &[String], compared: &[Compared]) -> String {
    let summaries: Vec<&Value> = compared.iter().map(|one| &one.summary).collect();
    let mut parts = vec![describe_columns(columns, compared), describe_answers(&summaries), describe_runs(&summaries), strangers(compared)];
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n")
}

/// How far measures go and the largest of what acts, in each run, with the differences to the first.
fn describe_answers(summaries: &[&Value]) -> String {
    let answers = answers(summaries);
    if answers.is_empty() {
        return String::new();
    }
    let row = |answer: &Answer| {
        let cell = |(run, value): (usize, &Option<f64>)| {
            let value = value.map_or("–".into(), |value| figures_beside(value, answer.size));
            answer.difference(run).map_or(value.clone(), |difference| format!("{value} ({difference})"))
        };
        let unit = if answer.unit == "1" { String::new() } else { format!(" ({})", answer.unit) };
        let name = format!("{} {}{unit}", answer.name, answer.what);
        [name].into_iter().chain(answer.values.iter().enumerate().map(cell)).collect::<Vec<_>>()
    };
    let header: Vec<&str> = ["answer"].into_iter().chain(summaries.iter().map(|summary| text(summary, "label"))).collect();
    table(&header, &answers.iter().map(row).collect::<Vec<_>>())
}

/// How far the columns asked for go in each run, and how far they are from those of the first: a table for each.
fn describe_columns(columns: &[String], compared: &[Compared]) -> String {
    let Some(first) = compared.first().filter(|_| !columns.is_empty()) else { return String::new() };
    let tables = columns.iter().map(|column| {
        let unit = first.recording.find(column).map_or("1", |column| &*column.heading.unit);
        let heading = if unit == "1" { column.clone() } else { format!("{column} ({unit})") };
        let row = |one: &Compared| {
            let values = one.recording.column(column).unwrap_or_default().iter().copied().filter(|value| value.is_finite());
            let [least, largest] = values.fold([f64::NAN; 2], |[least, largest], value| [value.min(least), value.max(largest)]);
            let reach = |value: f64| if value.is_finite() { figures_between(value, [least, largest]) } else { "–".into() };
            let number = |key: &str| digits(one.summary["differences"][column.as_str()][key].as_f64().unwrap_or(f64::NAN));
            vec![one.label.clone(), reach(least), reach(largest), number("largest"), number("at"), number("rms")]
        };
        table(&[&heading, "least", "largest", "difference", "at s", "rms"], &compared.iter().map(row).collect::<Vec<_>>())
    });
    format!("{}\ndifferences are to {}", tables.collect::<Vec<_>>().join("\n\n"), first.label)
}

/// Says of which hardly any rows are at times of the first.
fn strangers(compared: &[Compared]) -> String {
    let Some((first, others)) = compared.split_first() else { return String::new() };
    others.iter().filter_map(|other| hardly_meets(other, first)).collect::<Vec<_>>().join("\n")
}

/// Share of its rows that a curve has in common with another below which it is probably told in other units of time.
const HARDLY: f64 = 0.1;

/// Says where hardly any rows are at times that another has.
fn hardly_meets(one: &Compared, first: &Compared) -> Option<String> {
    let [own, others] = [one, first].map(|run| run.recording.column("t").unwrap_or_default());
    let whole = *others.first()?..=*others.last()?;
    let common = own.iter().filter(|t| whole.contains(t)).count();
    (common as f64 <= HARDLY * own.len() as f64)
        .then(|| format!("only {common} of {} rows of {} are at times that {} has: times are in s", own.len(), one.label, first.label))
}

/// A table of all runs, and why those ended that did not come to the end asked for.
fn describe_runs(summaries: &[&Value]) -> String {
    let header = ["run", "status", "reached s", "drift J", "largest rise J", "‖Φ‖", "‖dΦ/dt‖", "‖d²Φ/dt²‖", "its/step", "µs/step"];
    let rows: Vec<Vec<String>> = summaries.iter().map(|summary| row(summary)).collect();
    let reasons = summaries.iter().filter_map(|summary| {
        let label = text(summary, "label");
        let by_event = || ended(summary).map(|(event, at)| format!("\n{label} ended at {} s by the event `{event}`", short(at)));
        let stopped = summary["stopped_at"].as_f64();
        stopped.map(|at| format!("\n{label} stopped at {} s: {}", short(at), text(summary, "reason"))).or_else(by_event)
    });
    let reasons: String = reasons.collect();
    let gap = if reasons.is_empty() { "" } else { "\n" };
    format!("{}{gap}{reasons}", table(&header, &rows))
}

fn row(summary: &Value) -> Vec<String> {
    let number = |group: &str, key: &str| digits(summary[group][key].as_f64().unwrap_or(f64::NAN));
    let at_event = ended(summary).map(|(_, at)| at);
    let reached = summary["stopped_at"].as_f64().or(at_event).or(summary["end"].as_f64()).unwrap_or(f64::NAN);
    vec![
        text(summary, "label").into(),
        text(summary, "status").into(),
        short(reached),
        number("energy", "max_drift"),
        number("energy", "max_rise"),
        number("violation", "position"),
        number("violation", "velocity"),
        number("violation", "acceleration"),
        number("work", "iterations_per_step"),
        number("time", "us_per_step"),
    ]
}

fn text<'a>(summary: &'a Value, key: &str) -> &'a str {
    summary[key].as_str().unwrap_or("")
}

/// Three significant digits, so that a column can be compared at a glance; no number at all is a dash.
fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e4).contains(&size) => format!("{value:.*}", (2 - size.log10().floor() as i32).max(0) as usize),
        size if size.is_finite() => format!("{value:.2e}"),
        _ => "–".into(),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::options::{Cli, Command};

    #[test]
    fn a_column_has_three_digits() {
        for (value, text) in
            [(0.0, "0"), (6787.199264, "6787"), (12.935, "12.9"), (0.002744, "0.00274"), (-2.31e-13, "-2.31e-13"), (f64::NAN, "–")]
        {
            assert_eq!(digits(value), text);
        }
    }

    #[test]
    fn summaries_carry_the_label_of_the_table() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let words = "holonom compare example:simple-pendulum --end 0.1 --method radau --method ggl/bdf-2 --step 0.01 --step 0.02 --quiet --no-report --out";
        let Command::Compare(arguments) = Cli::parse_from(words.split(' ').chain([out])).command else { panic!("another command") };
        compare(&arguments).unwrap_or_else(|failure| panic!("{failure}"));
        let written = std::fs::read(folder.path().join("summary.json")).unwrap();
        let summaries: Vec<Value> = serde_json::from_slice(&written).unwrap();
        let labels: Vec<&str> = summaries.iter().map(|summary| text(summary, "label")).collect();
        assert_eq!(labels, ["radau, 0.01 s", "ggl/bdf-2, 0.01 s", "radau, 0.02 s", "ggl/bdf-2, 0.02 s"]);
        assert!(describe_runs(&summaries.iter().collect::<Vec<_>>()).contains("ggl/bdf-2, 0.02 s"));
    }

    #[test]
    fn why_a_run_stopped_is_told_below_the_table() {
        let stopped = json!({"label": "bold", "status": "stopped", "stopped_at": 1.5, "reason": "no convergence"});
        let told = describe_runs(&[&stopped, &json!({"label": "good", "status": "completed", "stopped_at": null, "end": 2.0})]);
        assert!(told.ends_with("\n\nbold stopped at 1.5 s: no convergence"), "{told}");
    }

    #[test]
    fn a_run_that_an_event_ended_did_not_reach_the_end_asked_for() {
        let events = json!([{"event": "lands", "t": 0.25, "stopped": false}, {"event": "lands", "t": 0.75, "stopped": true}]);
        let ended = json!({"label": "low", "status": "completed", "stopped_at": null, "end": 2.0, "ended_by": "lands", "events": events});
        let told = describe_runs(&[&ended, &json!({"label": "high", "status": "completed", "stopped_at": null, "end": 2.0})]);
        assert!(told.ends_with("\n\nlow ended at 0.75 s by the event `lands`"), "{told}");
        let reached: Vec<&str> = told.lines().skip(2).take(2).map(|line| line.split_whitespace().nth(2).unwrap()).collect();
        assert_eq!(reached, ["0.75", "2"], "{told}");
    }
}
