//! Laws of a joint coordinate q: springs, dampers, friction, stops and formulas.
//!
//! A law hands over f with effort −f along q. Between two positions the coordinate is taken half way and its rate is
//! Δq/h, so that f Δq is exactly the change of energy, or the energy that is taken out (methods §5, §8).

use num_dual::Dual64;

use crate::model::expression::Program;
use crate::system::{Bend, Law, MAX_ARGUMENTS, Reach, Response};

/// V = ½ k (q − q₀)².
pub struct Spring {
    pub stiffness: f64,
    pub rest: f64,
}

impl Law for Spring {
    fn energy(&self, value: &[f64]) -> f64 {
        0.5 * self.stiffness * (value[0] - self.rest).powi(2)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        out.force[0] = self.stiffness * (value[0] - self.rest);
        out.by_value[0][0] = self.stiffness;
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        out.force[0] = self.stiffness * (0.5 * (reach.from[0] + reach.to[0]) - self.rest);
        out.by_value[0][0] = 0.5 * self.stiffness;
    }
}

/// f(q̇), against the motion: the force and its derivative.
pub trait Resistance: Send + Sync {
    fn at(&self, rate: f64) -> [f64; 2];

    /// Hands over where it bends, as [`Law::bends`] does.
    fn bends(&self, _rate: f64, _note: &mut dyn FnMut(Bend)) {}
}

/// f = c q̇.
pub struct Viscous(pub f64);

impl Resistance for Viscous {
    fn at(&self, rate: f64) -> [f64; 2] {
        [self.0 * rate, self.0]
    }
}

/// f = F tanh(q̇/v): dry friction, smooth at rest.
pub struct Dry {
    pub effort: f64,
    pub speed: f64,
}

/// Rate over that of dry friction from which on the friction is as good as full, and steps do not see from there how it falls.
const FULL: f64 = 6.0;

impl Resistance for Dry {
    fn bends(&self, rate: f64, note: &mut dyn FnMut(Bend)) {
        [-FULL, FULL].into_iter().for_each(|full| note(Bend::Corner(rate - full * self.speed)));
    }

    fn at(&self, rate: f64) -> [f64; 2] {
        let tanh = (rate / self.speed).tanh();
        [self.effort * tanh, self.effort / self.speed * (1.0 - tanh * tanh)]
    }
}

/// A resistance as a law.
pub struct Resisting<R>(pub R);

impl<R: Resistance> Law for Resisting<R> {
    fn bends(&self, _value: &[f64], rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        self.0.bends(rate[0], note);
    }

    fn conservative(&self) -> bool {
        false
    }

    fn at(&self, _value: &[f64], rate: &[f64], _t: f64, out: &mut Response) {
        [out.force[0], out.by_rate[0][0]] = self.0.at(rate[0]);
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let [force, slope] = self.0.at((reach.to[0] - reach.from[0]) / reach.step);
        out.force[0] = force;
        out.by_value[0][0] = slope / reach.step;
    }
}

/// A stop: V = ½ k p² with p how far q is beyond a limit, above it for `sign` 1 and below it for −1.
pub struct Buffer {
    pub stiffness: f64,
    pub limit: f64,
    pub sign: f64,
}

impl Buffer {
    fn beyond(&self, q: f64) -> f64 {
        (self.sign * (q - self.limit)).max(0.0)
    }
}

impl Law for Buffer {
    fn energy(&self, value: &[f64]) -> f64 {
        0.5 * self.stiffness * self.beyond(value[0]).powi(2)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn bends(&self, value: &[f64], _rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        note(Bend::Corner(self.sign * (value[0] - self.limit)));
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        let p = self.beyond(value[0]);
        out.force[0] = self.sign * self.stiffness * p;
        out.by_value[0][0] = if p > 0.0 { self.stiffness } else { 0.0 };
    }

    /// f = k p̄ Δp/Δq.
    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let (q0, q1) = (reach.from[0], reach.to[0]);
        let (p0, p1) = (self.beyond(q0), self.beyond(q1));
        let (mean, change) = (0.5 * (p0 + p1), q1 - q0);
        let in_contact = |p: f64| if p > 0.0 { self.sign } else { 0.0 };
        if (p0 > 0.0) == (p1 > 0.0) {
            out.force[0] = self.stiffness * mean * in_contact(p1);
            out.by_value[0][0] = 0.5 * self.stiffness * in_contact(p1).powi(2);
            return;
        }
        let slope = (p1 - p0) / change;
        out.force[0] = self.stiffness * mean * slope;
        out.by_value[0][0] = self.stiffness * (0.5 * in_contact(p1) * slope + mean * (in_contact(p1) - slope) / change);
    }
}

