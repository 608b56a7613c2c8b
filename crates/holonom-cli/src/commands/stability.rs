//! `holonom stability`.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use holonom::analysis::{LargestStep, largest_step};
use holonom::simulation::{Choice, Method, NAMED, Simulation, Status, Verdict};
use holonom_report::{Search, StabilityReport};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::folder::{Folder, holds};
use crate::found::Found;
use crate::load::{self, Loaded};
use crate::options::StabilityArguments;
use crate::provenance::Provenance;
use crate::table::{short, table};

/// Largest step tried, over the length of the run: beyond it there is little left to complete.
const LARGEST_SHARE: f64 = 0.1;

/// Ratio between the step that completes and the step that fails at which the search ends.
const RATIO: f64 = 1.01;

/// Energy above its start, over the exchanged energy, at which a run counts as unstable although it went on.
const EXPLODED: f64 = 1e6;

/// Where the search takes place, s.
struct Bounds {
    end: f64,
    first: f64,
    limit: f64,
}

impl Bounds {
    fn of(loaded: &Loaded) -> Result<Self, Failure> {
        let [first, end] = loaded.model.times().map_err(load::run_failure)?;
        if end == 0.0 {
            return Err(Failure::usage("a run that ends at 0 s takes no step", "give --end 10"));
        }
        Ok(Self { end, first, limit: LARGEST_SHARE * end })
    }
}

