//! The bicycle by the linear equations of lean and steer that Meijaard, Papadopoulos, Ruina and Schwab (2007) print.

use crate::{Run, assert_follows, runge_kutta};

/// M, of the accelerations of lean and steer, both to the right.
const MASS: [[f64; 2]; 2] = [[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]];
/// K₀, times g, and K₂, times the square of the speed: of lean and steer.
const OF_GRAVITY: [[f64; 2]; 2] = [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]];
const OF_SPEED: [[f64; 2]; 2] = [[0.0, 76.59734589573222], [0.0, 2.65431523794604]];
/// C₁, times the speed: of the rates.
const OF_RATES: [[f64; 2]; 2] = [[0.0, 33.86641391492494], [-0.85035641456978, 1.6854039739756]];

/// Lean and steer with their rates, every five milliseconds.
fn motion(speed: f64, fall: f64) -> Vec<[f64; 4]> {
    let rates = |_: f64, [lean, steer, lean_rate, steer_rate]: [f64; 4]| {
        let pull = [0, 1].map(|k| {
            let stiffness = [0, 1].map(|i| 9.81 * OF_GRAVITY[k][i] + speed * speed * OF_SPEED[k][i]);
            -stiffness[0] * lean - stiffness[1] * steer - speed * (OF_RATES[k][0] * lean_rate + OF_RATES[k][1] * steer_rate)
        });
        let acceleration = crate::solve(MASS, pull);
        [lean_rate, steer_rate, acceleration[0], acceleration[1]]
    };
    runge_kutta(rates, [0.0, 0.0, fall, 0.0], 5e-3, 10, 10.0)
}

fn compare(run: &Run, speed: f64, fall: f64) {
    let states = motion(speed, fall);
    let at = |t: f64| states[(t / 5e-3).round() as usize];
    // What is not linear in the leans that follow is a share of their squares.
    assert_follows(run, "lean", 1e-6, |t| at(t)[0].to_degrees());
    assert_follows(run, "steer", 1e-6, |t| at(t)[1].to_degrees());
}

#[test]
fn the_bicycle_rides_by_itself() {
    compare(&Run::of("bicycle", &[]), 5.0, 1e-3);
}

/// Where it weaves, and where its lean grows.
#[test]
fn slow_and_fast_bicycles_fall() {
    for speed in [4.25, 7.0] {
        let changes = [("parameters.speed", &*speed.to_string()), ("parameters.fall", "1e-4"), ("simulation.step", "5e-3")];
        compare(&Run::of("bicycle", &changes), speed, 1e-4);
    }
}
