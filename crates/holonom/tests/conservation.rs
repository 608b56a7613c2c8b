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

/// Steps of any length, forwards, keep the energy: one-step schemes have no past to disturb.
#[test]
fn conserving_ggl_keeps_the_energy_with_any_steps() {
    use holonom::simulation::{Method, Simulation, Verdict};
    let system = pendulum();
    let mut simulation = Simulation::new(&system, Method::resolve(&named("conserving-ggl")).unwrap(), 1.0).unwrap();
    let mut t = 0.0;
    for k in 0..2000 {
        // Between 1e-4 and 0.05 s, from one to the next by up to five hundred times.
        t += 1e-4 * 500_f64.powf(0.5 + 0.5 * (12.9898 * f64::from(k)).sin());
        assert_eq!(simulation.run(t, &mut |_: &Simulation<'_>| Verdict::GoOn), Status::Completed);
    }
    let energy = simulation.audit().energy_summary();
    println!("{t:.1} s: {:.1e} J", energy.max_drift);
    assert!(energy.max_drift <= 1e-10, "{}", energy.max_drift);
}