/// Searches the largest step of each method. Steps are never subdivided here, nor chosen by an accuracy.
pub fn stability(arguments: &StabilityArguments) -> Result<ExitCode, Failure> {
    load::require_kept(&arguments.model.set, !arguments.methods.is_empty())?;
    let mut overrides = load::overrides(&arguments.model.set);
    overrides.number("simulation.step", arguments.step.as_deref());
    overrides.number("simulation.end", arguments.end.as_deref());
    let loaded = load::load(&arguments.model.model, overrides)?;
    let bounds = Bounds::of(&loaded)?;
    let searches = searches(&arguments.methods, &loaded)?;
    let planned: Value = searches.iter().map(|(.., provenance)| json!({ "provenance": provenance })).collect();
    let folder = Folder::claim(&arguments.to, &format!("{}-stability", loaded.name), |path| holds(path, &planned))?;
    let (provenances, found) = search_all(searches, &loaded, &bounds, &AtomicBool::new(false));
    let results = results(&loaded, &bounds, &found, &provenances);
    folder.write("stability.json", |out| holonom_io::write_json(&results, out))?;
    if !arguments.no_report {
        write_report(&folder, &loaded, &bounds, &found, &results[0]["provenance"])?;
    }
    if arguments.to.json {
        println!("{}", serde_json::to_string_pretty(&results).expect("a result is plain data"));
    } else if !arguments.to.quiet {
        println!("{}\n\nresults in {}", describe(&loaded, &bounds, &found), folder.path.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Names and choices of the methods, and what their runs are; what is wrong with one is said before anything runs.
fn searches(methods: &[String], loaded: &Loaded) -> Result<Vec<(String, Choice, Provenance)>, Failure> {
    let names: Vec<&str> = match methods.is_empty() {
        true => NAMED.iter().map(|named| named.name).collect(),
        false => methods.iter().map(String::as_str).collect(),
    };
    let search = |name: &str| {
        let mut choice = loaded.model.choice(Some(name));
        choice.subdivide = Some(false);
        // Of steps that it chooses none is the largest.
        choice.accuracy = None;
        let method = Method::resolve(&choice).map_err(load::method_failure)?;
        Ok((name.to_string(), choice, loaded.provenance(&method, None, None)?))
    };
    names.into_iter().map(search).collect()
}

/// Searches the largest steps of some methods, or of all, for a program; the flag ends the search, of which nothing is left then.
///
/// # Errors
/// A model without step or end, and a method that cannot be.
pub fn largest_steps(loaded: &Loaded, methods: &[String], interrupted: &AtomicBool) -> Result<Option<Found>, Failure> {
    let bounds = Bounds::of(loaded)?;
    let (provenances, found) = search_all(searches(methods, loaded)?, loaded, &bounds, interrupted);
    let found = Found { value: results(loaded, &bounds, &found, &provenances), text: describe(loaded, &bounds, &found) };
    Ok((!interrupted.load(Ordering::Relaxed)).then_some(found))
}

/// What the runs of each method are, and its largest step.
fn search_all(
    searches: Vec<(String, Choice, Provenance)>,
    loaded: &Loaded,
    bounds: &Bounds,
    interrupted: &AtomicBool,
) -> (Vec<Provenance>, Vec<(String, LargestStep)>) {
    let one = |(name, choice, provenance)| (provenance, (name, search(loaded, &choice, bounds, interrupted)));
    searches.into_iter().map(one).unzip()
}

fn search(loaded: &Loaded, choice: &Choice, bounds: &Bounds, interrupted: &AtomicBool) -> LargestStep {
    largest_step(bounds.first, bounds.limit, RATIO, |step| completes(loaded, choice, step, bounds.end, interrupted))
}

/// Whether a run reaches its end without its energy exploding on the way.
fn completes(loaded: &Loaded, choice: &Choice, step: f64, end: f64, interrupted: &AtomicBool) -> bool {
    if interrupted.load(Ordering::Relaxed) {
        return false;
    }
    let method = Method::resolve(choice).expect("the choice was resolved before");
    let Ok(mut simulation) = Simulation::new(loaded.model.system.clone(), method, step) else { return false };
    let status = simulation.run(end, &mut |simulation: &Simulation| {
        let energy = simulation.audit().energy_summary();
        let exploded = !energy.last.is_finite() || energy.max_drift > EXPLODED * (energy.initial.abs() + energy.work_total.abs() + 1.0);
        if exploded || interrupted.load(Ordering::Relaxed) { Verdict::Stop } else { Verdict::GoOn }
    });
    status == Status::Completed
}

/// Content of `stability.json`.
fn results(loaded: &Loaded, bounds: &Bounds, found: &[(String, LargestStep)], provenances: &[Provenance]) -> Value {
    let result = |((name, found), provenance): (&(String, LargestStep), &Provenance)| {
        json!({
            "method": name, "completes": found.completes, "fails": found.fails, "runs": found.runs,
            "model": loaded.name, "end": bounds.end, "first": bounds.first, "limit": bounds.limit,
            "provenance": provenance,
        })
    };
    Value::Array(found.iter().zip(provenances).map(result).collect())
}

fn write_report<'a>(
    folder: &Folder,
    loaded: &Loaded,
    bounds: &Bounds,
    found: &'a [(String, LargestStep)],
    provenance: &Value,
) -> Result<(), Failure> {
    let search =
        |(method, found): &'a (String, LargestStep)| Search { method, completes: found.completes, fails: found.fails, runs: found.runs };
    let searches: Vec<Search<'_>> = found.iter().map(search).collect();
    let report = StabilityReport {
        title: loaded.title(),
        model_text: loaded.source.text(),
        provenance,
        end: bounds.end,
        first: bounds.first,
        limit: bounds.limit,
        ratio: RATIO,
        exploded: EXPLODED,
        searches: &searches,
    };
    folder.write("report.html", |out| report.write(out))
}

/// The search as people read it.
fn describe(loaded: &Loaded, bounds: &Bounds, found: &[(String, LargestStep)]) -> String {
    let header = ["method", "completes s", "fails s", "runs"];
    let row = |(name, found): &(String, LargestStep)| {
        let completes = if found.completes > 0.0 { short(found.completes) } else { "none".into() };
        let fails = found.fails.map_or("none tried".to_string(), short);
        vec![name.clone(), completes, fails, found.runs.to_string()]
    };
    let rows: Vec<Vec<String>> = found.iter().map(row).collect();
    let Bounds { end, first, limit } = bounds;
    let question =
        format!("largest step that completes a run of {} s, searched from {} s up to {} s", short(*end), short(*first), short(*limit));
    format!("{}\n{question}\n\n{}", loaded.title(), table(&header, &rows))
}
