//! Moments of a simulation at which something happens: when a condition is met, and at a fixed rate.

use std::cell::LazyCell;
use std::sync::Arc;

use super::rounding::{WAYS, changed};
use super::{Look, Reading, Rounding, System};

/// A number that is made of what is read.
pub trait Indicator: Send + Sync {
    /// The number, for what is [read](Reading), `x`, its rates `v`, and the time.
    fn value(&self, x: &[f64], v: &[f64], t: f64) -> f64;
}

/// Which way an indicator goes through zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either way.
    Both,
}

impl Crossing {
    /// Whether it lies between two values. One that begins at zero has been there.
    pub(crate) fn is_between(self, from: f64, to: f64) -> bool {
        let (rises, falls) = (from < 0.0 && to >= 0.0, from > 0.0 && to <= 0.0);
        match self {
            Self::Rising => rises,
            Self::Falling => falls,
            Self::Both => rises || falls,
        }
    }
}

/// The size of an indicator that has come to zero without its event, which happens the other way: it is past zero.
pub(crate) const PAST: f64 = f64::MIN_POSITIVE;

/// When an event happens.
#[derive(Clone)]
pub enum Trigger {
    /// When an indicator goes through zero.
    When(Arc<dyn Indicator>, Crossing),
    /// At all multiples of a period, s, from t = 0 on.
    Every(f64),
}

impl Trigger {
    /// Whether it happens between two values of its indicator. One that is [just past](PAST) zero and is found at it has stayed there.
    pub(crate) fn is_between(&self, from: f64, to: f64) -> bool {
        let has_stayed = to == 0.0 && from.abs() == PAST;
        matches!(self, Self::When(_, crossing) if !has_stayed && crossing.is_between(from, to))
    }
}

/// Moments whose times are found, and what happens then.
#[derive(Clone)]
pub struct Event {
    /// With its index where it is repeated.
    pub name: String,
    /// What the indicator reads, and the numbers that inputs are set to.
    pub reading: Reading,
    /// When it happens.
    pub trigger: Trigger,
    /// Whether a run ends there.
    pub stops: bool,
    /// Inputs that are set there, by their numbers, and to what.
    pub set: Vec<(usize, Arc<dyn Indicator>)>,
}

/// How many times more than rounding leaves open numbers are changed to see what that makes of an indicator: a change by rounding alone would be
/// rounded itself.
const MAGNIFIED: f64 = 1e6;

impl System {
    /// Values of the indicators of all events; zero of those that have none, and where rounding decides on which side of zero one is.
    pub(crate) fn indicators(&self, look: Look<'_>, rounding: impl FnOnce() -> Rounding) -> Vec<f64> {
        let rounding = LazyCell::new(rounding);
        let value = |event: &Event| match &event.trigger {
            Trigger::When(indicator, _) => {
                let [x, v] = self.read(&event.reading, look);
                let value = indicator.value(&x, &v, look.t);
                let is_rounded = || {
                    let roundings = self.rounding_of_reading(&event.reading, look.at, *rounding);
                    is_rounding(value, |way| {
                        let [x, v] = [(&x, &roundings[0]), (&v, &roundings[1])].map(|(of, by)| changed(of, by, way, MAGNIFIED));
                        indicator.value(&x, &v, look.t)
                    })
                };
                if value != 0.0 && is_rounded() { 0.0 } else { value }
            }
            Trigger::Every(_) => 0.0,
        };
        self.events.iter().map(value).collect()
    }

    /// The inputs that an event sets, by their numbers, and to what.
    pub(crate) fn settings(&self, event: &Event, look: Look<'_>) -> Vec<(usize, f64)> {
        if event.set.is_empty() {
            return Vec::new();
        }
        let [x, v] = self.read(&event.reading, look);
        event.set.iter().map(|(input, value)| (*input, value.value(&x, &v, look.t))).collect()
    }
}

/// Whether a number is no more than what rounding leaves open of it. `changed` is the number where all that it is made of is changed in a way.
fn is_rounding(value: f64, changed: impl Fn(usize) -> f64) -> bool {
    let change = |way: usize| (changed(way) - value).abs();
    // Mostly it is far more.
    value.abs() <= change(0) && value.abs() * MAGNIFIED <= (0..WAYS).map(change).fold(0.0, f64::max)
}
