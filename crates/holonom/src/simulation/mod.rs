//! A method at work on a system: the step loop, step control, and how a run ended.

mod adapt;
mod advance;
pub(crate) mod any_number;
mod audit;
mod bracket;
mod checkpoint;
mod conflict;
mod control;
mod crowd;
mod doubts;
mod events;
mod fall;
mod follow;
mod golden;
mod landing;
mod linear;
mod locate;
mod method;
mod motions;
mod no_value;
mod passage;
mod past;
mod periods;
mod pilot;
mod places;
mod promise;
mod reactions;
mod reason;
mod rest;
mod shares;
mod sharp;
mod sight;
mod start;
mod state;
mod summary;
mod words;

pub use audit::Audit;
pub use checkpoint::Checkpoint;
pub use conflict::Conflict;
pub use events::Happening;
pub(crate) use follow::{along, follow};
pub(crate) use golden::GOLDEN;
pub(crate) use linear::{NoRest, Rest, Spot};
pub use method::{
    Choice, LEVELS, LOOP_TOLERANCE, MAX_ITERATIONS, Method, NAMED, Named, OMEGA, PENALTY, ProjectionChoice, TOLERANCE, XI, combinations,
};
pub(crate) use motions::{Motions, Slow};
pub(crate) use periods::uncountable;
pub(crate) use places::Places;
pub use promise::Promise;
pub(crate) use reactions::Found;
pub(crate) use reactions::wrench;
pub use reactions::{Apart, Finder, Reactions};
pub(crate) use rest::Restless;
use start::Asked;
pub use start::{Start, StartError};
pub use state::State;
pub use summary::{EnergySummary, MethodSummary, ModelSize, MomentumSummary, ProjectionSummary, Summary, ViolationSummary, WorkSummary};
pub use words::MethodError;

use std::sync::Arc;

use crate::formulation::{Followers, Independence, Newton, Sure, Workspace, independent};
use crate::integrator::Integrator;
use crate::system::{Evaluation, GaugeValues, System};
use checkpoint::{Grid, Hints};
use doubts::Contact;
use pilot::Pilot;
use promise::Judge;
use shares::Shares;

/// How a run ended.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The time it was to reach is reached.
    Completed,
    /// It ended before: a step could not be taken, or an observer wanted no more.
    Stopped {
        /// Time that was reached, s.
        at: f64,
        /// Why, in words; `interrupted` by an observer.
        reason: String,
    },
}

/// What an observer answers after each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The run takes the next step.
    GoOn,
    /// The run ends here, as [stopped](Status::Stopped).
    Stop,
}

/// Where an observer looks inside of nominal steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divisions {
    /// Nowhere, but for what events do.
    Unseen,
    /// Where the parts end that a step is taken in. Forces of the constraints are not found there.
    Ends,
    /// There, inside of long parts, and before inputs are set and after, with the forces of the constraints where they are wanted.
    Inside,
}

/// Is shown the start and every nominal step, and the last of these once more where an event ended the run that belongs to the same time.
pub trait Observer {
    /// Looks at the simulation after a step.
    fn after_step(&mut self, simulation: &Simulation) -> Verdict;

    /// Whether it will look at the forces of the constraints after the step to come, where the simulation finds them. They take time.
    fn wants_forces(&self) -> bool {
        true
    }

    /// Looks at the simulation inside a nominal step.
    fn at_division(&mut self, _simulation: &Simulation) {}

    /// Where it looks there.
    fn divisions(&self) -> Divisions {
        Divisions::Unseen
    }
}

impl<F: FnMut(&Simulation) -> Verdict> Observer for F {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self(simulation)
    }
}

