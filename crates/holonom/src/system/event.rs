//! Moments of a simulation at which something happens: when a condition is met, and at a fixed rate.

use std::sync::Arc;

use super::{Look, Reading, System};

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

/// When an event happens.
#[derive(Clone)]
pub enum Trigger {
    /// When an indicator goes through zero.
    When(Arc<dyn Indicator>, Crossing),
    /// At all multiples of a period, s, from t = 0 on.
    Every(f64),
}

impl Trigger {
    /// Whether it happens between two values of its indicator.
    pub(crate) fn is_between(&self, from: f64, to: f64) -> bool {
        matches!(self, Self::When(_, crossing) if crossing.is_between(from, to))
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

impl System {
    /// Values of the indicators of all events; zero of those that have none.
    pub(crate) fn indicators(&self, look: Look<'_>) -> Vec<f64> {
        let value = |event: &Event| match &event.trigger {
            Trigger::When(indicator, _) => {
                let [x, v] = self.read(&event.reading, look);
                indicator.value(&x, &v, look.t)
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
