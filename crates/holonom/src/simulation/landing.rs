//! Steps by accuracy end where forces bend (methods §16).

use std::cell::LazyCell;

use super::Simulation;
use super::bracket::Bracket;
use super::control::Control;
use super::events::{LOCATED, MOST_TRIES, SHORTEST};
use super::pilot::{BETWEEN, Pilot, SMALLEST_SHARE, is_rough};
use super::sight::{INSIDE, Passed, Sight};
use crate::formulation::Failure;
use crate::integrator::Step;
use crate::system::{Bends, Look, Seen, System};

/// Share of what the accuracy allows a step to err by within which what is at a kink rests there.
const REST: f64 = 0.1;

/// Where a step ends.
pub(super) enum Landing {
    /// Where no force bends.
    Between(Sight),
    /// Where one does.
    OnBend(Sight),
    /// Not at all, as a force bends where it begins; whether it had bent there already.
    AtOnce { again: bool },
    /// Not at all, as it may be so long only, s: a force that bent where it began bends again before it ends, as if it had not bent; or a peak of
    /// one is shorter than it.
    TooLong(f64),
    /// Not at all, as it failed.
    Failed,
}

impl Sight {
    /// Where a step that failed ends as far as can be told from where it began: a force that jumps at its end may allow none.
    pub fn stop_before(&mut self, step: f64, system: &System) -> Landing {
        let left = |bend: usize| self.left(bend, SHORTEST * step, system);
        let soon = (0..self.corners.len())
            .filter(|&bend| !self.reached[bend])
            .map(|bend| (bend, left(bend)))
            .filter(|(_, left)| (0.0..2.0 * step).contains(left));
        match soon.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((bend, left)) if left <= SHORTEST * step => Landing::AtOnce { again: self.pass(bend, step, system) },
            // What moves gets faster, too.
            Some((_, left)) => Landing::TooLong(if left < step { 0.99 * left } else { 0.5 * step }),
            None => Landing::Failed,
        }
    }

    /// The end of a step of length `step` (s) from what was seen `before` at a bend. A peak that ends there, too, is seen by steps that are as short,
    /// but none shorter than `least` (s): what jumps at the end of this one says nothing of it.
    fn land(mut self, bend: usize, before: &Self, step: f64, least: f64, system: &System) -> Landing {
        let share = 1.0 - 1.0 / INSIDE;
        if step > INSIDE * least && before.is_gone(&self, share, &self.peaks, system) {
            return Landing::TooLong(share * step);
        }
        self.reach(bend, before, step, system);
        Landing::OnBend(self)
    }
}

impl Simulation {
    /// Where a force bends within the step that was just taken, it is taken again and ends there: what follows is not continued from what came
    /// before.
    pub(super) fn land_on_bend(&mut self, taken: &mut Step, step: &mut f64, pilot: &mut Pilot) -> Result<Landing, Failure> {
        let system = self.system.clone();
        let mut at = self.smooth_sight(*step, pilot)?;
        let (begin, whole) = (pilot.before.state.t, *step);
        let from = &mut pilot.sight;
        let least = 2.0 * SMALLEST_SHARE * pilot.control.span;
        // Over so short a way from a bend to a time, such as that of an event there, what has bent is where it was but for rounding.
        if whole < SHORTEST * pilot.control.step && from.reached.contains(&true) {
            return Ok(Landing::Between(at));
        }
        // What begins where something changes is as long as a peak that begins there.
        let is_new = pilot.control.begins() && whole > INSIDE * least;
        if is_new && from.is_gone(&at, 1.0 / INSIDE, &from.peaks, &system) {
            return Ok(Landing::TooLong(whole / INSIDE));
        }
        // A step that ends about at a peak has an error that shows it.
        if let Some(left) = from.first_hidden(&at, &system).map(|share| share * whole).filter(|left| *left > least) {
            return Ok(Landing::TooLong(left));
        }
        let width = (LOCATED * whole).max(f64::EPSILON * self.state.t.abs());
        let open = LazyCell::new(|| self.open(whole, &pilot.control));
        let Some(first) = from.first_passed(&at, &system, &open) else {
            let bend = at.first_beyond(from, width, &system, &open);
            return Ok(match (bend, from.first_of(&self.work.estimate.stages, &system, &open)) {
                (Some(bend), _) => at.land(bend, from, whole, least, &system),
                (None, Some(t)) => Landing::TooLong((t - begin).min(0.5 * whole)),
                (None, None) => Landing::Between(at),
            });
        };
        let open = open.clone();
        let left = whole * Bracket::new(first.shares, first.values).secant();
        if left <= SHORTEST * whole {
            return Ok(Landing::AtOnce { again: from.pass(first.bend, whole, &system) });
        }
        if from.reached[first.bend] {
            return Ok(Landing::TooLong(left / BETWEEN));
        }
        let (mut bend, mut passed) = (first.bend, Some(first));
        let mut bracket: Option<Bracket> = None;
        for _ in 0..MOST_TRIES {
            let t = self.state.t;
            let next = match passed {
                // What is seen between is about so: only what is seen at the end of a step is sure.
                Some(Passed { bend: first, shares: [_, share], .. }) if share < 1.0 => {
                    (bend, bracket) = (first, None);
                    begin + share * *step
                }
                Some(Passed { bend: first, .. }) => {
                    let known = match bracket.take().filter(|_| first == bend) {
                        Some(known) => known.narrowed(t, at.corners[first], true),
                        None => Bracket::new([begin, t], [pilot.sight.corners[first], at.corners[first]]),
                    };
                    bend = first;
                    // It ends just before, where forces are those that the step has had.
                    let is_found = known.high - known.low <= width && known.low > begin;
                    let next = if is_found { known.low } else { known.next(width) };
                    bracket = Some(known);
                    next
                }
                None => {
                    let Some(known) = bracket.take() else { return Ok(Landing::Between(at)) };
                    let known = known.narrowed(t, at.corners[bend], false);
                    if known.high - known.low <= width || at.is_beyond(bend, width, &system) {
                        break;
                    }
                    let ahead = t + at.left(bend, SHORTEST * whole, &system) - 0.5 * width;
                    let next = if ahead > t && ahead < known.high { ahead } else { known.next(width) };
                    bracket = Some(known);
                    next
                }
            };
            if next <= begin {
                return Ok(Landing::AtOnce { again: pilot.sight.pass(bend, whole, &system) });
            }
            pilot.before.restore(self);
            self.audit.reject(&self.newton);
            *step = next - begin;
            *taken = self.substep(*step, next)?;
            at = self.smooth_sight(*step, pilot)?;
            passed = pilot.sight.first_passed(&at, &system, &&open);
        }
        Ok(at.land(bend, &pilot.sight, *step, least, &system))
    }

