//! The double wishbone: each arm and the upright turn about a known axis until a distance is right, which is a trigonometric equation;
//! the wheel load is what the potential energy changes by with the travel.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use crate::{Run, assert_follows};

type V = Vector3<f64>;

const LOWER: [V; 2] = [V::new(0.0, 0.35, 0.2), V::new(1.0, 0.05, 0.03)];
const UPPER: [V; 2] = [V::new(0.0, 0.42, 0.49), V::new(1.0, -0.04, -0.08)];
const BALLS: [V; 2] = [V::new(0.0, 0.72, 0.19), V::new(-0.02, 0.66, 0.51)];
const TIE: [V; 2] = [V::new(-0.12, 0.37, 0.26), V::new(-0.13, 0.69, 0.26)];
const WHEEL: V = V::new(0.0, 0.75, 0.32);

/// A place turned about an axis through a point.
fn turned(place: V, [through, axis]: [V; 2], angle: f64) -> V {
    through + Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle) * (place - through)
}

/// The smaller angle by which a place is turned about an axis to get to a distance from another.
fn turn_to_reach(place: V, axis: [V; 2], other: V, distance: f64) -> f64 {
    let u = axis[1].normalize();
    let (r, q) = (place - axis[0], other - axis[0]);
    let across = r - u * u.dot(&r);
    let (cos, sin) = (q.dot(&across), q.dot(&u.cross(&across)));
    let level = 0.5 * (r.norm_squared() + q.norm_squared() - distance * distance) - u.dot(&r) * u.dot(&q);
    let (middle, half) = (sin.atan2(cos), (level / cos.hypot(sin)).acos());
    [middle - half, middle + half].into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
}

/// Axes of the upright that go with the way between its balls.
fn triad(way: V) -> Matrix3<f64> {
    let along = way.normalize();
    let ahead = (V::x() - along * along.x).normalize();
    Matrix3::from_columns(&[along, ahead, along.cross(&ahead)])
}

/// Where everything is at a turn of the lower arm: the turn of the upper one, and place and rotation of the upright.
struct Pose {
    angles: [f64; 2],
    wheel: V,
    rotation: Matrix3<f64>,
}

fn pose(lower: f64) -> Pose {
    let ball = turned(BALLS[0], LOWER, lower);
    let upper = turn_to_reach(BALLS[1], UPPER, ball, (BALLS[1] - BALLS[0]).norm());
    let way = turned(BALLS[1], UPPER, upper) - ball;
    let rotation = triad(way) * triad(BALLS[1] - BALLS[0]).transpose();
    let pin = [ball, way];
    let turn = turn_to_reach(ball + rotation * (TIE[1] - BALLS[0]), pin, TIE[0], (TIE[1] - TIE[0]).norm());
    let rotation = Rotation3::from_axis_angle(&Unit::new_normalize(way), turn).into_inner() * rotation;
    Pose { angles: [lower, upper], wheel: ball + rotation * (WHEEL - BALLS[0]), rotation }
}

/// The pose at a travel of the wheel, m, by the secant method.
fn at(travel: f64) -> Pose {
    let off = |angle: f64| pose(angle).wheel.z - WHEEL.z - travel;
    let (mut last, mut angle) = (0.0, travel / 0.4 + 1e-3);
    for _ in 0..30 {
        let slope = (off(angle) - off(last)) / (angle - last);
        if !slope.is_normal() {
            break;
        }
        (last, angle) = (angle, angle - off(angle) / slope);
    }
    pose(angle)
}

/// Energy of the spring and of all weights but the plate's, J.
fn potential(travel: f64) -> f64 {
    let pose = at(travel);
    let lower = |place: V| turned(place, LOWER, pose.angles[0]);
    let spring = (lower(V::new(0.0, 0.58, 0.22)) - V::new(0.0, 0.45, 0.65)).norm() - 0.53;
    let heights =
        6.0 * lower(V::new(0.02, 0.52, 0.2)).z + 3.0 * turned(V::new(-0.01, 0.54, 0.5), UPPER, pose.angles[1]).z + 25.0 * pose.wheel.z;
    0.5 * 4e4 * spring * spring + 9.81 * heights
}

/// Its derivative by the travel, from four differences.
fn load(travel: f64) -> f64 {
    let h = 1e-3;
    let difference = |h: f64| potential(travel + h) - potential(travel - h);
    (8.0 * difference(h) - difference(2.0 * h)) / (12.0 * h)
}

fn travel(t: f64, period: f64) -> f64 {
    0.08 * (std::f64::consts::TAU * t / period).sin()
}

fn compare_angles(run: &Run, period: f64) {
    let axis = |t: f64| at(travel(t, period)).rotation * V::y();
    assert_follows(run, "camber", 1e-9, |t| (-axis(t).z.asin()).to_degrees());
    assert_follows(run, "toe", 1e-9, |t| axis(t).x.atan2(axis(t).y).to_degrees());
}

#[test]
fn camber_and_toe_of_the_wishbone() {
    compare_angles(&Run::of("wishbone", &[]), 1.0);
}

/// So slowly that nothing but springs and weights is felt.
#[test]
fn the_wheel_load_of_the_wishbone() {
    let slow = [("drive.rig.profile", "80*mm*sin(tau*t/1e6)"), ("simulation.end", "1e6"), ("simulation.step", "12500")];
    let run = Run::of("wishbone", &slow);
    compare_angles(&run, 1e6);
    assert_follows(&run, "rig.effort", 1e-8, |t| load(travel(t, 1e6)) + 20.0 * 9.81);
}
