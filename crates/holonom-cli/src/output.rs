//! One run and what it leaves in its folder.

use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cpu_time::ProcessTime;
use holonom::analysis;
use holonom::model::Model;
use holonom::record::{COLUMNS, Column, Constraints, Peaks, Recorder, Recording, Works};
use holonom::simulation::{Method, Simulation, Status};
use holonom_io::{WriteTable, Writer};
use holonom_report::{Report, Run};
use serde_json::{Value, json};

use crate::checkpoint::Point;
use crate::clock::Clock;
use crate::desk::{Desk, Rows};
use crate::failure::Failure;
use crate::folder::{Folder, holds};
use crate::keeper::Keeper;
use crate::load::{self, Loaded};
use crate::message::note;
use crate::notes::{doubts, hasty, of_start, rows_without_forces, shared_forces, slips, turned_bushings, unknown_measures};
use crate::options::Destination;
use crate::progress::Watched;
use crate::provenance::Provenance;
use crate::spins::long_turns;

/// Name of the column of time.
const TIME: &str = COLUMNS[0];

/// A finished run.
pub struct Finished {
    /// Name of the method.
    pub method: String,
    /// All columns.
    pub recording: Recording,
    /// Content of `summary.json`.
    pub summary: Value,
    /// Whether it reached its end.
    pub completed: bool,
}

/// What a finished run is resumed from: where it is, and where it was before a last step that its end cut short.
pub(crate) struct Reached {
    pub last: Point,
    pub before_end: Option<Point>,
}

impl Finished {
    /// Leaves the run in a folder as `holonom run` does, but for what a run is resumed from.
    ///
    /// # Errors
    /// A format that there is not, a folder with the results of another run that is not to be overwritten, and what cannot be written.
    pub fn write_to(&self, path: &Path, loaded: &Loaded, formats: &[String], with_report: bool, force: bool) -> Result<(), Failure> {
        let writers = writers(formats)?;
        let to = Destination { out: Some(path.into()), force, json: false, quiet: true };
        let folder = Folder::claim(&to, "", |path| holds(path, &self.summary))?;
        self.write(&folder, loaded, &writers, with_report)
    }

    /// Writes what follows from a finished run; the summary comes last, and says that it is finished.
    pub(crate) fn write(&self, folder: &Folder, loaded: &Loaded, writers: &[&Writer], with_report: bool) -> Result<(), Failure> {
        folder.write_trajectory("trajectory", writers, loaded, &self.recording)?;
        if with_report {
            folder.write("report.html", |out| self.report(loaded, out))?;
        }
        folder.write("summary.json", |out| holonom_io::write_json(&self.summary, out))
    }

    /// Writes the report of the run.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn report(&self, loaded: &Loaded, out: &mut dyn Write) -> std::io::Result<()> {
        let run = Run { label: &self.method, recording: &self.recording, scene: &loaded.model.scene, summary: &self.summary };
        Report { title: loaded.title(), model_text: loaded.source.text(), runs: &[run], columns: &[] }.write(out)
    }
}

/// What a run is asked to do.
pub struct Order {
    /// By which method.
    pub method: Method,
    /// Everything that its numbers follow from.
    pub provenance: Provenance,
    /// Whether nothing is said on standard error.
    pub quiet: bool,
    /// Whether rows may be made in a thread of their own, while steps go on. What formulas of measures call is then called by two threads, and what it
    /// says about a step comes after others.
    pub has_thread: bool,
    /// What notes begin with where there are several runs.
    pub(crate) label: Option<String>,
    /// Where to go on, and the rows before.
    pub(crate) resume: Option<(Point, Recording)>,
}

impl Order {
    /// A run of a model from its start, by its own method or a named one, of which its own or a given share of the steps is recorded.
    ///
    /// # Errors
    /// A method that cannot be, or a model without step or end.
    pub fn new(loaded: &Loaded, method: Option<&str>, every: Option<u64>, quiet: bool) -> Result<Self, Failure> {
        let named = load::method(&loaded.model, method)?;
        let provenance = loaded.provenance(&named, method, every)?;
        Ok(Self { method: named, provenance, quiet, has_thread: true, label: None, resume: None })
    }
}

/// The recorder of a model's runs.
pub fn recorder(model: &Model, every: u64) -> Recorder {
    Recorder::new(&model.channels, &model.system, every, model.output.constraints())
}

/// Simulates a model until its end, or until the flag is set.
///
/// # Errors
/// Why it cannot start.
pub fn simulate(loaded: &Loaded, order: Order, interrupted: &Arc<AtomicBool>) -> Result<Finished, Failure> {
    simulate_kept(loaded, order, interrupted, None).map(|(finished, _)| finished)
}

