//! Checkpoints: all that a run goes on from, so that a resumed one has the same bits.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::doubts::Contact;
use super::events::SHORTEST;
use super::pilot::Flight;
use super::shares::Shares;
use super::{Audit, Happening, Method, Reactions, Simulation, State};
use crate::formulation::{Fit, Newton, Rank, Workspace};
use crate::integrator::Integrator;
use crate::system::{Measured, System};

/// A run between two nominal steps. It is plain data: what is written and read again is the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Where the run is.
    pub state: State,
    /// What goes on beside the state, where that is a run of the same method.
    run: Option<Run>,
}

impl Checkpoint {
    /// Whether a run that goes on from here is as one that did not end here: not from within a nominal step, as after a last one that the
    /// end of the run has cut short, and not where an event has ended the run.
    pub fn goes_on_unbroken(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.grid.is_on(self.state.t) && !run.has_ended)
    }

    /// Keeps forces of the constraints that were found apart from the simulation.
    pub(crate) fn keep(&mut self, reactions: &Reactions) {
        if let Some(run) = &mut self.run {
            run.progress.reactions = Some(reactions.clone());
        }
    }
}

impl From<State> for Checkpoint {
    /// A run that begins at a state: nothing is booked of what was before.
    fn from(state: State) -> Self {
        Self { state, run: None }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Run {
    /// The method in words.
    method: String,
    grid: Grid,
    happenings: Vec<Happening>,
    /// Indicators of the events there, and the time, s.
    watched: Option<(f64, Vec<f64>)>,
    /// How often events with a period have happened.
    samples: Vec<u64>,
    has_ended: bool,
    progress: Progress,
}

/// What a step changes beside the state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Progress {
    steps: u64,
    /// Velocities and accelerations that are shown.
    shown: [Vec<f64>; 2],
    measured: Measured,
    audit: Audit,
    shares: Shares,
    contacts: Vec<Contact>,
    reactions: Option<Reactions>,
    hints: Hints,
    /// Iterations and factorisations so far.
    counters: [u64; 2],
    flight: Option<Flight>,
}

/// Where steps within a nominal one begin, to go back to.
pub(super) struct Moment {
    state: State,
    progress: Progress,
}

/// What the steps before said of rows and dampers, of which the next step is made beside the state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Hints {
    rank: Rank,
    fit: Fit,
    /// What the integrator carries on.
    carried: Vec<f64>,
}

impl Hints {
    pub(super) fn of(newton: &Newton, integrator: &dyn Integrator) -> Self {
        let mut hints = Self { rank: newton.rank.clone(), fit: newton.fit.clone(), carried: Vec::new() };
        hints.keep(newton, integrator);
        hints
    }

    pub(super) fn keep(&mut self, newton: &Newton, integrator: &dyn Integrator) {
        self.rank.copy_from(&newton.rank);
        self.fit.copy_from(&newton.fit);
        self.carried.clear();
        integrator.carry(&mut self.carried);
    }

    pub(super) fn restore(&self, newton: &mut Newton, integrator: &mut dyn Integrator) {
        newton.rank.copy_from(&self.rank);
        newton.fit.copy_from(&self.fit);
        integrator.carry_on(&self.carried);
    }
}

/// The times of nominal steps: `first` + k `step`, of which `passed` lie behind, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Grid {
    first: f64,
    step: f64,
    passed: u64,
}

impl Grid {
    pub(super) fn new(first: f64, step: f64) -> Self {
        Self { first, step, passed: 0 }
    }

    /// The time after so many steps.
    fn at(&self, count: u64) -> f64 {
        self.first + count as f64 * self.step
    }

    /// Whether a time is that of the last nominal step.
    fn is_on(&self, t: f64) -> bool {
        t == self.at(self.passed)
    }

    /// The next nominal time after `t` in a run to `end`; a run that is not on the grid begins another.
    pub(super) fn next(&mut self, t: f64, end: f64) -> f64 {
        if !self.is_on(t) {
            *self = Self::new(t, self.step);
        }
        let count = ((end - self.first) / self.step - SHORTEST).ceil().max(0.0) as u64;
        self.passed += 1;
        if self.passed >= count { end } else { self.at(self.passed) }
    }

    /// The nominal time after `t`.
    pub(super) fn following(&self, t: f64) -> f64 {
        if self.is_on(t) { self.at(self.passed + 1) } else { t + self.step }
    }

    /// Takes the last nominal time back, which was not reached.
    pub(super) fn back(&mut self) {
        self.passed -= 1;
    }
}

