//! The gyroscope by Lagrange's equations in the turn of the frame and the tilt of the gimbal; the momenta of the spin and of the
//! turn are constant.

use std::f64::consts::{FRAC_PI_3, PI};

use crate::{Run, assert_follows, runge_kutta};

/// Moment of inertia of the rotor about its axis and across.
const ROTOR: [f64; 2] = [0.5 * 0.05 * 0.05, (3.0 * 0.05 * 0.05 + 0.02 * 0.02) / 12.0];
/// Mass of the weight times its arm, kg·m, and its own moment of inertia.
const WEIGHT: f64 = 0.05 * 0.1;
const BALL: f64 = 0.4 * 0.05 * 0.01 * 0.01;
/// What turns with the gimbal: about the trunnion, across, and about the axis of the rotor without it.
const ABOUT: [f64; 3] = [9e-4 + ROTOR[1] + 0.1 * WEIGHT + BALL, 5e-4 + ROTOR[1] + 0.1 * WEIGHT + BALL, 6e-4 + BALL];
const SPIN: f64 = 3000.0 * PI / 30.0;

/// Rate of the frame at a tilt: the moment about the vertical is that of the start.
fn precession(tilt: f64, speed: f64) -> f64 {
    let (sin, cos) = tilt.sin_cos();
    ROTOR[0] * speed * SPIN * (FRAC_PI_3.cos() - cos) / (1.5e-3 + ABOUT[1] * sin * sin + ABOUT[2] * cos * cos)
}

/// Turn of the frame, tilt of the gimbal and its rate, every half of a millisecond.
fn motion(speed: f64) -> Vec<[f64; 3]> {
    let rates = |_: f64, [_, tilt, rate]: [f64; 3]| {
        let (sin, cos) = tilt.sin_cos();
        let turn = precession(tilt, speed);
        let moment = (ABOUT[1] - ABOUT[2]) * sin * cos * turn * turn - ROTOR[0] * speed * SPIN * turn * sin + WEIGHT * 9.81 * sin;
        [turn, rate, moment / ABOUT[0]]
    };
    runge_kutta(rates, [0.0, FRAC_PI_3, 0.0], 5e-4, 20, 1.0)
}

fn compare(run: &Run, speed: f64) {
    let states = motion(speed);
    let at = |t: f64| states[(t / 5e-4).round() as usize];
    assert_follows(run, "base.angle", 1e-7, |t| at(t)[0]);
    assert_follows(run, "precession", 1e-6, |t| precession(at(t)[1], speed));
    assert_follows(run, "nutation", 1e-6, |t| (at(t)[1] - FRAC_PI_3).to_degrees());
    assert_follows(run, "spin", 1e-8, |t| (speed * SPIN - precession(at(t)[1], speed) * at(t)[1].cos()) * 30.0 / PI);
}

#[test]
fn the_gimbals_of_the_gyroscope_precess_and_nutate() {
    compare(&Run::of("gimbal", &[]), 1.0);
}

/// With a quarter of the spin, by another method.
#[test]
fn the_gimbals_of_a_slow_gyroscope() {
    let spin = "[0, \"750*rpm*sin(tilt)\", \"750*rpm*cos(tilt)\"]";
    compare(&Run::of("gimbal", &[("body.rotor.angular_velocity", spin), ("simulation.method", "radau")]), 0.25);
}
