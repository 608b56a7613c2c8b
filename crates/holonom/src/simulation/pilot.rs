//! What chooses steps by accuracy: how far each may go, what its error is worth, and the moments to go back to.

use serde::{Deserialize, Serialize};

use super::control::Control;
use super::passage::View;
use super::shares::Shares;
use super::sight::Sight;
use super::{Audit, Method, Simulation, State};
use crate::energy;
use crate::formulation::{Failure, Independence, Newton};
use crate::integrator::{Estimate, Step};
use crate::projection::{Metric, Projection, Solve};
use crate::system::{GaugeValues, Measured, System};

/// Smallest step over the length of the run that an accuracy may ask for: below it times no longer tell steps apart.
pub(super) const SMALLEST_SHARE: f64 = 1e-13;

/// A state, what is shown and measured of it, and what is booked of the run up to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Moment {
    pub state: State,
    pub v: Vec<f64>,
    a: Vec<f64>,
    measured: Measured,
    audit: Audit,
    shares: Shares,
}

impl Moment {
    pub fn keep(&mut self, simulation: &Simulation) {
        self.state.copy_from(&simulation.state);
        self.v.copy_from_slice(&simulation.shown_v);
        self.a.copy_from_slice(&simulation.shown_a);
        self.measured.keep(&simulation.gauges);
        self.audit.clone_from(&simulation.audit);
        self.shares.copy_from(&simulation.shares);
    }

    /// Puts a simulation back here.
    pub fn restore(&self, simulation: &mut Simulation) {
        simulation.state.copy_from(&self.state);
        simulation.shown_v.copy_from_slice(&self.v);
        simulation.shown_a.copy_from_slice(&self.a);
        simulation.gauges.restore(&self.measured);
        simulation.gauges.count_on(&self.state.measured);
        simulation.audit.clone_from(&self.audit);
        simulation.shares.copy_from(&self.shares);
        let work = &mut simulation.work;
        work.start.at.functions.angle.copy_from_slice(&self.state.angle);
        simulation.system.evaluate_again(&self.state.x, self.state.t, &mut work.start.at);
    }
}

/// What chooses the steps, and the moments to go back to.
pub(super) struct Pilot {
    pub control: Control,
    pub end: f64,
    /// The projection that smooths velocities for the estimate from the steps before, where nothing else does.
    pub smooth: Option<Projection>,
    /// Velocities (D × nodes) that errors are estimated from.
    pub v: Vec<f64>,
    /// What is known of singular positions ahead.
    pub view: View,
    /// The start of the last step, and its end, where integration goes on.
    pub before: Moment,
    pub front: Moment,
    pub last: Option<(Step, f64)>,
    /// How independent rows are, and how many are redundant everywhere, as far as is known.
    pub independence: Independence,
    pub redundant: usize,
    pub patience: Patience,
    /// What is seen of forces that bend at the end of the last step.
    pub sight: Sight,
    /// Times at which steps end, as something changes abruptly there, s.
    pub switches: Vec<f64>,
}

/// How attempts at steps have gone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Patience {
    /// Rejected one after the other.
    pub rejected: u32,
    /// Attempts since `since` (s).
    pub attempts: u32,
    since: f64,
    /// Looks one after the other at which they had hardly come on, and those of them at which many had ended at bends of forces.
    slow: u32,
    #[serde(default)]
    chatters: u32,
    /// Attempts since then that ended at a bend, and the last of these.
    #[serde(default)]
    bent: u32,
    #[serde(default)]
    bend: usize,
    /// What steps that showed nothing but round-off near a singular position have made of the energy, J.
    #[serde(default)]
    hidden: f64,
    /// Steps since then whose errors were seen.
    #[serde(default)]
    seen: u32,
}

/// Largest share of the energy to move that a step may make or lose, in units of the accuracy it is allowed.
const WORSE: f64 = 20.0;

/// Order of the schemes whose errors of energy come and go.
const SYMMETRIC: u8 = 2;

/// Share of the accuracy that errors of schemes of order 2 are held to where nothing holds the energy: they add up in one direction.
const LOOSE: f64 = 0.5;

/// Attempts between counts of redundant rows, steps behind a singular position after which it is passed, and rejections in a row after which no row
/// is taken to be redundant everywhere.
pub(super) const OFTEN: u32 = 64;
const DOUBT: u32 = 2;

