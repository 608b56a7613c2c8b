//! One run and what it leaves in its folder.

use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cpu_time::ProcessTime;
use holonom::analysis::{self, Undetermined};
use holonom::model::{Model, StartChange};
use holonom::record::{COLUMNS, Channels, Column, Constraints, Peaks, RecordedJoint, Recorder, Recording};
use holonom::simulation::{Method, Simulation, Start, Status};
use holonom_io::{WriteTable, Writer};
use holonom_report::{Report, Run};
use serde_json::{Value, json};

use crate::checkpoint::Point;
use crate::clock::Clock;
use crate::failure::Failure;
use crate::folder::{Folder, holds};
use crate::keeper::Keeper;
use crate::load::{self, Loaded};
use crate::message::{listed, note, unused_parameters};
use crate::options::Destination;
use crate::progress::Watched;
use crate::provenance::Provenance;
use crate::table::short;

/// Positions over the size of the mechanism that round-off moves at the start.
const ROUNDED: f64 = 1e-12;

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
        Ok(Self { method: named, provenance, quiet, resume: None })
    }
}

/// The recorder of a model's runs.
pub fn recorder(model: &Model, every: u64) -> Recorder<'_> {
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
    let Order { method, provenance, quiet, resume } = order;
    let Provenance { step, end, every, .. } = provenance;
    let name = method.name.clone();
    let (resume, before) = match resume {
        Some((Point { run, recorder, corrections, .. }, rows)) => (Some((run, corrections)), Some((recorder, rows))),
        None => (None, None),
    };
    let (mut simulation, corrections) = match resume {
        Some((run, corrections)) => Simulation::resume(model.system.clone(), method, step, run)
            .map(|simulation| (simulation, corrections))
            .ok_or_else(|| Failure::usage("the checkpoint is of another model", "run from the start, without --resume"))?,
        None => {
            let simulation = Simulation::new(model.system.clone(), method, step).map_err(load::start_failure)?;
            let mut corrections = corrections(model, &simulation);
            corrections.extend(costly(simulation.method()));
            if !quiet {
                slips(loaded).chain(corrections.clone()).for_each(|text| note(&text));
            }
            (simulation, corrections)
        }
    };
    let rank = analysis::rank_of(&simulation);
    if model.output.constraints() != Constraints::Nothing || !model.channels.efforts.is_empty() {
        model.find_reactions(&mut simulation);
    }
    let recorder = recorder(model, every);
    let recorder = match before {
        Some((mark, rows)) => recorder.resume(&mark).after(rows),
        None => recorder,
    };
    let mut watched = Watched::new(recorder, step, end, quiet, interrupted.clone()).kept(keeper, &corrections);
    let (first_step, first_time) = (simulation.steps(), simulation.state().t);
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
        "us_per_step": 1e6 * cpu / (simulation.steps() - first_step).max(1) as f64,
        "realtime_factor": (simulation.state().t - first_time) / wall.max(1e-9),
    });
    if !step_us.is_null() {
        value["time"]["step_us"] = step_us;
    }
    let unknown = unknown_measures(model, watched.recorder.recording());
    let without = rows_without_forces(model, watched.recorder.recording());
    let of_results: Vec<String> = unknown.into_iter().chain(without).chain(shared_forces(model, &simulation)).collect();
    if !quiet {
        of_results.iter().for_each(|text| note(text));
    }
    value["provenance"] = serde_json::to_value(&provenance).expect("a provenance is plain data");
    value["notes"] = slips(loaded).chain(corrections.clone()).chain(of_results).collect();
    let last = Point::of(&simulation, &watched.recorder, &corrections);
    let before_end = watched.before_end.take().filter(|_| !last.run.goes_on_unbroken());
    let recording = watched.finish();
    value["peaks"] = serde_json::to_value(Peaks::of(&model.channels, &recording)).expect("peaks are plain data");
    let finished = Finished { method: name, recording, summary: value, completed: status == Status::Completed };
    Ok((finished, Reached { last, before_end }))
}

/// Most rows for which a run says which forces are not unique: it takes a time that grows with their cube.
const FEW_ROWS: usize = 200;

/// Which of the forces that a run has recorded redundant rows leave undetermined.
fn shared_forces(model: &Model, simulation: &Simulation) -> Option<String> {
    simulation.reactions()?;
    let free = analysis::undetermined_of(simulation, FEW_ROWS).filter(|free| free.count() > 0)?;
    let open = open_columns(&free, model.channels.told(), &simulation.reacting_positions(), model);
    let named = (!open.is_empty()).then(|| listed(&open))?;
    Some(format!(
        "redundant constraints leave open how they share forces: of {named} one way of many is shown (a bushing in place of a joint decides it)"
    ))
}

