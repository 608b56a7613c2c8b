//! `holonom sweep`.

use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use cpu_time::ProcessTime;
use holonom_io::Table;
use serde_json::{Value, json};

use crate::failure::{Failure, STOPPED};
use crate::items::items;
use crate::load;
use crate::message::note;
use crate::options::SweepArguments;
use crate::output::table_writers;
use crate::progress::{interrupt_flag, runs_bar};
use crate::sweep::{Answers, Ending, JOURNAL, Line, Plan, Store, Study};
use crate::table::{list, measured};

/// Runs every run of a plan that its journal does not hold yet, and writes the table of all.
pub fn sweep(arguments: &SweepArguments) -> Result<ExitCode, Failure> {
    let writers = table_writers(&arguments.formats)?;
    let plan = Plan::new(arguments)?;
    let varied = plan.varied.len();
    load::require_kept(&arguments.model.set, arguments.method.name.is_some())?;
    let mut overrides = load::overrides(&arguments.model.set);
    overrides.number("simulation.step", arguments.method.step.as_deref());
    overrides.number("simulation.accuracy", arguments.method.accuracy.as_deref());
    overrides.number("simulation.end", arguments.method.end.as_deref());
    let (source, name) = load::open(&arguments.model.model, &overrides)?;
    let columns: Vec<String> = arguments.columns.iter().flat_map(|given| items(given)).map(str::to_string).collect();
    let study = Study::new(source, &name, plan, arguments.method.name.as_deref(), &columns)?;
    if !arguments.to.quiet {
        study.slips().iter().for_each(|text| note(text));
    }
    let identity = identity(arguments, &columns, overrides.given(), &study);
    let mut store = Store::claim(&arguments.to, &format!("{name}-sweep"), &study, &identity)?;
    let spent = run(&study, &mut store, arguments)?;
    let table = store.table(&study);
    let is_whole = store.is_whole();
    if is_whole {
        store.finish(&study, &table, &writers, (!arguments.no_report).then_some(overrides.given()))?;
    }
    let any_completed = study.count(&table, Ending::Completed) > 0;
    let units = if columns.is_empty() { &[] } else { study.units() };
    let answers = Answers::new(&table, varied, units);
    let mut summary = summary(&name, &study, &table, &spent);
    if !columns.is_empty() {
        summary["columns"] = answers.values();
    }
    summary["notes"] = if is_whole { study.notes(&table) } else { study.slips() }.into();
    tell(arguments, &store, &summary, &answers, is_whole);
    if is_whole && !arguments.to.quiet {
        study.of_runs(&table).iter().for_each(|text| note(text));
    }
    // Whatever was asked not to be said, a status of failure has its reason.
    if !arguments.to.quiet || !any_completed {
        tell_failures(&study.failures(&table), any_completed);
    }
    Ok(if is_whole && any_completed { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// What two sweeps must have in common for one to go on with the other's runs.
fn identity(arguments: &SweepArguments, columns: &[String], set: &[String], study: &Study) -> Value {
    let mut identity = study.identity(set);
    identity["columns"] = json!(columns);
    identity["vary"] = json!(arguments.vary);
    identity["samples"] = json!(arguments.samples);
    identity["seed"] = json!(arguments.samples.map(|_| arguments.seed));
    identity
}

/// What the runs of this call took.
struct Spent {
    threads: usize,
    /// s
    cpu: f64,
    steps: u64,
}

/// Runs what is missing in the journal, in no order.
fn run(study: &Study, store: &mut Store, arguments: &SweepArguments) -> Result<Spent, Failure> {
    let missing = store.missing();
    let bar = runs_bar(study.runs(), study.runs() - missing.len() as u64, arguments.to.quiet);
    let threads = arguments.threads.map_or_else(rayon::current_num_threads, usize::from);
    let (steps, store, cpu) = (AtomicU64::new(0), Mutex::new(store), ProcessTime::now());
    study.run(&missing, threads, &interrupt_flag(), &|line: Line| {
        steps.fetch_add(line.steps, Ordering::Relaxed);
        bar.inc(1);
        store.lock().expect("no run panics while it writes").add(line)
    })?;
    bar.finish_and_clear();
    Ok(Spent { threads, cpu: cpu.elapsed().as_secs_f64(), steps: steps.into_inner() })
}

fn summary(name: &str, study: &Study, table: &Table, spent: &Spent) -> Value {
    let [completed, stopped, refused] = Ending::ALL.map(|ending| study.count(table, ending));
    json!({
        "model": name, "runs": study.runs(), "completed": completed, "stopped": stopped, "refused": refused, "threads": spent.threads,
        "time": { "cpu_s": spent.cpu, "steps": spent.steps, "us_per_step": (spent.steps > 0).then(|| 1e6 * spent.cpu / spent.steps as f64) },
    })
}

/// Says how it went.
fn tell(arguments: &SweepArguments, store: &Store, summary: &Value, answers: &Answers<'_>, is_whole: bool) {
    if !is_whole {
        eprintln!("interrupted: {JOURNAL} holds the finished runs, and the same command goes on");
    }
    if arguments.to.json {
        println!("{}", serde_json::to_string_pretty(summary).expect("a summary is plain data"));
    } else if !arguments.to.quiet {
        let folder = store.path().unwrap_or(".".as_ref());
        let answers = answers.words().filter(|_| is_whole).map_or(String::new(), |words| format!("\n\n{words}"));
        println!("{}{answers}\n\nresults in {}", describe(summary), folder.display());
    }
}

/// Runs that did not complete of which the reasons are told.
const TOLD: usize = 5;

/// Says on standard error why runs did not complete.
fn tell_failures(failures: &[String], any_completed: bool) {
    failures.iter().take(TOLD).for_each(|failure| eprintln!("{failure}"));
    if failures.len() > TOLD {
        eprintln!("and {} more runs did not complete: the column `reason` of the table has why", failures.len() - TOLD);
    }
    if !any_completed && !failures.is_empty() {
        eprintln!("no run completed");
    }
}

/// The summary as people read it.
fn describe(summary: &Value) -> String {
    let time = |key: &str, unit: &str| summary["time"][key].as_f64().map(|time| format!("{} {unit}", measured(time)));
    let times = [time("cpu_s", "s of the processor"), time("us_per_step", "µs a step")];
    let items = [
        ("runs", format!("{} on {} threads", summary["runs"], summary["threads"])),
        ("status", format!("{} completed, {} stopped, {} refused", summary["completed"], summary["stopped"], summary["refused"])),
        ("time", times.into_iter().flatten().collect::<Vec<_>>().join(", ")),
    ];
    format!("{}\n{}", summary["model"].as_str().unwrap_or(""), list(&items))
}
