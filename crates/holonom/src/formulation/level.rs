//! The level at which a formulation puts the rows on: a weighted sum of Φ̈, Φ̇ and Φ.

/// Weights of Φ̈, Φ̇ and Φ in the condition that replaces the rows: each has a unit of 1/s more than the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Of Φ̈.
    pub acceleration: f64,
    /// Of Φ̇.
    pub velocity: f64,
    /// Of Φ.
    pub position: f64,
}

impl Level {
    /// Φ = 0, index 3.
    pub const POSITION: Self = Self { acceleration: 0.0, velocity: 0.0, position: 1.0 };
    /// Φ̇ = 0, index 2.
    pub const VELOCITY: Self = Self { acceleration: 0.0, velocity: 1.0, position: 0.0 };
    /// Φ̈ = 0, index 1.
    pub const ACCELERATION: Self = Self { acceleration: 1.0, velocity: 0.0, position: 0.0 };

    /// What the weighted sum is multiplied by to be of the size of Φ, for a stage whose velocity changes by `rate` and
    /// whose acceleration by 1/`inertia` with the position.
    pub fn scale(&self, rate: f64, inertia: f64) -> f64 {
        1.0 / (self.position + self.velocity * rate.abs() + self.acceleration / inertia)
    }
}
