//! How the time of the engine's solver grows with the number of bodies: `cargo bench -p holonom --bench growth`.
//!
//! Time grows linearly with chains, trees and ladders whose order of elimination is a good one, and nearly so with random
//! mechanisms that a twentieth of all rods closes to loops. Grids come to N^1.5 at best (George 1973), and to N² in their natural
//! order.

mod matrices;
mod models;

use std::time::{Duration, Instant};

use holonom::linalg::{Plan, Plans, Solver};
use matrices::Matrix;
use models::{Case, cases};

/// Mechanisms with fewer bodies tell of the overhead.
const FEWEST: usize = 50;

/// Time for each size, in which the fastest run counts.
const LENGTH: Duration = Duration::from_millis(500);

/// Factor with the values before, and solution, s.
struct Times {
    bodies: usize,
    factor: f64,
    solve: f64,
}

fn main() {
    let cases: Vec<Case> = cases().filter(|case| case.bodies() >= FEWEST).collect();
    println!("mechanism       unknowns   factor, µs    solve, µs   both, µs a body");
    for family in cases.chunk_by(|a, b| a.family() == b.family()) {
        let times: Vec<Times> = family.iter().map(measure).collect();
        println!("{} grows with N^{:.2}\n", family[0].family(), exponent(&times));
    }
}

fn measure(case: &Case) -> Times {
    let matrix = Matrix::of(&case.model());
    let pattern: Vec<(u32, u32)> = matrix.entries.iter().map(|&(i, j, _)| (i as u32, j as u32)).collect();
    let plan = Plan::new(&Plans::default(), matrix.size, &pattern, &matrix.order);
    let places = plan.places();
    let mut solver = Solver::new(plan.clone());
    let positions: Vec<usize> = matrix.entries.iter().map(|&(i, j, _)| places.position(i, j) as usize).collect();
    let mut x = matrix.right_side();
    let mut times = Times { bodies: case.bodies(), factor: f64::INFINITY, solve: f64::INFINITY };
    let start = Instant::now();
    while start.elapsed() < LENGTH {
        let begin = Instant::now();
        let values = solver.values_mut();
        values.fill(0.0);
        for (&position, &(_, _, value)) in positions.iter().zip(&matrix.entries) {
            values[position] += value;
        }
        solver.factor().expect("the matrix is regular");
        times.factor = times.factor.min(begin.elapsed().as_secs_f64());
        x.fill(1.0);
        let begin = Instant::now();
        solver.solve(&mut x);
        times.solve = times.solve.min(begin.elapsed().as_secs_f64());
    }
    let Times { bodies, factor, solve } = times;
    let each = 1e6 * (factor + solve) / bodies as f64;
    println!("{:14} {:9} {:12.1} {:12.1} {each:17.3}", case.to_string(), matrix.size, 1e6 * factor, 1e6 * solve);
    times
}

/// The power of N that fits best, by least squares in logarithms.
fn exponent(times: &[Times]) -> f64 {
    let points: Vec<[f64; 2]> = times.iter().map(|times| [(times.bodies as f64).ln(), (times.factor + times.solve).ln()]).collect();
    let mean = |k: usize| points.iter().map(|point| point[k]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let product: f64 = points.iter().map(|[a, b]| (a - x) * (b - y)).sum();
    product / points.iter().map(|[a, _]| (a - x) * (a - x)).sum::<f64>()
}