/// Simulates a model by a method, and saves it meanwhile where there is a keeper.
pub(crate) fn simulate_kept(
    loaded: &Loaded,
    order: Order,
    interrupted: &Arc<AtomicBool>,
    keeper: Option<&mut Keeper<'_>>,
) -> Result<(Finished, Reached), Failure> {
    let model = &loaded.model;
    let Order { method, provenance, quiet, has_thread, label, resume } = order;
    let say = |text: &str| match &label {
        None => note(text),
        Some(label) => note(&format!("{label}: {text}")),
    };
    let Provenance { step, end, every, .. } = provenance;
    let name = method.name.clone();
    let (resume, corrections, before) = match resume {
        Some((Point { run, recorder, corrections, .. }, rows)) => (Some(run), Some(corrections), Some((recorder, rows))),
        None => (None, None, None),
    };
    let mut simulation = match resume {
        Some(run) => Simulation::resume(model.system.clone(), method, step, run)
            .ok_or_else(|| Failure::usage("the checkpoint is of another model", "run from the start, without --resume"))?,
        None => Simulation::new(model.system.clone(), method, step).map_err(load::start_failure)?,
    };
    let rank = analysis::rank_of(&mut simulation);
    let corrections = corrections.unwrap_or_else(|| of_start(model, &mut simulation, &rank));
    // The end may be a later one than that of the run before.
    let unseen = model.unseen(simulation.method(), step, end);
    let before_it: Vec<String> = slips(loaded).chain(corrections.clone()).chain(unseen).collect();
    if !quiet {
        before_it.iter().for_each(|text| say(text));
    }
    if model.output.constraints() != Constraints::Nothing || !model.channels.efforts.is_empty() {
        model.find_reactions(&mut simulation);
    }
    let recorder = recorder(model, every);
    let recorder = match before {
        Some((mark, rows)) => recorder.resume(&mark).after(rows),
        None => recorder,
    };
    // The start and the end may be beside the rows of nominal steps.
    let nominal = (end - simulation.state().t) / (step * every as f64);
    let recorder = recorder.expecting(nominal.min(1e9) as usize + 2);
    let is_real_time = simulation.method().settings.iterations.is_some();
    let has_thread = has_thread && !is_real_time && std::thread::available_parallelism().is_ok_and(|threads| threads.get() > 1);
    let desk = Desk { keeper, corrections: corrections.clone(), before_end: None };
    let (first_step, first_time) = (simulation.steps(), simulation.state().t);
    let (wall, cpu) = (std::time::Instant::now(), ProcessTime::now());
    let (status, step_us, recorder, desk) = std::thread::scope(|scope| {
        let rows = match has_thread {
            true => Rows::in_a_thread(recorder, desk, &mut simulation, scope),
            false => Rows::Here(Box::new(recorder), desk),
        };
        let mut watched = Watched::new(rows, step, end, quiet, interrupted.clone());
        let (status, step_us) = match is_real_time {
            false => (simulation.run(end, &mut watched), Value::Null),
            true => {
                let mut clock = Clock::new(&mut watched, (end / step) as usize + 1);
                (simulation.run(end, &mut clock), clock.summary())
            }
        };
        let (recorder, desk) = watched.finish().join(&mut simulation);
        (status, step_us, recorder, desk)
    });
    let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    let summary = simulation.summary(&loaded.name, end, &status, rank.size(&model.system));
    let mut value = serde_json::to_value(&summary).expect("a summary is plain data");
    value["time"] = json!({
        "cpu_s": cpu,
        "us_per_step": 1e6 * wall / (simulation.steps() - first_step).max(1) as f64,
        "realtime_factor": (simulation.state().t - first_time) / wall.max(1e-9),
    });
    if !step_us.is_null() {
        value["time"]["step_us"] = step_us;
    }
    let unknown = unknown_measures(model, recorder.recording());
    let without = rows_without_forces(model, recorder.recording());
    let turns = long_turns(model, &simulation, recorder.recording(), summary.size.dof > 0);
    let turned = turned_bushings(model, recorder.recording());
    // What spins is told by its name.
    let hasty = if turns.is_none() { hasty(&simulation) } else { None };
    let of_steps = doubts(&simulation, &rank, status == Status::Completed).chain(turned).chain(turns).chain(hasty);
    let of_results: Vec<String> =
        unknown.into_iter().chain(without).chain(shared_forces(model, &simulation, recorder.recording())).chain(of_steps).collect();
    if !quiet {
        of_results.iter().for_each(|text| say(text));
    }
    value["provenance"] = serde_json::to_value(&provenance).expect("a provenance is plain data");
    value["notes"] = before_it.into_iter().chain(of_results).collect();
    let last = Point::of(&simulation, &recorder, &corrections);
    let before_end = desk.before_end.filter(|_| !last.run.goes_on_unbroken()).map(|point| *point);
    let recording = recorder.finish();
    value["work_by"] = serde_json::to_value(Works::of(&model.channels, &simulation)).expect("works are plain data");
    value["peaks"] = serde_json::to_value(Peaks::of(&model.channels, &recording, &model.system)).expect("peaks are plain data");
    let finished = Finished { method: name, recording, summary: value, completed: status == Status::Completed };
    Ok((finished, Reached { last, before_end }))
}