    /// Goes on to just behind the bends that a step of length `step` (s) has ended before, so that forces are those of what follows also where the
    /// next begins, with the velocities that belong there, and those that errors are estimated from. The conserving schemes, which ask for the
    /// forces between, stay where the energy is what it was.
    pub(super) fn pass_bend(&mut self, pilot: &mut Pilot, step: f64) {
        if self.method.integrator.conserves {
            return;
        }
        let sight = pilot.sight.clone();
        // A number that is clipped on the other side stays at zero there.
        let is_behind = |corners: &[f64], clipped: bool| {
            let passes = |wanted: f64, there: f64| wanted * there > 0.0 || (clipped && wanted < 0.0 && there == 0.0);
            (0..corners.len()).all(|bend| !sight.reached[bend] || passes(sight.corners[bend], corners[bend]))
        };
        let system = self.system.clone();
        let ahead = |hop: f64| system.bends(&sight.seen.ahead(hop)).corners;
        let hops = || std::iter::successors(Some(LOCATED * step), |hop| Some(2.0 * hop)).take_while(|hop| *hop <= SHORTEST * step);
        let Some(clipped) = [false, true].into_iter().find(|clipped| hops().any(|hop| is_behind(&ahead(hop), *clipped))) else { return };
        self.begin_anew();
        let (t, x, v, shown, smooth) = (self.state.t, self.state.x.clone(), self.state.v.clone(), self.shown_v.clone(), pilot.v.clone());
        for hop in hops().filter(|hop| is_behind(&ahead(*hop), clipped)) {
            let Self { state, shown_v, work, .. } = self;
            state.x.iter_mut().zip(&x).zip(&shown).for_each(|((x, from), v)| *x = from + hop * v);
            for (v, from) in [(&mut state.v, &v), (shown_v, &shown), (&mut pilot.v, &smooth)] {
                v.iter_mut().zip(from).zip(&state.a).for_each(|((v, from), a)| *v = from + hop * a);
            }
            state.t = t + hop;
            system.place_known(state.t, &mut state.x, &mut work.end.v, &mut work.a);
            system.evaluate_again(&state.x, state.t, &mut work.start.at);
            // The hop may be so short that the rounded place is still before the bend, or at it, with the forces of what came before.
            if is_behind(&self.sight().corners, clipped) {
                break;
            }
        }
        let Self { state, shown_v, work, gauges, audit, .. } = self;
        audit.move_on(&system, state, work);
        system.measure(&state.x, shown_v, gauges);
        state.measured.copy_from_slice(gauges.counted());
    }

    /// What rounding, and the accuracy for a step so long (s), leave open at the present state of what forces that bend depend on.
    fn open(&self, step: f64, control: &Control) -> Seen {
        let Self { system, state, shown_v, work, method, .. } = self;
        let rounding = system.rounding(&state.x, shown_v, is_rough(method).then_some(step));
        let sizes = [work.scales.length, system.largest_of_directions(&state.x)];
        system.open(&work.start.at, rounding.or_share(REST * control.allowed() * step, sizes, control.speed))
    }

    /// What is seen of forces that bend at the end of a step of length `step` (s), with the velocities that errors are estimated from: those that no row
    /// holds go to and fro, and so would what a rope along a rod seems to do.
    fn smooth_sight(&mut self, step: f64, pilot: &mut Pilot) -> Result<Sight, Failure> {
        self.smooth(step, pilot)?;
        Ok(self.sight_of(&pilot.v))
    }

    /// What is seen of forces that bend at the present state.
    pub(super) fn sight(&self) -> Sight {
        self.sight_of(&self.shown_v)
    }

    /// The same with these velocities.
    fn sight_of(&self, v: &[f64]) -> Sight {
        let seen = self.system.see(Look { v, ..self.look() });
        let Bends { corners, peaks } = self.system.bends(&seen);
        Sight { seen, reached: vec![false; corners.len()], corners, peaks }
    }
}
