//! The start: velocities and positions are put on the constraints, or refused with the rows named.

mod common;

use common::*;
use holonom::simulation::{Method, Simulation, StartError, Status, Verdict};
use holonom::system::{Place, System, SystemBuilder};

/// The paper's pendulum, its velocities pushed along the rod and apart, its outer mass moved by `off` along x.
fn pushed(off: f64) -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let inner = Place::Node(builder.free_node([1.0, 0.0, 0.0], [0.1, 0.5, 0.0]));
    let outer = Place::Node(builder.free_node([2.0 + off, 0.0, 0.0], [-0.2, 1.1, 0.3]));
    builder.mass(inner, inner, 1.0);
    builder.mass(outer, outer, 1.0);
    let (short, long) = (builder.square(&[(inner, 1.0)]), builder.square(&[(outer, 1.0), (inner, -1.0)]));
    builder.constant_row("inner-rod", short, 0.5);
    builder.constant_row("outer-rod", long, 0.5);
    for c in 0..3 {
        let mut e = [0.0; 3];
        e[c] = 1.0;
        let straight = builder.cross(e, &[(inner, 1.0)], &[(outer, 1.0), (inner, -1.0)]);
        builder.constant_row(format!("straight[{c}]"), straight, 0.0);
    }
    builder.build()
}

/// The mass-weighted projection keeps what turns the rod: the angular momentum about the support.
#[test]
fn velocities_off_the_constraints_are_projected_first() {
    for (name, choice) in every_method() {
        let system = pushed(0.0);
        let simulation = Simulation::new(system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
        assert!(simulation.start().turned > 0.1, "{name} says what it changed");
        assert!(simulation.audit().phi_dot < 1e-14, "{name}: {}", simulation.audit().phi_dot);
        let v = &simulation.state().v;
        // One angular rate about z and one about y: (1·0.5 + 2·1.1)/5 and (2·0.3)/5.
        let expected = [0.0, 0.54, 0.12, 0.0, 1.08, 0.24];
        for (found, expected) in v.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{name}: {v:?}");
        }
    }
}

#[test]
fn positions_slightly_off_are_moved_and_it_is_said() {
    let system = pushed(1e-3);
    let simulation = Simulation::new(system.clone(), Method::resolve(&named("conserving-ggl")).unwrap(), 0.01).unwrap();
    assert!((1e-4..2e-3).contains(&simulation.start().moved), "{}", simulation.start().moved);
    assert!(simulation.audit().phi < 1e-14);
}

/// Rods of one metre between supports three metres apart: no place for the point between them.
#[test]
fn positions_that_cannot_be_assembled_are_refused_with_their_rows() {
    let mut builder = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let point = Place::Node(builder.free_node([1.5, 0.0, 0.0], [0.0; 3]));
    builder.mass(point, point, 1.0);
    for (name, x) in [("left-rod", 0.0), ("right-rod", 3.0)] {
        let square = builder.square(&[(point, 1.0), (Place::Fixed([x, 0.0, 0.0]), -1.0)]);
        builder.constant_row(name, square, 0.5);
    }
    let system = builder.build();
    match Simulation::new(system.clone(), Method::resolve(&named("conserving-ggl")).unwrap(), 0.01).err() {
        Some(StartError::Position { rows }) => assert!(rows.contains("left-rod") && rows.contains("right-rod"), "{rows}"),
        other => panic!("{other:?}"),
    }
}

/// Steps with which no run ends, and an end that is none, are refused instead of passed over.
#[test]
fn times_that_lead_nowhere_are_refused() {
    let mut builder = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let point = Place::Node(builder.free_node([0.0; 3], [0.0; 3]));
    builder.mass(point, point, 1.0);
    let system = builder.build();
    let with = |step: f64| Simulation::new(system.clone(), Method::resolve(&named("conserving-ggl")).unwrap(), step);
    for step in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert!(matches!(with(step).err(), Some(StartError::Step { .. })), "a step of {step} s");
    }
    let mut simulation = with(0.01).unwrap();
    assert!(matches!(simulation.step_to(f64::NAN), Status::Stopped { at: 0.0, .. }));
    assert_eq!(simulation.step_to(0.1), Status::Completed);
    let reason = |step: f64, end: f64| match with(step).unwrap().run(end, &mut |_: &Simulation| Verdict::Stop) {
        Status::Stopped { at: 0.0, reason } => reason,
        other => panic!("{other:?}"),
    };
    // 2⁵² of them can be counted.
    for (step, end) in [(1e-30, 1.0), (1e-20, 1e-3), (1e-3, 1e17), (0.9_f64.powi(2) / 2.0_f64.powi(52), 1.0)] {
        assert!(reason(step, end).contains("more than can be counted"), "{step} s to {end} s");
    }
    for (step, end) in [(1e-9, 1.0), (1.1 / 2.0_f64.powi(52), 1.0), (1e-30, 1e-20), (1e-3, f64::INFINITY)] {
        assert_eq!(reason(step, end), "interrupted", "{step} s to {end} s");
    }
}
