//! Motions that are told by formulas of time and change abruptly: what could follow them has no finite speed or acceleration.

use super::bodies::short;
use super::expression::{Program, TimeProgram};
use crate::system::{Signal, zeros};

/// Change over the largest value of a run that is taken for round-off.
const ROUNDED: f64 = 1e-9;

/// Values that the largest is found of.
const LOOKS: u32 = 200;

/// Says where a motion first jumps in a run, or else where its rate does.
pub(super) fn jump(motion: Program, end: f64) -> Option<String> {
    let mut times: Vec<f64> = motion.switches(0).into_iter().flat_map(|switch| zeros(&TimeProgram(switch), end)).collect();
    times.sort_by(f64::total_cmp);
    let motion = TimeProgram(motion);
    let largest = |k: usize| (0..=LOOKS).map(|look| motion.at(end * f64::from(look) / f64::from(LOOKS))[k].abs()).fold(0.0, f64::max);
    let jump = |k: usize, what: fn(String, String) -> String| {
        let least = ROUNDED * largest(k);
        let by = |t: f64| {
            // Across the zero, which is some roundings after it.
            let after = (0..4).fold(t, |t, _| t.next_up());
            motion.at(after)[k] - motion.at(t)[k]
        };
        times.iter().map(|&t| (t, by(t))).find(|(_, by)| by.abs() > least).map(|(t, by)| what(short(by), short(t)))
    };
    jump(0, |by, t| format!("it jumps by {by} at {t} s, which nothing can follow: let it change over some steps"))
        .or_else(|| jump(1, |by, t| format!("its rate jumps by {by} per s at {t} s, which is a blow: round it off")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expression::Scope;

    #[test]
    fn jumps_of_motions_and_rates_are_found_and_smooth_switches_are_none() {
        for (text, end, words) in [
            ("0.5*step(t - 1)", 2.0, Some("it jumps by 0.5 at 1 s")),
            ("t + 2*sign(sin(3*t))", 2.0, Some("it jumps by -4 at 1.0472 s")),
            ("min(t, 0.3)", 2.0, Some("its rate jumps by -1 per s at 0.3 s")),
            ("abs(t - 0.5) + step(t - 1.5)", 2.0, Some("it jumps by 1 at 1.5 s")),
            ("0.5*step(t - 1)", 0.9, None),
            ("step(t - 1)*(t - 1)^2", 2.0, None),
            ("step(t - 1)*(1 - cos(t - 1)) + 1e9", 2.0, None),
            ("max(t, -1)", 2.0, None),
            ("sin(t)", 2.0, None),
            ("atan2(sin(5*t), cos(5*t))", 1.0, Some("it jumps by -6.28")),
            ("atan2(t - 0.5, 1)", 1.0, None),
            ("atan(tan(5*t))", 0.5, Some("it jumps by -3.14")),
        ] {
            let found = jump(Program::parse(text, &["t"], &Scope::default()).unwrap(), end);
            assert_eq!(found.is_some(), words.is_some(), "{text}: {found:?}");
            assert!(found.unwrap_or_default().contains(words.unwrap_or_default()), "{text}");
        }
    }
}
