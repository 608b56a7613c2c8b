//! The paper's example (§7) and its numbers, as an independent implementation of its algorithms measured them.

mod common;

use common::*;
use holonom::analysis::largest_step;
use holonom::simulation::Status;
use holonom::system::{Place, SystemBuilder};

const STEP: f64 = 0.025;
const END: f64 = 20.0;

fn completed(run: &Run) {
    assert_eq!(run.status, Status::Completed);
}

/// Figure 2: the trapezoidal rule without projections.
#[test]
fn trapezoidal_breaks_down_as_in_figure_2() {
    let run = run(&pendulum(), &paper_loop("trapezoidal", "simultaneous"), STEP, END);
    let crossing = run.steps.iter().find(|row| row.phi_dot > 1e-2).expect("the violation grows").t;
    assert!((3.4..4.1).contains(&crossing), "‖Φ̇‖ passes 1e-2 at {crossing} s");
    let error = (run.at(3.5).energy - PENDULUM_ENERGY).abs();
    assert!((0.04..0.15).contains(&error), "energy error {error} J at 3.5 s");
    let is_off = run.steps.iter().any(|row| row.t <= 6.5 && (row.energy - PENDULUM_ENERGY).abs() > 1.0);
    assert!(is_off || matches!(run.status, Status::Stopped { at, .. } if at < 6.5), "{:?}", run.status);
}

/// Figure 3: the trapezoidal rule with projections, A = M.
#[test]
fn trapezoidal_with_projections_stays_on_all_constraints() {
    let exact = run(&pendulum(), &named("trapezoidal-projected"), STEP, END);
    completed(&exact);
    assert!(exact.summary.violation.position <= 1e-11);
    assert!(exact.summary.violation.velocity <= 1e-10);
    assert!(exact.summary.violation.acceleration <= 1e-8);
    let (low, high) = (-exact.largest(|row| PENDULUM_ENERGY - row.energy), exact.largest(|row| row.energy - PENDULUM_ENERGY));
    assert!(low >= -0.097 && high <= 1e-6, "energy within [{low}, {high}] of its start");
    assert!(low <= -0.09, "the paper's loss is there: {low}");

    let penalty = run(&pendulum(), &projected("trapezoidal-projected", "mass", "penalty"), STEP, END);
    completed(&penalty);
    assert!(penalty.summary.violation.velocity <= 1e-8);
}

/// Figure 3: the conserving scheme.
#[test]
fn conserving_keeps_energy_and_vertical_momentum() {
    let run = run(&pendulum(), &named("conserving"), STEP, END);
    completed(&run);
    assert!(run.summary.energy.max_drift <= 1e-10);
    assert!(run.summary.violation.position <= 1e-11);
    assert!((1e-3..3e-3).contains(&run.summary.violation.velocity));
    assert!(run.summary.momentum.angular_drift <= 1e-10);
    assert!(run.summary.momentum.angular_drift > 0.0, "the vertical momentum is watched");
}

/// Figure 4: with exact velocity projection the energy falls in every step. Newton ends with increments of 1e-14 of
/// the mechanism's 2 m; against forces of some 40 N that is below 1e-12 J a step.
#[test]
fn conserving_with_projection_only_dissipates() {
    let run = run(&pendulum(), &named("conserving-projected"), STEP, END);
    completed(&run);
    let loss = run.steps.last().unwrap().energy - PENDULUM_ENERGY;
    assert!((loss + 0.0142).abs() <= 1e-4, "E(20) − E(0) = {loss}");
    assert!(run.summary.energy.max_rise <= 1e-12, "largest rise {}", run.summary.energy.max_rise);
}

#[test]
fn conserving_ggl_keeps_everything() {
    let run = run(&pendulum(), &named("conserving-ggl"), STEP, END);
    completed(&run);
    assert!(run.summary.energy.max_drift <= 1e-10);
    assert!(run.summary.violation.position <= 1e-11);
    assert!(run.summary.violation.velocity <= 1e-11);
    assert!(run.summary.work.iterations_per_step <= 4.5);
}

