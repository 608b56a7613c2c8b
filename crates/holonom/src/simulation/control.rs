//! Steps from an accuracy: local errors are kept so small that over the run they add up to it (methods §16).

use serde::{Deserialize, Serialize};

use super::State;
use super::past::Past;
use crate::formulation::Workspace;
use crate::integrator::{Estimate, Step};
use crate::linalg::largest;

/// A step is aimed at this share of what is allowed.
const SAFETY: f64 = 0.9;

/// Estimated errors below this share of positions, and of velocities that are their differences over the step, are
/// round-off: shorter steps would only raise it.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

/// How many times that is rounded in differences of many states.
const TERMS: f64 = 8.0;

/// The share of it in velocities that are no differences of positions.
const OWN_ROUNDED: f64 = 0.1;

/// Where nothing is seen of errors, one step in so many asks whether longer ones do. Where velocities so many steps apart do not show it, those
/// twice as far apart may.
const ASKED: u32 = 16;

/// Ratio of error and allowance that leaves the step about as it is.
pub(super) const KEEPING: f64 = 0.5;

/// Smallest ratio of error and allowance that counts.
const LEAST: f64 = 1e-6;

/// Loads at the ends of a step may differ so many times more from what was taken of them between: they are there for those that jump.
const WORSE: f64 = 20.0;

/// Lengths of the mechanism that anything may go in a run before errors of its energy count more, as they add up along the way.
const WAYS: f64 = 3.0;

/// Changes of the step by less than this are left out: matrices of equal steps are alike.
const WORTH: f64 = 1.2;

/// What decides on the length of steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Control {
    accuracy: f64,
    /// Order of the method, and that of the last step.
    order: u8,
    in_use: u8,
    estimate: Estimate,
    /// Whether the last attempt showed nothing but round-off near a singular position.
    is_rounded: bool,
    /// Whether it did so anywhere, and how many such steps were accepted in a row.
    is_noise: bool,
    unseen: u32,
    /// Steps between the velocities of `far`.
    apart: u32,
    /// Length of the run, s, over which errors may add up to the accuracy.
    pub span: f64,
    /// Step to try next, s.
    pub step: f64,
    last_ratio: f64,
    /// Largest speed so far, m/s: the unit of velocity errors.
    pub speed: f64,
    /// The last accepted steps, and those far apart in a row that showed nothing but round-off.
    past: Past,
    far: Past,
    /// Accelerations at the start (n), m/s².
    start: Vec<f64>,
}

impl Control {
    pub(super) fn new(accuracy: f64, order: u8, estimate: Estimate, n: usize) -> Self {
        Self {
            accuracy,
            order,
            in_use: order,
            estimate,
            is_rounded: false,
            is_noise: false,
            unseen: 0,
            apart: ASKED,
            span: 0.0,
            step: 0.0,
            last_ratio: 1.0,
            speed: 0.0,
            past: Past::new(n),
            far: Past::new(n),
            start: vec![0.0; n],
        }
    }

    /// Begins at a state, for a run of `span` seconds.
    pub(super) fn begin(&mut self, state: &State, v: &[f64], span: f64, length: f64) {
        let n = self.start.len();
        self.span = span;
        self.start.copy_from_slice(&state.a[..n]);
        self.past.keep(0);
        self.remember(state.t, v);
        self.speed = largest(&state.v).max((largest(&state.a) * length).sqrt()).max(length / span);
        if self.step == 0.0 {
            let share = 0.1 * self.accuracy.powf(1.0 / f64::from(self.order));
            self.step = (share * length / self.speed).min(0.1 * span);
        }
    }

    /// Begins anew at a state with velocities `v`, where something changes abruptly: of what came before nothing tells what comes,
    /// and a step of a tenth asks.
    pub(super) fn begin_anew(&mut self, state: &State, v: &[f64]) {
        let count = self.past.count();
        self.remember(state.t, v);
        self.past.keep(count);
        self.forget(state);
    }

    /// The same at the state whose velocities were remembered last.
    pub(super) fn forget(&mut self, state: &State) {
        let n = self.start.len();
        self.start.copy_from_slice(&state.a[..n]);
        // Where no step was taken since the last time the next is one that asks already.
        if self.past.count() > 1 {
            self.step *= 0.1;
        }
        self.past.keep(1);
        self.last_ratio = 1.0;
        self.look_near();
    }

    /// The accuracy that errors are held to.
    pub(super) fn accuracy(&self) -> f64 {
        self.accuracy
    }

    /// Local errors that are allowed, over the size of the mechanism and the step, 1/s.
    pub(super) fn allowed(&self) -> f64 {
        self.accuracy / self.span
    }

    /// Whether the last attempt showed nothing but round-off near a singular position.
    pub(super) fn is_rounded(&self) -> bool {
        self.is_rounded
    }

    /// Whether the last attempt showed nothing but round-off anywhere.
    pub(super) fn is_noise(&self) -> bool {
        self.is_noise
    }

    /// Whether nothing has been remembered since the start or since something changed abruptly.
    pub(super) fn begins(&self) -> bool {
        self.past.count() == 1
    }

    /// A few lengths of the mechanism over the longest way that anything may go in the run, or 1 where that is shorter.
    pub(super) fn share_of_way(&self, length: f64) -> f64 {
        (WAYS * length / (self.speed * self.span)).min(1.0)
    }

