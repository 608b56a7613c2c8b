//! Known functions of time.

use std::sync::Arc;

/// A known function of time with its first two derivatives.
pub trait Signal: Send + Sync {
    /// Value, rate and second derivative at `t`.
    fn at(&self, t: f64) -> [f64; 3];

    /// Whether the value never changes.
    fn is_constant(&self) -> bool {
        false
    }

    /// The only time at which the value is zero, s, where that is known; it changes its sign there.
    fn only_zero(&self) -> Option<f64> {
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
