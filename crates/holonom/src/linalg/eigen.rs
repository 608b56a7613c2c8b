//! Eigenvalues and inverses of small dense matrices, for analysis only.

use super::largest;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, EvdParams, evd_real, evd_scratch};
use faer::linalg::solvers::DenseSolveCore;
use faer::{Auto, Col, Mat, Par, Side, Spec};

/// How far what is symmetric may be from it, over its largest number: what rounding leaves where it comes of sums.
const ROUNDED: f64 = 1e-13;

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
    if is_symmetric(size, values) {
        let eigen = matrix(size, values).self_adjoint_eigen(Side::Lower).ok()?;
        return Some((0..size).map(|k| ([eigen.S()[k], 0.0], (0..size).map(|i| [eigen.U()[(i, k)], 0.0]).collect())).collect());
    }
    // One shift pair at a time: the reordering with which faer looks for several (0.24.4) may go on without end where eigenvalues lie close.
    let mut params: EvdParams = Auto::<f64>::auto();
    params.schur.blocking_threshold = usize::MAX;
    let params = || Spec::new(params);
    let scratch = evd_scratch::<f64>(size, ComputeEigenvectors::No, ComputeEigenvectors::Yes, Par::Seq, params());
    let (mut re, mut im, mut vectors) = (Col::zeros(size), Col::zeros(size), Mat::zeros(size, size));
    evd_real(
        matrix(size, values).as_ref(),
        re.as_diagonal_mut(),
        im.as_diagonal_mut(),
        None,
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        params(),
    )
    .ok()?;
    let column = |k: usize, of_imaginary: Option<(usize, f64)>| {
        let imaginary = |i: usize| of_imaginary.map_or(0.0, |(column, sign)| sign * vectors[(i, column)]);
        (0..size).map(|i| [vectors[(i, k)], imaginary(i)]).collect()
    };
    // Of a complex pair the first column has the real parts of the vectors, and the second the imaginary ones of the first of them.
    let mut pairs = Vec::with_capacity(size);
    while pairs.len() < size {
        let k = pairs.len();
        if im[k] == 0.0 {
            pairs.push(([re[k], 0.0], column(k, None)));
        } else {
            pairs.push(([re[k], im[k]], column(k, Some((k + 1, 1.0)))));
            pairs.push(([re[k], -im[k]], column(k, Some((k + 1, -1.0)))));
        }
    }
    Some(pairs)
}

/// Whether a matrix is symmetric but for rounding, whose eigenpairs are found faster.
fn is_symmetric(size: usize, values: &[f64]) -> bool {
    let most = ROUNDED * largest(values);
    (0..size).all(|i| (0..i).all(|j| (values[i * size + j] - values[j * size + i]).abs() <= most))
}

/// Orthonormal vectors that a symmetric positive semidefinite matrix (size × size, row-major) takes to at most `share` of
/// its largest eigenvalue.
pub fn null_space(size: usize, values: &[f64], share: f64) -> Vec<Vec<f64>> {
    let Ok(eigen) = matrix(size, values).self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let largest = (0..size).map(|k| eigen.S()[k].abs()).fold(0.0, f64::max);
    let vanishing = (0..size).filter(|&k| eigen.S()[k].abs() <= share * largest);
    vanishing.map(|k| (0..size).map(|i| eigen.U()[(i, k)]).collect()).collect()
}