/// A method at work on a system. Everything a step needs is allocated when it is made.
pub struct Simulation {
    system: Arc<System>,
    method: Method,
    integrator: Box<dyn Integrator>,
    newton: Newton,
    work: Workspace,
    state: State,
    /// Velocities and accelerations to show: those of the state, or their projections.
    shown_v: Vec<f64>,
    shown_a: Vec<f64>,
    /// Velocities and accelerations that the last step found, before projections.
    found_v: Vec<f64>,
    found_a: Vec<f64>,
    audit: Audit,
    /// What each of what does work has done of that of the audit.
    shares: Shares,
    judge: Judge,
    /// What was seen of forces that begin and end to act with what moves; nothing where an accuracy chooses the steps, as these end there.
    contacts: Vec<Contact>,
    start: Start,
    step: f64,
    grid: Grid,
    steps: u64,
    /// What chooses the steps by accuracy.
    pilot: Option<Box<Pilot>>,
    /// Measured at the present state, and at the end of the step that is tried.
    gauges: GaugeValues,
    next_gauges: GaugeValues,
    /// Forces of the constraints at the last state that was looked at, where they are wanted.
    reactions: Option<Reactions>,
    /// What finds them where the system itself does not tell all of them.
    apart: Option<Box<reactions::Elsewhere>>,
    /// What its own rows must add to be sure, once it was found.
    sure: Option<Option<Sure>>,
    /// What was known after the last step that was taken.
    hints: Hints,
    /// Finds the rows that steps leave out, once that was asked.
    followers: Option<Box<Followers>>,
    /// Events so far.
    happenings: Vec<Happening>,
    /// Indicators of the events at the end of the last step, and its time, s.
    watched: Option<(f64, Vec<f64>)>,
    /// How often each event with a period has happened.
    samples: Vec<u64>,
    /// Whether the last of them ended the last run.
    has_ended: bool,
}

impl Simulation {
    /// Prepares a run with nominal step `step` (s): corrects positions and velocities that miss their constraints a
    /// little, and finds accelerations and multipliers to start with.
    pub fn new(system: impl Into<Arc<System>>, method: Method, step: f64) -> Result<Self, StartError> {
        let system = system.into();
        if !(step > 0.0 && step.is_finite()) {
            return Err(StartError::Step { step });
        }
        Self::begin(Arc::clone(&system), method, step, &Asked::of(&system, step))
    }

    /// Puts the mechanism at the time, the positions and the velocities of a state, with its inputs, as at a start: what misses the
    /// constraints a little is corrected, accelerations and multipliers are found anew, and the audit begins again. Angles are the
    /// nearest to those of the state.
    ///
    /// # Errors
    /// As at a start; the simulation is then as it was.
    pub fn set_state(&mut self, state: &State) -> Result<(), StartError> {
        if !state.fits(&self.system) {
            return Err(StartError::Other);
        }
        if !state.is_finite() {
            return Err(StartError::NoNumber);
        }
        let impulse = vec![0.0; self.system.coordinates()];
        let asked = Asked {
            t: state.t,
            x: &state.x,
            v: &state.v,
            impulse: &impulse,
            angles: Some([&state.angle, &state.measured]),
            inputs: Some(&state.inputs),
            step: self.step,
        };
        let found = Self::begin(Arc::clone(&self.system), self.method.clone(), self.step, &asked)?;
        let before = std::mem::replace(self, found);
        match before.apart.and_then(|elsewhere| elsewhere.apart) {
            Some(apart) => self.find_reactions_apart(&apart),
            None if before.reactions.is_some() => self.find_reactions(),
            None => (),
        }
        Ok(())
    }

    fn begin(system: Arc<System>, method: Method, step: f64, asked: &Asked<'_>) -> Result<Self, StartError> {
        crowd::require_few_rows(&system)?;
        let mut work = Workspace::new(&system);
        work.level = method.settings.level;
        if let Some(inputs) = asked.inputs {
            work.inputs.copy_from_slice(inputs);
        }
        let mut newton = Newton::new(&system, &work.scales, method.settings);
        let start = start::prepare(&system, &method, asked, &mut newton, &mut work).map_err(|error| match error {
            StartError::NotFinite { what } => {
                let state = State::new(asked.t, &work, system.gauge_values().counted());
                StartError::NotFinite { what: no_value::lacking(&system, &state, &mut work, &[0.0]).unwrap_or(what) }
            }
            error => error,
        })?;
        let integrator = (method.integrator.make)(&system, &newton, method.parameters);
        work.memory = vec![0.0; integrator.memory(&system)];
        let mut state = State::new(asked.t, &work, system.gauge_values().counted());
        if let Some([_, measured]) = asked.angles {
            state.measured.copy_from_slice(measured);
        }
        let mut simulation = Self { start, ..Self::assemble(system, method, integrator, step, newton, work, state) };
        if simulation.start.leads_nowhere {
            simulation.start.conflict = simulation.conflict().or_else(|| simulation.blocked());
        }
        Ok(simulation)
    }