/// Attempts between looks at how far they have come, and so many looks in a row at which each had come on by less than this share of the run on
/// average: a stiff stop takes a hundred thousand steps at the finest accuracy, and then it is over.
const LOOK: u32 = 2000;
const SLOW: f64 = 1e-8;
const SLOW_LOOKS: u32 = 1000;

/// Share of the attempts between two looks that end at bends where a force jumps to and fro with what it moves, and so many looks at which that and
/// nothing else goes on.
const CHATTERS: f64 = 0.1;
const CHATTER_LOOKS: u32 = 3;

/// Steps between two times at which something changes abruptly: a pulse that is nothing at both is seen.
pub(super) const BETWEEN: f64 = 4.0;

impl Pilot {
    pub fn new(
        system: &System,
        method: &Method,
        newton: &Newton,
        state: &State,
        gauges: &GaugeValues,
        (audit, shares): (&Audit, &Shares),
    ) -> Option<Box<Self>> {
        let mut measured = Measured::default();
        measured.keep(gauges);
        let moment = || Moment {
            state: state.clone(),
            v: state.v.clone(),
            a: state.a.clone(),
            measured: measured.clone(),
            audit: audit.clone(),
            shares: shares.clone(),
        };
        let estimate = method.integrator.estimate;
        // Errors of schemes of order 2 add up in one direction where nothing holds the energy.
        let is_loose = method.order() <= SYMMETRIC && !method.integrator.conserves;
        let accuracy = if is_loose { LOOSE * method.accuracy? } else { method.accuracy? };
        let control = Control::new(accuracy, method.order(), estimate, system.coordinates());
        let mut independence = Independence::like(system, &newton.kkt);
        let redundant = independence.count_redundant(system, &state.x, &state.angle, state.t);
        let smooth = smoothing(method);
        Some(Box::new(Self {
            control,
            end: state.t,
            smooth,
            v: state.v.clone(),
            view: View::new(state.x.clone(), &independence),
            before: moment(),
            front: moment(),
            last: None,
            independence,
            redundant,
            patience: Patience::default(),
            sight: Sight::default(),
            switches: Vec::new(),
        }))
    }
}

/// What a pilot goes on from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Flight {
    control: Control,
    end: f64,
    v: Vec<f64>,
    before: Moment,
    front: Moment,
    /// Length of the last step, where one was taken, s.
    length: Option<f64>,
    redundant: usize,
    patience: Patience,
    sight: Sight,
    /// See [`View::clear`].
    #[serde(default)]
    clear: f64,
}

impl Pilot {
    /// Where a step from `t` ends at the latest on the way to `target`, as something changes abruptly there, and how long it may be.
    pub fn reach(&self, t: f64, target: f64) -> (f64, f64) {
        let next = self.switches.partition_point(|switch| *switch <= t);
        match (next.checked_sub(1).map(|last| self.switches[last]), self.switches.get(next)) {
            (_, None) => (target, self.control.step),
            (None, Some(&switch)) => (switch.min(target), self.control.step),
            (Some(last), Some(&switch)) => (switch.min(target), self.control.step.min((switch - last) / BETWEEN)),
        }
    }

    /// Whether `t` is the first time behind one at which something changes abruptly.
    pub fn is_behind_switch(&self, system: &System, t: f64) -> bool {
        let last = self.switches.partition_point(|switch| *switch < t).checked_sub(1);
        last.is_some_and(|last| system.behind_switch(self.switches[last]) == t)
    }

    /// The error of the last step over what is allowed. Where it is too large it is looked at once more: rows that hardly differ
    /// from others, but for those that are redundant anyway, make more of round-off, and shorter steps all the more.
    pub fn ratio(&mut self, simulation: &mut Simulation, taken: &Step, step: f64) -> f64 {
        let (t, integrator) = (simulation.state.t, simulation.method.integrator);
        let ratio = self.control.ratio(taken, step, t, &self.v, 1.0, &mut simulation.work);
        let of_energy = self.ratio_of_energy(simulation, step, 1.0);
        // Errors of explicit schemes grow there, too, and may be far more than their estimate, which the energy shows.
        if integrator.is_explicit() || ratio.max(of_energy) <= 1.0 {
            return ratio.max(of_energy);
        }
        self.count_redundant(&simulation.system, &simulation.state);
        let redundant = if self.patience.rejected < DOUBT { self.redundant } else { 0 };
        let amplified = self.independence.amplification(redundant);
        let of_energy = if of_energy > 1.0 { self.ratio_of_energy(simulation, step, amplified) } else { of_energy };
        self.control.ratio(taken, step, t, &self.v, amplified, &mut simulation.work).max(of_energy)
    }

