//! When something changes abruptly, as far as it is known in advance.

use super::{Signal, System};

/// Times between which no more than one zero of a switch is looked for.
const LOOKS: usize = 10_000;

/// Roundings of the time for which the argument of what jumps may be at zero: `t + 0.75 - 1` is at three numbers about 0.25.
const ROUNDINGS: usize = 16;

impl System {
    /// The times before `end` (s) at which the sign of a switch changes, in order, each a rounding before.
    pub(crate) fn switch_times(&self, end: f64) -> Vec<f64> {
        let mut times: Vec<f64> = self.switches.iter().flat_map(|switch| zeros(switch.as_ref(), end)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Whether a switch is at zero at a time (s), or has another sign right behind it.
    pub(crate) fn is_at_switch(&self, t: f64) -> bool {
        self.switches.iter().any(|switch| is_zero(switch.as_ref(), t) || sign(switch.as_ref(), t) != sign(switch.as_ref(), behind(t)))
    }

    /// The first time (s) behind a switch at `t`: one that is rounded may be at zero for some roundings of the time.
    pub(crate) fn behind_switch(&self, t: f64) -> f64 {
        let is_at_zero = |t: f64| self.switches.iter().any(|switch| is_zero(switch.as_ref(), t));
        let later = std::iter::successors(Some(behind(t)), |t| Some(t.next_up()));
        later.take(ROUNDINGS).find(|t| !is_at_zero(*t)).unwrap_or(behind(t))
    }
}

fn is_zero(switch: &dyn Signal, t: f64) -> bool {
    sign(switch, t) == 0
}

/// Whether a switch is below zero, at zero or above.
fn sign(switch: &dyn Signal, t: f64) -> i8 {
    let value = switch.at(t)[0];
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

/// The time behind what happens within a rounding after `t`.
fn behind(t: f64) -> f64 {
    t.next_up().next_up()
}

/// Times of a run at which a function of time changes its sign, each a rounding before.
pub(crate) fn zeros(switch: &dyn Signal, end: f64) -> Vec<f64> {
    if let Some(only) = switch.only_zero() {
        return Some(only.next_down().next_down()).filter(|t| *t > 0.0 && only <= end).into_iter().collect();
    }
    let at = |k: usize| end * k as f64 / LOOKS as f64;
    let changes = (0..LOOKS).filter(|&k| sign(switch, at(k)) != sign(switch, at(k + 1)));
    let bisected = changes.map(|k| {
        let (mut before, mut after) = (at(k), at(k + 1));
        loop {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                // At zero itself a formula may have changed already.
                return before.next_down();
            }
            *(if sign(switch, middle) == sign(switch, before) { &mut before } else { &mut after }) = middle;
        }
    });
    let mut found: Vec<f64> = bisected.filter(|t| *t > 0.0).collect();
    // What is at zero where it is looked at comes there and leaves.
    found.dedup_by(|later, earlier| *later - *earlier <= ROUNDINGS as f64 * f64::EPSILON * *earlier);
    found
}