    fn assemble(
        system: Arc<System>,
        method: Method,
        integrator: Box<dyn Integrator>,
        step: f64,
        newton: Newton,
        mut work: Workspace,
        mut state: State,
    ) -> Self {
        let audit = Audit::new(&system, &method, &mut work, &state);
        let shares = Shares::new(&system, &state.x, &work);
        let mut gauges = system.gauge_values();
        gauges.count_on(&state.measured);
        system.measure(&state.x, &state.v, &mut gauges);
        state.measured.copy_from_slice(gauges.counted());
        let pilot = Pilot::new(&system, &method, &newton, &state, &gauges, (&audit, &shares));
        let mut simulation = Self {
            hints: Hints::of(&newton, &*integrator),
            followers: None,
            grid: Grid::new(state.t, step),
            integrator,
            shown_v: state.v.clone(),
            shown_a: state.a.clone(),
            found_v: state.v.clone(),
            found_a: state.a.clone(),
            judge: Judge::new(&system, &method, &work),
            contacts: if method.accuracy.is_none() { system.switching_forces().map(|_| Contact::default()).collect() } else { Vec::new() },
            system,
            method,
            newton,
            work,
            state,
            audit,
            shares,
            start: Start::default(),
            step,
            steps: 0,
            pilot,
            next_gauges: gauges.clone(),
            gauges,
            reactions: None,
            apart: None,
            sure: None,
            happenings: Vec::new(),
            watched: None,
            samples: Vec::new(),
            has_ended: false,
        };
        simulation.begin_periods();
        simulation
    }

    /// Takes the next nominal step. An accuracy is that of a call: errors of many add up to more.
    pub fn step(&mut self) -> Status {
        self.step_observed(&mut |_: &Self| Verdict::GoOn)
    }

    /// The same, shown to an observer.
    pub fn step_observed(&mut self, observer: &mut dyn Observer) -> Status {
        self.run(self.grid.following(self.state.t), observer)
    }

    /// Runs to the time `t` (s), with the accuracy asked for up to there.
    pub fn step_to(&mut self, t: f64) -> Status {
        self.run(t, &mut |_: &Self| Verdict::GoOn)
    }

    /// Runs to time `end` (s), or to an event that ends the run, and shows the start and every nominal step to the observer. Where the end is closer
    /// than a millionth of a step, it is there.
    pub fn run(&mut self, end: f64, observer: &mut dyn Observer) -> Status {
        self.has_ended = false;
        if let Some(reason) = self.cannot_run(end) {
            return Status::Stopped { at: self.state.t, reason };
        }
        match self.begin_sampling() {
            Ok(true) => self.show_division(observer),
            Ok(false) => (),
            Err(failure) => return Status::Stopped { at: self.state.t, reason: self.reason(failure) },
        }
        if observer.after_step(self) == Verdict::Stop {
            return self.interrupted();
        }
        if self.steps == 0 {
            self.look_at_contacts();
        }
        self.begin_adapting(end);
        while !self.is_there(end) {
            let before = self.state.t;
            let target = self.grid.next(before, end);
            let wants_forces = observer.wants_forces();
            self.has_ended = match self.advance_through_events(target, observer) {
                Ok(has_ended) => has_ended,
                Err(failure) => {
                    self.grid.back();
                    // Shorter attempts may profit from what failed ones learned of the rows; what comes after the run may not.
                    self.hints.restore(&mut self.newton, &mut *self.integrator);
                    if let Some(pilot) = &mut self.pilot {
                        pilot.forget(self.state.t);
                    }
                    return Status::Stopped { at: self.state.t, reason: self.reason(failure) };
                }
            };
            if self.state.t == before {
                // An event stopped the run as it began the step: what is there was shown as it was before that.
                self.grid.back();
                if self.has_ended {
                    self.update_reactions();
                    let _ = observer.after_step(self);
                }
                break;
            }
            if self.has_ended && !wants_forces {
                // The last row of a run that an event ends is wanted by all.
                self.update_reactions();
            }
            if observer.after_step(self) == Verdict::Stop {
                return self.interrupted();
            }
            if self.has_ended {
                break;
            }
        }
        Status::Completed
    }

