//! The wiper by the closed form of a four-bar linkage and the power that its parts take.

use std::f64::consts::PI;

use super::jet::{Jet, Plate};
use crate::{Run, assert_follows};

/// Crank, rod, lever and base, m.
const LENGTHS: [f64; 4] = [0.045, 0.3, 0.08, 0.29];
const SPEED: f64 = 45.0 * PI / 30.0;

/// Torque of the motor at the crank, with masses `heavy` times those of the model.
fn torque(t: f64, heavy: f64) -> f64 {
    let [crank, rod, lever, base] = LENGTHS;
    let turn = Jet(SPEED * t, SPEED, 0.0);
    let [x, y] = [turn.cos() * crank, turn.sin() * crank];
    // The way from the crank pin to the arm's shaft, and the triangle over it.
    let [dx, dy] = [-x + base, -y];
    let square = dx * dx + dy * dy;
    let at_pin = ((square + (rod * rod - lever * lever)) / (square.sqrt() * (2.0 * rod))).acos();
    let rod_angle = Jet::atan2(dy, dx) + at_pin;
    let [pin_x, pin_y] = [x + rod_angle.cos() * rod, y + rod_angle.sin() * rod];
    let arm_angle = Jet::atan2(pin_y, pin_x + -base);
    let parts = [
        Plate { mass: 0.05, inertia: 0.05 * crank * crank / 12.0, place: [x * 0.5, y * 0.5], angle: turn },
        Plate { mass: 0.15, inertia: 0.15 * rod * rod / 12.0, place: [(x + pin_x) * 0.5, (y + pin_y) * 0.5], angle: rod_angle },
        Plate { mass: 0.6, inertia: 0.018, place: [arm_angle.cos() * -0.18 + base, arm_angle.sin() * -0.18], angle: arm_angle },
    ];
    let gravity = [0.0, -9.81 * (PI / 3.0).sin()];
    let moving: f64 = parts.iter().map(|part| part.power(gravity)).sum();
    let rubbing = 4.0 * (arm_angle.1 / 0.2).tanh() * arm_angle.1;
    (heavy * moving + rubbing) / SPEED
}

#[test]
fn the_motor_of_the_wiper() {
    let run = Run::of("wiper", &[]);
    assert_follows(&run, "motor.effort", 1e-12, |t| torque(t, 1.0));
}

#[test]
fn the_motor_of_a_wiper_of_other_masses_by_other_methods() {
    let heavy = [("body.crank.mass", "5"), ("body.rod.mass", "15"), ("body.arm.mass", "60"), ("body.arm.inertia", "1.8")];
    assert_follows(&Run::of("wiper", &heavy), "motor.effort", 1e-12, |t| torque(t, 100.0));
    for method in ["gauss", "bdf-3", "conserving-ggl"] {
        let run = Run::of("wiper", &[("simulation.method", method), ("simulation.step", "0.01")]);
        assert_follows(&run, "motor.effort", 1e-11, |t| torque(t, 1.0));
    }
}