impl Moment {
    pub(super) fn t(&self) -> f64 {
        self.state.t
    }
}

impl Simulation {
    /// Whether its checkpoint [goes on](Checkpoint::goes_on_unbroken) as a run that does not end here.
    pub fn goes_on_unbroken(&self) -> bool {
        self.grid.is_on(self.state.t) && !self.has_ended
    }

    /// All that the run goes on from.
    pub fn checkpoint(&self) -> Checkpoint {
        let run = Run {
            method: words(&self.method),
            grid: self.grid,
            happenings: self.happenings.clone(),
            watched: self.watched.clone().filter(|(t, indicators)| {
                // Files know no infinite numbers.
                *t == self.state.t && !indicators.is_empty() && indicators.iter().all(|indicator| indicator.is_finite())
            }),
            samples: self.samples.clone(),
            has_ended: self.has_ended,
            progress: self.progress(),
        };
        Checkpoint { state: self.state.clone(), run: Some(run) }
    }

    fn progress(&self) -> Progress {
        let mut measured = Measured::default();
        measured.keep(&self.gauges);
        Progress {
            steps: self.steps,
            shown: [self.shown_v.clone(), self.shown_a.clone()],
            measured,
            audit: self.audit.clone(),
            shares: self.shares.clone(),
            contacts: self.contacts.clone(),
            reactions: self.reactions.clone(),
            hints: Hints::of(&self.newton, &*self.integrator),
            counters: [self.newton.iterations, self.newton.factorizations],
            flight: self.pilot.as_ref().map(|pilot| pilot.flight()),
        }
    }

    /// Goes on from a checkpoint of an earlier run of the same system: with the same method and nominal step to the same bits, with
    /// others from its state. `None` when that is not one of this system and method, and where it or the step is no number to go on with.
    pub fn resume(system: impl Into<Arc<System>>, method: Method, step: f64, checkpoint: impl Into<Checkpoint>) -> Option<Self> {
        let system = system.into();
        let Checkpoint { state, run } = checkpoint.into();
        let mut work = Workspace::new(&system);
        let newton = Newton::new(&system, &work.scales, method.settings);
        let integrator = (method.integrator.make)(&system, &newton, method.parameters);
        let has_numbers = step > 0.0 && step.is_finite() && state.is_finite();
        if !has_numbers || !state.fits(&system) || state.memory.len() != integrator.memory(&system) {
            return None;
        }
        work.level = method.settings.level;
        work.memory = state.memory.clone();
        state.load(&mut work);
        system.evaluate_again(&state.x, state.t, &mut work.start.at);
        let mut simulation = Self::assemble(system, method, integrator, step, newton, work, state);
        if let Some(run) = run.filter(|run| run.method == words(&simulation.method)) {
            simulation.go_on(run.progress);
            (simulation.happenings, simulation.samples, simulation.has_ended) = (run.happenings, run.samples, run.has_ended);
            simulation.watched = run.watched;
            if run.grid.step == simulation.step {
                simulation.grid = run.grid;
            }
        }
        Some(simulation)
    }

    /// The present moment, to go back to.
    pub(super) fn moment(&self) -> Moment {
        Moment { state: self.state.clone(), progress: self.progress() }
    }

    /// Goes back to a moment of this run.
    pub(super) fn restore(&mut self, moment: &Moment) {
        self.state.copy_from(&moment.state);
        self.work.memory.copy_from_slice(&self.state.memory);
        self.go_on(moment.progress.clone());
    }

    fn go_on(&mut self, progress: Progress) {
        let state = self.state.clone();
        if let (Some(mut pilot), Some(flight)) = (self.pilot.take(), progress.flight) {
            pilot.take_over(flight, self);
            self.pilot = Some(pilot);
        }
        self.state.copy_from(&state);
        [self.shown_v, self.shown_a] = progress.shown;
        self.gauges.restore(&progress.measured);
        self.gauges.count_on(&state.measured);
        (self.audit, self.shares) = (progress.audit, progress.shares);
        self.work.powers.copy_from_slice(&self.shares.powers);
        (self.contacts, self.reactions) = (progress.contacts, progress.reactions);
        [self.newton.iterations, self.newton.factorizations] = progress.counters;
        self.hints = progress.hints;
        self.hints.restore(&mut self.newton, &mut *self.integrator);
        self.steps = progress.steps;
        state.load(&mut self.work);
        self.system.evaluate_again(&state.x, state.t, &mut self.work.start.at);
    }
}

/// All of a method that its numbers depend on.
fn words(method: &Method) -> String {
    format!("{} {:?}", method.name, method.summary())
}
