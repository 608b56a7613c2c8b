//! Where a model lies, how it is turned, that it moves as a whole, and its mirror image.

use holonom::model::{Table, Value};

use super::cases::{BOUND, Case};
use super::change::{Change, Matrix, SAME, product, rotation};
use super::columns::{check_change, check_change_to};
use super::motion::Scale;
use super::sections::{entries, kind};

/// A rotation that a model can be turned by: of bushings, which are along the axes of the model, one by right angles.
fn turn(case: &Case) -> Matrix {
    let has_bushing = entries(&case.description).iter().any(|(_, _, entry)| kind(entry) == "bushing");
    match (case.dimension(), has_bushing) {
        (3, true) => [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        (3, false) => rotation([0.36, -0.48, 0.8], 1.234),
        (_, true) => [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        _ => rotation([0.0, 0.0, 1.0], 1.234),
    }
}

fn shift(case: &Case, by: [f64; 3]) -> [f64; 3] {
    if case.dimension() == 3 { by } else { [by[0], by[1], 0.0] }
}

#[test]
fn turned_and_moved() {
    check_change("a rigid motion", |case| {
        let size = case.scale.length;
        Some(Change { turn: turn(case), shift: shift(case, [0.7 * size, -1.1 * size, 0.4 * size]), ..Change::default() })
    });
}

#[test]
fn turned_only() {
    check_change("turned", |case| Some(Change { turn: turn(case), ..Change::default() }));
}

/// Places of 1e4 m are rounded by 2e-12 m: angles by that over the smallest body, velocities by that over the step. Every step
/// may add one of these, as `conserving` keeps what it once has. Models that make more of round-off do so of this, too.
#[test]
fn far_from_the_origin() {
    const FAR: f64 = 1e4;
    let bound = |case: &Case| {
        let Scale { length, speed, spin, lever } = case.scale;
        let rounded = FAR * f64::EPSILON;
        let places = (rounded / length).max(rounded / lever);
        let velocities = (rounded / speed).max(rounded / lever / spin) / case.step;
        case.bound * (1.0 + case.steps as f64 * places.max(velocities) / BOUND)
    };
    check_change_to("shifted by 1e4 m", &bound, |case| Some(Change { shift: shift(case, [FAR, -FAR, 0.5 * FAR]), ..Change::default() }));
}
#[test]
fn mirrored() {
    let mirror = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Axes of a body may be turned over along x; those of a beam follow from its ends.
    let without_beams = |case: &Case| entries(&case.description).iter().all(|(section, ..)| *section != "beam");
    check_change("mirrored", |case| without_beams(case).then(|| Change { turn: mirror, ..Change::default() }));
    check_change("mirrored and turned", |case| {
        without_beams(case).then(|| Change { turn: product(&turn(case), &mirror), ..Change::default() })
    });
}

/// Models that are tied to no place may move at any speed.
#[test]
fn moving_as_a_whole() {
    let free = std::cell::RefCell::new(Vec::new());
    check_change("a Galilean shift", |case| {
        if touches_ground(&case.description) {
            return None;
        }
        free.borrow_mut().push(case.name.clone());
        let speed = case.scale.speed;
        Some(Change { drift: shift(case, [0.8 * speed, -0.5 * speed, 0.3 * speed]), ..Change::default() })
    });
    let mut free = free.into_inner();
    free.dedup();
    assert_eq!(free, FREE, "models that are tied to no place");
}

/// Models that no place holds.
const FREE: &[&str] = &[
    "free-body",
    "drifting",
    "joint:fixed",
    "joint:constant-velocity",
    "constraint:fixed",
    "constraint:expression",
    "force:force",
    "force:torque",
    "force:constant",
    "force:expression",
];

/// Whether a model is tied to places: to `"ground"`, to fixed or driven points, or to numbers.
fn touches_ground(description: &Table) -> bool {
    let is_place = |value: &Value| match value {
        Value::Text(text) => text == "ground",
        Value::List(items) => items.iter().all(|item| matches!(item, Value::Number(_))),
        _ => false,
    };
    let has_place = |value: &Value| match value {
        Value::List(items) => items.iter().any(is_place),
        other => is_place(other),
    };
    entries(description).iter().any(|(section, _, entry)| match (*section, kind(entry)) {
        ("point", _) => entry.get("fixed") == Some(&Value::Bool(true)) || entry.get("motion").is_some(),
        ("drive", "point") | ("constraint", "point-on-plane") => true,
        ("constraint", "fixed") => entry.get("point").is_some(),
        ("constraint", "point-on-line") => entry.get("direction").is_some(),
        ("constraint", _) => ["between", "points", "first", "second"].iter().any(|key| entry.get(key).is_some_and(has_place)),
        _ => entry.get("between").is_some_and(has_place),
    })
}

/// Every key put together anew by shape and unit, without any change.
#[test]
fn changes_that_change_nothing() {
    check_change("put together anew", |_| Some(Change { turn: SAME, ..Change::default() }));
}
