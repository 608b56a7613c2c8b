//! What projections and the variants of the conserving scheme promise (methods §5, §18).

mod common;

use common::*;
use holonom::analysis::projection_form;
use holonom::projection::{Metric, Projection, Solve};
use holonom::simulation::{Choice, ProjectionChoice, Status};

fn velocity(choice: ProjectionChoice) -> Choice {
    let projection = ProjectionChoice { levels: Some(vec!["velocity".into()]), ..choice };
    Choice { projection: Some(projection), ..named("conserving") }
}

/// With shadow projections the motion is that of the bare scheme, and what is shown satisfies the rows.
#[test]
fn shadow_projections_show_but_do_not_act() {
    let bare = run(&pendulum(), &named("conserving"), 0.025, 5.0);
    let shadow = run(&pendulum(), &velocity(ProjectionChoice { shadow: Some(true), ..ProjectionChoice::default() }), 0.025, 5.0);
    assert_eq!(bare.position, shadow.position);
    assert!(shadow.summary.energy.max_drift <= 1e-10);
    assert!(bare.summary.violation.velocity > 1e-3 && shadow.summary.violation.velocity < 1e-12);
}

/// One step projected by θ changes the energy by −½(2θ − θ²)‖v* − Πv*‖²_M, and scales the violation by 1 − θ.
#[test]
fn strength_changes_energy_as_the_formula_says() {
    let outcome = |strength: f64| {
        let choice = ProjectionChoice { strength: Some(strength), ..ProjectionChoice::default() };
        let run = run(&pendulum(), &velocity(choice), 0.1, 0.1);
        (run.summary.energy.projection_total, run.steps[1].phi_dot)
    };
    let (full, _) = outcome(1.0);
    let (_, violation) = { (0.0, run(&pendulum(), &named("conserving"), 0.1, 0.1).steps[1].phi_dot) };
    assert!(full < -1e-6 && violation > 1e-3, "there is something to project: {full}, {violation}");
    for strength in [0.25, 0.5, 1.5, 2.0] {
        let (energy, left) = outcome(strength);
        let expected = full * (2.0 * strength - strength * strength);
        assert!((energy - expected).abs() <= 1e-12, "θ = {strength}: {energy} and not {expected}");
        assert!((left - (1.0 - strength).abs() * violation).abs() <= 1e-12, "θ = {strength}: {left}");
    }
}

/// Every metric puts velocities on the rows.
#[test]
fn every_metric_meets_the_rows() {
    for (matrix, weights) in [("mass", None), ("identity", None), ("tangent", None), ("custom", Some(vec![1.0, 3.0]))] {
        let choice = ProjectionChoice { matrix: Some(matrix.into()), weights, ..ProjectionChoice::default() };
        let run = run(&pendulum(), &velocity(choice), 0.025, 5.0);
        assert_eq!(run.status, Status::Completed, "{matrix}");
        assert!(run.summary.violation.velocity <= 1e-11, "{matrix}: {}", run.summary.violation.velocity);
    }
}

/// Only A = M, and what acts like it on the rows, can never add energy (30).
#[test]
fn the_form_of_the_projection_tells_which_metric_dissipates() {
    let form = |metric: Metric| {
        let projection =
            Projection { position: false, velocity: true, acceleration: false, metric, solve: Solve::Exact, strength: 1.0, shadow: false };
        projection_form(&four_bar(2), &projection, 1e7, 0.01).expect("the mass matrix is definite")
    };
    let mass = form(Metric::Mass);
    assert!(mass.dissipative && (mass.condition - 1.0).abs() < 1e-9 && (mass.growth_bound - 1.0).abs() < 1e-9);
    let identity = form(Metric::Identity);
    assert!(
        !identity.dissipative && identity.condition > 1.5 && (1.0 + 1e-4..=identity.growth_bound).contains(&identity.growth),
        "{identity:?}"
    );
}

/// The update (18) as printed enforces the mean of Φ over a step. From a start on the rows that is the same motion; it
/// holds every later violation instead of removing it, which is why the default enforces Φ_{n+1} = 0.
#[test]
fn the_mean_constraint_gives_the_same_motion_from_a_good_start() {
    let mean = run(&pendulum(), &Choice { constraint_at: Some("mean".into()), ..named("conserving") }, 0.025, 5.0);
    let end = run(&pendulum(), &named("conserving"), 0.025, 5.0);
    let difference = mean.position.iter().zip(&end.position).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()));
    assert!(difference <= 1e-10, "{difference}");
    assert!(mean.summary.energy.max_drift <= 1e-10);
}

/// The penalty formulation with the conserving scheme keeps the energy with that of its stiff springs (14).
#[test]
fn conserving_penalty_keeps_the_energy_with_that_of_the_rows() {
    let choice = Choice { formulation: Some("penalty".into()), penalty: Some(1e5), ..named("conserving") };
    let run = run(&pendulum(), &choice, 0.01, 5.0);
    assert_eq!(run.status, Status::Completed);
    assert!(run.summary.violation.position > 1e-6, "the rows give way");
    assert!(run.summary.energy.max_drift <= 1e-9, "{}", run.summary.energy.max_drift);
}
