//! Steps from an accuracy: local errors are kept so small that over the run they add up to it (methods §7).

use super::State;
use crate::formulation::Workspace;
use crate::integrator::{Estimate, Step};

/// Velocities that the third derivatives are taken from, the present ones included.
const KEPT: usize = 4;

/// A step is aimed at this share of what is allowed.
const SAFETY: f64 = 0.9;

/// Changes of the step by less than this are left out: matrices of equal steps are alike.
const WORTH: f64 = 1.2;

/// What decides on the length of steps.
pub(super) struct Control {
    accuracy: f64,
    /// Order of the method.
    order: u8,
    estimate: Estimate,
    /// Length of the run, s, over which errors may add up to the accuracy.
    pub span: f64,
    /// Step to try next, s.
    pub step: f64,
    last_ratio: f64,
    /// Largest speed so far, m/s: the unit of velocity errors.
    speed: f64,
    /// Times and velocities of the last accepted steps, the latest first.
    times: [f64; KEPT],
    velocities: [Vec<f64>; KEPT],
    count: usize,
    /// Accelerations at the start (n), m/s².
    start: Vec<f64>,
}

impl Control {
    pub(super) fn new(accuracy: f64, order: u8, estimate: Estimate, n: usize) -> Self {
        Self {
            accuracy,
            order,
            estimate,
            span: 0.0,
            step: 0.0,
            last_ratio: 1.0,
            speed: 0.0,
            times: [0.0; KEPT],
            velocities: std::array::from_fn(|_| vec![0.0; n]),
            count: 0,
            start: vec![0.0; n],
        }
    }

    /// Begins at a state, for a run of `span` seconds.
    pub(super) fn begin(&mut self, state: &State, span: f64, length: f64) {
        let n = self.start.len();
        self.span = span;
        self.start.copy_from_slice(&state.a[..n]);
        self.count = 0;
        self.remember(state);
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        self.speed = largest(&state.v).max((largest(&state.a) * length).sqrt()).max(length / span);
        if self.step == 0.0 {
            let share = 0.1 * self.accuracy.powf(1.0 / f64::from(self.order));
            self.step = (share * length / self.speed).min(0.1 * span);
        }
    }

    /// Takes note of an accepted state.
    pub(super) fn remember(&mut self, state: &State) {
        self.velocities.rotate_right(1);
        self.times.rotate_right(1);
        self.times[0] = state.t;
        let n = self.start.len();
        self.velocities[0].copy_from_slice(&state.v[..n]);
        self.count = (self.count + 1).min(KEPT);
        self.speed = state.v.iter().fold(self.speed, |m, v| m.max(v.abs()));
    }

    /// The error of a step to `state` over what is allowed.
    pub(super) fn ratio(&mut self, taken: &Step, h: f64, state: &State, work: &mut Workspace) -> f64 {
        let mut own = taken.estimate;
        if self.estimate == Estimate::History {
            self.look_back(h, state, work);
            own = 2;
        }
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) });
        let estimated = (largest(&work.error_q) / work.length).max(largest(&work.error_v) / self.speed);
        // An estimate of lower order than the method's: with errors (h/τ)^(p+1) the method's own follow.
        let error = if own > 0 && self.order > own { estimated.powf(f64::from(self.order + 1) / f64::from(own + 1)) } else { estimated };
        (error * self.span / (self.accuracy * h)).max(1e-10)
    }

    /// Local errors of a scheme of order 2 that errs by h³/12 of the third derivatives, from divided differences.
    fn look_back(&self, h: f64, state: &State, work: &mut Workspace) {
        let t = |k: usize| if k == 0 { state.t } else { self.times[k - 1] };
        for i in 0..self.start.len() {
            let v = |k: usize| if k == 0 { state.v[i] } else { self.velocities[k - 1][i] };
            let slope = |k: usize| (v(k) - v(k + 1)) / (t(k) - t(k + 1));
            let second = |k: usize| (slope(k) - slope(k + 1)) / (t(k) - t(k + 2));
            let (bend, twist) = match self.count {
                1 => ((slope(0) - self.start[i]) / h, 0.0),
                2 => (second(0), 0.0),
                _ => (second(0), (second(0) - second(1)) / (t(0) - t(3))),
            };
            work.error_q[i] = h * h * h * bend / 6.0;
            work.error_v[i] = h * h * h * twist / 2.0;
        }
    }

    /// The next step after one of length `h` that was accepted with `ratio`: a proportional and integral controller.
    pub(super) fn accept(&mut self, h: f64, ratio: f64) {
        let order = f64::from(self.order);
        let factor = SAFETY * ratio.powf(-0.7 / order) * self.last_ratio.powf(0.4 / order);
        self.last_ratio = ratio;
        if !(1.0 / WORTH..WORTH).contains(&factor) {
            self.step = h * factor.clamp(0.2, 2.0);
        }
    }

    /// The next step after one that was rejected.
    pub(super) fn reject(&mut self, h: f64, ratio: f64) {
        self.step = h * (SAFETY * ratio.powf(-1.0 / f64::from(self.order))).clamp(0.1, 0.9);
    }
}
