//! Motions that are told by formulas and change abruptly: what could follow them has no finite speed or acceleration.

use num_dual::Dual2_64;

use super::bodies::short;
use super::expression::Program;
use crate::system::{EvenZeros, Signal, zeros};

/// Change over the largest value of a run that is taken for round-off.
const ROUNDED: f64 = 1e-9;

/// Share of the way that is looked at for what rises steeply behind a place, and of its rise there that a jump has at once.
const STEEP: f64 = 1e-10;
const JUMPED: f64 = 0.5;

/// Share of the way by which the place of a jump may be off, as the numbers that it comes of are rounded.
const BESIDE: f64 = 16.0 * f64::EPSILON;

/// Values that the largest is found of.
const LOOKS: u32 = 200;

/// Says where a motion first jumps in a run, or else where its rate does.
pub(super) fn jump(motion: Program, end: f64) -> Option<String> {
    let motion = Way { program: motion, sense: 1.0 };
    let times = motion.switches(end);
    let found = |k: usize| motion.first_jump(&times, k, end).map(|(t, by)| (short(t), short(by)));
    let jumps = |(t, by)| format!("it jumps by {by} at {t} s, which nothing can follow: let it change over some steps");
    let turns = |(t, by)| format!("its rate jumps by {by} per s at {t} s, which is a blow: round it off");
    found(0).map(jumps).or_else(|| found(1).map(turns))
}

/// Where, up to `reach` on both sides of zero, a function of one number or its slope jumps.
pub(super) fn corner(function: &Program, reach: f64) -> Option<f64> {
    [1.0, -1.0].into_iter().find_map(|sense| {
        let way = Way { program: function.clone(), sense };
        let places = way.switches(reach);
        (0..2).find_map(|k| way.first_jump(&places, k, reach)).map(|(at, _)| sense * at)
    })
}

/// A function of one number along its positive or its negative side.
struct Way {
    program: Program,
    sense: f64,
}

impl Way {
    /// Where it may jump or have a corner, in order.
    fn switches(&self, end: f64) -> Vec<f64> {
        let ways = self.program.corners(0).into_iter().map(|program| Self { program, ..*self });
        let mut found: Vec<f64> = ways.flat_map(|switch| zeros(&switch, end)).collect();
        found.sort_by(f64::total_cmp);
        found
    }

    /// Where its k-th derivative first jumps, and by how much.
    fn first_jump(&self, places: &[f64], k: usize, end: f64) -> Option<(f64, f64)> {
        // Also between two places: a motion may be shorter than what is looked at evenly, and is round-off where it comes to rest.
        let between = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let looks = (0..=LOOKS).map(|look| end * f64::from(look) / f64::from(LOOKS)).chain(between);
        let largest = looks.map(|t| self.at(t)[k].abs()).fold(0.0, f64::max);
        let across = |t: f64, after: f64| self.at(after)[k] - self.at(t)[k];
        let jump = |&t: &f64| {
            // Across the zero, which is some roundings beside the place. What rises steeply there, as a root does, has risen by more a little farther on.
            let beside = BESIDE * t.abs().max(end);
            let before = (t - beside).max(0.0);
            // What comes behind the end the run does not see.
            let by = across(before, (t + beside).min(end));
            let is_jump = by.abs() > ROUNDED * largest && by.abs() > JUMPED * across(before, t + STEEP * t.abs().max(end)).abs();
            is_jump.then_some((t, by))
        };
        places.iter().find_map(jump)
    }
}

impl Signal for Way {
    fn at(&self, t: f64) -> [f64; 3] {
        let value = self.program.evaluate(&[Dual2_64::new(self.sense * t, 1.0, 0.0)]);
        [value.re, self.sense * value.v1, value.v2]
    }

    fn even_zeros(&self) -> Option<EvenZeros> {
        self.program.even_zeros().map(|zeros| EvenZeros { one: self.sense * zeros.one, ..zeros })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expression::Scope;

    /// A smooth motion that is over between two of the times that are looked at evenly.
    const SHORT_RAMP: &str =
        "0.01*max(0, min(1, (t-0.1)/0.004))^3*(10 - 15*max(0, min(1, (t-0.1)/0.004)) + 6*max(0, min(1, (t-0.1)/0.004))^2)";

    #[test]
    fn jumps_of_motions_and_rates_are_found_and_smooth_switches_are_none() {
        for (text, end, words) in [
            ("0.5*step(t - 1)", 2.0, Some("it jumps by 0.5 at 1 s")),
            ("t + 2*sign(sin(3*t))", 2.0, Some("it jumps by -4 at 1.0472 s")),
            ("min(t, 0.3)", 2.0, Some("its rate jumps by -1 per s at 0.3 s")),
            ("abs(t - 0.5) + step(t - 1.5)", 2.0, Some("it jumps by 1 at 1.5 s")),
            ("0.5*step(t - 1)", 0.9, None),
            ("0.5*step(t - 1)", 1.0, Some("it jumps by 0.5 at 1 s")),
            ("step(t + 0.75 - 1)", 0.5, Some("it jumps by 1 at 0.25 s")),
            ("floor(2*t + 0.5)", 0.5, Some("it jumps by 1 at 0.25 s")),
            ("max(0, t + 0.75 - 1)", 0.5, Some("its rate jumps by 1 per s at 0.25 s")),
            ("step(t)", 1.0, None),
            ("step(t - 1)*(t - 1)^2", 2.0, None),
            ("step(t - 1)*(1 - cos(t - 1)) + 1e9", 2.0, None),
            ("max(t, -1)", 2.0, None),
            ("0.1*max(0, t - 1)^1.5", 2.0, None),
            ("0.1*max(0, t - 1)^1.01 + 1e-3*max(0, t - 0.5)", 2.0, Some("its rate jumps by 0.001 per s at 0.5 s")),
            ("sin(t)", 2.0, None),
            (SHORT_RAMP, 1.0, None),
            ("atan2(sin(5*t), cos(5*t))", 1.0, Some("it jumps by -6.28")),
            ("atan2(t - 0.5, 1)", 1.0, None),
            ("atan(tan(5*t))", 0.5, Some("it jumps by -3.14")),
        ] {
            let found = jump(Program::parse(text, &["t"], &Scope::default()).unwrap(), end);
            assert_eq!(found.is_some(), words.is_some(), "{text}: {found:?}");
            assert!(found.unwrap_or_default().contains(words.unwrap_or_default()), "{text}");
        }
    }

    #[test]
    fn corners_are_found_on_both_sides_of_the_start() {
        for (text, at) in
            [("abs(q - 0.3)", Some(0.3)), ("max(q, -0.7)", Some(-0.7)), ("step(q + 2)", Some(-2.0)), ("min(q, 9)", None), ("q^2", None)]
        {
            let found = corner(&Program::parse(text, &["q"], &Scope::default()).unwrap(), 5.0);
            assert_eq!(found.map(|q| (q * 1e9).round() / 1e9), at, "{text}");
        }
    }
}
