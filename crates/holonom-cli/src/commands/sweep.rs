//! `holonom sweep`.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use cpu_time::ProcessTime;
use holonom_io::Table;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::failure::{Failure, STOPPED};
use crate::folder::Folder;
use crate::items::items;
use crate::load;
use crate::options::SweepArguments;
use crate::output::table_writers;
use crate::progress::{interrupt_flag, runs_bar};
use crate::sweep::{Ending, Journal, Plan, Runner, Sheet, check, write_report};
use crate::table::{list, measured};

/// The file in the folder that holds finished runs.
const JOURNAL: &str = "sweep.journal";

/// Runs every run of a plan that its journal does not hold yet, and writes the table of all.
pub fn sweep(arguments: &SweepArguments) -> Result<ExitCode, Failure> {
    let writers = table_writers(&arguments.formats)?;
    let plan = Plan::new(arguments)?;
    let mut overrides = load::overrides(&arguments.model.set);
    overrides.number("simulation.step", arguments.method.step.as_deref());
    overrides.number("simulation.end", arguments.method.end.as_deref());
    let (source, name) = load::open(&arguments.model.model, &overrides)?;
    let columns = check(arguments, &overrides, &source, &plan)?;
    let sheet = Sheet::new(&plan, &columns);
    let identity = identity(arguments, overrides.given(), source.text());
    let folder = Folder::claim(&arguments.to, &format!("{name}-sweep"), |path| is_of(path, arguments, &identity))?;
    let mut journal = open(&folder, &identity, &plan, &sheet)?;
    let runner = Runner {
        source: &source,
        plan: &plan,
        method: arguments.method.name.as_deref(),
        columns: &columns,
        eliminations: Arc::default(),
        interrupted: interrupt_flag(),
    };
    let spent = run(&runner, &sheet, &mut journal, arguments)?;
    let table = sheet.table(journal.lines.iter().flatten());
    let is_whole = journal.missing().is_empty();
    if is_whole {
        writers.iter().try_for_each(|(writer, write)| folder.write(&format!("sweep.{}", writer.extension), |out| write(&table, out)))?;
        if !arguments.no_report {
            folder.write("report.html", |out| write_report((&source, &name), overrides.given(), &plan, &columns, &table, out))?;
        }
    }
    let any_completed = sheet.count(&table, Ending::Completed) > 0;
    tell(arguments, &folder, &summary(&name, &plan, &sheet, &table, &spent), is_whole);
    // Whatever was asked not to be said, a status of failure has its reason.
    if !arguments.to.quiet || !any_completed {
        tell_failures(&sheet.failures(&table), any_completed);
    }
    Ok(if is_whole && any_completed { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// What two sweeps must have in common for one to go on with the other's runs.
fn identity(arguments: &SweepArguments, set: &[String], text: &str) -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"), "vary": arguments.vary, "samples": arguments.samples,
        "seed": arguments.samples.map(|_| arguments.seed), "set": set, "method": arguments.method.name,
        "columns": arguments.columns.iter().flat_map(|given| items(given)).collect::<Vec<_>>(),
        "model": text,
    })
}

/// Whether a folder holds runs of the same sweep. Where the user names a folder with another sweep in it, its journal says what differs.
fn is_of(path: &Path, arguments: &SweepArguments, identity: &Value) -> bool {
    let journal = path.join(JOURNAL);
    let is_named = arguments.to.out.is_some() && !arguments.to.force;
    Journal::is_of(&journal, identity) || (is_named && (journal.exists() || path.join("sweep.csv").exists()))
}

/// The journal of the folder. A table that no journal vouches for is left alone.
fn open(folder: &Folder, identity: &Value, plan: &Plan, sheet: &Sheet) -> Result<Journal, Failure> {
    let (journal, table) = (folder.path.join(JOURNAL), folder.path.join("sweep.csv"));
    if table.exists() && !journal.exists() {
        return Err(Failure::usage(
            format!("{} is there without its {JOURNAL}", table.display()),
            "give another --out, or --force to overwrite it",
        ));
    }
    Journal::open(&journal, identity, plan.runs, sheet)
}

/// What the runs of this call took.
struct Spent {
    threads: usize,
    /// s
    cpu: f64,
    steps: u64,
}

/// Runs what is missing in the journal, in no order.
fn run(runner: &Runner<'_>, sheet: &Sheet, journal: &mut Journal, arguments: &SweepArguments) -> Result<Spent, Failure> {
    let missing = journal.missing();
    let bar = runs_bar(runner.plan.runs, runner.plan.runs - missing.len() as u64, arguments.to.quiet);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build();
    let pool = pool.map_err(|error| Failure::usage(format!("the threads cannot be started: {error}"), "give fewer --threads"))?;
    let (steps, journal, cpu) = (AtomicU64::new(0), Mutex::new(journal), ProcessTime::now());
    let one = |&run: &u64| {
        let settings = runner.plan.settings(run);
        let Some(outcome) = runner.run(&settings) else { return Ok(()) };
        steps.fetch_add(outcome.figures.as_ref().map_or(0, |figures| figures.steps), Ordering::Relaxed);
        let line = sheet.line(run, &settings, &outcome);
        bar.inc(1);
        journal.lock().expect("no run panics while it writes").add(run, line)
    };
    pool.install(|| missing.par_iter().with_max_len(1).try_for_each(one))?;
    bar.finish_and_clear();
    Ok(Spent { threads: pool.current_num_threads(), cpu: cpu.elapsed().as_secs_f64(), steps: steps.into_inner() })
}

fn summary(name: &str, plan: &Plan, sheet: &Sheet, table: &Table, spent: &Spent) -> Value {
    let [completed, stopped, refused] = Ending::ALL.map(|ending| sheet.count(table, ending));
    json!({
        "model": name, "runs": plan.runs, "completed": completed, "stopped": stopped, "refused": refused, "threads": spent.threads,
        "time": { "cpu_s": spent.cpu, "steps": spent.steps, "us_per_step": (spent.steps > 0).then(|| 1e6 * spent.cpu / spent.steps as f64) },
    })
}

/// Says how it went.
fn tell(arguments: &SweepArguments, folder: &Folder, summary: &Value, is_whole: bool) {
    if !is_whole {
        eprintln!("interrupted: {JOURNAL} holds the finished runs, and the same command goes on");
    }
    if arguments.to.json {
        println!("{}", serde_json::to_string_pretty(summary).expect("a summary is plain data"));
    } else if !arguments.to.quiet {
        println!("{}\n\nresults in {}", describe(summary), folder.path.display());
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
    let time = |key: &str| summary["time"][key].as_f64().map_or("–".to_string(), measured);
    let items = [
        ("runs", format!("{} on {} threads", summary["runs"], summary["threads"])),
        ("status", format!("{} completed, {} stopped, {} refused", summary["completed"], summary["stopped"], summary["refused"])),
        ("time", format!("{} s of the processor, {} µs a step", time("cpu_s"), time("us_per_step"))),
    ];
    format!("{}\n{}", summary["model"].as_str().unwrap_or(""), list(&items))
}
