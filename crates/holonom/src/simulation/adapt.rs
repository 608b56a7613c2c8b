//! Steps by accuracy at work: attempts, rejected ones taken back, and results between the steps of integrators with dense
//! output.

use super::advance::{Inside, SHORT};
use super::control::KEEPING;
use super::events::{LOCATED, SHORTEST};
use super::landing::Landing;
use super::pilot::{OFTEN, Pilot, SMALLEST_SHARE, TO_ROWS, is_rough};
use super::sight::INSIDE;
use super::{Audit, Simulation, start};
use crate::energy;
use crate::formulation::{Failure, Multipliers};
use crate::integrator::{Step, Work};

/// So many steps rejected one after the other are no matter of length: the motion is another one, and what was kept of the steps
/// before says nothing.
const RESTART: u32 = 3;

/// Times are the same when they are closer than so many times what bends of forces are found to.
const SAME: f64 = 16.0;

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
        if self.system.is_at_switch(self.state.t) {
            // At the switch itself forces may be others than behind it, as those by `sign` are.
            self.go_behind();
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
        let (Some((taken, length)), Some(everywhere)) = (pilot.last, look.as_ref().map(|inside| inside.everywhere)) else {
            return Ok(false);
        };
        let begin = pilot.before.state.t;
        let (low, high) = (from.max(begin), target.min(begin + length));
        if low >= high {
            return Ok(false);
        }
        pilot.front.keep(self);
        let front = self.state.t;
        let parts = if everywhere { (INSIDE * (high - low) / length - 1e-9).ceil() } else { 1.0 };
        let inside = (1..parts as u32).map(|k| low + f64::from(k) * (high - low) / parts);
        let has_switch = pilot.is_behind_switch(&self.system, front);
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
    pub(super) fn interpolate(&mut self, target: f64, taken: Step, length: f64) -> Result<(), Failure> {
        let (system, start) = (&*self.system, self.state.t);
        let share = (target - start) / length;
        self.state.load(&mut self.work);
        let done = self.integrator.interpolate(system, start, length, share, &mut self.newton, &mut self.work)?;
        self.finish(Step { work: Work::Sum(done), ..taken }, share * length, target).map(|_| ())
    }

    /// One attempt at a step, and whether it is taken; a step whose error is too large, or that fails, is taken back and the next one shorter.
    fn attempt(&mut self, step: f64, target: f64, pilot: &mut Pilot) -> Result<bool, Failure> {
        pilot.require_progress(step, self.state.t)?;
        pilot.require_visible(self)?;
        pilot.before.keep(self);
        self.work.estimate.speed = pilot.control.speed;
        let (mut step, mut landing) = (step, Landing::Failed);
        let outcome = self.substep(step, target).and_then(|mut taken| {
            landing = self.land_on_bend(&mut taken, &mut step, pilot)?;
            if matches!(landing, Landing::Between(_)) && self.lands_before_singular(&mut taken, &mut step, pilot)? {
                landing = self.land_on_bend(&mut taken, &mut step, pilot)?;
            }
            Ok(taken)
        });
        if outcome.is_err() {
            landing = pilot.sight.stop_before(step, &self.system);
        }
        let has_bend = matches!(landing, Landing::OnBend(_));
        if has_bend || pilot.sight.reached.contains(&true) {
            // What jumps where the step ends, or where it begins, is known.
            self.work.estimate.loads = 0.0;
        }
        let mut ratio = outcome.as_ref().map_or(f64::INFINITY, |taken| pilot.ratio(self, taken, step));
        if step < SHORTEST * pilot.control.step && ratio.is_finite() {
            // What is left to a bend or to a time may be so short that only rounding errs.
            ratio = ratio.min(KEEPING);
        }
        if let (Ok(taken), Landing::Between(sight) | Landing::OnBend(sight), true) = (outcome, &mut landing, ratio <= 1.0) {
            if pilot.redundant > 0 && pilot.patience.attempts.is_multiple_of(OFTEN) {
                pilot.count_redundant(&self.system, &self.state);
            }
            pilot.control.remember(self.state.t, &pilot.v);
            let planned = pilot.control.step;
            pilot.control.accept(step, ratio, self.work.scales.length);
            pilot.book_hidden(self);
            pilot.last = Some((taken, step));
            pilot.patience.rejected = 0;
            pilot.sight = std::mem::take(sight);
            if has_bend || step < 0.5 * planned {
                // How long the step to a bend was, or what was left to a time, says nothing of the next one.
                pilot.control.step = planned;
            }
            if has_bend {
                pilot.bend();
            }
            if self.pass_switch(pilot) {
                return Ok(true);
            }
            if has_bend {
                self.pass_bend(pilot, step);
                self.turn(pilot);
            } else if step < SHORT * planned && self.carries_accelerations() {
                // Longer steps would make more of their rounding.
                self.begin_anew();
            }
            return Ok(true);
        }
        pilot.before.restore(self);
        self.audit.reject(&self.newton);
        match landing {
            Landing::AtOnce { again } => {
                pilot.bend();
                self.pass_bend(pilot, step);
                self.begin_anew();
                // Several bends at one place ask once.
                if again || !pilot.control.begins() {
                    pilot.control.forget(&self.state);
                }
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
        let skips = left < (SMALLEST_SHARE * pilot.control.span).max(SAME * LOCATED * self.step);
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
            self.go_behind();
            pilot.sight = self.sight();
            pilot.control.begin_anew(&self.state, &pilot.v);
        }
        has_switch
    }

    /// Goes to just behind the present time, and begins anew there.
    fn go_behind(&mut self) {
        self.state.t = self.system.behind_switch(self.state.t);
        self.begin_anew();
    }

    /// Goes on from here as at a start.
    fn turn(&mut self, pilot: &mut Pilot) {
        self.begin_anew();
        pilot.control.begin_anew(&self.state, &pilot.v);
    }

    /// Goes on with the accelerations that forces have now, and without what was kept of the steps before. As at a start velocities are on the rows:
    /// what they are off would be a multiple of it after the first steps, and of that behind the next place like this.
    pub(super) fn begin_anew(&mut self) {
        self.state.memory.fill(0.0);
        let is_soft = matches!(self.method.settings.multipliers, Multipliers::Penalty(_));
        self.stand_at_state();
        if is_rough(&self.method) && !self.method.integrator.conserves && !is_soft {
            self.put_velocities_on_rows();
            self.stand_at_state();
        }
        let (system, work, t) = (&*self.system, &mut self.work, self.state.t);
        if start::accelerate(system, &self.method, t, &mut self.newton, work).is_ok() {
            self.state.a.copy_from_slice(&work.a);
            self.state.lambda.copy_from_slice(&work.lambda);
            self.audit.change_power(system, &self.state, work);
            self.shares.powers.copy_from_slice(&work.powers);
        }
    }

    /// Puts the workspace at the present state, as the end of a step.
    fn stand_at_state(&mut self) {
        let (system, work, t) = (&*self.system, &mut self.work, self.state.t);
        self.state.load(work);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&self.state.x, t, &work.start.at, &mut work.end.at);
    }

    /// Puts the velocities of the present state, at which the workspace is, on the rows, where that can be.
    fn put_velocities_on_rows(&mut self) {
        let Self { system, state, shown_v, gauges, audit, shares, newton, work, .. } = self;
        if TO_ROWS.apply(system, state.t, self.step, newton, work).is_ok() {
            work.shares.fill(0.0);
            audit.put_on_rows(system, &state.v, true, work);
            if system.is_driven() {
                energy::add_of_projections(system, work);
            }
            shares.add(work);
            state.v.copy_from_slice(&work.end.v);
            shown_v.copy_from_slice(&work.end.v);
            system.measure(&state.x, shown_v, gauges);
        }
    }

    /// The velocities that errors are estimated from: those shown, or where the method leaves them off the constraints
    /// their projections.
    pub(super) fn smooth(&mut self, step: f64, pilot: &mut Pilot) -> Result<(), Failure> {
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
