//! Eigenvalues of small dense matrices, for analysis only.

use faer::{Mat, Side};

/// Eigenvalues of a symmetric matrix (size × size, row-major), ascending. `None` when the iteration does not end.
pub fn symmetric_eigenvalues(size: usize, values: &[f64]) -> Option<Vec<f64>> {
    let matrix = Mat::from_fn(size, size, |i, j| values[i * size + j]);
    matrix.self_adjoint_eigenvalues(Side::Lower).ok()
}
