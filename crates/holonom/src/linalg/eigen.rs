//! Eigenvalues and inverses of small dense matrices, for analysis only.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side};

/// Eigenvalues of M⁻¹A for symmetric A and positive definite M, ascending. `None` when M is not positive definite.
pub fn relative_eigenvalues(size: usize, a: &[f64], m: &[f64]) -> Option<Vec<f64>> {
    let factor = matrix(size, m).llt(Side::Lower).ok()?;
    let lower = factor.L().to_owned().partial_piv_lu().inverse();
    let reduced = &lower * matrix(size, a) * lower.transpose();
    reduced.self_adjoint_eigenvalues(Side::Lower).ok()
}

/// Inverse of a regular matrix (size × size, row-major), row-major.
pub fn inverse(size: usize, values: &[f64]) -> Vec<f64> {
    let inverse = matrix(size, values).partial_piv_lu().inverse();
    (0..size * size).map(|k| inverse[(k / size, k % size)]).collect()
}

fn matrix(size: usize, values: &[f64]) -> Mat<f64> {
    Mat::from_fn(size, size, |i, j| values[i * size + j])
}

/// An eigenvalue with its eigenvector: real and imaginary parts of each number.
pub type Eigenpair = ([f64; 2], Vec<[f64; 2]>);

/// Those of a matrix (size × size, row-major). `None` where they are not found.
pub fn eigenpairs(size: usize, values: &[f64]) -> Option<Vec<Eigenpair>> {
    let eigen = matrix(size, values).eigen().ok()?;
    let pair = |k: usize| {
        let vector = (0..size).map(|i| eigen.U()[(i, k)]).map(|entry| [entry.re, entry.im]).collect();
        ([eigen.S()[k].re, eigen.S()[k].im], vector)
    };
    Some((0..size).map(pair).collect())
}

/// Orthonormal vectors that a symmetric positive semidefinite matrix (size × size, row-major) takes to at most `share` of
/// its largest eigenvalue.
pub fn null_space(size: usize, values: &[f64], share: f64) -> Vec<Vec<f64>> {
    let Ok(eigen) = matrix(size, values).self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let largest = (0..size).map(|k| eigen.S()[k].abs()).fold(0.0, f64::max);
    let vanishing = (0..size).filter(|&k| eigen.S()[k].abs() <= share * largest);
    vanishing.map(|k| (0..size).map(|i| eigen.U()[(i, k)]).collect()).collect()
}
