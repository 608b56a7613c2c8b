//! What a step costs and what of it is which part, by the number of bodies: `cargo bench -p holonom --bench step`.
//!
//! Throughput is in bodies per second: where it stays the same from size to size, time is linear in the number of bodies.

mod models;

use divan::Bencher;
use divan::counter::ItemsCount;
use holonom::formulation::{Newton, RowsAt, Sampling, Stage, Workspace};
use holonom::simulation::{Simulation, Verdict};
use holonom::system::System;
use models::{Case, STEP, cases, method};

fn main() {
    divan::main();
}

/// The stage of the conserving scheme.
const STAGE: Stage =
    Stage { sampling: Sampling::Between, rows: RowsAt::End, start: 0.0, step: STEP, inertia: 0.5 * STEP * STEP, rate: 1.0 / STEP };

/// A workspace at the start, with the increment of free flight, and the tangent and residual there.
fn workspace(system: &System) -> (Workspace, Newton) {
    let mut work = Workspace::new(system);
    for (d, v) in work.d.iter_mut().zip(&work.start.v) {
        *d = STEP * v;
    }
    work.prediction.drift.copy_from_slice(&work.d);
    let mut newton = Newton::new(system, &work.scales, method("conserving").settings);
    newton.proximal(STAGE.inertia, None, &work.scales);
    work.place(&STAGE);
    work.evaluate(system, &STAGE);
    work.tangent(system, &STAGE, 1.0, &mut newton.kkt);
    work.residual(system, &STAGE, &mut newton.unknowns);
    (work, newton)
}

/// Positions, rows, forces and residual of an iteration.
#[divan::bench(args = cases(), max_time = 0.5)]
fn evaluate(bencher: Bencher<'_, '_>, case: &Case) {
    let system = case.model().system;
    let (mut work, mut newton) = workspace(&system);
    bencher.counter(ItemsCount::new(case.bodies())).bench_local(|| {
        work.place(&STAGE);
        work.evaluate(&system, &STAGE);
        work.residual(&system, &STAGE, &mut newton.unknowns);
    });
}

/// The tangent of an iteration.
#[divan::bench(args = cases(), max_time = 0.5)]
fn assemble(bencher: Bencher<'_, '_>, case: &Case) {
    let system = case.model().system;
    let (mut work, mut newton) = workspace(&system);
    bencher.counter(ItemsCount::new(case.bodies())).bench_local(|| work.tangent(&system, &STAGE, 1.0, &mut newton.kkt));
}

/// Its factors, with the copy of the matrix that they overwrite.
#[divan::bench(args = cases(), max_time = 0.5)]
fn factor(bencher: Bencher<'_, '_>, case: &Case) {
    let system = case.model().system;
    let (work, mut newton) = workspace(&system);
    let matrix = newton.kkt.solver.values_mut().to_vec();
    bencher.counter(ItemsCount::new(case.bodies())).bench_local(|| {
        newton.kkt.solver.values_mut().copy_from_slice(&matrix);
        newton.factor(&work.scales).expect("the matrix is regular");
    });
}

/// A solution with them, with the copy of the right side.
#[divan::bench(args = cases(), max_time = 0.5)]
fn solve(bencher: Bencher<'_, '_>, case: &Case) {
    let system = case.model().system;
    let (work, mut newton) = workspace(&system);
    newton.factor(&work.scales).expect("the matrix is regular");
    let right_side = newton.unknowns.clone();
    bencher.counter(ItemsCount::new(case.bodies())).bench_local(|| {
        newton.unknowns.copy_from_slice(&right_side);
        newton.solve().expect("the solution is finite");
    });
}

#[divan::bench(args = cases(), sample_count = 10, sample_size = 10)]
fn step_conserving(bencher: Bencher<'_, '_>, case: &Case) {
    steps(bencher, case, "conserving");
}

#[divan::bench(args = cases(), sample_count = 10, sample_size = 10)]
fn step_conserving_ggl(bencher: Bencher<'_, '_>, case: &Case) {
    steps(bencher, case, "conserving-ggl");
}

/// One step after the other, from the start on.
fn steps(bencher: Bencher<'_, '_>, case: &Case, name: &str) {
    let system = case.model().system;
    let mut simulation = Simulation::new(system.clone(), method(name), STEP).expect("the model starts");
    let mut go_on = |_: &Simulation| Verdict::GoOn;
    bencher.counter(ItemsCount::new(case.bodies())).bench_local(|| {
        let end = simulation.state().t + STEP;
        simulation.run(end, &mut go_on)
    });
}
