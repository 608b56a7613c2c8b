//! The energy balance on driven systems and custom rows, and what every combination of parts must hold.

mod common;

use std::sync::Arc;

use common::*;
use holonom::simulation::Status;
use holonom::system::{Differentiated, Number, Place, SmoothFunction, SystemBuilder};

/// The audit closes with the work of the drive: energy of the order of 10 J goes in and out.
#[test]
fn the_work_of_a_drive_closes_the_balance() {
    for name in ["conserving", "conserving-ggl"] {
        let run = run(&driven_pendulum(), &named(name), 0.01, 10.0);
        assert_eq!(run.status, Status::Completed);
        let exchanged = run.largest(|row| row.work.abs());
        assert!(exchanged > 1.0, "the drive works: {exchanged} J");
        assert!(run.summary.energy.max_drift <= 1e-10 * exchanged.max(1.0), "{name}: {}", run.summary.energy.max_drift);
    }
}

/// The paper's β (15): a custom row of any shape, at rest, does no work either.
#[test]
fn custom_rows_close_the_balance() {
    let run = run(&surface(), &named("conserving"), 0.01, 2.0);
    assert_eq!(run.status, Status::Completed);
    assert!(run.largest(|row| row.work.abs()) > 0.1, "the rising surface works");
    assert!(run.summary.energy.max_drift <= 1e-10, "{}", run.summary.energy.max_drift);
    assert!(run.summary.violation.position <= 1e-12);
}

/// Resists the bending of three points: a function of three invariants, homogeneous in none.
struct Bending;

impl SmoothFunction for Bending {
    fn evaluate<N: Number>(&self, value: &[N]) -> N {
        let straight = value[2] / (value[0] * value[1] * 4.0).sqrt() - 1.0;
        straight * straight * 80.0 + (value[0] - 0.5) * (value[0] - 0.5) * 300.0 + (value[1] - 0.5) * (value[1] - 0.5) * 300.0
    }
}

/// Three free points held by a potential of several invariants: the G-equivariant discrete gradient keeps energy, linear
/// and angular momentum.
#[test]
fn a_potential_of_several_invariants_keeps_energy_and_momenta() {
    let mut builder = SystemBuilder::new(3, [0.0; 3]);
    let starts = [([-1.0, 0.1, 0.0], [0.0, 1.0, 0.3]), ([0.0, 0.0, 0.2], [0.4, 0.0, 0.0]), ([1.0, 0.2, 0.0], [0.0, -1.0, 0.5])];
    let points = starts.map(|(position, velocity)| Place::Node(builder.free_node(position, velocity)));
    points.iter().for_each(|&point| builder.mass(point, point, 1.0));
    let [a, b, c] = points;
    let (left, right) = ([(b, 1.0), (a, -1.0)], [(c, 1.0), (b, -1.0)]);
    let arguments = [builder.square(&left), builder.square(&right), builder.dot(&left, &right)];
    builder.law("bending", &arguments, Arc::new(Differentiated(Bending)));
    let run = run(&builder.build(), &named("conserving"), 0.01, 10.0);
    assert_eq!(run.status, Status::Completed);
    assert!(run.summary.energy.max_drift <= 1e-10, "energy: {}", run.summary.energy.max_drift);
    assert!(run.summary.momentum.linear_drift <= 1e-11 && run.summary.momentum.angular_drift <= 1e-11, "{:?}", run.summary.momentum);
    assert!(run.summary.momentum.angular_drift > 0.0, "the angular momentum is watched");
    assert!(run.summary.work.iterations_per_step <= 5.0, "the tangent is that of the discrete gradient");
}