/// Components of forces and moments of joints, efforts of drives and couplers, and tensions of rods, that are left undetermined, `world` being where the
/// nodes are: `hinge.fy .tx`, `motor.effort`.
pub(crate) fn open_columns(free: &Undetermined<'_>, channels: &Channels, world: &[f64], model: &Model) -> Vec<String> {
    let mut open = Vec::new();
    for joint in &channels.joints {
        let unique = free.are_unique(&joint.rows, &joint.nodes, free.system().of_world(joint.place(world, model.dimension)));
        let columns = RecordedJoint::columns(model.axes);
        let columns: Vec<&str> = columns.iter().filter(|(k, _)| !unique[*k]).map(|(_, column)| column.as_str()).collect();
        if !columns.is_empty() {
            open.push(format!("{}.{}", joint.name, columns.join(" .")));
        }
    }
    let shared: HashSet<usize> = free.rows().into_iter().collect();
    let efforts = channels.efforts.iter().map(|effort| (&effort.name, effort.row));
    let couplings = channels.couplings.iter().map(|coupling| (&coupling.name, coupling.row));
    let efforts = efforts.chain(couplings).filter(|(_, row)| shared.contains(row));
    open.extend(efforts.map(|(name, _)| format!("{name}.effort")));
    let rods = channels.rods.iter().filter(|rod| shared.contains(&rod.row));
    open.extend(rods.map(|rod| format!("{}.force", rod.name)));
    open
}

/// Measures that have no value in some rows.
fn unknown_measures(model: &Model, recording: &Recording) -> Vec<String> {
    let rows = recording.rows();
    let count = |name: &String| recording.column(name).map_or(0, |values| values.iter().filter(|value| value.is_nan()).count());
    let of_measures = model.channels.measures.iter().map(|measure| (&measure.name, count(&measure.name)));
    let without = of_measures.filter(|(_, count)| *count > 0);
    without
        .map(|(name, count)| format!("the measure `{name}` has no value in {count} of {rows} rows: a formula is outside its domain there"))
        .collect()
}

/// That rows have no forces of joints, as the position is singular there.
fn rows_without_forces(model: &Model, recording: &Recording) -> Option<String> {
    let told = model.channels.told();
    let of_joints = told.joints.first().map(|joint| format!("{}.f{}", joint.name, &model.axes[..1]));
    let of_drives = told.efforts.first().map(|effort| format!("{}.effort", effort.name));
    let name = of_joints.or(of_drives).or(told.rods.first().map(|rod| format!("{}.force", rod.name)))?;
    let unknown = recording.column(&name)?.iter().zip(recording.column("t")?).filter(|(force, _)| force.is_nan());
    let times: Vec<f64> = unknown.map(|(_, t)| *t).collect();
    let first = times.first()?;
    let rows = if times.len() == 1 { "one row has".into() } else { format!("{} rows have", times.len()) };
    (times.len() < recording.rows()).then(|| {
        format!(
            "{rows} no accelerations and no forces of joints and drives, first at {} s: at a singular position none keep all constraints",
            short(*first)
        )
    })
}

/// What looks like a slip, and what was put right before the start.
pub fn notes(loaded: &Loaded, simulation: &Simulation) -> Vec<String> {
    slips(loaded).chain(corrections(&loaded.model, simulation)).collect()
}

/// What looks like a slip in a model, or in how it is run.
fn slips(loaded: &Loaded) -> impl Iterator<Item = String> {
    unused_parameters(&loaded.source).into_iter().chain(loaded.model.notes.clone())
}

/// What was put right before the start.
fn corrections(model: &Model, simulation: &Simulation) -> Vec<String> {
    let mut notes = Vec::new();
    let start = simulation.start();
    let size = simulation.state().x.iter().fold(0.0, |most: f64, x| x.abs().max(most));
    if start.moved > ROUNDED * size {
        notes.push(format!("positions were moved by up to {:.2e} m onto their constraints", start.moved));
    }
    notes.extend(nowhere(start));
    let mut changes = model.start_changes(&simulation.state().x, simulation.velocities());
    // That parts start moving for which no velocity was written is what a drive is for.
    changes.retain(|change| !change.was_at_rest);
    if !changes.is_empty() {
        notes.push(format!("to meet the constraints, start velocities were changed: {}", changes_in_words(&changes)));
    }
    notes
}

/// Accuracies below this take schemes of order 2 ten times the steps for two digits, where one of order 5 takes four times as many.
const FINE: f64 = 1e-6;

/// That another method would take far fewer steps.
fn costly(method: &Method) -> Option<String> {
    let accuracy = method.accuracy.filter(|accuracy| *accuracy < FINE && method.order() == 2)?;
    Some(format!("`{}` is of order 2, and takes very many steps for an accuracy of {}: `radau` takes few", method.name, short(accuracy)))
}

/// That no motion begins with the velocities of a start.
pub(crate) fn nowhere(start: &Start) -> Option<String> {
    let text = "no motion begins with the start velocities: at this singular position no accelerations keep all constraints, and what comes is one way of many \
                (give the velocities of one of the ways in which it can move from there)";
    start.leads_nowhere.then(|| text.into())
}

/// Bodies and points with the change of their velocities at the start.
pub fn changes_in_words(changes: &[StartChange]) -> String {
    let words = changes.iter().map(|change| match change.angular_velocity > 0.0 {
        true => format!("`{}` by {} m/s and {} rad/s", change.name, short(change.velocity), short(change.angular_velocity)),
        false => format!("`{}` by {} m/s", change.name, short(change.velocity)),
    });
    listed(&words.collect::<Vec<_>>())
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
        self.write("columns.json", |out| holonom_io::write_json(&holonom_io::headings(recording.columns()), out))
    }
}
