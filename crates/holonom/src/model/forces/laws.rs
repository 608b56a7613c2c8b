//! Laws of the distance r between two points, written on the invariant π = ½ r²: r = √(2π), ṙ = π̇ / r.
//!
//! A law hands over f with force on the nodes −f ∇π, so f is the tension over r. Between two positions
//! r̄ = ½ (r₀ + r₁) and Δπ = r̄ Δr, which makes f Δπ the exact difference of the energy (methods §5).

use num_dual::{Dual2_64, Dual64};

use crate::model::expression::Program;
use crate::system::{Bend, Law, Reach, Response};

/// Relative change of length below which the quotient ΔV/Δr gives way to an average of V′, which does not cancel.
const QUOTIENT: f64 = 1e-3;

/// Work over a way, over the energy itself, below which the difference of the energy is too much of rounding.
const CANCELS: f64 = 1e-6;

/// Points and weights of the three-point Gauss rule on [0, 1].
const GAUSS: [(f64, f64); 3] = [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Names of the variables of a force law.
pub(super) const FORCE_VARIABLES: &[&str] = &["length", "rate", "t", "rest", "extension"];

/// Names of the variables of an energy.
pub(super) const ENERGY_VARIABLES: &[&str] = &["length", "rest", "extension"];

/// r and dr/dπ, where a distance counts as `shortest` at least (m): a spring of no length has no direction, and nothing must become 0/0.
pub(super) fn length(half_square: f64, shortest: f64) -> (f64, f64) {
    let r = (2.0 * half_square).sqrt();
    // Also taken when rounding has made the square negative.
    if r > shortest { (r, 1.0 / r) } else { (shortest, 0.0) }
}

/// Lengths at the ends of a step and between them.
pub(super) struct Lengths {
    start: f64,
    end: f64,
    /// r̄
    pub mean: f64,
    /// Δr
    pub rise: f64,
    /// dr₁/dπ₁
    pub slope: f64,
}

/// Lengths at the ends of a step from half their squares.
pub(super) fn lengths(from: f64, to: f64, shortest: f64) -> Lengths {
    let ((start, _), (end, slope)) = (length(from, shortest), length(to, shortest));
    let mean = 0.5 * (start + end);
    // The same as r₁ − r₀ without its cancellation.
    let rise = if start > shortest && end > shortest { (to - from) / mean } else { end - start };
    Lengths { start, end, mean, rise, slope }
}

/// V = ½ k (r − L₀)².
pub(super) struct LinearSpring {
    pub stiffness: f64,
    pub rest_length: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
}

impl Law for LinearSpring {
    fn energy(&self, value: &[f64]) -> f64 {
        // That of a spring without a length is k π, also where r has no direction.
        if self.rest_length == 0.0 {
            return self.stiffness * value[0];
        }
        0.5 * self.stiffness * (length(value[0], self.shortest).0 - self.rest_length).powi(2)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        let (r, slope) = length(value[0], self.shortest);
        out.force[0] = self.stiffness * (1.0 - self.rest_length / r);
        out.by_value[0][0] = self.stiffness * self.rest_length / (r * r) * slope;
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let Lengths { mean, slope, .. } = lengths(reach.from[0], reach.to[0], self.shortest);
        out.force[0] = self.stiffness * (1.0 - self.rest_length / mean);
        out.by_value[0][0] = self.stiffness * self.rest_length / (mean * mean) * 0.5 * slope;
    }
}

/// Tension c ṙ.
pub(super) struct Damper {
    pub damping: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
}

impl Law for Damper {
    fn conservative(&self) -> bool {
        false
    }

    fn at(&self, value: &[f64], rate: &[f64], _t: f64, out: &mut Response) {
        let (r, slope) = length(value[0], self.shortest);
        out.by_rate[0][0] = self.damping / (r * r);
        out.force[0] = out.by_rate[0][0] * rate[0];
        out.by_value[0][0] = -2.0 * out.force[0] / r * slope;
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let Lengths { mean, rise, slope, .. } = lengths(reach.from[0], reach.to[0], self.shortest);
        let c = self.damping / reach.step;
        out.force[0] = c * rise / mean;
        out.by_value[0][0] = c * slope * (1.0 / mean - 0.5 * rise / (mean * mean));
    }
}

/// V(r, L₀, r − L₀) as an expression.
pub(super) struct Energy {
    pub formula: Program,
    /// L₀, m
    pub rest: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
}

impl Energy {
    /// V
    pub fn value(&self, r: f64) -> f64 {
        self.formula.evaluate(&[r, self.rest, r - self.rest])
    }

    pub fn bends(&self, r: f64, note: &mut dyn FnMut(Bend)) {
        self.formula.bends(&[r, self.rest, r - self.rest], note);
    }

    /// V with its derivatives.
    pub fn v(&self, r: f64) -> Dual2_64 {
        let r = Dual2_64::new(r, 1.0, 0.0);
        self.formula.evaluate(&[r, self.rest.into(), r - self.rest])
    }

    /// Mean of V′ over the way from `start` to `end`, `rise` long, and its derivative by the end. Lengths are of the size `size`.
    pub fn average(&self, [start, end]: [f64; 2], rise: f64, size: f64) -> [f64; 2] {
        let (from, to) = (self.v(start), self.v(end));
        let work = rise.abs() * from.v1.abs().max(to.v1.abs());
        if rise.abs() > QUOTIENT * size && work >= CANCELS * from.re.abs().max(to.re.abs()) {
            let average = (to.re - from.re) / rise;
            return [average, (to.v1 - average) / rise];
        }
        let [mut average, mut by_end] = [0.0; 2];
        for (s, weight) in GAUSS {
            let v = self.v(start + s * rise);
            average += weight * v.v1;
            by_end += weight * s * v.v2;
        }
        [average, by_end]
    }
}

impl Law for Energy {
    fn bends(&self, value: &[f64], _rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        self.bends(length(value[0], self.shortest).0, note);
    }

    fn energy(&self, value: &[f64]) -> f64 {
        self.value(length(value[0], self.shortest).0)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        let (r, slope) = length(value[0], self.shortest);
        let v = self.v(r);
        out.force[0] = v.v1 / r;
        out.by_value[0][0] = (v.v2 / r - v.v1 / (r * r)) * slope;
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let Lengths { start, end, mean, rise, slope } = lengths(reach.from[0], reach.to[0], self.shortest);
        let [average, by_end] = self.average([start, end], rise, mean);
        out.force[0] = average / mean;
        out.by_value[0][0] = (by_end / mean - 0.5 * average / (mean * mean)) * slope;
    }
}

/// Tension F(r, ṙ, t, L₀, r − L₀) as an expression, booked as work.
pub(super) struct Force {
    pub formula: Program,
    /// L₀, m
    pub rest: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
}

impl Force {
    pub fn bends(&self, r: f64, rate: f64, t: f64, note: &mut dyn FnMut(Bend)) {
        self.formula.bends(&[r, rate, t, self.rest, r - self.rest], note);
    }

    /// F with its derivatives by r and ṙ.
    pub fn tension(&self, r: f64, rate: f64, t: f64) -> (f64, f64, f64) {
        let at = |r: Dual64, rate: Dual64| self.formula.evaluate(&[r, rate, t.into(), self.rest.into(), r - self.rest]);
        let by_length = at(Dual64::new(r, 1.0), rate.into());
        let by_rate = at(r.into(), Dual64::new(rate, 1.0));
        (by_length.re, by_length.eps, by_rate.eps)
    }
}

impl Law for Force {
    fn bends(&self, value: &[f64], rate: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        let (r, _) = length(value[0], self.shortest);
        self.bends(r, rate[0] / r, t, note);
    }

    fn conservative(&self) -> bool {
        false
    }

    fn may_supply(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], rate: &[f64], t: f64, out: &mut Response) {
        let (r, slope) = length(value[0], self.shortest);
        let speed = rate[0] / r;
        let (tension, by_length, by_speed) = self.tension(r, speed, t);
        out.force[0] = tension / r;
        out.by_value[0][0] = ((by_length - by_speed * speed / r) / r - tension / (r * r)) * slope;
        out.by_rate[0][0] = by_speed / (r * r);
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let Lengths { mean, rise, slope, .. } = lengths(reach.from[0], reach.to[0], self.shortest);
        let (tension, by_length, by_speed) = self.tension(mean, rise / reach.step, reach.middle);
        out.force[0] = tension / mean;
        out.by_value[0][0] = ((0.5 * by_length + by_speed / reach.step) / mean - 0.5 * tension / (mean * mean)) * slope;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expression::Scope;

    const SHORTEST: f64 = 1e-12;

    fn laws() -> Vec<(&'static str, Box<dyn Law>)> {
        let parse = |text, variables: &[&str]| Program::parse(text, variables, &Scope::default()).unwrap();
        let energy = |text| Energy { formula: parse(text, ENERGY_VARIABLES), rest: 0.7, shortest: SHORTEST };
        let force = |text| Force { formula: parse(text, FORCE_VARIABLES), rest: 0.7, shortest: SHORTEST };
        vec![
            ("linear spring", Box::new(LinearSpring { stiffness: 30.0, rest_length: 0.7, shortest: SHORTEST })),
            ("spring of no rest length", Box::new(LinearSpring { stiffness: 30.0, rest_length: 0.0, shortest: SHORTEST })),
            ("damper", Box::new(Damper { damping: 2.0, shortest: SHORTEST })),
            ("energy", Box::new(energy("3*(length - 0.4)^4 + 1/length"))),
            ("force", Box::new(force("4*(length - 1)^3 + rate^3*length + sin(t)"))),
            ("energy of the extension", Box::new(energy("30*extension^4/rest"))),
            ("force of the extension", Box::new(force("4*extension^3 + rate*extension*rest"))),
        ]
    }

    fn at(law: &dyn Law, value: f64, rate: f64) -> Response {
        let mut out = Response::default();
        law.at(&[value], &[rate], 0.3, &mut out);
        out
    }

    fn between(law: &dyn Law, from: f64, to: f64) -> Response {
        let mut out = Response::default();
        law.between(Reach { from: &[from], to: &[to], step: 0.1, middle: 0.3 }, &mut out);
        out
    }

    fn close(name: &str, analytic: f64, numeric: f64) {
        assert!((analytic - numeric).abs() <= 1e-6 * (1.0 + numeric.abs()), "{name}: {analytic} against {numeric}");
    }

    #[test]
    fn derivatives_at_a_state_agree_with_differences() {
        let h = 1e-6;
        for (name, law) in laws() {
            for (value, rate) in [(0.3, 0.4), (0.8, -1.3), (5.0, 0.2)] {
                let here = at(&*law, value, rate);
                close(name, here.by_value[0][0], (at(&*law, value + h, rate).force[0] - at(&*law, value - h, rate).force[0]) / (2.0 * h));
                close(name, here.by_rate[0][0], (at(&*law, value, rate + h).force[0] - at(&*law, value, rate - h).force[0]) / (2.0 * h));
                if law.conservative() {
                    close(name, here.force[0], (law.energy(&[value + h]) - law.energy(&[value - h])) / (2.0 * h));
                }
            }
        }
    }

    #[test]
    fn derivatives_between_two_positions_agree_with_differences() {
        let h = 1e-6;
        for (name, law) in laws() {
            // Far apart, near each other, and at the same place.
            for (from, to) in [(0.3, 0.9), (0.9, 0.3), (0.5, 0.5004), (0.5, 0.5)] {
                let here = between(&*law, from, to);
                close(
                    name,
                    here.by_value[0][0],
                    (between(&*law, from, to + h).force[0] - between(&*law, from, to - h).force[0]) / (2.0 * h),
                );
                if law.conservative() {
                    let (work, rise) = (here.force[0] * (to - from), law.energy(&[to]) - law.energy(&[from]));
                    assert!((work - rise).abs() < 1e-13 * (1.0 + rise.abs()), "{name}: work {work}, energy {rise}");
                }
            }
        }
    }

    #[test]
    fn the_two_ways_of_averaging_meet() {
        let law = &laws()[3].1;
        let from: f64 = 0.5;
        let to = |ratio: f64| 0.5 * ((2.0 * from).sqrt() * (1.0 + ratio)).powi(2);
        let (below, above) = (between(&**law, from, to(0.9999e-3)), between(&**law, from, to(1.0011e-3)));
        assert!((below.force[0] - above.force[0]).abs() < 1e-4);
        assert!((below.by_value[0][0] - above.by_value[0][0]).abs() < 1e-3);
    }

    /// A difference of large energies over a way as short as 1e-9 m from zero is nothing but rounding.
    #[test]
    fn a_large_constant_in_an_energy_is_no_force() {
        let parse = |text| Program::parse(text, ENERGY_VARIABLES, &Scope::default()).unwrap();
        let [plain, raised] = ["4*length^2 + 2*length", "4*length^2 + 2*length + 1e5"].map(|text| Energy {
            formula: parse(text),
            rest: 0.7,
            shortest: SHORTEST,
        });
        for way in [1e-12, 1e-9, 1e-6, 1e-3, 0.1] {
            let [plain, raised] = [&plain, &raised].map(|energy| energy.average([0.0, way], way, way));
            assert!((plain[0] - raised[0]).abs() < 1e-7 && (plain[1] - raised[1]).abs() < 1e-3, "{way} m: {plain:?}, {raised:?}");
        }
        // From slope to slope over a hill, the average is still that of the energy.
        let hill = Energy { formula: parse("exp(-length^2)"), rest: 0.7, shortest: SHORTEST };
        assert_eq!(hill.average([-0.5, 0.5], 1.0, 0.5)[0], 0.0);
    }

    #[test]
    fn a_damper_takes_out_what_it_says_and_nothing_becomes_nan() {
        let damper = Damper { damping: 2.0, shortest: SHORTEST };
        let (from, to): (f64, f64) = (0.5, 0.8);
        let rise = (2.0 * to).sqrt() - (2.0 * from).sqrt();
        assert!((between(&damper, from, to).force[0] * (to - from) - 2.0 * rise * rise / 0.1).abs() < 1e-14);
        for (name, law) in laws() {
            for response in
                [at(&*law, 0.0, 0.0), at(&*law, -1e-20, 0.0), between(&*law, 0.0, 0.0), between(&*law, 0.0, 0.5), between(&*law, 0.5, 0.0)]
            {
                assert!(
                    response.force[0].is_finite() && response.by_value[0][0].is_finite() && response.by_rate[0][0].is_finite(),
                    "{name}: {response:?}"
                );
            }
        }
    }
}
