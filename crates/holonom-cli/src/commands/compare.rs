//! `holonom compare`.

use std::process::ExitCode;

use holonom::simulation::NAMED;
use holonom_io::Writer;
use holonom_report::Run;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::folder::{Folder, file_stem, holds};
use crate::load::{self, Loaded};
use crate::options::CompareArguments;
use crate::output::{Finished, Order, simulate, writers};
use crate::progress::interrupt_flag;
use crate::table::{short, table};

/// A run that is asked for.
struct Planned {
    label: String,
    /// Index of its model, which differ in the step.
    model: usize,
    order: Order,
}

/// Runs every method with every step and puts the curves into one report. A run that stops early is part of the
/// comparison, not a failure of the command.
pub fn compare(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    let output = &arguments.output;
    let writers = writers(&output.formats)?;
    let models = models(arguments)?;
    let planned = plan(arguments, &models)?;
    let loaded = models.last().expect("there is at least one step");
    let summaries: Value = planned.iter().map(|run| json!({ "provenance": run.order.provenance })).collect();
    let folder = Folder::claim(&output.to, &format!("{}-compare", loaded.name), |path| holds(path, &summaries))?;
    let interrupted = interrupt_flag();
    let mut finished: Vec<(String, Finished)> = Vec::new();
    for Planned { label, model, order } in planned {
        let mut run = simulate(&models[model], order, &interrupted, None)?;
        name(&mut run.summary, &label, &models[model]);
        finished.push((label, run));
    }
    write(&folder, loaded, &finished, &writers, output.no_report)?;
    let summaries: Vec<&Value> = finished.iter().map(|(_, run)| &run.summary).collect();
    if output.to.json {
        println!("{}", serde_json::to_string_pretty(&summaries).expect("a summary is plain data"));
    } else if !output.to.quiet {
        println!("{}\n{}\n\nresults in {}", loaded.title(), describe(&summaries), folder.path.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// The model once for each step asked for.
fn models(arguments: &CompareArguments) -> Result<Vec<Loaded>, Failure> {
    let with_step = |step: Option<&str>| {
        let mut overrides = load::overrides(&arguments.model.set);
        overrides.number("simulation.step", step);
        overrides.number("simulation.end", arguments.end.as_deref());
        load::load_to_run(&arguments.model.model, overrides)
    };
    match arguments.steps.is_empty() {
        true => Ok(vec![with_step(None)?]),
        false => arguments.steps.iter().map(|step| with_step(Some(step))).collect(),
    }
}

/// Every method with every step; what is wrong with a name is said before anything runs.
fn plan(arguments: &CompareArguments, models: &[Loaded]) -> Result<Vec<Planned>, Failure> {
    let methods: Vec<&str> = match arguments.methods.is_empty() {
        true => NAMED.iter().map(|named| named.name).collect(),
        false => arguments.methods.iter().map(String::as_str).collect(),
    };
    let mut planned = Vec::new();
    for (model, loaded) in models.iter().enumerate() {
        for name in &methods {
            let order = Order::new(loaded, Some(name), &arguments.output)?;
            let label = if models.len() > 1 { format!("{name}, {} s", short(order.provenance.step)) } else { name.to_string() };
            planned.push(Planned { label, model, order });
        }
    }
    Ok(planned)
}

/// Puts into a summary how the run is called, and the accuracy where its steps follow from one.
fn name(summary: &mut Value, label: &str, loaded: &Loaded) {
    summary["label"] = json!(label);
    if let Some(accuracy) = loaded.model.settings.choice.accuracy {
        summary["accuracy"] = json!(accuracy);
    }
}

fn write(folder: &Folder, loaded: &Loaded, finished: &[(String, Finished)], writers: &[&Writer], no_report: bool) -> Result<(), Failure> {
    for (label, run) in finished {
        folder.write_trajectory(&file_stem(label), writers, loaded, &run.recording)?;
    }
    let summaries: Vec<&Value> = finished.iter().map(|(_, run)| &run.summary).collect();
    folder.write("summary.json", |out| holonom_io::write_json(&json!(summaries), out))?;
    if no_report {
        return Ok(());
    }
    let scene = &loaded.model.scene;
    let runs: Vec<Run<'_>> =
        finished.iter().map(|(label, run)| Run { label, recording: &run.recording, scene, summary: &run.summary }).collect();
    folder.write_report(loaded, &runs)
}

/// A table of all runs, and why those stopped that did.
fn describe(summaries: &[&Value]) -> String {
    let header = ["run", "status", "reached s", "drift J", "largest rise J", "‖Φ‖", "‖dΦ/dt‖", "‖d²Φ/dt²‖", "its/step", "µs/step"];
    let rows: Vec<Vec<String>> = summaries.iter().map(|summary| row(summary)).collect();
    let reasons = summaries.iter().filter_map(|summary| {
        let at = summary["stopped_at"].as_f64()?;
        Some(format!("\n{} stopped at {} s: {}", text(summary, "label"), short(at), text(summary, "reason")))
    });
    let reasons: String = reasons.collect();
    let gap = if reasons.is_empty() { "" } else { "\n" };
    format!("{}{gap}{reasons}", table(&header, &rows))
}

fn row(summary: &Value) -> Vec<String> {
    let number = |group: &str, key: &str| digits(summary[group][key].as_f64().unwrap_or(f64::NAN));
    let reached = summary["stopped_at"].as_f64().or(summary["end"].as_f64()).unwrap_or(f64::NAN);
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
        assert!(describe(&summaries.iter().collect::<Vec<_>>()).contains("ggl/bdf-2, 0.02 s"));
    }

    #[test]
    fn why_a_run_stopped_is_told_below_the_table() {
        let stopped = json!({"label": "bold", "status": "stopped", "stopped_at": 1.5, "reason": "no convergence"});
        let told = describe(&[&stopped, &json!({"label": "good", "status": "completed", "stopped_at": null, "end": 2.0})]);
        assert!(told.ends_with("\n\nbold stopped at 1.5 s: no convergence"), "{told}");
    }
}
