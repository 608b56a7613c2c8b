//! `holonom compare`.

use std::path::PathBuf;
use std::process::ExitCode;

use holonom::simulation::NAMED;
use holonom_report::Run;
use serde_json::Value;

use crate::failure::Failure;
use crate::load;
use crate::options::CompareArguments;
use crate::output::{Finished, Folder, Order, simulate, writers};
use crate::progress::interrupt_flag;
use crate::table::{short, table};

/// Runs every method with every step and puts the curves into one report. A run that stops early is part of the
/// comparison, not a failure of the command.
pub fn compare(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    let methods: Vec<String> = match arguments.methods.is_empty() {
        true => NAMED.iter().map(|named| named.name.to_string()).collect(),
        false => arguments.methods.clone(),
    };
    let steps: Vec<Option<&str>> = match arguments.steps.is_empty() {
        true => vec![None],
        false => arguments.steps.iter().map(|step| Some(step.as_str())).collect(),
    };
    let interrupted = interrupt_flag();
    let output = &arguments.output;
    let writers = writers(&output.formats)?;
    let mut finished: Vec<(String, Finished)> = Vec::new();
    let mut shown = None;
    for step in &steps {
        let mut overrides = load::overrides(&arguments.model.set);
        overrides.number("simulation.step", *step);
        overrides.number("simulation.end", arguments.end.as_deref());
        let loaded = load::load(&arguments.model.model, overrides)?;
        for name in &methods {
            let order = Order {
                method: load::method(&loaded, Some(name))?,
                step: loaded.step()?,
                end: loaded.end()?,
                every: output.every.unwrap_or(loaded.every()),
                quiet: output.quiet,
                resume: None,
            };
            let label = if steps.len() > 1 { format!("{name}, {} s", short(order.step)) } else { name.clone() };
            finished.push((label, simulate(&loaded, order, &interrupted)?));
        }
        shown = Some(loaded);
    }
    let loaded = shown.expect("there is at least one step");
    let path = output.out.clone().unwrap_or_else(|| PathBuf::from(format!("results/{}-compare", loaded.name)));
    let folder = Folder::create(&path)?;
    for (label, run) in &finished {
        let prefix = label.replace(", ", "-").replace(' ', "").replace('/', "-");
        folder.write_trajectory(&prefix, &writers, &loaded, &run.recording)?;
    }
    let summaries: Vec<&Value> = finished.iter().map(|(_, run)| &run.summary).collect();
    folder.write("summary.json", |out| holonom_io::write_json(&serde_json::json!(summaries), out))?;
    if !output.no_report {
        let runs: Vec<Run<'_>> = finished
            .iter()
            .map(|(label, run)| Run { label, recording: &run.recording, scene: &loaded.model.scene, summary: &run.summary })
            .collect();
        folder.write_report(&loaded, &runs)?;
    }
    if output.json {
        println!("{}", serde_json::to_string_pretty(&summaries).expect("a summary is plain data"));
    } else if !output.quiet {
        let header = ["run", "reached s", "drift J", "largest rise J", "‖Φ‖", "‖Φ̇‖", "‖Φ̈‖", "its/step", "µs/step"];
        let rows: Vec<Vec<String>> = finished.iter().map(|(label, run)| row(label, &run.summary)).collect();
        println!("{}\n{}\n\nresults in {}", loaded.title(), table(&header, &rows), folder.path.display());
    }
    Ok(ExitCode::SUCCESS)
}

fn row(label: &str, summary: &Value) -> Vec<String> {
    let number = |group: &str, key: &str| short(summary[group][key].as_f64().unwrap_or(f64::NAN));
    let reached = summary["stopped_at"].as_f64().or(summary["end"].as_f64()).unwrap_or(f64::NAN);
    vec![
        label.into(),
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
