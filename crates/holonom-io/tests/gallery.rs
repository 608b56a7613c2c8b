//! The gallery against reference solutions computed elsewhere in 113-bit arithmetic.

mod common;

use common::example;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, Simulation, Status, Summary, Verdict};
use holonom::system::Place;

/// Runs a model; the place of a point at the end, and the summary.
fn run(model: &Model, method: &str, step: f64, end: f64, point: &str) -> ([f64; 2], Summary) {
    let method = Method::resolve(&Choice::default().named(method)).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
    let status = simulation.run(end, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed);
    let found = model.points.iter().find(|known| known.name == point).expect("the point is there");
    let Place::Node(node) = found.place else { panic!("{point} moves") };
    let at = node.index() * model.dimension;
    let size = holonom::analysis::rank(&model.system, &simulation.state().x, end).size(&model.system);
    ([simulation.state().x[at], simulation.state().x[at + 1]], simulation.summary("test", end, &status, size))
}

struct Reference {
    model: &'static str,
    point: &'static str,
    end: f64,
    place: [f64; 2],
    /// Coarser of the two steps between which the order is measured, s.
    step: f64,
}

const REFERENCES: &[Reference] = &[
    Reference { model: "car-axis", point: "right", end: 3.0, place: [1.04174252488543, 0.373911027265366], step: 1e-3 },
    Reference { model: "simple-pendulum", point: "bob", end: 10.0, place: [-0.275087462576117, -0.961419205099125], step: 1e-2 },
    Reference { model: "double-pendulum", point: "m2", end: 2.0, place: [0.458295895031555, -1.29605879684337], step: 1e-3 },
    Reference { model: "spring-pendulum", point: "bob", end: 2.0, place: [0.787163379341288, -0.619690574822012], step: 1e-4 },
    Reference { model: "chain", point: "P[10]", end: 1.0, place: [7.52722901556036, -4.906262319715], step: 2e-3 },
];

/// Errors against the reference fall with order two, for both conserving schemes.
#[test]
fn examples_converge_to_their_references() {
    for Reference { model: name, point, end, place, step } in REFERENCES {
        let model = example(name);
        for method in ["conserving", "conserving-ggl"] {
            let error = |step: f64| {
                let (found, _) = run(&model, method, step, *end, point);
                (found[0] - place[0]).hypot(found[1] - place[1])
            };
            let (coarse, fine) = (error(*step), error(0.5 * step));
            let order = (coarse / fine).log2();
            println!("{name}, {method}: error {fine:.2e} at {} s, order {order:.3}", 0.5 * step);
            assert!((order - 2.0).abs() < 0.1, "{name}, {method}: order {order}, error {fine:e}");
        }
    }
}

/// The road does work on the car axis of about 1e-3; the balance closes with it to round-off.
#[test]
fn the_work_of_the_road_closes_the_balance() {
    for method in ["conserving", "conserving-ggl"] {
        let (_, summary) = run(&example("car-axis"), method, 1e-3, 3.0, "right");
        assert!(summary.energy.work_total.abs() > 1e-5);
        assert!(summary.energy.max_drift < 1e-10 * summary.energy.work_total.abs(), "{}", summary.energy.max_drift);
    }
}

/// Drives, dampers, friction and engines do work on these; the balance closes to a billionth of what goes through.
#[test]
fn driven_and_damped_models_close_their_balance() {
    for name in ["robot-arm", "stewart-platform", "jansen-linkage", "differential", "flyball-governor", "suspension", "andrews"] {
        let model = example(name);
        let (step, end) = (model.settings.step.expect("a step"), model.settings.end.expect("an end").min(1.0));
        for method in ["conserving", "conserving-ggl"] {
            let method = Method::resolve(&Choice::default().named(method)).unwrap();
            let label = method.name.clone();
            let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
            // What has gone back and forth between kinetic and potential energy, and what was done from outside.
            let (mut through, mut before) = (0.0, [simulation.audit().kinetic, simulation.audit().work]);
            let status = simulation.run(end, &mut |simulation: &Simulation| {
                let now = [simulation.audit().kinetic, simulation.audit().work];
                through += (now[0] - before[0]).abs() + (now[1] - before[1]).abs();
                before = now;
                Verdict::GoOn
            });
            assert_eq!(status, Status::Completed, "{name}, {label}");
            let drift = simulation.audit().energy_summary().max_drift;
            println!("{name:20} {label:16} {drift:8.1e} J of {through:8.1e} J");
            assert!(drift <= 1e-9 * through, "{name}, {label}: {drift:e} J of {through:e} J");
        }
    }
}
