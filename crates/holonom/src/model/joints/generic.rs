use super::pair::{Pair, build};
use super::{AT, BETWEEN, JointKind, Site};
use crate::model::entry::Spot;
use crate::model::fault::{Read, suggest};
use crate::model::geometry::{cross, norm, scale, unit};
use crate::model::key::{Key, Kind, Shape};

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "generic",
        doc: "any of the six motions of two bodies against each other locked, along and about three axes of the first body; \
              locks of rotation hold for any others, but two alone are those of a joint with one free axis: locked rx and ry leave rz",
        equations: "x: d·x_A = 0, y: d·y_A = 0, z: d·z_A = 0, rx: y_A·z_B = 0, ry: z_A·x_B = 0, rz: x_A·y_B = 0",
        keys: &[
            BETWEEN,
            AT,
            Key::required("locks", Shape::Words(&LOCKS), "", "which motions are locked"),
            Key::optional(
                "axes",
                Shape::Directions,
                "those of the model",
                "any",
                "the x axis at the start, and a direction towards the y axis",
            ),
        ],
        example: r#"
[body.load]
mass = 1
shape = { box = [0.2, 0.1, 0.1] }
position = [0, 0, 0]

[joint.guide]
type = "generic"
between = ["ground", "load"]
at = [0, 0, 0]
locks = ["x", "y", "rx", "ry", "rz"]
"#,
        build,
    },
    freedom: [Some(6), None],
    at: Site::Given,
    axes: [0, 0],
    shares: [&[], &[]],
    rows,
};

const LOCKS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    let locks = locks(pair)?;
    let axes = axes(pair)?;
    pair.geometry.triad = [axes; 2];
    for k in 0..3 {
        match locks[k] {
            true => pair.stay(k),
            false => pair.displacement(LOCKS[k], k),
        }
    }
    for k in (0..3).filter(|&k| locks[3 + k]) {
        pair.perpendicular((k + 2) % 3, (k + 1) % 3);
    }
    if let ([free], 2) = (&(0..3).filter(|&k| !locks[3 + k]).collect::<Vec<_>>()[..], locks[3..].iter().filter(|lock| **lock).count()) {
        let form = pair.angle_between([(free + 1) % 3, (free + 2) % 3]);
        pair.coordinate("angle", form, true);
    }
    Ok(())
}

fn locks(pair: &Pair<'_, '_>) -> Read<[bool; 6]> {
    let mut locks = [false; 6];
    for (k, word) in pair.entry.texts("locks")?.into_iter().enumerate() {
        match LOCKS.iter().position(|lock| *lock == word) {
            Some(lock) => locks[lock] = true,
            None => {
                let spot = Spot { key: "locks", item: Some(k) };
                return Err(pair.entry.refuse(spot, format!("there is no lock \"{word}\""), suggest(word, LOCKS)));
            }
        }
    }
    match locks.contains(&true) {
        true => Ok(locks),
        false => {
            Err(pair.entry.refuse("locks", "a joint without locks holds nothing", "lock some of x, y, z, rx, ry, rz, or remove the joint"))
        }
    }
}

/// x, y and z of the joint at the start.
fn axes(pair: &Pair<'_, '_>) -> Read<[[f64; 3]; 3]> {
    if !pair.entry.has("axes") {
        return Ok([0, 1, 2].map(unit));
    }
    let [x, towards] = super::geometry::directions(pair.assembly, pair.entry, "axes")?;
    let z = cross(x, towards);
    let size = norm(z);
    if size < 1e-6 {
        return Err(pair.entry.refuse("axes", "the two axes are parallel", "give an x axis, and a direction towards the y axis"));
    }
    let z = scale(z, 1.0 / size);
    Ok([x, cross(z, x), z])
}
