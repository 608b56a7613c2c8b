//! When something changes abruptly, as far as it is known in advance.

use super::{EvenZeros, Signal, System};

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
    if let Some(even) = switch.even_zeros().filter(|even| end / even.apart < LOOKS as f64) {
        return zeros_near(switch, even, end);
    }
    let at = |k: usize| end * k as f64 / LOOKS as f64;
    let changes = (0..LOOKS).filter_map(|k| bisect(switch, at(k), at(k + 1)));
    let mut found: Vec<f64> = changes.filter(|t| *t > 0.0).collect();
    // What is at zero where it is looked at comes there and leaves.
    found.dedup_by(|later, earlier| *later - *earlier <= ROUNDINGS as f64 * f64::EPSILON * *earlier);
    found
}

/// The same where zeros are known but for rounding.
fn zeros_near(switch: &dyn Signal, even: EvenZeros, end: f64) -> Vec<f64> {
    let EvenZeros { one, apart, size } = even;
    let [first, last] = if apart.is_finite() { [(-one / apart).ceil(), ((end - one) / apart).floor()] } else { [0.0; 2] };
    let times = (0..=(last - first).max(-1.0) as i64).map(|k| if k == 0 && first == 0.0 { one } else { one + (first + k as f64) * apart });
    let change = |t: f64| {
        let beside = ROUNDINGS as f64 * f64::EPSILON * t.abs().max(one.abs()).max(size);
        bisect(switch, t - beside, (t + beside).min(end))
    };
    times.filter_map(change).filter(|t| *t > 0.0).collect()
}

/// A rounding before the time at which a function of time changes its sign, if it has another one `after` than `before`.
fn bisect(switch: &dyn Signal, mut before: f64, mut after: f64) -> Option<f64> {
    if sign(switch, before) == sign(switch, after) {
        return None;
    }
    loop {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            // At zero itself a formula may have changed already.
            return Some(before.next_down());
        }
        *(if sign(switch, middle) == sign(switch, before) { &mut before } else { &mut after }) = middle;
    }
}
