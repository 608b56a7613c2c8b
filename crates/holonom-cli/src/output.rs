//! One run and what it leaves in its folder.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cpu_time::ProcessTime;
use holonom::analysis;
use holonom::record::{RecordedPoint, Recorder, Recording};
use holonom::simulation::{Method, Simulation, State, Status};
use holonom_report::{Report, Run};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::load::{self, Loaded};
use crate::progress::Watched;

/// A finished run.
pub struct Finished {
    pub method: String,
    pub recording: Recording,
    /// Content of `summary.json`.
    pub summary: Value,
    pub completed: bool,
    pub state: State,
}

/// What a run is asked to do.
pub struct Order {
    pub method: Method,
    pub step: f64,
    pub end: f64,
    pub every: u64,
    pub quiet: bool,
    pub resume: Option<State>,
}

/// Simulates a model by a method.
pub fn simulate(loaded: &Loaded, order: Order, interrupted: &Arc<AtomicBool>) -> Result<Finished, Failure> {
    let model = &loaded.model;
    let Order { method, step, end, every, quiet, resume } = order;
    let name = method.name.clone();
    let mut simulation = match resume {
        Some(state) => Simulation::resume(&model.system, method, step, state).ok_or_else(|| {
            Failure::usage("the checkpoint is of another model", "resume with the model and the --set options that made it")
        })?,
        None => Simulation::new(&model.system, method, step).map_err(load::start_failure)?,
    };
    if !quiet {
        announce_corrections(&simulation);
    }
    let rank = analysis::rank(&model.system, &simulation.state().x, simulation.state().t);
    let points = model.points.iter().map(|point| RecordedPoint { name: point.name.clone(), place: point.place });
    let recorder = Recorder::new(points.collect(), model.axes, every);
    let mut watched = Watched::new(recorder, end, quiet, interrupted.clone());
    let (wall, cpu) = (std::time::Instant::now(), ProcessTime::now());
    let status = simulation.run(end, &mut watched);
    let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    let summary = simulation.summary(&loaded.name, end, &status, rank.size(&model.system));
    let mut value = serde_json::to_value(&summary).expect("a summary is plain data");
    value["time"] = json!({
        "cpu_s": cpu,
        "us_per_step": 1e6 * cpu / simulation.steps().max(1) as f64,
        "realtime_factor": simulation.state().t / wall.max(1e-9),
    });
    Ok(Finished {
        method: name,
        recording: watched.finish(),
        summary: value,
        completed: status == Status::Completed,
        state: simulation.state().clone(),
    })
}

/// Says on standard error what was put right before the start.
fn announce_corrections(simulation: &Simulation<'_>) {
    let start = simulation.start();
    if start.moved > 1e-12 {
        eprintln!("note: positions were moved by up to {:.2e} m onto their constraints", start.moved);
    }
    if start.turned > 1e-12 {
        eprintln!("note: velocities were changed by up to {:.2e} m/s onto their constraints", start.turned);
    }
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

    /// Writes the table of a run in each format.
    pub fn write_trajectory(&self, prefix: &str, formats: &[String], recording: &Recording) -> Result<(), Failure> {
        for format in formats {
            let writer = holonom_io::WRITERS.iter().find(|writer| writer.name == format).ok_or_else(|| {
                let known: Vec<&str> = holonom_io::WRITERS.iter().map(|writer| writer.name).collect();
                Failure::usage(format!("there is no format `{format}`"), format!("take one of: {}", known.join(", ")))
            })?;
            self.write(&format!("{prefix}.{}", writer.extension), |out| (writer.write)(recording, out))?;
        }
        Ok(())
    }

    /// Writes the report of some runs.
    pub fn write_report(&self, loaded: &Loaded, runs: &[Run<'_>]) -> Result<(), Failure> {
        let report = Report { title: loaded.title(), model_text: &loaded.text, runs };
        self.write("report.html", |out| report.write(out))
    }
}
