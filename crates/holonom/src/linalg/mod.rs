//! Linear systems with a fixed pattern: dense for small ones, sparse with a static order for the others.
//!
//! The only folder that names the linear algebra library.

mod dense;
mod eigen;
mod ordering;
mod sparse;

pub use eigen::{inverse, null_space, relative_eigenvalues};
pub use ordering::fill_reducing_order;

use dense::DenseLu;
use sparse::SparseLu;

/// A square matrix of fixed pattern with its factorisation L U in place.
///
/// Write the values through [`Solver::values_mut`] at the positions [`Solver::position`] gave, then
/// [`Solver::factor`], then [`Solver::solve`] as often as needed. Only the construction allocates.
pub struct Solver {
    form: Form,
}

enum Form {
    Dense(DenseLu),
    Sparse(SparseLu),
}

/// A pivot that is zero or not a number: the matrix cannot be factored as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pivot {pivot} of the matrix is zero or not a number")]
pub struct Singular {
    pub pivot: usize,
}

/// Largest matrix that is treated as dense. Below it partial pivoting costs nothing; above it the sparse
/// form is faster (measured in `benches`).
pub const DENSE_LIMIT: usize = 24;

impl Solver {
    /// Plans a matrix of `size` rows with the structurally symmetric pattern `entries` (row, column), eliminated in
    /// the order `order` when it is sparse.
    pub fn new(size: usize, entries: &[(u32, u32)], order: &[u32]) -> Self {
        let form = match size <= DENSE_LIMIT {
            true => Form::Dense(DenseLu::new(size)),
            false => Form::Sparse(SparseLu::new(size, entries, order)),
        };
        Self { form }
    }

    /// Where the entry (row, column) of the pattern is among the values.
    pub fn position(&self, row: usize, column: usize) -> u32 {
        match &self.form {
            Form::Dense(lu) => lu.position(row, column),
            Form::Sparse(lu) => lu.position(row, column),
        }
    }

    /// The value of an entry, zero outside the pattern.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        match &self.form {
            Form::Dense(lu) => lu.values[lu.position(row, column) as usize],
            Form::Sparse(lu) => lu.find(row, column).map_or(0.0, |at| lu.values[at as usize]),
        }
    }

    /// The values; after [`Solver::factor`] they are overwritten by the factors.
    pub fn values_mut(&mut self) -> &mut [f64] {
        match &mut self.form {
            Form::Dense(lu) => &mut lu.values,
            Form::Sparse(lu) => &mut lu.values,
        }
    }

    /// Factors the matrix in place.
    pub fn factor(&mut self) -> Result<(), Singular> {
        match &mut self.form {
            Form::Dense(lu) => lu.factor(),
            Form::Sparse(lu) => lu.factor(),
        }
    }

    /// Replaces `b` by the solution.
    pub fn solve(&mut self, b: &mut [f64]) {
        match &mut self.form {
            Form::Dense(lu) => lu.solve(b),
            Form::Sparse(lu) => lu.solve(b),
        }
    }

    /// Size of the pivot met at each row of the matrix (size).
    pub fn pivots(&self, out: &mut [f64]) {
        match &self.form {
            Form::Dense(lu) => lu.pivots(out),
            Form::Sparse(lu) => lu.pivots(out),
        }
    }
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

    fn residual(size: usize) -> f64 {
        let entries = chain(size);
        let pattern: Vec<_> = entries.iter().map(|&(i, j, _)| (i as u32, j as u32)).collect();
        let order: Vec<u32> = (0..size as u32).step_by(2).chain((1..size as u32).step_by(2)).collect();
        let mut solver = Solver::new(size, &pattern, &order);
        for &(i, j, value) in &entries {
            let at = solver.position(i, j) as usize;
            solver.values_mut()[at] += value;
        }
        solver.factor().expect("the matrix is regular");
        let b: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let mut x = b.clone();
        solver.solve(&mut x);
        let mut r = b;
        for &(i, j, value) in &entries {
            r[i] -= value * x[j];
        }
        r.iter().fold(0.0, |m, r| f64::max(m, r.abs()))
    }

    #[test]
    fn both_forms_solve() {
        for size in [8, DENSE_LIMIT, DENSE_LIMIT + 2, 200] {
            assert!(residual(size) < 1e-10, "size {size}: {}", residual(size));
        }
    }
}
