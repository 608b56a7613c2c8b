//! The energy balance on driven systems and custom rows, and what every combination of parts must hold.

mod common;

use std::sync::Arc;

use common::*;
use holonom::simulation::Status;
use holonom::system::{Differentiated, Number, Place, PotentialFunction, SystemBuilder};

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

impl PotentialFunction for Bending {
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
