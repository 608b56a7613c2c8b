//! One run of a sweep: the model with the values of the run, from its start to its end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use holonom::analysis::{self, modes};
use holonom::linalg::Plans;
use holonom::model::{Model, Value};
use holonom::record::Constraints;
use holonom::simulation::{Divisions, Method, Observer, Simulation, Status, Verdict};
use holonom_io::Source;

use super::check::of_formula;
use super::plan::Plan;
use super::vary::Setting;
use super::vibration;
use super::watch::{Columns, Watch};
use crate::failure::Failure;
use crate::load;
use crate::notes::{doubts, hasty, of_start};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// At its end.
    Completed,
    /// Before its end.
    Stopped,
    /// Before its start: the model or the method cannot have these values.
    Refused,
}

impl Ending {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Completed, Self::Stopped, Self::Refused];

    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Stopped => "stopped",
            Self::Refused => "refused",
        }
    }
}

/// What became of a run.
pub struct Outcome {
    pub ending: Ending,
    /// Time reached by a run that stopped, s.
    pub stopped_at: Option<f64>,
    /// Why it did not complete; empty where it did.
    pub reason: String,
    /// What is said of its model, its start and its results.
    pub notes: Vec<String>,
    /// Nothing where the run was refused, or none was asked for.
    pub figures: Option<Figures>,
    /// The columns asked for; `None` for those that this run's model does not have, or that have no value in it. Nothing where the run was refused.
    pub columns: Vec<Option<f64>>,
}

impl Outcome {
    /// Of a model of which no run is made.
    fn still(model: &Model, columns: usize) -> Self {
        let (notes, columns) = (model.notes.clone(), vec![None; columns]);
        Self { ending: Ending::Completed, stopped_at: None, reason: String::new(), notes, figures: None, columns }
    }
}

/// What a run is judged by.
pub struct Figures {
    /// Nominal steps.
    pub steps: u64,
    /// max |E(t) − E(0) − work done on the system|, J.
    pub drift: f64,
    /// Largest ‖Φ‖ and ‖Φ̇‖.
    pub position: f64,
    pub velocity: f64,
    pub iterations_per_step: f64,
    pub rejected_steps: u64,
}

/// Runs the runs of a plan.
pub struct Runner<'a> {
    pub source: &'a Source,
    pub plan: &'a Plan,
    /// Name of the method, where the command line gives one.
    pub method: Option<&'a str>,
    pub columns: &'a Columns,
    /// The eliminations of the runs, planned once where runs differ in numbers only.
    pub eliminations: Arc<Plans>,
    pub interrupted: Arc<AtomicBool>,
}

impl Runner<'_> {
    /// The run with some values; nothing where it was interrupted.
    pub fn run(&self, settings: &[Setting]) -> Option<Outcome> {
        if self.interrupted.load(Ordering::Relaxed) {
            return None;
        }
        let changes: Vec<(&str, Value)> =
            self.plan.varied.iter().zip(settings).map(|(vary, setting)| (vary.path.as_str(), setting.value.clone())).collect();
        let model = match self.columns.constraints != Constraints::Nothing {
            true => self.source.model_with_forces_and(&changes),
            false => self.source.model_with(&changes),
        };
        let mut model = match model {
            Ok(model) => model,
            Err(faults) => {
                let reason = of_formula(&faults, &self.columns.asked).map_or_else(|| faults.to_string(), |(message, _)| message);
                return Some(refused(reason));
            }
        };
        Arc::make_mut(&mut model.system).share_plans(&self.eliminations);
        match self.ask(&model) {
            Ok(outcome) => outcome,
            Err(Failure::Usage { message, .. }) => Some(refused(message)),
            Err(failure) => Some(refused(failure.to_string())),
        }
    }

    /// Makes the run, and finds the modes, as far as the columns ask for them.
    fn ask(&self, model: &Model) -> Result<Option<Outcome>, Failure> {
        let modes = self.columns.modes.then(|| modes(&model.system)).transpose();
        let modes = match modes.map_err(load::modes_failure) {
            // What a start lacks is told with its cure.
            Err(Failure::Usage { message, cure }) => return Ok(Some(refused(format!("{message}: {cure}")))),
            modes => modes?,
        };
        let ran = if self.columns.runs { self.simulate(model)? } else { Some(Outcome::still(model, self.columns.asked.len())) };
        Ok(ran.map(|mut outcome| {
            if let Some(modes) = modes {
                vibration::fill(&mut outcome.columns, &self.columns.asked, &modes);
                outcome.notes.extend(vibration::notes(&modes));
            }
            outcome
        }))
    }

    fn simulate(&self, model: &Model) -> Result<Option<Outcome>, Failure> {
        let Task { method, step, end } = Task::new(model, self.method)?;
        let mut simulation = Simulation::new(model.system.clone(), method, step).map_err(load::start_failure)?;
        let rank = analysis::rank_of(&mut simulation);
        let mut notes = model.notes.clone();
        notes.extend(of_start(model, &mut simulation, &rank));
        notes.extend(model.unseen(simulation.method(), step, end));
        if self.columns.forces {
            model.find_reactions(&mut simulation);
        }
        let mut watched = Interruptible { watch: Watch::new(model, self.columns), interrupted: &self.interrupted };
        let status = simulation.run(end, &mut watched);
        if self.interrupted.load(Ordering::Relaxed) {
            return Ok(None);
        }
        if self.columns.constraints != Constraints::Nothing || !model.channels.efforts.is_empty() {
            model.find_reactions(&mut simulation);
        }
        let columns = watched.watch.values(&simulation);
        let figures = Some(figures(&simulation));
        notes.extend(doubts(&simulation, &rank, status == Status::Completed).chain(hasty(&simulation)));
        Ok(Some(match status {
            Status::Completed => Outcome { ending: Ending::Completed, stopped_at: None, reason: String::new(), notes, figures, columns },
            Status::Stopped { at, reason } => Outcome { ending: Ending::Stopped, stopped_at: Some(at), reason, notes, figures, columns },
        }))
    }
}

fn figures(simulation: &Simulation) -> Figures {
    let audit = simulation.audit();
    let (violation, work) = (audit.violation_summary(), simulation.work());
    Figures {
        steps: simulation.steps(),
        drift: audit.energy_summary().max_drift,
        position: violation.position,
        velocity: violation.velocity,
        iterations_per_step: work.iterations_per_step,
        rejected_steps: work.rejected_steps,
    }
}

/// A watch that ends the run on an interrupt.
struct Interruptible<'a> {
    watch: Watch<'a>,
    interrupted: &'a AtomicBool,
}

impl Observer for Interruptible<'_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self.watch.after_step(simulation);
        if self.interrupted.load(Ordering::Relaxed) { Verdict::Stop } else { Verdict::GoOn }
    }

    fn wants_forces(&self) -> bool {
        self.watch.wants_forces()
    }

    fn divisions(&self) -> Divisions {
        self.watch.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.watch.at_division(simulation);
    }
}

/// How a model is to be run.
pub struct Task {
    method: Method,
    step: f64,
    /// s
    pub end: f64,
}

impl Task {
    /// What the model, and the name of a method on the command line, say of it.
    pub fn new(model: &Model, method: Option<&str>) -> Result<Self, Failure> {
        Ok(Self { method: load::method(model, method)?, step: load::step(model)?, end: load::end(model)? })
    }
}

fn refused(reason: String) -> Outcome {
    Outcome { ending: Ending::Refused, stopped_at: None, reason, notes: Vec::new(), figures: None, columns: Vec::new() }
}
