//! The scissor lift by the angle of its arms, which the length of the cylinder gives, and the power that its parts take.

use std::f64::consts::{PI, TAU};

use super::jet::{Jet, Plate};
use crate::{Run, assert_follows};

const ARM: f64 = 2.0;
const BASE: f64 = 1.4;
const EYE: f64 = 0.6;

/// Length of the cylinder, and the angle of the arms.
fn motion(t: f64) -> [Jet; 2] {
    let w = TAU / 12.0;
    let closed = (BASE * BASE + EYE * EYE - 2.0 * BASE * EYE * (PI / 15.0).cos()).sqrt();
    let stroke = |way: f64, rate: f64, second: f64| Jet(closed + 0.39 * way, 0.39 * rate, 0.39 * second);
    let length = stroke(t / 12.0 - (w * t).sin() / TAU, (1.0 - (w * t).cos()) / 12.0, w * (w * t).sin() / 12.0);
    [length, angle_of(length)]
}

/// Angle of the arms with this length of the cylinder: the cosine theorem.
fn angle_of(length: Jet) -> Jet {
    ((-(length * length) + (BASE * BASE + EYE * EYE)) * (0.5 / (BASE * EYE))).acos()
}

/// Force of the cylinder with this mass of the platform in this gravity: the virtual work along a metre of the cylinder.
fn force(t: f64, platform: f64, gravity: f64) -> f64 {
    let [length, angle] = motion(t);
    let parts = |angle: Jet| {
        let [w, h] = [angle.cos() * ARM, angle.sin() * ARM];
        let arm = |level: f64, sign: f64| Plate {
            mass: 40.0,
            inertia: 40.0 / 12.0 * (ARM * ARM + 0.05 * 0.05),
            place: [w * 0.5, h * (level + 0.5)],
            angle: angle * sign,
        };
        // The pin of the platform goes straight up above that of the floor.
        let start = PI / 15.0;
        let place = [Jet::constant(0.5 * ARM * start.cos() + 0.3), h * 2.0 + 0.4];
        let top = Plate { mass: platform, inertia: 300.0, place, angle: Jet::constant(0.0) };
        [arm(0.0, 1.0), arm(0.0, -1.0), arm(1.0, 1.0), arm(1.0, -1.0), top]
    };
    let ways = parts(angle_of(Jet(length.0, 1.0, 0.0)));
    parts(angle).iter().zip(&ways).map(|(part, way)| part.work(way, [0.0, -gravity])).sum()
}

#[test]
fn the_cylinder_of_the_scissor_lift() {
    let run = Run::of("scissor", &[]);
    assert_follows(&run, "cylinder.effort", 1e-12, |t| force(t, 600.0, 9.81));
    assert_follows(&run, "length", 1e-12, |t| 1e3 * motion(t)[0].0);
    assert_follows(&run, "height", 1e-12, |t| 2.0 * ARM * motion(t)[1].0.sin());
}

#[test]
fn the_cylinder_of_a_scissor_lift_on_the_moon_with_another_load() {
    let changes = [("gravity", "[0, -1.62]"), ("body.platform.mass", "6000"), ("simulation.method", "conserving-ggl")];
    assert_follows(&Run::of("scissor", &changes), "cylinder.effort", 1e-12, |t| force(t, 6000.0, 1.62));
}
