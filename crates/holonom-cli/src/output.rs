//! One run and what it leaves in its folder.

use std::collections::HashSet;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cpu_time::ProcessTime;
use holonom::analysis;
use holonom::model::{Model, StartChange};
use holonom::record::{COLUMNS, Column, Constraints, Peaks, Recorder, Recording};
use holonom::simulation::{Method, Simulation, Status};
use holonom_io::{WriteTable, Writer};
use holonom_report::{Report, Run};
use serde_json::{Value, json};

use crate::clock::Clock;
use crate::failure::Failure;
use crate::load::{self, Kept, Loaded};
use crate::progress::Watched;
use crate::table::short;

/// A finished run.
pub struct Finished {
    pub method: String,
    pub recording: Recording,
    /// Content of `summary.json`.
    pub summary: Value,
    pub completed: bool,
    pub kept: Kept,
}

/// What a run is asked to do.
pub struct Order {
    pub method: Method,
    pub step: f64,
    pub end: f64,
    pub every: u64,
    pub quiet: bool,
    pub resume: Option<Kept>,
}

/// Simulates a model by a method.
pub fn simulate(loaded: &Loaded, order: Order, interrupted: &Arc<AtomicBool>) -> Result<Finished, Failure> {
    let model = &loaded.model;
    let Order { method, step, end, every, quiet, resume } = order;
    let name = method.name.clone();
    let (resume, mark) = resume.map_or((None, None), |kept| (Some(kept.run), Some(kept.recorder)));
    if let Some(t) = resume.as_ref().map(|run| run.state.t).filter(|t| *t >= end) {
        let message = format!("the checkpoint is at {} s, and the run ends at {} s", short(t), short(end));
        return Err(Failure::usage(message, "give a later --end"));
    }
    let mut simulation = match resume {
        Some(run) => Simulation::resume(model.system.clone(), method, step, run).ok_or_else(|| {
            Failure::usage("the checkpoint is of another model", "resume with the model and the --set options that made it")
        })?,
        None => Simulation::new(model.system.clone(), method, step).map_err(load::start_failure)?,
    };
    if !quiet && mark.is_none() {
        announce_corrections(model, &simulation);
    }
    let rank = analysis::rank_of(&simulation);
    let constraints = constraints(model);
    if constraints != Constraints::Nothing || !model.channels.efforts.is_empty() {
        model.find_reactions(&mut simulation);
    }
    let recorder = Recorder::new(&model.channels, &model.system, every, constraints);
    let recorder = if let Some(mark) = &mark { recorder.resume(mark) } else { recorder };
    let mut watched = Watched::new(recorder, end, quiet, interrupted.clone());
    let (wall, cpu) = (std::time::Instant::now(), ProcessTime::now());
    let (status, step_us) = match simulation.method().settings.iterations {
        None => (simulation.run(end, &mut watched), Value::Null),
        Some(_) => {
            let mut clock = Clock::new(&mut watched, (end / step) as usize + 1);
            (simulation.run(end, &mut clock), clock.summary())
        }
    };
    let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    let summary = simulation.summary(&loaded.name, end, &status, rank.size(&model.system));
    let mut value = serde_json::to_value(&summary).expect("a summary is plain data");
    value["time"] = json!({
        "cpu_s": cpu,
        "us_per_step": 1e6 * cpu / simulation.steps().max(1) as f64,
        "realtime_factor": simulation.state().t / wall.max(1e-9),
    });
    if !step_us.is_null() {
        value["time"]["step_us"] = step_us;
    }
    let kept = Kept { run: simulation.checkpoint(), recorder: watched.recorder.mark() };
    let recording = watched.finish();
    value["peaks"] = serde_json::to_value(Peaks::of(&model.channels, &recording)).expect("peaks are plain data");
    Ok(Finished { method: name, recording, summary: value, completed: status == Status::Completed, kept })
}