/// What a stop takes out: f = k d p q̇, as in Hunt and Crossley's impact.
pub struct Impact {
    pub buffer: Buffer,
    /// d, s/m or s/rad.
    pub dissipation: f64,
}

impl Impact {
    /// The rate that counts, and by how much it changes with the rate: what goes out faster than at 1/d takes all of the spring's force, and is
    /// not pulled back.
    fn counted(&self, rate: f64) -> (f64, f64) {
        let fastest = -self.buffer.sign / self.dissipation;
        if self.buffer.sign * rate < -1.0 / self.dissipation { (fastest, 0.0) } else { (rate, 1.0) }
    }
}

impl Law for Impact {
    /// Where what goes out in contact gets as fast as 1/d.
    fn bends(&self, value: &[f64], rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        let is_in_contact = self.buffer.beyond(value[0]) > 0.0;
        note(Bend::Corner(if is_in_contact { self.buffer.sign * rate[0] + 1.0 / self.dissipation } else { 0.0 }));
    }

    fn conservative(&self) -> bool {
        false
    }

    fn at(&self, value: &[f64], rate: &[f64], _t: f64, out: &mut Response) {
        let factor = self.buffer.stiffness * self.dissipation;
        let p = self.buffer.beyond(value[0]);
        let (rate, counts) = self.counted(rate[0]);
        out.force[0] = factor * p * rate;
        out.by_value[0][0] = if p > 0.0 { factor * self.buffer.sign * rate } else { 0.0 };
        out.by_rate[0][0] = factor * p * counts;
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let factor = self.buffer.stiffness * self.dissipation;
        let (p0, p1) = (self.buffer.beyond(reach.from[0]), self.buffer.beyond(reach.to[0]));
        let (rate, counts) = self.counted((reach.to[0] - reach.from[0]) / reach.step);
        let mean = 0.5 * (p0 + p1);
        out.force[0] = factor * mean * rate;
        out.by_value[0][0] = factor * (counts * mean / reach.step + if p1 > 0.0 { 0.5 * self.buffer.sign * rate } else { 0.0 });
    }
}

/// An effort E(t, q, q̇, …) along the first coordinate as a formula of time and of all coordinates and rates: variables
/// t, then each coordinate followed by its rate.
pub struct Effort(pub Program);

impl Effort {
    fn variables(value: &[f64], rate: &[f64], t: f64) -> [f64; 1 + 2 * MAX_ARGUMENTS] {
        let mut variables = [t; 1 + 2 * MAX_ARGUMENTS];
        for (k, (value, rate)) in value.iter().zip(rate).enumerate() {
            (variables[1 + 2 * k], variables[2 + 2 * k]) = (*value, *rate);
        }
        variables
    }

    /// E, and its derivatives by coordinates and by rates.
    fn evaluate(&self, value: &[f64], rate: &[f64], t: f64) -> (f64, [f64; MAX_ARGUMENTS], [f64; MAX_ARGUMENTS]) {
        let m = value.len();
        let mut variables = Self::variables(value, rate, t).map(Dual64::from);
        let (mut effort, mut by) = (0.0, [[0.0; MAX_ARGUMENTS]; 2]);
        for k in 0..2 * m {
            variables[1 + k].eps = 1.0;
            let result: Dual64 = self.0.evaluate(&variables[..1 + 2 * m]);
            variables[1 + k].eps = 0.0;
            effort = result.re;
            by[k % 2][k / 2] = result.eps;
        }
        (effort, by[0], by[1])
    }
}

impl Law for Effort {
    fn bends(&self, value: &[f64], rate: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        self.0.bends(&Self::variables(value, rate, t), note);
    }

    fn conservative(&self) -> bool {
        false
    }

    fn may_supply(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], rate: &[f64], t: f64, out: &mut Response) {
        let (effort, by_value, by_rate) = self.evaluate(value, rate, t);
        out.force[0] = -effort;
        (out.by_value[0], out.by_rate[0]) = (by_value.map(|d| -d), by_rate.map(|d| -d));
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let m = reach.from.len();
        let (mut middle, mut rate) = ([0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS]);
        for k in 0..m {
            middle[k] = 0.5 * (reach.from[k] + reach.to[k]);
            rate[k] = (reach.to[k] - reach.from[k]) / reach.step;
        }
        let (effort, by_value, by_rate) = self.evaluate(&middle[..m], &rate[..m], reach.middle);
        out.force[0] = -effort;
        (0..m).for_each(|k| out.by_value[0][k] = -(0.5 * by_value[k] + by_rate[k] / reach.step));
    }
}
