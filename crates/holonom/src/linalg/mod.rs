//! Linear systems with a fixed pattern, factored by dense fronts in a static order.
//!
//! The only folder that names the linear algebra library.

mod eigen;
mod factor;
mod fronts;
mod groups;
mod multifrontal;
mod ordering;
mod plans;
mod solve;
mod tile;

pub use eigen::{Eigenpair, eigenpairs, inverse, null_space, relative_eigenvalues};
pub use ordering::fill_reducing_order;
pub use plans::Plans;

use std::sync::Arc;

use fronts::Fronts;
use multifrontal::Multifrontal;

/// Where everything goes in the elimination of a matrix of fixed pattern.
#[derive(Clone)]
pub struct Plan(Arc<Fronts>);

impl Plan {
    /// Plans a matrix of `size` rows with the structurally symmetric pattern `entries` (row, column), eliminated in
    /// the order `order`, but for unknowns that do not know of each other. What is among the `plans` is not planned again.
    pub fn new(plans: &Plans, size: usize, entries: &[(u32, u32)], order: &[u32]) -> Self {
        Self(plans.fronts(size, entries, order))
    }

    /// To look many entries up.
    pub fn places(&self) -> Places<'_> {
        Places { fronts: &self.0, positions: self.0.positions() }
    }
}

/// Where the entries of a planned matrix are.
pub struct Places<'a> {
    fronts: &'a Fronts,
    positions: Vec<u32>,
}

impl Places<'_> {
    /// Where the entry (row, column) of the pattern is among the values.
    pub fn position(&self, row: usize, column: usize) -> u32 {
        self.positions[self.fronts.find(row, column).expect("the entry is in the pattern")]
    }
}

/// A square matrix of fixed pattern with its factorisation L U in place.
///
/// Write the values through [`Solver::values_mut`] at the positions [`Places::position`] gave, then
/// [`Solver::factor`], then [`Solver::solve`] as often as needed. Only the construction allocates.
pub struct Solver {
    lu: Multifrontal,
}

/// A pivot that is zero or not a number: the matrix cannot be factored as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pivot {pivot} of the matrix is zero or not a number")]
pub struct Singular {
    /// The unknown whose pivot it is, by its row in the pattern.
    pub pivot: usize,
}

impl Solver {
    /// A matrix by a plan, its values zero.
    pub fn new(plan: Plan) -> Self {
        Self { lu: Multifrontal::new(plan.0) }
    }

    /// Another matrix by the same plan, with the same units.
    pub fn twin(&self) -> Self {
        Self { lu: self.lu.twin() }
    }

    /// The value of an entry, zero outside the pattern.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.lu.plan.position(row, column).map_or(0.0, |at| self.lu.values()[at])
    }

    /// The values; [`Solver::factor`] may overwrite them by the factors.
    pub fn values_mut(&mut self) -> &mut [f64] {
        self.lu.values_mut()
    }

    /// Sets what the rows are multiplied by when numbers of different ones are compared, as these may have different units.
    pub fn set_units(&mut self, units: &[f64]) {
        self.lu.set_units(units);
    }

    /// Factors the matrix in place.
    pub fn factor(&mut self) -> Result<(), Singular> {
        self.lu.factor()
    }

    /// Factors the matrix in the order that was planned, without exchanges. A pivot smaller than `least` is dropped with what it
    /// would take from those after it.
    pub fn factor_dropping(&mut self, least: f64) -> Result<(), Singular> {
        self.lu.factor_dropping(least)
    }

    /// Whether it can be factored in part.
    pub fn has_parts(&self) -> bool {
        self.lu.plan.one_front().is_none()
    }

    /// Factors again after a few values changed: those of all entries that the given unknowns share with each other.
    pub fn factor_with(&mut self, unknowns: impl Iterator<Item = usize>) -> Result<(), Singular> {
        self.lu.factor_with(unknowns)
    }

    /// Replaces `b` by the solution.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.lu.solve(b);
    }

    /// Whether rows changed places when it was last factored: pivots of others than they came from tell little of them.
    pub fn has_exchanged(&self) -> bool {
        self.lu.has_exchanged()
    }

    /// Size of the pivot met at a row of the matrix.
    pub fn pivot(&self, row: usize) -> f64 {
        self.lu.pivot(row).0
    }

    /// Sizes of all pivots, in an order of their own.
    pub fn pivots(&self) -> impl Iterator<Item = f64> {
        self.lu.pivots()
    }

    /// Whether the pivot of a row of the matrix was dropped.
    pub fn is_dropped(&self, row: usize) -> bool {
        self.lu.pivot(row).1
    }
}

