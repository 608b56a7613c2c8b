//! What rates of quantities are rounded by.

use super::{Evaluation, Quantity, System};
use crate::linalg::largest;

/// Rounding of a number at both ends of a step, over the sizes of the terms that it is a sum of.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Sizes of the terms that a number and its rate are sums of: of those of the number that are rounded with positions, and of those of the rate that
/// are rounded with velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    value: f64,
    rate: f64,
}

impl Sizes {
    /// What the rate is rounded by in a step of length `step` (s): velocities are as sure as increments of rounded positions over half of it.
    pub fn of_rate(self, step: f64) -> f64 {
        ROUNDED * (2.0 * self.value / step.abs() + self.rate)
    }
}

impl System {
    /// The sizes of a quantity and its rate at positions and velocities of all nodes, where it is evaluated, in a mechanism of the size `length` (m).
    /// Positions near the origin are no surer than others: the fixed places that they are compared with are rounded, too.
    pub(crate) fn sizes_of(&self, quantity: Quantity, at: &Evaluation, [x, v]: [&[f64]; 2], length: f64) -> Sizes {
        let mut sizes = Sizes { value: at.value[self.value_index(quantity)].abs(), rate: 0.0 };
        for slot in self.slots_of(quantity) {
            let (g, node) = (slot * self.dim, self.slots.nodes[slot] as usize * self.dim);
            let gradient = largest(&at.gradient[g..g + self.dim]);
            sizes.value += gradient * largest(&x[node..node + self.dim]).max(length);
            sizes.rate += gradient * largest(&v[node..node + self.dim]);
        }
        sizes
    }
}