/// Composed to order 4 and 6 the schemes keep energy and momentum as exactly, with steps backwards among their parts.
#[test]
fn compositions_conserve() {
    for (method, drift) in [("ggl/conserving-ggl-4", 1e-10), ("ggl/conserving-ggl-6", 1e-10), ("lagrange-3/conserving-4", 1e-10)] {
        let run = run(&pendulum(), &named(method), 0.025, 20.0);
        assert_eq!(run.status, Status::Completed);
        println!("{method}: {:.1e} J", run.summary.energy.max_drift);
        assert!(run.summary.energy.max_drift <= drift, "{method}: {}", run.summary.energy.max_drift);
        assert!(run.summary.momentum.angular_drift <= 1e-10, "{method}");
        assert!(run.summary.violation.position <= 1e-11, "{method}");
    }
}

/// What is shown as ‖Φ̈‖ of a conserving scheme is x̄·a + v̄·v̄ of each rod at the middle of the step: with mean position,
/// mean velocity Δx/h and mean acceleration Δv/h from the states at both ends. The gradient x̄ is that of the last
/// evaluation, which the last increment of 1e-9 m at most comes after.
#[test]
fn the_violation_of_accelerations_is_that_of_the_middle_of_the_step() {
    use holonom::simulation::{Method, Simulation, Verdict};
    let mut builder = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let [a, b] = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(|position| Place::Node(builder.free_node(position, [0.0; 3])));
    for (name, mass, node, other) in [("inner", 1.0, a, None), ("outer", 2.0, b, Some(a))] {
        builder.mass(node, node, mass);
        let ends: Vec<(Place, f64)> = [(node, 1.0)].into_iter().chain(other.map(|place| (place, -1.0))).collect();
        let square = builder.square(&ends);
        builder.constant_row(name, square, 0.5);
    }
    let (system, h) = (builder.build(), 0.05);
    let mut simulation = Simulation::new(system.clone(), Method::resolve(&named("conserving")).unwrap(), h).unwrap();
    let rods = |x: &[f64]| [[x[0], x[1]], [x[2] - x[0], x[3] - x[1]]];
    let mut before = (rods(&simulation.state().x), rods(&simulation.state().v));
    let mut largest = 0.0_f64;
    let mut observer = |simulation: &Simulation| {
        let state = simulation.state();
        let after = (rods(&state.x), rods(&state.v));
        let of_rod = |k: usize| -> f64 {
            let along = |c: usize| {
                let (x0, x1, v0, v1) = (before.0[k][c], after.0[k][c], before.1[k][c], after.1[k][c]);
                0.5 * (x0 + x1) * (v1 - v0) / h + ((x1 - x0) / h).powi(2)
            };
            along(0) + along(1)
        };
        let expected = of_rod(0).hypot(of_rod(1));
        if state.t > 0.0 {
            let shown = simulation.audit().phi_ddot;
            assert!((shown - expected).abs() <= 1e-8 * (1.0 + expected), "{shown} instead of {expected} at {} s", state.t);
            largest = largest.max(expected);
        }
        before = after;
        Verdict::GoOn
    };
    assert_eq!(simulation.run(2.0, &mut observer), Status::Completed);
    assert!(largest > 1e-3, "there is something to show: {largest}");
}

/// Steps of any length, forwards, keep the energy: one-step schemes have no past to disturb.
#[test]
fn conserving_ggl_keeps_the_energy_with_any_steps() {
    use holonom::simulation::{Method, Simulation, Verdict};
    let system = pendulum();
    let mut simulation = Simulation::new(system.clone(), Method::resolve(&named("conserving-ggl")).unwrap(), 1.0).unwrap();
    let mut t = 0.0;
    for k in 0..2000 {
        // Between 1e-4 and 0.05 s, from one to the next by up to five hundred times.
        t += 1e-4 * 500_f64.powf(0.5 + 0.5 * (12.9898 * f64::from(k)).sin());
        assert_eq!(simulation.run(t, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
    }
    let energy = simulation.audit().energy_summary();
    println!("{t:.1} s: {:.1e} J", energy.max_drift);
    assert!(energy.max_drift <= 1e-10, "{}", energy.max_drift);
}