/// Size of the largest of some numbers. What is no number has none.
pub fn largest(values: &[f64]) -> f64 {
    let larger = |m: f64, x: f64| if x.abs() > m { x.abs() } else { m };
    let (blocks, rest) = values.as_chunks::<4>();
    let most = rest.iter().fold(0.0, |m, &x| larger(m, x));
    // The numbers of a node are fewer.
    if blocks.is_empty() {
        return most;
    }
    let mut sizes = [0.0; 4];
    for block in blocks {
        sizes = std::array::from_fn(|k| larger(sizes[k], block[k]));
    }
    sizes.iter().fold(most, |m, &x| larger(m, x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quasi-definite matrix of a chain: unknowns in pairs (coordinate, row), with unsymmetric values.
    fn chain(size: usize) -> Vec<(usize, usize, f64)> {
        let mut entries = Vec::new();
        for i in 0..size {
            entries.push((i, i, if i % 2 == 0 { 4.0 + i as f64 * 0.01 } else { -1e-3 }));
            if i % 2 == 1 {
                for j in [i - 1, (i + 1).min(size - 2)] {
                    entries.push((i, j, 1.0 + j as f64 * 0.1));
                    entries.push((j, i, 1.1 + j as f64 * 0.1));
                }
            }
        }
        entries
    }

    fn factored(size: usize, entries: &[(usize, usize, f64)]) -> Solver {
        let pattern: Vec<_> = entries.iter().map(|&(i, j, _)| (i as u32, j as u32)).collect();
        let order: Vec<u32> = (0..size as u32).step_by(2).chain((1..size as u32).step_by(2)).collect();
        let plan = Plan::new(&Plans::default(), size, &pattern, &order);
        let mut solver = Solver::new(plan.clone());
        for &(i, j, value) in entries {
            let at = plan.places().position(i, j) as usize;
            solver.values_mut()[at] += value;
        }
        solver.factor().expect("the matrix is regular");
        solver
    }

    /// What the solution leaves of a right side.
    fn residual(size: usize, entries: &[(usize, usize, f64)], solver: &mut Solver) -> f64 {
        let b: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let mut x = b.clone();
        solver.solve(&mut x);
        let mut r = b;
        for &(i, j, value) in entries {
            r[i] -= value * x[j];
        }
        r.iter().fold(0.0, |m, r| f64::max(m, r.abs()))
    }

    #[test]
    fn chains_are_solved() {
        for size in [2, 8, 24, 26, 200] {
            let entries = chain(size);
            let left = residual(size, &entries, &mut factored(size, &entries));
            assert!(left < 1e-10, "size {size}: {left}");
        }
    }

    /// Three rows on two coordinates, the second a multiple of the first.
    #[test]
    fn small_pivots_are_dropped() {
        let mut entries = vec![(0, 0, 1.0), (1, 1, 1.0)];
        for (row, g) in [[0.1, 0.3], [0.7 * 0.1, 0.7 * 0.3], [0.3, -0.1]].into_iter().enumerate() {
            entries.extend((0..2).flat_map(|k| [(k, 2 + row, g[k]), (2 + row, k, g[k])]));
            entries.push((2 + row, 2 + row, 0.0));
        }
        let pattern: Vec<_> = entries.iter().map(|&(i, j, _)| (i as u32, j as u32)).collect();
        let plan = Plan::new(&Plans::default(), 5, &pattern, &[0, 1, 2, 3, 4]);
        let mut solver = Solver::new(plan.clone());
        for (i, j, value) in entries {
            let at = plan.places().position(i, j) as usize;
            solver.values_mut()[at] = value;
        }
        solver.factor_dropping(1e-9).expect("pivots that are nothing are dropped");
        let pivots = [2, 3, 4].map(|row| solver.pivot(row));
        assert!((pivots[0] - 0.1).abs() < 1e-15 && pivots[1] < 1e-15 && (pivots[2] - 0.1).abs() < 1e-15, "{pivots:?}");
        assert_eq!([2, 3, 4].map(|row| solver.is_dropped(row)), [false, true, false]);
    }

    #[test]
    fn factors_follow_a_few_values() {
        let mut entries = chain(200);
        let mut solver = factored(200, &entries);
        for place in [13, 14, 151] {
            for (i, j, value) in entries.iter_mut().filter(|(i, j, _)| [*i, *j].contains(&place)) {
                let at = solver.lu.plan.position(*i, *j).expect("it is in the pattern");
                solver.values_mut()[at] += 0.5;
                *value += 0.5;
            }
        }
        assert!(residual(200, &entries, &mut solver) > 1e-3, "the factors are those of before");
        let changed = [13, 14, 151].into_iter().flat_map(|place| [place - 1, place, place + 1]);
        solver.factor_with(changed).expect("the matrix is regular");
        let left = residual(200, &entries, &mut solver);
        assert!(left < 1e-10, "{left}");
    }
}
