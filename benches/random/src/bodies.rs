//! Random bodies: solid, thin to the last digit, or nearly points.

use nalgebra::Vector3;

use crate::mechanism::{Key, list, number};
use crate::random::Random;

/// How much thinner than long a needle may be, and how much smaller than its mechanism a body that is nearly a point.
const THINNEST: f64 = 1e-6;

/// The keys of shape and inertia of a body of a size (m) and mass (kg).
pub fn substance(random: &mut Random, dim: usize, size: f64, mass: f64) -> Vec<Key> {
    let edge = |random: &mut Random| size * random.log_between(0.1, 1.0);
    let shape = |key: &str, value: String| vec![("shape", format!("{{ {key} = {value} }}"))];
    match random.below(10) {
        0..=2 => shape("box", list((0..3).map(|_| number(edge(random))))),
        3 => shape("cylinder", list([number(edge(random)), number(edge(random))])),
        4 => shape("sphere", number(edge(random))),
        5 | 6 => shape("rod", number(edge(random))),
        7 => shape("cylinder", list([number(size * random.log_between(THINNEST, 0.1)), number(size)])),
        8 => shape("sphere", number(size * random.log_between(THINNEST, 0.1))),
        _ => vec![("inertia", plate(dim, mass, [edge(random), edge(random)]))],
    }
}

/// The inertia of a plate with these edges, without thickness.
fn plate(dim: usize, mass: f64, edges: [f64; 2]) -> String {
    let [x, y] = edges.map(|edge| mass * edge * edge / 12.0);
    if dim == 2 { number(x + y) } else { list([x, y, x + y].map(number)) }
}

/// The key of how a body is turned; bodies along the axes of the model have none.
pub fn orientation(random: &mut Random, dim: usize) -> Option<Key> {
    if random.chance(0.4) {
        return None;
    }
    Some(match dim {
        2 => ("orientation", format!("{{ angle = {} }}", number(random.between(-3.0, 3.0)))),
        _ => ("orientation", format!("{{ quat_wxyz = {} }}", list(random.quaternion().map(number)))),
    })
}

/// How the bodies of a mechanism move at the start.
pub enum Motion {
    Still,
    /// As one, about a place: it fits joints between bodies.
    Turning {
        about: Vector3<f64>,
        spin: Vector3<f64>,
    },
    /// Each as it likes: the start makes velocities of it that fit.
    Wild {
        size: f64,
        rate: f64,
    },
}

impl Motion {
    /// A motion with a rate (1/s) of a mechanism of a size (m).
    pub fn new(random: &mut Random, dim: usize, about: Vector3<f64>, size: f64, rate: f64) -> Self {
        let axis = if dim == 3 { random.direction(3) } else { Vector3::z() };
        match random.below(3) {
            0 => Self::Still,
            1 => Self::Turning { about, spin: axis * rate },
            _ => Self::Wild { size, rate },
        }
    }

    /// Velocity (m/s) and angular velocity (rad/s) of a body.
    pub fn of(&self, random: &mut Random, dim: usize, centre: &Vector3<f64>) -> Option<[Vector3<f64>; 2]> {
        match self {
            Self::Still => None,
            Self::Turning { about, spin } => Some([spin.cross(&(centre - about)), *spin]),
            Self::Wild { size, rate } => {
                let spin = if dim == 3 { random.direction(3) } else { Vector3::z() };
                Some([random.direction(dim) * (size * rate), spin * *rate])
            }
        }
    }
}
