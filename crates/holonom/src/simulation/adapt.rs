//! Steps by accuracy at work: attempts, rejected ones taken back, and results between the steps of integrators with dense
//! output.

use serde::{Deserialize, Serialize};

use super::advance::Inside;
use super::control::{Control, KEEPING};
use super::events::LOCATED;
use super::landing::Landing;
use super::sight::{INSIDE, REACHED, Sight};
use super::{Audit, Method, Simulation, State, start};
use crate::energy;
use crate::formulation::{Failure, Independence, Newton};
use crate::integrator::{Estimate, Step, Work};
use crate::projection::{Metric, Projection, Solve};
use crate::system::{GaugeValues, Measured, System};

/// Smallest step over the length of the run that an accuracy may ask for: below it times no longer tell steps apart.
const SMALLEST_SHARE: f64 = 1e-13;

/// Share of itself that a row adds to the others below which it adds nothing.
const LEAST_SHARE: f64 = 1e-10;

/// A state, what is shown and measured of it, and what is booked of the run up to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Moment {
    pub state: State,
    v: Vec<f64>,
    a: Vec<f64>,
    measured: Measured,
    audit: Audit,
}

impl Moment {
    fn keep(&mut self, simulation: &Simulation) {
        self.state.copy_from(&simulation.state);
        self.v.copy_from_slice(&simulation.shown_v);
        self.a.copy_from_slice(&simulation.shown_a);
        self.measured.keep(&simulation.gauges);
        self.audit.clone_from(&simulation.audit);
    }

    /// Puts a simulation back here.
    pub fn restore(&self, simulation: &mut Simulation) {
        simulation.state.copy_from(&self.state);
        simulation.shown_v.copy_from_slice(&self.v);
        simulation.shown_a.copy_from_slice(&self.a);
        simulation.gauges.restore(&self.measured);
        simulation.gauges.count_on(&self.state.measured);
        simulation.audit.clone_from(&self.audit);
        let work = &mut simulation.work;
        work.start.at.functions.angle.copy_from_slice(&self.state.angle);
        simulation.system.evaluate_again(&self.state.x, self.state.t, &mut work.start.at);
    }
}

/// What chooses the steps, and the moments to go back to.
pub(super) struct Pilot {
    control: Control,
    end: f64,
    /// The projection that smooths velocities for the estimate from the steps before, where nothing else does.
    smooth: Option<Projection>,
    /// Velocities (D × nodes) that errors are estimated from.
    v: Vec<f64>,
    /// The start of the last step, and its end, where integration goes on.
    pub before: Moment,
    front: Moment,
    last: Option<(Step, f64)>,
    /// How independent rows are, and how many are redundant everywhere, as far as is known.
    independence: Independence,
    redundant: usize,
    patience: Patience,
    /// What is seen of forces that bend at the end of the last step.
    pub sight: Sight,
    /// Times at which steps end, as something changes abruptly there, s.
    switches: Vec<f64>,
}

/// How attempts at steps have gone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Patience {
    /// Rejected one after the other.
    rejected: u32,
    /// Attempts since `since` (s).
    attempts: u32,
    since: f64,
    /// Looks one after the other at which they had hardly come on.
    slow: u32,
}

/// So many steps rejected one after the other are no matter of length: the motion is another one, and what was kept of the steps
/// before says nothing.
const RESTART: u32 = 3;

/// Largest share of the energy to move that a step of an explicit scheme may make or lose, in units of the accuracy it is allowed.
const WORSE: f64 = 20.0;

/// Attempts between counts of redundant rows, and rejections in a row after which none is taken to be redundant everywhere.
const OFTEN: u32 = 64;
const DOUBT: u32 = 2;

/// Attempts between looks at how far they have come, and so many looks in a row at which each had come on by less than this share of the run on
/// average: a stiff stop takes a hundred thousand steps at the finest accuracy, and then it is over.
const LOOK: u32 = 2000;
const SLOW: f64 = 1e-8;
const SLOW_LOOKS: u32 = 1000;