/// The writers of the formats asked for.
pub fn writers(formats: &[String]) -> Result<Vec<&'static Writer>, Failure> {
    let find = |format: &String| {
        holonom_io::WRITERS.iter().find(|writer| writer.name == format).ok_or_else(|| {
            let known: Vec<&str> = holonom_io::WRITERS.iter().map(|writer| writer.name).collect();
            Failure::usage(format!("there is no format `{format}`"), format!("take one of: {}", known.join(", ")))
        })
    };
    formats.iter().map(find).collect()
}

/// The first writer, which a table always has, and those of the formats asked for.
pub fn table_writers(formats: &[String]) -> Result<Vec<(&'static Writer, WriteTable)>, Failure> {
    let with_words = || holonom_io::WRITERS.iter().filter_map(|writer| writer.write_table.map(|write| (writer, write)));
    if let Some(unknown) = formats.iter().find(|format| with_words().all(|(writer, _)| writer.name != format.as_str())) {
        let known: Vec<&str> = with_words().map(|(writer, _)| writer.name).collect();
        return Err(Failure::usage(
            format!("there is no format `{unknown}` for tables with words"),
            format!("take one of: {}", known.join(", ")),
        ));
    }
    let is_asked = |k: usize, writer: &Writer| k == 0 || formats.iter().any(|format| format == writer.name);
    Ok(with_words().enumerate().filter(|(k, (writer, _))| is_asked(*k, writer)).map(|(_, writer)| writer).collect())
}

/// Whether `[output]` asks for all columns.
pub fn has_all(model: &Model) -> bool {
    model.output.points.is_none() && model.output.columns.is_none()
}

/// The columns of a recording that `[output]` asks for.
fn only(recording: &Recording, model: &Model) -> Recording {
    let names = columns(recording, model);
    let columns: Vec<&Column> = names.iter().filter_map(|name| recording.find(name)).collect();
    let mut kept = Recording::new(columns.iter().map(|column| column.heading.clone()));
    let mut row = Vec::new();
    for k in 0..recording.rows() {
        row.clear();
        row.extend(columns.iter().map(|column| column.values[k]));
        kept.push(&row);
    }
    kept
}

/// Names of the columns that `[output]` asks for, the points of its list in that order; always the time.
pub fn columns(recording: &Recording, model: &Model) -> Vec<String> {
    let names = match &model.output.points {
        Some(points) => of_points(recording, points, model),
        None => recording.columns().iter().map(|column| column.heading.name.clone()).collect(),
    };
    names.into_iter().filter(|name| name == TIME || model.output.has_column(name)).collect()
}

/// Names of the columns without the points and bodies that are not among `points`, which come in this order.
fn of_points(recording: &Recording, points: &[String], model: &Model) -> Vec<String> {
    let all = || recording.columns().iter().map(|column| column.heading.name.as_str());
    let owners = model.points.iter().map(|point| &point.name).chain(model.bodies.iter().map(|body| &body.name));
    let owners = owners.chain(model.channels.points.iter().map(|point| &point.name));
    let owners: HashSet<&str> = owners.map(String::as_str).collect();
    let is_of = |name: &str, point: &str| owner_and_suffix(name).is_some_and(|(owner, _)| owner == point);
    let has_owner = |name: &&str| owner_and_suffix(name).is_some_and(|(owner, _)| owners.contains(owner));
    let is_force = |name: &&str| owner_and_suffix(name).is_some_and(|(_, suffix)| suffix.len() == 2 && suffix.starts_with('r'));
    let is_kept = |name: &&str| points.iter().any(|point| is_of(name, point));
    let motion = points.iter().flat_map(|point| all().filter(move |name| is_of(name, point) && !is_force(name)));
    let others = all().skip(COLUMNS.len()).filter(|name| !has_owner(name) || (is_force(name) && is_kept(name)));
    let names = COLUMNS.into_iter().chain(motion).chain(others).map(str::to_string);
    names.filter(|name| recording.column(name).is_some()).collect()
}

/// The point, body or joint that a column is of, and what it shows of it.
fn owner_and_suffix(column: &str) -> Option<(&str, &str)> {
    column.rsplit_once('.')
}

impl Folder {
    /// Writes the table of a run with each writer: the points that `[output]` asks for, in its order.
    pub fn write_trajectory(&self, prefix: &str, writers: &[&Writer], loaded: &Loaded, recording: &Recording) -> Result<(), Failure> {
        let asked = (!has_all(&loaded.model)).then(|| only(recording, &loaded.model));
        let recording = asked.as_ref().unwrap_or(recording);
        for writer in writers {
            self.write(&format!("{prefix}.{}", writer.extension), |out| (writer.write)(recording, out))?;
        }
        // A run that was kept has all of them there.
        if asked.is_none() && writers.is_empty() && self.path.join("columns.json").exists() {
            return Ok(());
        }
        self.write("columns.json", |out| holonom_io::write_json(&holonom_io::headings(recording.columns()), out))
    }
}
