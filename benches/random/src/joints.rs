//! Random joints between two bodies. A joint is defined by where it sits at the start, so that any joint fits there.

use nalgebra::Vector3;

use crate::layout::Layout;
use crate::mechanism::{Key, list, number, text, vector};
use crate::random::Random;

/// Kinds in space; what is there more than once is more frequent.
const IN_SPACE: &[&str] = &[
    "spherical",
    "spherical",
    "revolute",
    "revolute",
    "revolute",
    "revolute",
    "universal",
    "prismatic",
    "prismatic",
    "cylindrical",
    "planar",
    "fixed",
    "screw",
    "constant-velocity",
    "point-on-line",
    "point-on-plane",
    "parallel",
    "perpendicular",
    "orientation",
    "distance",
    "generic",
    "generic",
];

/// Kinds in the plane.
const IN_PLANE: &[&str] =
    &["revolute", "revolute", "revolute", "revolute", "prismatic", "prismatic", "point-on-line", "distance", "fixed", "orientation"];

/// Kinds whose second side may be a particle, in space and in the plane.
const OF_POINTS: [&[&str]; 2] = [&["spherical", "distance", "point-on-line", "point-on-plane"], &["distance", "point-on-line"]];

/// Motions that a generic joint locks.
const LOCKS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// A joint that is to be written.
#[derive(Clone)]
pub struct Joint {
    pub name: String,
    /// Names of its two sides.
    pub between: [String; 2],
    pub second_is_point: bool,
    /// Where it sits, m.
    pub at: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub kind: &'static str,
    /// Names of its coordinates, and whether they are angles.
    pub coordinates: Vec<(&'static str, bool)>,
    pub keys: Vec<Key>,
}

/// A kind of joint.
pub fn kind(random: &mut Random, dim: usize, second_is_point: bool) -> &'static str {
    match (second_is_point, dim) {
        (true, _) => random.pick(OF_POINTS[usize::from(dim == 2)]),
        (false, 2) => random.pick(IN_PLANE),
        _ => random.pick(IN_SPACE),
    }
}

impl Joint {
    /// Chooses what its kind needs beside place and axis. `far` is a place on the second side away from the joint's.
    pub fn complete(mut self, random: &mut Random, layout: &mut Layout, far: &Vector3<f64>, size: f64) -> Self {
        let dim = layout.dim;
        let at = ("at", vector(dim, &self.at));
        let axis = ("axis", vector(dim, &self.axis));
        let (mut keys, coordinates) = match self.kind {
            "revolute" if dim == 2 => (vec![at], vec![("angle", true)]),
            "revolute" => (vec![at, axis], vec![("angle", true)]),
            "prismatic" | "point-on-line" => (vec![at, axis], vec![("displacement", false)]),
            "cylindrical" => (vec![at, axis], vec![("angle", true), ("displacement", false)]),
            "planar" => (vec![at, axis], vec![("angle", true), ("x", false), ("y", false)]),
            "point-on-plane" => (vec![at, axis], vec![("x", false), ("y", false)]),
            "parallel" => (vec![at, axis], vec![("angle", true)]),
            "screw" => {
                let pitch = size * random.log_between(0.01, 10.0) * random.sign();
                (vec![at, axis, ("pitch", number(pitch))], vec![("angle", true), ("displacement", false)])
            }
            "universal" => (vec![at, self.axes(random, true)], vec![("angle1", true), ("angle2", true)]),
            "perpendicular" => (vec![at, self.axes(random, true)], vec![]),
            "constant-velocity" => (vec![at, self.axes(random, false)], vec![]),
            "generic" => {
                let (locks, coordinates) = locks(random);
                (vec![at, self.axes(random, true), ("locks", locks)], coordinates)
            }
            "distance" => (vec![("at", list([&self.at, far].map(|place| vector(dim, place))))], vec![]),
            _ => (vec![at], vec![]),
        };
        let [a, b] = &self.between;
        keys.splice(0..0, [("type", text(self.kind)), ("between", list([text(a), text(b)]))]);
        (self.keys, self.coordinates) = (keys, coordinates);
        self
    }

    /// Two axes, at a right angle or as those of two shafts.
    fn axes(&self, random: &mut Random, right: bool) -> Key {
        let across = random.across(&self.axis);
        let bend = random.pick(&[0.0, 0.3, 1.0]);
        let other = if right { across } else { self.axis + across * bend };
        ("axes", list([&self.axis, &other].map(|u| vector(3, u))))
    }
}

/// Some locks, and the coordinates of the motions that are left.
fn locks(random: &mut Random) -> (String, Vec<(&'static str, bool)>) {
    let certain = random.below(6);
    let is_locked: Vec<bool> = (0..6).map(|k| k == certain || random.chance(0.5)).collect();
    let locked = (0..6).filter(|&k| is_locked[k]).map(|k| text(LOCKS[k]));
    let mut free: Vec<_> = (0..3).filter(|&k| !is_locked[k]).map(|k| (LOCKS[k], false)).collect();
    if is_locked[3..].iter().filter(|locked| **locked).count() == 2 {
        free.push(("angle", true));
    }
    (list(locked), free)
}
