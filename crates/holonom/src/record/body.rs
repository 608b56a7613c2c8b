//! How a body is turned, by its nodes.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use smallvec::SmallVec;

use crate::system::{Term, place_of, rate_of};

/// A body whose motion is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedBody {
    /// With its index where it is repeated.
    pub name: String,
    /// Its centre of mass.
    pub centre: Vec<Term>,
    /// Orthogonal unit vectors in body axes, with their nodes: three, two of a plate, one of a rod and in the plane.
    pub directions: Vec<([f64; 3], Vec<Term>)>,
    /// From body axes to the world's at the start, which says how a rod is turned about itself.
    pub start: Matrix3<f64>,
}

impl RecordedBody {
    /// Velocity of the centre (m/s) and angular velocity (rad/s, of a rod that across it) at positions `x` and velocities `v` of all
    /// nodes.
    pub fn velocity(&self, x: &[f64], v: &[f64], dim: usize) -> [Vector3<f64>; 2] {
        let spin = match (&self.directions[..], dim) {
            ([(_, terms)], _) => Vector3::from(place_of(terms, x, dim)).cross(&Vector3::from(rate_of(terms, v, dim))),
            _ => self.turned(x, v).1,
        };
        [rate_of(&self.centre, v, dim).into(), spin]
    }

    /// Angular acceleration (rad/s², of a rod that across it) at positions `x`, velocities `v` and accelerations `a` of all nodes.
    pub(super) fn angular_acceleration(&self, x: &[f64], v: &[f64], a: &[f64], dim: usize) -> Vector3<f64> {
        let of = |terms: &[Term]| {
            (Vector3::from(place_of(terms, x, dim)), Vector3::from(rate_of(terms, v, dim)), Vector3::from(rate_of(terms, a, dim)))
        };
        let directions: SmallVec<[_; 3]> = self.directions.iter().map(|(_, terms)| of(terms)).collect();
        match directions[..] {
            [(e, _, bend)] => e.cross(&bend),
            [(e, e_rate, e_bend), (f, f_rate, f_bend)] => {
                let (g, bend) = (e.cross(&f), e_bend.cross(&f) + 2.0 * e_rate.cross(&f_rate) + e.cross(&f_bend));
                0.5 * (e.cross(&e_bend) + f.cross(&f_bend) + g.cross(&bend))
            }
            // ë = α × e + ω × (ω × e), the last part of which has no sum.
            _ => 0.5 * directions.iter().map(|(e, _, bend)| e.cross(bend)).sum::<Vector3<f64>>(),
        }
    }

    /// Where its centre is at the positions `x` of all nodes in the world, m.
    pub fn place(&self, x: &[f64], dim: usize) -> Vector3<f64> {
        place_of(&self.centre, x, dim).into()
    }

    /// From body axes to the world's at the positions `x` of all nodes, in space.
    pub fn orientation(&self, x: &[f64]) -> Matrix3<f64> {
        self.turned(x, &vec![0.0; x.len()]).0.to_rotation_matrix().into_inner()
    }

    /// Orientation and angular velocity in space.
    pub(crate) fn turned(&self, x: &[f64], v: &[f64]) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let world: SmallVec<[Vector3<f64>; 3]> = self.directions.iter().map(|(_, terms)| place_of(terms, x, 3).into()).collect();
        let rates: SmallVec<[Vector3<f64>; 3]> = self.directions.iter().map(|(_, terms)| rate_of(terms, v, 3).into()).collect();
        let local: SmallVec<[Vector3<f64>; 3]> = self.directions.iter().map(|&(local, _)| local.into()).collect();
        match world[..] {
            [axis] => {
                // Of a rod the turn about itself is not known: the shortest from the start.
                let turn = Rotation3::rotation_between(&(self.start * local[0]), &axis).unwrap_or_else(Rotation3::identity);
                (quaternion(turn.into_inner() * self.start), axis.cross(&rates[0]))
            }
            [e, f] => {
                let (g, rate) = (e.cross(&f), rates[0].cross(&f) + e.cross(&rates[1]));
                let matrix =
                    Matrix3::from_columns(&[e, f, g]) * Matrix3::from_columns(&[local[0], local[1], local[0].cross(&local[1])]).transpose();
                (quaternion(matrix), 0.5 * (e.cross(&rates[0]) + f.cross(&rates[1]) + g.cross(&rate)))
            }
            [e, f, g] => {
                let matrix = Matrix3::from_columns(&[e, f, g]) * Matrix3::from_columns(&[local[0], local[1], local[2]]).transpose();
                (quaternion(matrix), 0.5 * (e.cross(&rates[0]) + f.cross(&rates[1]) + g.cross(&rates[2])))
            }
            _ => unreachable!("a body in space has one to three directions"),
        }
    }
}

fn quaternion(matrix: Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix))
}