    /// The same by the energy that the step has made or lost, for schemes that err by little but in the same direction in step after step: what is
    /// off in the velocity adds up to a way, which may be many times the length of the mechanism. Round-off counts `amplified` times.
    fn ratio_of_energy(&self, simulation: &Simulation, step: f64, amplified: f64) -> f64 {
        let Simulation { system, state, audit, work, method, judge, .. } = simulation;
        // Velocities that no row holds at the end of a step come and go.
        let comes_and_goes = method.integrator.conserves || method.order() <= SYMMETRIC || is_rough(method);
        // What positions off their rows have of energy is no matter of the length of steps.
        let drifts = method.integrator.is_explicit() && !method.projection.position;
        // Schemes of several steps book work less exactly than they find the motion: where anything does work their estimate alone tells.
        let is_unsure = method.integrator.estimate == Estimate::OwnOfStates && audit.work != self.before.audit.work;
        if comes_and_goes || drifts {
            return 0.0;
        }
        // Formulas of time round the velocities of what they drive as those of its largest speed, also where it comes to rest.
        let of_speeds = judge.of_speeds(audit.kinetic.max(self.before.audit.kinetic), self.control.speed);
        let of_states = || energy::size(system, work, &state.x) + judge.lift(work.scales.length) + of_speeds;
        let booked = if is_unsure { 0.0 } else { audit.made_since(&self.before.audit, amplified, judge.still(work), of_states) };
        // The estimate is no energy that is there: beside it the mechanism has at least what it has when it goes its own length in the run.
        let slow = judge.motion(work.scales.length / self.control.span);
        let estimated = audit.estimated(work.estimate.energy, amplified * work.estimate.rounded, slow);
        // Differences of states that are round-off say nothing of the energy either, and shorter steps would only raise it.
        let made = if self.control.is_noise() { booked } else { booked.max(estimated) };
        made / (WORSE * self.control.allowed() * step * self.control.share_of_way(work.scales.length))
    }

    /// Books what the last step has made of the energy, where nothing but round-off was seen of its error. Where drives leave no freedom the motion
    /// is theirs, whatever the energy.
    pub fn book_hidden(&mut self, simulation: &Simulation) {
        let Simulation { system, audit, .. } = simulation;
        let is_free = system.constraints() < system.coordinates() + self.redundant;
        if is_free && self.control.is_rounded() {
            self.patience.hidden += audit.made() - self.before.audit.made();
            self.patience.seen = 0;
        } else {
            self.patience.seen = self.patience.seen.saturating_add(1);
        }
    }

    /// Counts the rows that are redundant here: those that are so everywhere are the fewest, as a run may begin at a singular position.
    pub fn count_redundant(&mut self, system: &System, state: &State) {
        self.redundant = self.redundant.min(self.independence.count_redundant(system, &state.x, &state.angle, state.t));
    }

    /// Begins anew at the present state, where inputs were set: what was found beyond it was of others.
    pub fn begin_anew(&mut self, simulation: &Simulation) {
        self.v.copy_from_slice(&simulation.shown_v);
        self.control.begin_anew(&simulation.state, &self.v);
        self.sight = simulation.sight();
        self.turn(simulation);
    }

    /// Goes on from the present state.
    pub fn turn(&mut self, simulation: &Simulation) {
        self.front.keep(simulation);
        self.last = None;
    }

    /// Has the next run begin as at a start, where this one ended at `t` with attempts that failed: what these came to says nothing of it.
    pub fn forget(&mut self, t: f64) {
        (self.end, self.control.step, self.patience) = (t, 0.0, Patience::default());
    }

    /// All energy there was to move up to where integration has come, J.
    pub fn supply(&self) -> f64 {
        self.front.audit.supply()[1]
    }

