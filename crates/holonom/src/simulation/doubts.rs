//! What the energy balance does not show: work of forces without a potential that steps are too long for, and positions off rows that a method does
//! not hold.

use serde::{Deserialize, Serialize};

/// What is not sure of the work of forces without a potential, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct UnsureWork {
    /// By how much it would be another by Simpson's rule, and the largest of that so far.
    sum: f64,
    largest: f64,
    /// The force that differed most in one step, by its number among the working forces, and by how much.
    most: (usize, f64),
}

impl UnsureWork {
    /// Adds by how much the work of a step would be another, and that of the force that differs most.
    pub fn add(&mut self, (by, most): (f64, (usize, f64))) {
        self.sum += by;
        self.largest = self.largest.max(self.sum.abs());
        if most.1.abs() > self.most.1.abs() {
            self.most = most;
        }
    }

    /// The largest so far, J, and the number of the force that differs most.
    pub fn largest(&self) -> (f64, usize) {
        (self.largest, self.most.0)
    }
}

/// A row and how far positions are off it, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Stray {
    pub row: usize,
    pub way: f64,
}

impl Stray {
    fn farther(self, other: Self) -> Self {
        if other.way > self.way { other } else { self }
    }
}

/// The row that positions were farthest off at the end of a nominal step, and that of the last step, which may be part of one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Strays {
    pub farthest: Stray,
    last: Stray,
}

impl Strays {
    /// Looks at the rows `phi` after a step, which are |Φ_k| over the size of their gradients off, m.
    pub fn look(&mut self, phi: &[f64], gradient: &[f64]) {
        let ways = phi.iter().zip(gradient).map(|(phi, gradient)| phi.abs() / gradient).enumerate();
        self.last = ways.map(|(row, way)| Stray { row, way }).fold(Stray::default(), Stray::farther);
    }

    /// Keeps what was seen last, at the end of a nominal step.
    pub fn keep(&mut self) {
        self.farthest = self.farthest.farther(self.last);
    }

    /// Keeps what another knows.
    pub fn follow(&mut self, other: &Self) {
        self.farthest = self.farthest.farther(other.farthest);
    }
}
