//! Which of the rows that hold velocities only, as those of wheels, follow from all others. At every place of the mechanism they agree with these; in the
//! middle of a step, where directions are means of those at its ends, they ask for motions that differ by the square of its length. Steps leave them out
//! (methods §14).

use super::independence::{Independence, independent};
use crate::system::System;

/// Most rows that hold velocities only for which that is looked for: each takes a solution of the whole system, and each pair a product.
const MOST: usize = 100;

/// What a row that is left out adds counts so much less, so that rows do not come and go with every rounding.
const STAYS: f64 = 0.25;

/// Rows that add this share of the most are alike, and the first of them is kept, whatever rounding says.
const ALIKE: f64 = 0.999;

/// Finds them at the places where steps end.
pub struct Followers {
    independence: Independence,
    /// What the other rows leave of each row's gradient (n each).
    left: Vec<f64>,
    /// Products of these with each other (rows × rows).
    products: Vec<f64>,
    /// What was found last.
    found: Vec<u32>,
}

impl Followers {
    /// Plans the matrix of a system.
    pub fn new(system: &System) -> Self {
        Self { independence: Independence::new(system), left: Vec::new(), products: Vec::new(), found: Vec::new() }
    }

    /// The rows found last, ascending.
    pub fn found(&self) -> &[u32] {
        &self.found
    }

    /// Looks at the positions `x` and the time `t`, with turns counted from `near`. Of rows that follow from each other those are kept that add most: along
    /// one of its two rows a wheel may roll, and the other holds it across. What is `left_out` already stays so unless it adds several times more.
    pub fn find(&mut self, system: &System, x: &[f64], near: &[f64], t: f64, left_out: &[u32]) -> &[u32] {
        self.found.clear();
        let (rows, n) = (system.velocity_rows.len(), system.coordinates());
        if rows > MOST {
            return &self.found;
        }
        self.independence.project_velocity_rows(system, x, near, t, &mut self.left);
        self.products.clear();
        let left = || self.left.chunks_exact(n);
        self.products.extend(left().flat_map(|a| left().map(|b| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>())));
        // Cholesky with the largest pivots first.
        let mut follow: Vec<usize> = (0..rows).collect();
        let is_left_out = |place: usize| left_out.binary_search(&system.velocity_rows[place]).is_ok();
        let weighed = |own: &Self, place| own.adds(place) * if is_left_out(place) { STAYS } else { 1.0 };
        while !follow.is_empty() {
            let most = follow.iter().map(|&place| weighed(self, place)).fold(0.0, f64::max);
            let place = follow.iter().position(|&place| weighed(self, place) >= ALIKE * most).unwrap_or(0);
            let pivot = follow[place];
            let square = self.adds(pivot);
            if square <= independent(n) {
                break;
            }
            follow.remove(place);
            for &row in &follow {
                let share = self.products[row * rows + pivot] / square;
                (0..rows).for_each(|k| self.products[row * rows + k] -= share * self.products[pivot * rows + k]);
            }
        }
        self.found.extend(follow.iter().map(|&place| system.velocity_rows[place]));
        &self.found
    }

    /// What a row adds to those that are kept so far, squared.
    fn adds(&self, place: usize) -> f64 {
        self.products[place * self.products.len().isqrt() + place]
    }
}