    /// Refuses to go on behind a singular position where more was hidden than the accuracy leaves of all there was to move, or of what the mechanism
    /// has when it goes its own length in the run: what begins at rest there has hardly anything yet.
    pub fn require_visible(&self, simulation: &Simulation) -> Result<(), Failure> {
        let Patience { hidden, seen, .. } = self.patience;
        let (Simulation { audit, work, judge, .. }, Some(accuracy)) = (simulation, simulation.method.accuracy) else { return Ok(()) };
        if seen != OFTEN {
            return Ok(());
        }
        let share = hidden.abs() / audit.supply()[1].max(judge.motion(work.scales.length / self.control.span));
        if share > WORSE * accuracy { Err(Failure::Hidden { share }) } else { Ok(()) }
    }

    /// Refuses attempts at steps of length `step` (s) that come nowhere: at this pace the run never ends.
    pub fn require_progress(&mut self, step: f64, t: f64) -> Result<(), Failure> {
        if step < SMALLEST_SHARE * self.control.span {
            return Err(self.reached().map_or(Failure::TooSmall, |corner| Failure::JumpsBack { corner }));
        }
        let Patience { attempts, since, slow, chatters, bent, bend, .. } = &mut self.patience;
        *attempts += 1;
        if *attempts % LOOK != 0 {
            return Ok(());
        }
        let pace = (t - *since) / f64::from(LOOK);
        *since = t;
        let is_slow = pace < SLOW * self.control.span;
        *slow = if is_slow { *slow + 1 } else { 0 };
        *chatters = if is_slow && f64::from(*bent) > CHATTERS * f64::from(LOOK) { *chatters + 1 } else { 0 };
        *bent = 0;
        if *chatters >= CHATTER_LOOKS {
            return Err(Failure::JumpsBack { corner: *bend });
        }
        if *slow >= SLOW_LOOKS { Err(Failure::Crawling { pace, left: (self.end - t) / pace }) } else { Ok(()) }
    }

    /// The first bend of a force at which the last step ended.
    fn reached(&self) -> Option<usize> {
        self.sight.reached.iter().position(|reached| *reached)
    }

    /// Takes note of an attempt that ended at a bend of a force.
    pub fn bend(&mut self) {
        if let Some(bend) = self.reached() {
            (self.patience.bent, self.patience.bend) = (self.patience.bent + 1, bend);
        }
    }

    pub fn flight(&self) -> Flight {
        let length = self.last.map(|(_, length)| length);
        let (control, v) = (self.control.clone(), self.v.clone());
        Flight {
            control,
            end: self.end,
            v,
            before: self.before.clone(),
            front: self.front.clone(),
            length,
            redundant: self.redundant,
            patience: self.patience,
            sight: self.sight.clone(),
            clear: self.view.clear,
        }
    }

    /// Goes on from there. An integrator with dense output takes the last step once more, to know what is inside it.
    pub fn take_over(&mut self, flight: Flight, simulation: &mut Simulation) {
        let Flight { control, end, v, before, front, length, redundant, patience, sight, clear } = flight;
        (self.redundant, self.patience, self.sight, self.view.clear) = (redundant, patience, sight, clear);
        (self.control, self.end, self.v, self.before, self.front) = (control, end, v, before, front);
        simulation.work.estimate.allowed = self.control.allowed();
        if let (Some(length), true) = (length, simulation.method.integrator.dense) {
            self.before.restore(simulation);
            self.last = simulation.substep(length, self.front.state.t).ok().map(|taken| (taken, length));
            if let Some((taken, length)) = self.last {
                self.before.restore(simulation);
                // What is inside the step is known then, as it is where something was read there.
                let middle = self.before.state.t + 0.5 * length;
                let _ = simulation.interpolate(middle, taken, length);
            }
        }
    }
}

/// Whether nothing holds the velocities on the rows.
pub(super) fn is_rough(method: &Method) -> bool {
    method.formulation.is_at_position() && !method.projection.velocity
}

fn smoothing(method: &Method) -> Option<Projection> {
    (is_rough(method) && method.integrator.estimate == Estimate::History).then_some(TO_ROWS)
}

/// The projection that puts velocities on the rows, by the least change in the metric of the mass.
pub(super) const TO_ROWS: Projection = Projection {
    position: false,
    velocity: true,
    acceleration: false,
    metric: Metric::Mass,
    solve: Solve::Exact,
    strength: 1.0,
    shadow: true,
};
