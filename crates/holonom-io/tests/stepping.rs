//! Simulations that a program steps: to times a hair ahead of where they are, and on when what made a step fail is mended.

mod common;

use common::model;
use holonom::simulation::{Choice, Method, Simulation, Status};

const PENDULUM: &str = "plane = \"xy\"\ngravity = [0, -10]\n[input.push]\n[point.inner]\nmass = 1\nposition = [1, 0]\n\
                        [point.outer]\nmass = 1\nposition = [2, 0]\n\
                        [constraint.first]\ntype = \"distance\"\nbetween = [[0, 0], \"inner\"]\n\
                        [constraint.second]\ntype = \"distance\"\nbetween = [\"inner\", \"outer\"]\n\
                        [force.thrust]\ntype = \"expression\"\npoint = \"outer\"\nforce = [\"sqrt(1 + push) - 1\", 0]\n";

fn simulation(method: &str, accuracy: Option<f64>) -> Simulation {
    let method = Method::resolve(&Choice { accuracy, ..Choice::default().named(method) }).unwrap();
    Simulation::new(model(PENDULUM).system, method, 0.002).unwrap()
}

fn outer(simulation: &Simulation) -> [f64; 2] {
    let x = &simulation.state().x;
    [x[2], x[3]]
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A host whose clock is a rounding, or a little more, ahead of the last state: steps over which a rounding of positions would be a
/// velocity are not taken, and after short ones no method goes on from the accelerations that rounding makes.
#[test]
fn times_a_hair_ahead_change_nothing() {
    for method in ["conserving-ggl", "conserving", "trapezoidal-projected", "generalized-alpha", "newmark", "bdf", "rattle", "radau"] {
        let mut exact = simulation(method, None);
        assert_eq!(exact.step_to(0.4), Status::Completed);
        for hair in [1e-16, 1e-13, 1e-11, 1e-8] {
            let mut other = simulation(method, None);
            for t in [0.1, 0.1 + hair, 0.2, 0.2 + hair, 0.4] {
                assert_eq!(other.step_to(t), Status::Completed, "{method}, {hair:e} s");
                assert!((other.state().t - t).abs() <= hair.min(2e-9) + 1e-15, "{method}, {hair:e} s");
            }
            // Steps that begin a hair later are other steps, with errors of the same order.
            let off = apart(outer(&exact), outer(&other));
            assert!(off < 1e-4, "{method}, {hair:e} s: {off:e} m");
        }
    }
}

/// A force that had no value for a while.
#[test]
fn a_run_that_failed_goes_on_when_its_cause_is_mended() {
    for method in ["conserving-ggl", "radau", "bdf", "generalized-alpha", "dopri5"] {
        for accuracy in [None, Some(1e-6)] {
            let choice = if method == "dopri5" { "ode/dopri5" } else { method };
            let mut simulation = simulation(choice, accuracy);
            assert_eq!(simulation.step_to(0.1), Status::Completed);
            assert!(simulation.set_input("push", -2.0));
            assert!(matches!(simulation.step_to(0.2), Status::Stopped { .. }), "{method}, {accuracy:?}");
            assert!(simulation.set_input("push", 0.0));
            assert_eq!(simulation.step_to(0.2), Status::Completed, "{method}, {accuracy:?}");
            let mut other = self::simulation("radau", Some(1e-9));
            assert_eq!(other.step_to(0.2), Status::Completed);
            let off = apart(outer(&simulation), outer(&other));
            assert!(off < 1e-4, "{method}, {accuracy:?}: {off:e} m");
        }
    }
}

#[test]
fn an_accuracy_is_that_of_a_run_with_an_end() {
    let status = simulation("radau", Some(1e-6)).step_to(f64::INFINITY);
    assert!(matches!(&status, Status::Stopped { reason, .. } if reason.contains("a run with an end")), "{status:?}");
}