/// What a run of a model records of the forces of its constraints.
pub fn constraints(model: &Model) -> Constraints {
    match model.output.reactions {
        Some(false) => Constraints::Nothing,
        None => Constraints::Joints,
        Some(true) => Constraints::Rows,
    }
}

/// Says on standard error what was put right before the start.
fn announce_corrections(model: &Model, simulation: &Simulation) {
    let start = simulation.start();
    if start.moved > 1e-12 {
        eprintln!("note: positions were moved by up to {:.2e} m onto their constraints", start.moved);
    }
    let changes = model.start_changes(&simulation.state().x, simulation.velocities());
    if !changes.is_empty() {
        eprintln!("note: to meet the constraints, start velocities were changed: {}", changes_in_words(&changes));
    }
}

/// Bodies and points with the change of their velocities at the start, at most [`NAMED_CHANGES`].
pub fn changes_in_words(changes: &[StartChange]) -> String {
    let words = changes.iter().take(NAMED_CHANGES).map(|change| match change.angular_velocity > 0.0 {
        true => format!("`{}` by {} m/s and {} rad/s", change.name, short(change.velocity), short(change.angular_velocity)),
        false => format!("`{}` by {} m/s", change.name, short(change.velocity)),
    });
    let words: Vec<String> = words.collect();
    match changes.len().saturating_sub(NAMED_CHANGES) {
        0 => words.join(", "),
        more => format!("{}, and {more} more", words.join(", ")),
    }
}

/// Changes of velocities that are said by name.
const NAMED_CHANGES: usize = 5;

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

/// A recording without the points and bodies that are not among `points`, which come in this order.
fn only(recording: &Recording, points: &[String], model: &Model) -> Recording {
    let names = columns(recording, points, model);
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

/// Names of the columns without the points and bodies that are not among `points`, which come in this order.
pub fn columns(recording: &Recording, points: &[String], model: &Model) -> Vec<String> {
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

/// Makes a folder and writes into it through a closure for each file.
pub struct Folder {
    pub path: PathBuf,
}

impl Folder {
    /// Creates the folder where it is missing.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        std::fs::create_dir_all(path).map_err(|source| Failure::File { doing: "create", path: path.into(), source })?;
        Ok(Self { path: path.into() })
    }

    /// Writes one file.
    pub fn write(&self, name: &str, write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Failure> {
        let path = self.path.join(name);
        let file = File::create(&path).and_then(|file| {
            let mut out = BufWriter::new(file);
            write(&mut out)?;
            out.flush()
        });
        file.map_err(|source| Failure::File { doing: "write", path, source })
    }

    /// Writes one file in full before it takes the place of an older one.
    pub fn replace(&self, name: &str, write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Failure> {
        let new = format!("{name}.new");
        self.write(&new, write)?;
        let path = self.path.join(name);
        std::fs::rename(self.path.join(new), &path).map_err(|source| Failure::File { doing: "write", path, source })
    }

    /// Writes the table of a run with each writer: the points that `[output]` asks for, in its order.
    pub fn write_trajectory(&self, prefix: &str, writers: &[&Writer], loaded: &Loaded, recording: &Recording) -> Result<(), Failure> {
        let asked = loaded.model.output.points.as_ref().map(|points| only(recording, points, &loaded.model));
        let recording = asked.as_ref().unwrap_or(recording);
        for writer in writers {
            self.write(&format!("{prefix}.{}", writer.extension), |out| (writer.write)(recording, out))?;
        }
        self.write("columns.json", |out| holonom_io::write_json(&holonom_io::headings(recording), out))
    }

    /// Writes the report of some runs.
    pub fn write_report(&self, loaded: &Loaded, runs: &[Run<'_>]) -> Result<(), Failure> {
        let report = Report { title: loaded.title(), model_text: &loaded.text, runs, columns: &[] };
        self.write("report.html", |out| report.write(out))
    }
}