    /// Takes note of an accepted state's time and velocities.
    pub(super) fn remember(&mut self, t: f64, v: &[f64]) {
        self.past.remember(t, v);
        self.speed = largest(v).max(self.speed);
    }

    /// The error of a step of length `h` to the time `t` and velocities `v` over what is allowed. `amplified` says how many times
    /// larger round-off is than that of a number: near a singular position.
    pub(super) fn ratio(&mut self, taken: &Step, h: f64, t: f64, v: &[f64], amplified: f64, work: &mut Workspace) -> f64 {
        let [order, estimated] = taken.estimate.unwrap_or([2; 2]);
        if self.estimate == Estimate::History {
            self.look_back(h, t, v, work);
        }
        let of_loads = work.estimate.loads / (WORSE * self.speed);
        let error = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) });
        // Of places far away, as on a long way, more is rounded.
        let terms = if self.estimate == Estimate::OwnOfStates { TERMS } else { 1.0 };
        let noise = ROUND_OFF * terms * amplified * (largest(&work.end.x) / work.scales.length).max(1.0);
        let above = |error: f64, noise: f64| if error > noise { error } else { 0.0 };
        let mut position = error(&work.estimate.q) / work.scales.length;
        let mut velocity = (error(&work.estimate.v) / self.speed).max(of_loads);
        let differs = self.estimate == Estimate::History;
        let rounded = if differs { 1.0 } else { OWN_ROUNDED };
        let of_velocity = noise * (rounded * work.scales.length / (h * self.speed)).max(1.0);
        self.is_noise = position <= noise && velocity.max(WORSE * of_loads) <= of_velocity;
        if amplified > 1.0 {
            (position, velocity) = (above(position, noise), above(velocity, of_velocity));
        }
        // The estimate of a lower order shows how many times shorter than the motion's own time the step is; the error is
        // that to a higher power.
        let order = order.min(self.order);
        let size = position.max(velocity);
        let error = if order > estimated { size.powf(f64::from(order + 1) / f64::from(estimated + 1)) } else { size };
        self.in_use = order;
        let ratio = (error / (self.allowed() * h)).max(LEAST);
        // Schemes that go on from the step before err where its length changes to and fro.
        self.is_rounded = amplified > 1.0 && size == 0.0 && differs;
        if self.is_rounded {
            return KEEPING;
        }
        if self.is_noise { ratio.min(KEEPING) } else { ratio }
    }

    /// Local errors of a scheme of order 2 that errs by h³/12 of the third derivatives, from divided differences. Where the step is much shorter
    /// than those before, what jumped within it is little of a third derivative over all of them: it counts as within equal steps, too.
    fn look_back(&self, h: f64, now: f64, latest: &[f64], work: &mut Workspace) {
        let equal = if self.past.tells_thirds() { self.past.back(now, 2) * self.past.back(now, 3) / (6.0 * WORSE) } else { 0.0 };
        for i in 0..self.start.len() {
            let [slope, second, third] = self.past.differences(i, now, latest[i]);
            let bend = if self.begins() { (slope - self.start[i]) / h } else { second };
            work.estimate.q[i] = h * h * h * bend / 6.0;
            work.estimate.v[i] = h * third / 2.0 * equal.max(h * h);
        }
    }

    /// The next step after one of length `h` that was accepted with `ratio`: a proportional and integral controller. `length` is that of the mechanism.
    pub(super) fn accept(&mut self, h: f64, ratio: f64, length: f64) {
        let order = f64::from(self.in_use);
        let trend = (self.last_ratio / ratio).clamp(0.1, 10.0);
        let factor = SAFETY * ratio.powf(-0.3 / order) * trend.powf(0.4 / order);
        self.last_ratio = ratio;
        if !(1.0 / WORTH..WORTH).contains(&factor) {
            self.step = h * factor.clamp(0.2, 2.0);
        }
        if !self.is_noise {
            return self.look_near();
        }
        self.unseen += 1;
        let may_double = if self.is_rounded { self.unseen.is_multiple_of(ASKED) } else { self.shows_afar(2.0 * h, length) };
        if may_double {
            self.step = 2.0 * h;
        }
    }

    /// Goes by the last steps again.
    fn look_near(&mut self) {
        (self.unseen, self.apart) = (0, ASKED);
        self.far.keep(0);
    }

    /// Whether velocities far apart, of whose third derivatives round-off hides less, show that a step of length `h` errs by little.
    fn shows_afar(&mut self, h: f64, length: f64) -> bool {
        if self.estimate != Estimate::History || !self.unseen.is_multiple_of(self.apart) {
            return false;
        }
        let (now, latest) = self.past.latest();
        let errs = |i: usize| {
            let [_, second, third] = self.far.differences(i, now, latest[i]);
            (h * h * h * second / 6.0 / length).abs().max((h * h * h * third / 2.0 / self.speed).abs())
        };
        let largest = (0..latest.len()).map(errs).fold(0.0, f64::max);
        let shows = self.far.tells_thirds() && largest <= KEEPING * self.allowed() * h;
        self.far.remember(now, latest);
        if self.far.is_full() && !shows {
            self.far.thin();
            self.apart *= 2;
        }
        shows
    }

    /// The next step after one that was rejected.
    pub(super) fn reject(&mut self, h: f64, ratio: f64) {
        self.step = h * (SAFETY * ratio.powf(-1.0 / f64::from(self.in_use))).clamp(0.1, 0.9);
    }
}
