//! `holonom run`.

use std::process::ExitCode;

use serde_json::{Value, json};

use crate::checkpoint::Resumed;
use crate::failure::{Failure, STOPPED};
use crate::folder::{Folder, file_stem, holds};
use crate::keeper::Keeper;
use crate::load::{self, Loaded};
use crate::message::{listed, note};
use crate::options::{OutputArguments, RunArguments};
use crate::output::{Order, recorder, simulate_kept, writers};
use crate::progress::interrupt_flag;
use crate::table::{figures, figures_between, freedom, list, measured, short};

/// Of runs whose steps are chosen.
const CHANGED_ACCURACY: &str = "an accuracy is that of the whole run, so its steps depend on its end: the rows up to the checkpoint are those of the \
                                earlier end";

/// Simulates one model by one method and leaves everything in a folder.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    load::require_kept(&arguments.model.set, arguments.method.name.is_some())?;
    let mut overrides = load::overrides(&arguments.model.set);
    overrides.number("simulation.step", arguments.method.step.as_deref());
    overrides.number("simulation.accuracy", arguments.method.accuracy.as_deref());
    overrides.number("simulation.end", arguments.method.end.as_deref());
    let loaded = load::load_to_run(&arguments.model.model, overrides)?;
    let output = &arguments.output;
    let writers = writers(&output.formats)?;
    let mut order = Order::new(&loaded, arguments.method.name.as_deref(), output.every, output.to.quiet)?;
    let (folder, on_disk) = place(arguments, &loaded, &mut order)?;
    let mut keeper = Keeper::new(&folder, &loaded, &writers, &order.provenance);
    if let Some(OnDisk { table, rows, bytes }) = on_disk {
        keeper.go_on(&table, rows, bytes);
    }
    let (finished, reached) = simulate_kept(&loaded, order, &interrupt_flag(), Some(&mut keeper))?;
    match keeper.is_behind(reached.last.run.state.t) {
        Some(t) if !output.to.quiet => note(&format!("{} holds the same run up to {} s, which stays", folder.path.display(), short(t))),
        Some(_) => (),
        None => {
            keeper.finish(&finished.recording, reached.last, reached.before_end)?;
            finished.write(&folder, &loaded, &keeper.others(&writers), !output.no_report)?;
        }
    }
    if output.to.json {
        println!("{}", serde_json::to_string_pretty(&finished.summary).expect("a summary is plain data"));
    } else if !output.to.quiet {
        println!("{}", describe(&loaded, &finished.summary));
        println!("\nresults in {}", folder.path.display());
    } else if !finished.completed {
        eprintln!("{}", status(&finished.summary).replace('\n', " "));
    }
    Ok(if finished.completed { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// Rows of an earlier run in the folder, and the file and the bytes that have them.
struct OnDisk {
    table: String,
    rows: usize,
    bytes: u64,
}

/// The folder for a run. One that is resumed is told where to go on, and stays in the folder of the earlier run unless another is named.
fn place(arguments: &RunArguments, loaded: &Loaded, order: &mut Order) -> Result<(Folder, Option<OnDisk>), Failure> {
    let output = &arguments.output;
    let Some(path) = &arguments.resume else { return Ok((claim(loaded, order, output)?, None)) };
    let resumed = Resumed::open(path, &order.provenance, &loaded.source)?;
    if !output.to.quiet && loaded.model.settings.choice.accuracy.is_some() && resumed.end != order.provenance.end {
        note(CHANGED_ACCURACY);
    }
    let mut before = recorder(&loaded.model, order.provenance.every).finish();
    let bytes = resumed.rows(&mut before)?;
    let rows = before.rows();
    let stays = output.to.out.as_deref().is_none_or(|out| resumed.is_in(out));
    order.resume = Some((resumed.point, before));
    match stays {
        true => Ok((resumed.folder, Some(OnDisk { table: resumed.table, rows, bytes }))),
        false => Ok((claim(loaded, order, output)?, None)),
    }
}

/// The folder for a run that does not go on in that of an earlier one.
fn claim(loaded: &Loaded, order: &Order, output: &OutputArguments) -> Result<Folder, Failure> {
    let usual = format!("{}-{}", loaded.name, file_stem(&order.method.name));
    let folder = Folder::claim(&output.to, &usual, |path| holds(path, &json!({ "provenance": order.provenance })))?;
    if let Some(t) = folder.reached().filter(|_| !output.to.quiet && !folder.path.join("summary.json").exists()) {
        let path = folder.path.display();
        note(&format!("{path} holds this run up to {} s, where it was killed; --resume {path} goes on from there", short(t)));
    }
    Ok(folder)
}

/// Sorts of what acts, in the order in which they are counted.
const SORTS: [&str; 3] = ["drives", "forces", "joints"];

/// The largest of what acts of a sort, one after the other.
fn peaks(summary: &Value, sort: usize) -> String {
    let (of_sort, more) = (&summary["peaks"][SORTS[sort]], &summary["peaks"]["more"][sort]);
    let peak = |peak: &Value| {
        let [value, at] = ["value", "at"].map(|key| figures(peak[key].as_f64().unwrap_or(f64::NAN)));
        [peak["name"].as_str().unwrap_or("").to_string(), value, format!("{} at {at} s", peak["unit"].as_str().unwrap_or(""))]
    };
    let peaks: Vec<[String; 3]> = of_sort.as_array().into_iter().flatten().map(peak).collect();
    aligned(&peaks, more.as_u64().unwrap_or(0) as usize)
}

/// Works that have lines of their own.
const WORKS: usize = 10;

/// What put energy into the mechanism, and below zero what took it out.
fn works(summary: &Value) -> String {
    let (works, more) = holonom_report::largest_works(summary, WORKS);
    let works: Vec<[String; 3]> = works
        .into_iter()
        .map(|own| {
            let stored = own.stored.map_or(String::new(), |stored| {
                format!("; holds {} J {} than at the start", figures(stored.abs()), if stored > 0.0 { "more" } else { "less" })
            });
            [own.name, figures(own.work), format!("J{stored}")]
        })
        .collect();
    aligned(&works, more)
}

/// Lines of a name, a number and more, the numbers below each other, and how many are not listed.
fn aligned(entries: &[[String; 3]], more: usize) -> String {
    let width = |k: usize| entries.iter().map(|entry| entry[k].chars().count()).max().unwrap_or(0);
    let (names, values) = (width(0), width(1));
    let mut lines: Vec<String> = entries.iter().map(|[name, value, rest]| format!("{name:names$}  {value:>values$} {rest}")).collect();
    lines.extend((more > 0).then(|| format!("{more} smaller one{}", if more == 1 { "" } else { "s" })));
    lines.join("\n")
}

/// How far each measure goes.
fn measures(of: &Value) -> String {
    let line = |measure: &Value| {
        let number = |key: &str| measure[key].as_f64().unwrap_or(f64::NAN);
        let [min, max, last] = ["min", "max", "last"].map(|key| figures_between(number(key), [number("min"), number("max")]));
        let [min_at, max_at] = ["min_at", "max_at"].map(|key| figures(number(key)));
        let unit = measure["unit"].as_str().filter(|unit| *unit != "1").map_or(String::new(), |unit| format!(" {unit}"));
        format!("{}  {min} at {min_at} s … {max}{unit} at {max_at} s, {last} at the end", measure["name"].as_str().unwrap_or(""))
    };
    of.as_array().into_iter().flatten().map(line).collect::<Vec<_>>().join("\n")
}

/// Events that have lines of their own.
const LISTED: usize = 20;

/// The events of the run by their names: how often each happened, first and last, the one that ended the run at the end; and those that did not happen.
fn events(summary: &Value, conditions: &[String]) -> String {
    let events = summary["events"].as_array().map_or(&[][..], Vec::as_slice);
    let name = |event: &Value| event["event"].as_str().unwrap_or("").to_string();
    let mut happened: Vec<(String, Vec<f64>)> = Vec::new();
    for event in events {
        let t = event["t"].as_f64().unwrap_or(f64::NAN);
        match happened.iter_mut().find(|(known, _)| *known == name(event)) {
            Some((_, times)) => times.push(t),
            None => happened.push((name(event), vec![t])),
        }
    }
    // Frequencies are read off times: small ones have as many figures as others.
    let time = |t: f64| if (1e-12..1e-3).contains(&t) { format!("{t:.5e}") } else { short(t) };
    let ended_by = summary["ended_by"].as_str();
    happened.sort_by_key(|(name, _)| Some(name.as_str()) == ended_by);
    let line = |(name, times): &(String, Vec<f64>)| {
        let (first, last) = (time(times[0]), time(times[times.len() - 1]));
        let end = if Some(name.as_str()) == ended_by { ", where the run ended" } else { "" };
        match times.len() {
            1 => format!("{name} at {first} s{end}"),
            count => format!("{name} {count} times, first at {first} s and last at {last} s{end}"),
        }
    };
    let missing: Vec<String> = conditions.iter().filter(|name| happened.iter().all(|(known, _)| known != *name)).cloned().collect();
    let mut lines: Vec<String> = happened.iter().map(line).collect();
    if let more @ 1.. = lines.len().saturating_sub(LISTED) {
        lines.splice(LISTED - 1..LISTED - 1 + more, [format!("{more} more in summary.json")]);
    }
    lines.extend((!missing.is_empty()).then(|| format!("{} did not happen", listed(&missing))));
    lines.join("\n")
}

/// Which steps were recorded, where not all were. Forces of constraints are not found between them, and so not looked at.
fn recorded(summary: &Value) -> String {
    let every = match summary["provenance"]["every"].as_u64() {
        None | Some(1) => String::new(),
        Some(every) => format!("; one in {every} recorded"),
    };
    let is_sparse = !every.is_empty() || summary["work"]["steps_taken"].as_u64() > summary["steps"].as_u64();
    let is_shown = ["drives", "joints"].iter().any(|sort| summary["peaks"][sort].as_array().is_some_and(|peaks| !peaks.is_empty()));
    match is_sparse && is_shown {
        true => format!("{every}; the largest values of drives and joints are those in the rows recorded"),
        false => every,
    }
}

/// How a run ended.
fn status(summary: &Value) -> String {
    match summary["stopped_at"].as_f64() {
        None => "completed".to_string(),
        Some(at) => format!("stopped at {} s: {}", short(at), summary["reason"].as_str().unwrap_or("")),
    }
}

/// Names of the events that happen on a condition; those with a period happen all the time.
fn conditions(loaded: &Loaded) -> Vec<String> {
    loaded.model.system.conditions().map(str::to_string).collect()
}

/// The summary as people read it.
pub fn describe(loaded: &Loaded, summary: &Value) -> String {
    let number = |group: &str, key: &str| short(summary[group][key].as_f64().unwrap_or(f64::NAN));
    let time = |key: &str| summary["time"][key].as_f64().map_or("–".into(), measured);
    let mut items = vec![("method", summary["method"]["name"].as_str().unwrap_or("").to_string()), ("status", status(summary))];
    // What the model asks for comes first.
    items.extend([("measures", measures(&summary["peaks"]["measures"])), ("events", events(summary, &conditions(loaded)))]);
    items.extend([0, 1, 2].map(|sort| (SORTS[sort], peaks(summary, sort))));
    items.push(("work", works(summary)));
    items.retain(|(_, text)| !text.is_empty());
    items.extend([
        (
            "size",
            format!(
                "{} coordinates, {} rows of rank {} ({} redundant), {}",
                summary["coordinates"],
                summary["constraints"],
                summary["rank"],
                summary["redundant"],
                freedom(summary["dof"].as_u64().unwrap_or(0))
            ),
        ),
        (
            "steps",
            format!(
                "{} of {} s{}, {} iterations{}, {} rejected{}",
                summary["steps"],
                short(summary["step"].as_f64().unwrap_or(0.0)),
                match summary["method"]["accuracy"].as_f64() {
                    None => String::new(),
                    Some(accuracy) => format!(", {} taken for an accuracy of {}", summary["work"]["steps_taken"], short(accuracy)),
                },
                number("work", "iterations_per_step"),
                // A run that stopped at its start has taken none.
                if summary["work"]["steps_taken"].as_u64() == Some(0) { "" } else { " in each" },
                summary["work"]["rejected_steps"],
                recorded(summary)
            ),
        ),
        ("energy", format!("{} J at the start, {} J at the end", number("energy", "initial"), number("energy", "final"))),
        (
            "drift",
            format!("{} J beyond the work done, largest rise in a step {} J", number("energy", "max_drift"), number("energy", "max_rise")),
        ),
        (
            "balance",
            format!(
                "integrator {} J, projection {} J, work {} J",
                number("energy", "integrator_total"),
                number("energy", "projection_total"),
                number("energy", "work_total")
            ),
        ),
        (
            "violation",
            format!(
                "position {}, velocity {}, acceleration {}",
                number("violation", "position"),
                number("violation", "velocity"),
                number("violation", "acceleration")
            ),
        ),
    ]);
    // What nothing keeps has no drift.
    let drifts = ["linear", "angular"].map(|of| (of, format!("{of}_drift"))).into_iter().filter(|(_, key)| summary["momentum"][key] != 0.0);
    let drifts: Vec<String> = drifts.map(|(of, key)| format!("{of} drift {}", number("momentum", &key))).collect();
    items.extend((!drifts.is_empty()).then(|| ("momentum", drifts.join(", "))));
    if summary["end"] == 0.0 {
        // Of the start alone there is nothing that a method could have made.
        items.retain(|(key, _)| !["steps", "drift", "balance", "momentum"].contains(key));
    }
    // A run that stopped at its start has no time of a step.
    if summary["steps"].as_u64() != Some(0) {
        items.push(("time", format!("{} µs a step, {} times real time", time("us_per_step"), time("realtime_factor"))));
    }
    if let Value::Object(step) = &summary["time"]["step_us"] {
        let time = |key: &str| measured(step[key].as_f64().unwrap_or(f64::NAN));
        let text =
            format!("median {} µs, 90 % within {}, 99 % within {}, longest {}", time("median"), time("p90"), time("p99"), time("max"));
        items.push(("one step", text));
    }
    format!("{}\n{}", loaded.title(), list(&items))
}
