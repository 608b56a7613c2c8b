//! The solver of the engine against those of the library, on the matrices of a stage: `cargo bench -p holonom --bench solver`.
//!
//! Each bench sets the values, factors and solves once, with everything that follows from the pattern done before. That there
//! is one solver for all sizes rests on these figures.

mod matrices;
mod models;

use divan::Bencher;
use divan::counter::ItemsCount;
use faer::Mat;
use faer::linalg::solvers::Solve;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use holonom::linalg::{Plan, Plans, Solver};
use matrices::Matrix;
use models::{Case, cases};

fn main() {
    divan::main();
}

/// Largest matrix that the dense solver is asked to factor.
const LARGEST_DENSE: usize = 1_500;

/// Time over the unknowns instead of bodies.
fn unknowns(matrix: &Matrix) -> ItemsCount {
    ItemsCount::new(matrix.size)
}

#[divan::bench(args = cases(), max_time = 0.5)]
fn engine(bencher: Bencher<'_, '_>, case: &Case) {
    let matrix = Matrix::of(&case.model());
    let pattern: Vec<(u32, u32)> = matrix.entries.iter().map(|&(i, j, _)| (i as u32, j as u32)).collect();
    let plan = Plan::new(&Plans::default(), matrix.size, &pattern, &matrix.order);
    let places = plan.places();
    let mut solver = Solver::new(plan.clone());
    let positions: Vec<usize> = matrix.entries.iter().map(|&(i, j, _)| places.position(i, j) as usize).collect();
    let mut x = matrix.right_side();
    bencher.counter(unknowns(&matrix)).bench_local(|| {
        let values = solver.values_mut();
        values.fill(0.0);
        for (&position, &(_, _, value)) in positions.iter().zip(&matrix.entries) {
            values[position] += value;
        }
        solver.factor().expect("the matrix is regular");
        x.fill(1.0);
        solver.solve(&mut x);
    });
}

#[divan::bench(args = cases(), max_time = 0.5)]
fn library_sparse(bencher: Bencher<'_, '_>, case: &Case) {
    let matrix = Matrix::of(&case.model());
    let full = SparseColMat::try_new_from_triplets(matrix.size, matrix.size, &matrix.triplets()).expect("the entries are in the matrix");
    let symbolic = SymbolicLu::try_new(full.symbolic()).expect("the pattern can be planned");
    let mut x = column(&matrix);
    bencher.counter(unknowns(&matrix)).bench_local(|| {
        let lu = Lu::try_new_with_symbolic(symbolic.clone(), full.as_ref()).expect("the matrix is regular");
        x.fill(1.0);
        lu.solve_in_place(x.as_mut());
    });
}

#[divan::bench(args = cases().filter(|case| Matrix::size_of(&case.model()) <= LARGEST_DENSE), max_time = 0.5)]
fn library_dense(bencher: Bencher<'_, '_>, case: &Case) {
    let matrix = Matrix::of(&case.model());
    let mut full = Mat::<f64>::zeros(matrix.size, matrix.size);
    for &(i, j, value) in &matrix.entries {
        full[(i, j)] += value;
    }
    let mut x = column(&matrix);
    bencher.counter(unknowns(&matrix)).bench_local(|| {
        let lu = full.partial_piv_lu();
        x.fill(1.0);
        lu.solve_in_place(x.as_mut());
    });
}

fn column(matrix: &Matrix) -> Mat<f64> {
    let values = matrix.right_side();
    Mat::from_fn(matrix.size, 1, |i, _| values[i])
}
