//! Known functions of time.

use std::sync::Arc;

/// The only times at which a function of time is zero, as far as its numbers are rounded, where they are known; it changes its sign there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenZeros {
    /// One of them, s.
    pub one: f64,
    /// How far each is from the next, s; infinite where there is only one.
    pub apart: f64,
    /// The largest number that is taken from the time or added to it, s, by which these times are rounded.
    pub size: f64,
}

/// A known function of time with its first two derivatives.
pub trait Signal: Send + Sync {
    /// Value, rate and second derivative at `t`.
    fn at(&self, t: f64) -> [f64; 3];

    /// Whether the value never changes.
    fn is_constant(&self) -> bool {
        false
    }

    /// The times at which the value is zero, where they are evenly apart and known.
    fn even_zeros(&self) -> Option<EvenZeros> {
        None
    }
}

/// A value that stays.
#[derive(Clone, Copy, Debug)]
pub struct Constant(pub f64);

impl Signal for Constant {
    fn at(&self, _t: f64) -> [f64; 3] {
        [self.0, 0.0, 0.0]
    }

    fn is_constant(&self) -> bool {
        true
    }
}

/// A motion that begins elsewhere: a number is added.
pub(crate) struct Shifted(pub Arc<dyn Signal>, pub f64);

impl Signal for Shifted {
    fn at(&self, t: f64) -> [f64; 3] {
        let [value, rate, second] = self.0.at(t);
        [value + self.1, rate, second]
    }

    fn is_constant(&self) -> bool {
        self.0.is_constant()
    }
}

/// ½ L(t)² of a length L.
pub(crate) struct HalfSquare(pub Arc<dyn Signal>);

impl Signal for HalfSquare {
    fn at(&self, t: f64) -> [f64; 3] {
        let [length, rate, second] = self.0.at(t);
        [0.5 * length * length, length * rate, rate * rate + length * second]
    }

    fn is_constant(&self) -> bool {
        self.0.is_constant()
    }
}
