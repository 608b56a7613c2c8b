//! When something changes abruptly, as far as it is known in advance.

use super::{Signal, System};

/// Times between which no more than one zero of a switch is looked for.
const LOOKS: usize = 10_000;

impl System {
    /// The times before `end` (s) at which a switch passes zero, in order, each the last at which it has not yet.
    pub(crate) fn switch_times(&self, end: f64) -> Vec<f64> {
        let mut times: Vec<f64> = self.switches.iter().flat_map(|switch| zeros(switch.as_ref(), end)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Whether a switch is at zero at a time (s).
    pub(crate) fn is_at_switch(&self, t: f64) -> bool {
        self.switches.iter().any(|switch| switch.at(t)[0] == 0.0)
    }
}

/// Times of a run at which a function of time changes its sign, each a rounding before.
pub(crate) fn zeros(switch: &dyn Signal, end: f64) -> Vec<f64> {
    let is_over = |t: f64| switch.at(t)[0] > 0.0;
    let at = |k: usize| end * k as f64 / LOOKS as f64;
    let changes = (0..LOOKS).filter(|&k| is_over(at(k)) != is_over(at(k + 1)));
    let bisected = changes.map(|k| {
        let (mut before, mut after) = (at(k), at(k + 1));
        loop {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                // At zero itself a formula may have changed already.
                return before.next_down();
            }
            *(if is_over(middle) == is_over(before) { &mut before } else { &mut after }) = middle;
        }
    });
    bisected.filter(|t| *t > 0.0).collect()
}
