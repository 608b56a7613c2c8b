//! Conditions whose times a simulation finds.

use std::sync::Arc;

use super::{Look, Reading, System};

/// A number whose zeros are events.
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

/// A condition whose times are found, and what happens then.
#[derive(Clone)]
pub struct Event {
    /// With its index where it is repeated.
    pub name: String,
    /// What the indicator reads.
    pub reading: Reading,
    /// Zero when it happens.
    pub indicator: Arc<dyn Indicator>,
    /// Which way.
    pub crossing: Crossing,
    /// Whether a run ends there.
    pub stops: bool,
    /// Inputs that are set there, by their numbers, and to what.
    pub set: Vec<(usize, f64)>,
}

impl System {
    /// Values of the indicators of all events.
    pub(crate) fn indicators(&self, look: Look<'_>) -> Vec<f64> {
        let value = |event: &Event| {
            let [x, v] = self.read(&event.reading, look);
            event.indicator.value(&x, &v, look.t)
        };
        self.events.iter().map(value).collect()
    }
}