/// Steps between two times at which something changes abruptly: a pulse that is nothing at both is seen.
pub(super) const BETWEEN: f64 = 4.0;

impl Pilot {
    pub(super) fn new(
        system: &System,
        method: &Method,
        newton: &Newton,
        state: &State,
        gauges: &GaugeValues,
        audit: &Audit,
    ) -> Option<Box<Self>> {
        let mut measured = Measured::default();
        measured.keep(gauges);
        let moment =
            || Moment { state: state.clone(), v: state.v.clone(), a: state.a.clone(), measured: measured.clone(), audit: audit.clone() };
        let control = Control::new(method.accuracy?, method.order(), method.integrator.estimate, system.coordinates());
        let mut independence = Independence::like(system, &newton.kkt);
        let redundant = independence.count_redundant(system, &state.x, state.t);
        let smooth = smoothing(method);
        Some(Box::new(Self {
            control,
            end: state.t,
            smooth,
            v: state.v.clone(),
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
}

impl Pilot {
    /// Where a step from `t` ends at the latest on the way to `target`, as something changes abruptly there, and how long it may be.
    fn reach(&self, t: f64, target: f64) -> (f64, f64) {
        let next = self.switches.partition_point(|switch| *switch <= t);
        match (next.checked_sub(1).map(|last| self.switches[last]), self.switches.get(next)) {
            (_, None) => (target, self.control.step),
            (None, Some(&switch)) => (switch.min(target), self.control.step),
            (Some(last), Some(&switch)) => (switch.min(target), self.control.step.min((switch - last) / BETWEEN)),
        }
    }

    /// The error of the last step over what is allowed. Where it is too large it is looked at once more: rows that hardly differ
    /// from others, but for those that are redundant anyway, make more of round-off, and shorter steps all the more.
    fn ratio(&mut self, simulation: &mut Simulation, taken: &Step, step: f64) -> f64 {
        let (t, work) = (simulation.state.t, &mut simulation.work);
        let ratio = self.control.ratio(taken, step, t, &self.v, 1.0, work);
        // Errors of explicit schemes grow there, too, and may be far more than their estimate, which the energy shows.
        if simulation.method.integrator.is_explicit() {
            let (system, state) = (&simulation.system, &simulation.state);
            let made = simulation.audit.made_since(&self.before.audit, || energy::size(system, work, &state.x));
            let of_energy = made / (WORSE * self.control.allowed() * step);
            // It may be the same however long steps are, as where positions have left their rows, and asks for no length then.
            return if of_energy > KEEPING { ratio.max(of_energy) } else { ratio };
        }
        if ratio <= 1.0 {
            return ratio;
        }
        self.count_redundant(&simulation.system, &simulation.state);
        let redundant = if self.patience.rejected < DOUBT { self.redundant } else { 0 };
        let weakest = self.independence.weakest(redundant).max(LEAST_SHARE);
        self.control.ratio(taken, step, t, &self.v, 1.0 / weakest.sqrt(), work)
    }

    /// Counts the rows that are redundant here: those that are so everywhere are the fewest, as a run may begin at a singular position.
    fn count_redundant(&mut self, system: &System, state: &State) {
        self.redundant = self.redundant.min(self.independence.count_redundant(system, &state.x, state.t));
    }

    /// Begins anew at the present state, where inputs were set: what was found beyond it was of others.
    pub(super) fn begin_anew(&mut self, simulation: &Simulation) {
        self.v.copy_from_slice(&simulation.shown_v);
        self.control.begin_anew(&simulation.state, &self.v);
        self.sight = simulation.sight();
        self.turn(simulation);
    }

    /// Goes on from the present state.
    fn turn(&mut self, simulation: &Simulation) {
        self.front.keep(simulation);
        self.last = None;
    }

    /// All energy there was to move up to where integration has come, J.
    pub(super) fn supply(&self) -> f64 {
        self.front.audit.supply()[1]
    }

    /// Refuses attempts at steps of length `step` (s) that come nowhere: at this pace the run never ends.
    fn require_progress(&mut self, step: f64, t: f64) -> Result<(), Failure> {
        if step < SMALLEST_SHARE * self.control.span {
            return Err(Failure::TooSmall);
        }
        let Patience { attempts, since, slow, .. } = &mut self.patience;
        *attempts += 1;
        if *attempts % LOOK != 0 {
            return Ok(());
        }
        let pace = (t - *since) / f64::from(LOOK);
        *since = t;
        *slow = if pace < SLOW * self.control.span { *slow + 1 } else { 0 };
        if *slow >= SLOW_LOOKS { Err(Failure::Crawling { pace, left: (self.end - t) / pace }) } else { Ok(()) }
    }

    pub(super) fn flight(&self) -> Flight {
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
        }
    }

    /// Goes on from there. An integrator with dense output takes the last step once more, to know what is inside it.
    pub(super) fn take_over(&mut self, flight: Flight, simulation: &mut Simulation) {
        let Flight { control, end, v, before, front, length, redundant, patience, sight } = flight;
        (self.redundant, self.patience, self.sight) = (redundant, patience, sight);
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

fn smoothing(method: &Method) -> Option<Projection> {
    let rough = method.formulation.is_at_position() && !method.projection.velocity;
    (rough && method.integrator.estimate == Estimate::History).then_some(Projection {
        velocity: true,
        acceleration: false,
        metric: Metric::Mass,
        solve: Solve::Exact,
        strength: 1.0,
        shadow: true,
    })
}

impl Simulation {
    /// Begins to choose steps for a run to `end` (s).
    pub(super) fn begin_adapting(&mut self, end: f64) {
        let Some(mut pilot) = self.pilot.take() else { return };
        pilot.switches = self.system.switch_times(end);
        if pilot.end == end {
            self.work.estimate.allowed = pilot.control.allowed();
            self.pilot = Some(pilot);
            return;
        }
        pilot.end = end;
        pilot.v.copy_from_slice(&self.shown_v);
        pilot.control.begin(&self.state, &pilot.v, end - self.state.t, self.work.scales.length);
        pilot.sight = self.sight();
        pilot.turn(self);
        self.work.estimate.allowed = pilot.control.allowed();
        self.pilot = Some(pilot);
    }

    /// Goes to `target` in equal steps no longer than the accuracy allows.
    pub(super) fn land(&mut self, target: f64, pilot: &mut Pilot, mut look: Option<&mut Inside<'_>>) -> Result<(), Failure> {
        while self.state.t < target {
            let (stop, longest) = pilot.reach(self.state.t, target);
            let left = stop - self.state.t;
            if self.skips(left, stop, pilot) {
                continue;
            }
            let parts = (left / longest - 1e-9).ceil().max(1.0);
            let step = left / parts;
            let is_taken = self.attempt(step, if parts == 1.0 { stop } else { self.state.t + step }, pilot)?;
            if is_taken && self.state.t < target && self.ends_here(&mut look)? {
                return Ok(());
            }
        }
        self.state.t = target;
        Ok(())
    }

    /// Goes on in steps as long as the accuracy allows, and reads what is at `target` between the ends of the last one.
    pub(super) fn cruise(&mut self, target: f64, pilot: &mut Pilot, mut look: Option<&mut Inside<'_>>) -> Result<(), Failure> {
        let shown = self.audit.clone();
        let from = self.state.t;
        pilot.front.restore(self);
        if self.look_inside([from, target], pilot, &shown, &mut look)? {
            return Ok(());
        }
        let mut outcome = Ok(());
        while self.state.t < target && outcome.is_ok() {
            // The last two steps are alike.
            let (stop, longest) = pilot.reach(self.state.t, pilot.end);
            let left = stop - self.state.t;
            if self.skips(left, stop, pilot) {
                continue;
            }
            let parts = (left / longest - 1e-9).ceil().max(1.0);
            let step = if parts <= 2.0 { left / parts } else { longest };
            let taken = self.attempt(step, if parts == 1.0 { stop } else { self.state.t + step }, pilot);
            if matches!(taken, Ok(true)) && self.look_inside([from, target], pilot, &shown, &mut look)? {
                return Ok(());
            }
            outcome = taken.map(|_| ());
        }
        if outcome.is_err() {
            // Where attempts that failed began is no start of the last step.
            pilot.last = None;
        }
        pilot.front.keep(self);
        if self.state.t > target
            && let Some((taken, length)) = pilot.last
        {
            pilot.before.restore(self);
            self.interpolate(target, taken, length)?;
        }
        self.audit.follow(&shown);
        outcome
    }

    /// Shows what is inside the last step and between two times, and says whether the nominal step ends there; if not, goes back to where
    /// integration has come. Where something changes abruptly at the end of the step, that is shown before it changes and after.
    fn look_inside(
        &mut self,
        [from, target]: [f64; 2],
        pilot: &mut Pilot,
        shown: &Audit,
        look: &mut Option<&mut Inside<'_>>,
    ) -> Result<bool, Failure> {
        let (Some((taken, length)), true) = (pilot.last, look.is_some()) else { return Ok(false) };
        let begin = pilot.before.state.t;
        let (low, high) = (from.max(begin), target.min(begin + length));
        if low >= high {
            return Ok(false);
        }
        pilot.front.keep(self);
        let front = self.state.t;
        let parts = (INSIDE * (high - low) / length - 1e-9).ceil();
        let inside = (1..parts as u32).map(|k| low + f64::from(k) * (high - low) / parts);
        let has_switch = pilot.switches.contains(&front.next_down().next_down());
        let last = [(has_switch, (begin + length).next_down().next_down()), (true, front)];
        let last = last.into_iter().filter_map(|(is_there, t)| (is_there && t > from && t < target).then_some(t));
        for t in inside.chain(last) {
            if t == front {
                pilot.front.restore(self);
            } else {
                pilot.before.restore(self);
                self.interpolate(t, taken, length)?;
            }
            self.audit.follow(shown);
            if self.ends_here(look)? {
                return Ok(true);
            }
        }
        pilot.front.restore(self);
        Ok(false)
    }

    /// Puts the state at a time inside the last step, which took `length` s.
    fn interpolate(&mut self, target: f64, taken: Step, length: f64) -> Result<(), Failure> {
        let (system, start) = (&*self.system, self.state.t);
        let share = (target - start) / length;
        self.state.load(&mut self.work);
        let done = self.integrator.interpolate(system, start, length, share, &mut self.newton, &mut self.work)?;
        self.finish(Step { work: Work::Sum(done), ..taken }, share * length, target).map(|_| ())
    }

    /// One attempt at a step, and whether it is taken; a step whose error is too large, or that fails, is taken back and the next one shorter.
    fn attempt(&mut self, step: f64, target: f64, pilot: &mut Pilot) -> Result<bool, Failure> {
        pilot.require_progress(step, self.state.t)?;
        pilot.before.keep(self);
        self.work.estimate.speed = pilot.control.speed;
        let (mut step, mut landing) = (step, Landing::Between(Sight::default()));
        let outcome = self.substep(step, target).and_then(|mut taken| {
            landing = self.land_on_bend(&mut taken, &mut step, pilot)?;
            self.smooth(step, pilot)?;
            Ok(taken)
        });
        if outcome.is_err() {
            landing = pilot.sight.stop_before(step, &self.system);
        }
        if pilot.sight.bends.iter().any(|bend| bend.abs() == REACHED) {
            // What jumped where the step begins is known.
            self.work.estimate.loads = 0.0;
        }
        let ratio = outcome.as_ref().map_or(f64::INFINITY, |taken| pilot.ratio(self, taken, step));
        let has_bend = matches!(landing, Landing::OnBend(_));
        if let (Ok(taken), Landing::Between(sight) | Landing::OnBend(sight), true) = (outcome, &mut landing, ratio <= 1.0) {
            if pilot.redundant > 0 && pilot.patience.attempts.is_multiple_of(OFTEN) {
                pilot.count_redundant(&self.system, &self.state);
            }
            pilot.control.remember(self.state.t, &pilot.v);
            let planned = pilot.control.step;
            pilot.control.accept(step, ratio);
            pilot.last = Some((taken, step));
            pilot.patience.rejected = 0;
            pilot.sight = std::mem::take(sight);
            if has_bend || step < 0.5 * planned {
                // How long the step to a bend was, or what was left to a time, says nothing of the next one.
                pilot.control.step = planned;
            }
            if !self.pass_switch(pilot) && has_bend {
                self.pass_bend(&pilot.sight, step);
                self.begin_anew();
                pilot.control.begin_anew(&self.state, &pilot.v);
            }
            return Ok(true);
        }
        pilot.before.restore(self);
        self.audit.reject(&self.newton);
        match landing {
            Landing::AtOnce => {
                self.pass_bend(&pilot.sight, step);
                self.begin_anew();
                pilot.control.forget(&self.state);
                return Ok(false);
            }
            Landing::TooLong(longest) => {
                pilot.control.step = longest;
                return Ok(false);
            }
            _ => pilot.control.reject(step, ratio),
        }
        pilot.patience.rejected += 1;
        if pilot.patience.rejected == RESTART {
            self.state.memory.fill(0.0);
        }
        Ok(false)
    }

    /// Whether so little is left (s) until the time `stop` that it is that time already.
    fn skips(&mut self, left: f64, stop: f64, pilot: &mut Pilot) -> bool {
        let skips = left < (SMALLEST_SHARE * pilot.control.span).max(16.0 * LOCATED * self.step);
        if skips {
            self.state.t = stop;
            self.pass_switch(pilot);
        }
        skips
    }

    /// Goes to just behind a time where something changes abruptly, if it is that, and begins anew there.
    fn pass_switch(&mut self, pilot: &mut Pilot) -> bool {
        let has_switch = pilot.switches.contains(&self.state.t);
        if has_switch {
            self.state.t = self.state.t.next_up().next_up();
            pilot.sight = self.sight();
            self.begin_anew();
            pilot.control.begin_anew(&self.state, &pilot.v);
        }
        has_switch
    }

    /// Goes on with the accelerations that forces have now, and without what was kept of the steps before.
    pub(super) fn begin_anew(&mut self) {
        self.state.memory.fill(0.0);
        let (system, work, t) = (&*self.system, &mut self.work, self.state.t);
        self.state.load(work);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&self.state.x, t, &work.start.at, &mut work.end.at);
        if start::accelerate(system, &self.method, t, &mut self.newton, work).is_ok() {
            self.state.a.copy_from_slice(&work.a);
            self.state.lambda.copy_from_slice(&work.lambda);
            self.audit.change_power(system, &self.state, work);
        }
    }

    /// The velocities that errors are estimated from: those shown, or where the method leaves them off the constraints
    /// their projections.
    fn smooth(&mut self, step: f64, pilot: &mut Pilot) -> Result<(), Failure> {
        pilot.v.copy_from_slice(&self.shown_v);
        let Some(projection) = &pilot.smooth else { return Ok(()) };
        // The end of the step is the start of the next already.
        let work = &mut self.work;
        work.end.at.copy_from(&work.start.at);
        projection.apply(&self.system, self.state.t, step, &mut self.newton, work)?;
        pilot.v.copy_from_slice(&work.end.v);
        Ok(())
    }
}
