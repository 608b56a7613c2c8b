//! The excavator's arm: each cylinder gives the third side of a triangle and with it an angle, two circles the place of the bucket's
//! link; the force of a cylinder is the virtual work along a metre of it, with the others held.

use std::f64::consts::{PI, TAU};

use super::jet::{Jet, Plate};
use crate::{Run, assert_follows};

const SOIL: f64 = 40e3;
/// Feet of the cylinders in the frames that carry them, and their eyes in those that they turn, whose pins are their origins.
const FEET: [[f64; 2]; 3] = [[0.9, -0.5], [2.2 - 5.0, 1.0], [0.3 - 2.2, 0.45]];
const EYES: [[f64; 2]; 3] = [[2.4, 0.5], [-0.9, 0.15], [0.5, 0.0]];
/// Angles of what they turn against what carries them, at the start.
const START: [f64; 3] = [PI / 6.0, -110.0 * PI / 180.0, 120.0 * PI / 180.0];
const STROKES: [f64; 3] = [0.05, 0.3, 0.5];

fn direction([x, y]: [f64; 2]) -> f64 {
    y.atan2(x)
}

fn length([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Length of a cylinder at an angle of what it turns, and the angle at a length on the same side.
fn reach(k: usize, angle: f64) -> f64 {
    let (foot, eye) = (length(FEET[k]), length(EYES[k]));
    let between = angle + direction(EYES[k]) - direction(FEET[k]);
    (foot * foot + eye * eye - 2.0 * foot * eye * between.cos()).sqrt()
}

fn angle(k: usize, reach: Jet) -> Jet {
    let (foot, eye) = (length(FEET[k]), length(EYES[k]));
    let between = ((-(reach * reach) + (foot * foot + eye * eye)) * (0.5 / (foot * eye))).acos();
    let at_start = (START[k] + direction(EYES[k]) - direction(FEET[k])).sin();
    between * at_start.signum() + (direction(FEET[k]) - direction(EYES[k]))
}

/// A place that is at `place` in a frame at `origin` turned by `angle`.
fn carried(origin: [Jet; 2], angle: Jet, [x, y]: [f64; 2]) -> [Jet; 2] {
    let (sin, cos) = (angle.sin(), angle.cos());
    [origin[0] + cos * x - sin * y, origin[1] + sin * x + cos * y]
}

fn middle(a: [Jet; 2], b: [Jet; 2]) -> [Jet; 2] {
    [(a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5]
}

/// Boom, stick, bucket, rocker and link, the teeth, and the angle of the bucket, with these lengths of the cylinders.
fn arm(reaches: [Jet; 3]) -> ([Plate; 5], [Jet; 2], Jet) {
    let boom = angle(0, reaches[0]);
    let stick = boom + angle(1, reaches[1]);
    let rocker = stick + angle(2, reaches[2]);
    let origin = [Jet::constant(0.0); 2];
    let elbow = carried(origin, boom, [5.0, 0.0]);
    let [wrist, pivot] = [2.6, 2.2].map(|x| carried(elbow, stick, [x, 0.0]));
    let end = carried(pivot, rocker, [0.5, 0.0]);
    let [dx, dy] = [end[0] - wrist[0], end[1] - wrist[1]];
    let way = (dx * dx + dy * dy).sqrt();
    let lever = Jet::atan2(dy, dx) - ((way * way + (0.4 * 0.4 - 0.5 * 0.5)) / (way * 0.8)).acos();
    let pin = carried(wrist, lever, [0.4, 0.0]);
    let bucket = lever + (-95.0 * PI / 180.0);
    let link = Jet::atan2(pin[1] - end[1], pin[0] - end[0]);
    let plate = |mass, inertia, place, angle| Plate { mass, inertia, place, angle };
    let parts = [
        plate(1500.0, 4000.0, carried(origin, boom, [2.3, 0.35]), boom),
        plate(800.0, 900.0, carried(elbow, stick, [0.9, 0.1]), stick),
        plate(700.0, 150.0, carried(wrist, bucket, [0.6, 0.25]), bucket),
        plate(40.0, 40.0 * 0.25 / 12.0, middle(pivot, end), rocker),
        plate(30.0, 30.0 * 0.25 / 12.0, middle(end, pin), link),
    ];
    (parts, carried(wrist, bucket, [1.4, 0.0]), bucket)
}

fn reaches(t: f64) -> [Jet; 3] {
    let w = TAU / 6.0;
    std::array::from_fn(|k| {
        let way = [t / 6.0 - (w * t).sin() / TAU, (1.0 - (w * t).cos()) / 6.0, w * (w * t).sin() / 6.0].map(|way| STROKES[k] * way);
        Jet(reach(k, START[k]) + way[0], way[1], way[2])
    })
}

/// Force of the cylinder `k`, with masses `heavy` times those of the model.
fn force(t: f64, k: usize, heavy: f64) -> f64 {
    let reaches = reaches(t);
    let (parts, _, bucket) = arm(reaches);
    let one = std::array::from_fn(|i| Jet(reaches[i].0, if i == k { 1.0 } else { 0.0 }, 0.0));
    let (ways, teeth, _) = arm(one);
    let moved: f64 = parts.iter().zip(&ways).map(|(part, way)| part.work(way, [0.0, -9.81])).sum();
    let dug = SOIL * (-bucket.0.sin() * teeth[0].1 + bucket.0.cos() * teeth[1].1);
    heavy * moved - dug
}

fn compare(run: &Run, heavy: f64) {
    for (k, name) in ["boom-cylinder", "stick-cylinder", "bucket-cylinder"].into_iter().enumerate() {
        assert_follows(run, &format!("{name}.effort"), 1e-11, |t| force(t, k, heavy));
    }
    assert_follows(run, "depth", 1e-12, |t| arm(reaches(t)).1[1].0);
}

#[test]
fn the_cylinders_of_the_excavator() {
    let run = Run::of("excavator", &[]);
    compare(&run, 1.0);
    assert_follows(&run, "bucket-pressure", 1e-11, |t| force(t, 2, 1.0) / (PI * 0.06 * 0.06) / 1e5);
}

/// The chapter's way to the force at which a relief valve opens: pressures are linear in the force of the soil.
#[test]
fn the_digging_force_of_the_excavator_at_250_bar() {
    let pressure = |soil: &str| {
        let run = Run::of("excavator", &[("parameters.soil", soil)]);
        run.column("bucket-pressure").iter().copied().fold(f64::MIN, f64::max)
    };
    let (empty, loaded) = (pressure("0"), pressure("40e3"));
    assert!((empty - 8.7758).abs() < 1e-4 && (loaded - 171.4033).abs() < 1e-4, "{empty} bar, {loaded} bar");
    let force = SOIL * (250.0 - empty) / (loaded - empty);
    assert!((force - 59.3e3).abs() < 50.0, "{force} N");
    assert!((pressure(&force.to_string()) - 250.0).abs() < 1e-9);
}

#[test]
fn the_cylinders_of_a_light_excavator_by_another_method() {
    let changes = [
        ("simulation.method", "conserving-ggl"),
        ("body.boom.mass", "150"),
        ("body.boom.inertia", "400"),
        ("body.stick.mass", "80"),
        ("body.stick.inertia", "90"),
        ("body.bucket.mass", "70"),
        ("body.bucket.inertia", "15"),
        ("body.rocker.mass", "4"),
        ("body.link.mass", "3"),
    ];
    compare(&Run::of("excavator", &changes), 0.1);
}
