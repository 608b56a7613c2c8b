//! Known functions of time.

/// A known function of time with its first two derivatives.
pub trait Signal: Send + Sync {
    /// Value, rate and second derivative at `t`.
    fn at(&self, t: f64) -> [f64; 3];

    /// Whether the value never changes.
    fn is_constant(&self) -> bool {
        false
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