    fn interrupted(&self) -> Status {
        Status::Stopped { at: self.state.t, reason: "interrupted".into() }
    }

    /// The system that is simulated.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The method at work.
    pub fn method(&self) -> &Method {
        &self.method
    }

    /// The present state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Velocities to show (D × nodes), m/s: the state's, or with shadow projections the projected ones.
    pub fn velocities(&self) -> &[f64] {
        &self.shown_v
    }

    /// Values and gradients at the present state.
    pub(crate) fn evaluation(&self) -> &Evaluation {
        &self.work.start.at
    }

    /// Accelerations to show (D × nodes), m/s².
    pub fn accelerations(&self) -> &[f64] {
        &self.shown_a
    }

    /// Coordinates of joints and their rates, in the order of [`System::gauges`].
    pub fn gauges(&self) -> &GaugeValues {
        &self.gauges
    }

    /// Value (rad or m) and rate (rad/s or m/s) of a coordinate of a joint by its name, such as `hinge.angle`, over any number of turns.
    pub fn coordinate(&self, name: &str) -> Option<[f64; 2]> {
        let at = self.system.gauges().iter().position(|known| known == name)?;
        Some([self.gauges.value[at], self.gauges.rate[at]])
    }

    /// How much each row (r) adds to those before it at the present state, as [`crate::formulation::independence`] has it. It is found in the room
    /// of the matrix of the steps, which go on as if nobody had asked.
    pub fn independence(&mut self) -> Vec<f64> {
        self.ask(|own| {
            Independence::within(&own.system, &mut own.newton.kkt).shares(&own.system, &own.state.x, &own.state.angle, own.state.t)
        })
    }

    /// How many rows follow from others at the present state.
    fn redundant_rows(&self) -> usize {
        let least = independent(self.system.coordinates());
        let shares =
            Independence::like(&self.system, &self.newton.kkt).shares(&self.system, &self.state.x, &self.state.angle, self.state.t);
        shares.into_iter().filter(|share| *share < least).count()
    }

    /// The energy audit so far.
    pub fn audit(&self) -> &Audit {
        &self.audit
    }

    /// What was corrected before the start.
    pub fn start(&self) -> &Start {
        &self.start
    }

    /// The summary of a run to `end` that ended with `status`, with what is known of the model's size.
    pub fn summary(&self, model: &str, end: f64, status: &Status, size: ModelSize) -> Summary {
        let (word, stopped_at, reason) = match status {
            Status::Completed => ("completed", None, None),
            Status::Stopped { at, reason } => ("stopped", Some(*at), Some(reason.clone())),
        };
        Summary {
            model: model.into(),
            method: self.method.summary(),
            status: word.into(),
            stopped_at,
            reason,
            step: self.step,
            end,
            ended_by: self.ended_by().map(|event| event.event.clone()),
            events: self.happenings.clone(),
            steps: self.steps,
            size,
            energy: self.audit.energy_summary(),
            momentum: self.audit.momentum_summary(),
            violation: self.audit.violation_summary(),
            work: self.work(),
        }
    }

    /// What the run has taken so far. Iterations count over nominal steps, and over those taken where an accuracy chooses them:
    /// it has nothing to do with the nominal ones.
    pub fn work(&self) -> WorkSummary {
        let nominal = self.audit.work_summary(self.steps);
        match self.method.accuracy {
            None => nominal,
            Some(_) => self.audit.work_summary(nominal.steps_taken),
        }
    }

    /// Nominal step, s.
    pub fn nominal_step(&self) -> f64 {
        self.step
    }

    /// Nominal steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }
}