/// The paper, §7.3, reaches 0.25 s with projections and 0.20 s with the conserving scheme.
#[test]
fn largest_steps_reach_and_pass_the_papers() {
    let system = pendulum();
    let search = |choice: holonom::simulation::Choice, limit: f64| {
        let choice = holonom::simulation::Choice { subdivide: Some(false), ..choice };
        largest_step(STEP, limit, 1.01, |step| run(&system, &choice, step, END).status == Status::Completed).completes
    };
    for (name, least) in [("trapezoidal-projected", 1.0), ("conserving-projected", 1.0), ("conserving-ggl", 1.0), ("conserving", 0.6)] {
        let step = search(named(name), 1.2);
        println!("{name}: {step:.3} s");
        assert!(step >= least, "{name} completes up to {step} s");
    }
    for (name, least) in [("trapezoidal-projected", 0.25), ("conserving", 0.2)] {
        let step = search(paper_loop(name, "simultaneous"), 0.6);
        println!("{name}, the paper's loop: {step:.3} s");
        assert!(step >= least, "{name} with the paper's loop completes up to {step} s");
    }
}

/// §7.1: the three iterations find the same solution at different cost.
#[test]
fn iterations_agree() {
    for name in ["trapezoidal-projected", "conserving"] {
        let newton = run(&pendulum(), &named(name), STEP, END);
        println!("{name}, newton: {:.2} iterations a step", newton.summary.work.iterations_per_step);
        for iteration in ["simultaneous", "nested"] {
            let other = run(&pendulum(), &paper_loop(name, iteration), STEP, END);
            println!("{name}, {iteration}: {:.2} iterations a step", other.summary.work.iterations_per_step);
            assert!(other.summary.work.iterations_per_step > newton.summary.work.iterations_per_step);
            let difference = largest_difference(&newton.position, &other.position);
            assert!(difference <= 1e-8, "{name}, {iteration}: {difference}");
        }
    }
}

/// With the Newton iteration the penalty is no parameter of the solution.
#[test]
fn penalties_do_not_matter_to_newton() {
    for name in ["trapezoidal-projected", "conserving"] {
        let reference = run(&pendulum(), &named(name), STEP, END);
        for exponent in 3..=12 {
            let choice = holonom::simulation::Choice { penalty: Some(10f64.powi(exponent)), ..named(name) };
            let run = run(&pendulum(), &choice, STEP, END);
            assert!(largest_difference(&reference.position, &run.position) <= 1e-9);
            let iterations = run.summary.work.iterations_per_step - reference.summary.work.iterations_per_step;
            assert!(iterations.abs() <= 1.0, "penalty 1e{exponent}: {iterations} more iterations");
        }
    }
}

/// Every method that stays stable is of order 2 in position against the reference at t = 2 s.
#[test]
fn positions_converge_with_order_two() {
    for name in ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected"] {
        let error = |step: f64| {
            let run = run(&pendulum(), &named(name), step, 2.0);
            largest_difference(&run.position[3..], &PENDULUM_AT_2)
        };
        let (coarse, fine) = (error(0.01), error(0.005));
        let order = (coarse / fine).log2();
        println!("{name}: order {order:.3}, error {fine:.1e} at 0.005 s");
        assert!((order - 2.0).abs() <= 0.1, "{name}: order {order}");
    }
}

/// Six coordinates with five rows or three with one: the same motion. A rod of 1.5 kg over 2 m with 0.75 kg at its end has
/// the weight and the inertia of both particles about the support.
#[test]
fn two_particles_move_like_one_rod() {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let tip = Place::Node(builder.free_node([2.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    bar(&mut builder, "rod", Place::Fixed([0.0; 3]), tip, 1.5, 2.0);
    builder.mass(tip, tip, 0.75);
    let rod = builder.build();
    for name in ["conserving", "conserving-ggl", "lagrange-3/conserving-4", "ggl/conserving-ggl-4", "lagrange-3/rattle"] {
        let [particles, rod] = [&pendulum(), &rod].map(|system| run(system, &named(name), STEP, END));
        let difference = largest_difference(&particles.position[3..], &rod.position);
        println!("{name}: {difference:.1e} m");
        assert!(difference <= 1e-11, "{name}: {difference}");
    }
}

/// A million conserving steps: 25 000 s of the pendulum.
#[test]
fn a_million_steps_keep_the_energy() {
    use holonom::simulation::{Method, Simulation, Verdict};
    let system = pendulum();
    let mut simulation = Simulation::new(system.clone(), Method::resolve(&named("conserving")).unwrap(), STEP).unwrap();
    let status = simulation.run(25_000.0, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed);
    assert_eq!(simulation.steps(), 1_000_000);
    // The potential energy falls by up to 29 J on the way: the scale of what is exchanged.
    let drift = simulation.audit().energy_summary().max_drift / 29.43;
    println!("relative drift over a million steps: {drift:.1e}");
    assert!(drift <= 1e-10, "{drift}");
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
