//! How couplers push: teeth at the pitch point, a belt along its strands. The row of a coupler only tells what it exerts along the coordinates
//! that it couples; what its forces do beside that the bearings of both wheels bear.

use nalgebra::Vector3;

use super::joint::Wrench;
use crate::system::{Term, place_of};

/// A coupler between two joints on one carrier whose forces are known.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTransmission {
    /// Of the coupler.
    pub name: String,
    /// Its row among those of the system.
    pub row: usize,
    /// The factor of the first coordinate in the row.
    pub factor: f64,
    /// Its joints among those that are recorded.
    pub joints: [usize; 2],
    /// 1 where the wheel (or the rack) is the second body of its joint, −1 where it is the first.
    pub sides: [f64; 2],
    /// The axis that both turn about, in space, as a direction of the carrier.
    pub axis: Vec<Term>,
    /// What it is.
    pub kind: Transmission,
}

/// What pushes.
#[derive(Clone, Debug, PartialEq)]
pub enum Transmission {
    /// Teeth of wheels.
    Teeth {
        /// Where the pitch point is, as a share of the way from the first axis to the second: below 0 and above 1 inside a ring.
        share: f64,
        /// Tangent of the pressure angle.
        slope: f64,
    },
    /// A belt or a chain.
    Belt {
        /// Of the first wheel, m.
        radius: f64,
        /// Sum of the radii where it crosses itself, and their difference where it does not, m.
        rise: f64,
        /// Tension of each strand at rest, N.
        pretension: f64,
    },
    /// Teeth of a wheel and of a rack.
    Rack {
        /// The way of the rack, as a direction of the carrier.
        way: Vec<Term>,
        /// How far the pitch point is from the axis along way × axis, m.
        radius: f64,
        /// Tangent of the pressure angle.
        slope: f64,
    },
}

/// What a transmission does at a state.
pub(super) struct Push {
    /// Force on the first wheel, N.
    pub force: Vector3<f64>,
    /// What the joints bear of it, on the first wheel and on the second: force (N), and moment about the joint's place (N·m).
    pub borne: [[Vector3<f64>; 2]; 2],
}

impl RecordedTransmission {
    /// The columns of its force.
    pub(super) fn acts(&self, axes: &str) -> Vec<String> {
        axes.chars().map(|axis| format!("{}.f{axis}", self.name)).collect()
    }

    /// What each of its joints bears of it beside its own rows: force (N) on the joint's second body, and moment (N·m) about its place.
    pub(super) fn borne(&self, push: &Push) -> impl Iterator<Item = (usize, Wrench)> {
        let of = |k: usize| (self.joints[k], push.borne[k].map(|part| (self.sides[k] * part).into()));
        [0, 1].map(of).map(|(joint, [force, moment])| (joint, (force, moment))).into_iter()
    }

    /// What it does where the axes of its joints are at `places` and its row has the multiplier `lambda`; `x` are the positions of all nodes.
    pub(super) fn push(&self, places: [[f64; 3]; 2], lambda: f64, x: &[f64], dim: usize) -> Push {
        let axis = if dim == 2 { Vector3::z() } else { direction(&self.axis, x) };
        // About the axis, on the first wheel.
        let moment = -self.factor * lambda * self.sides[0];
        let [first, second] = places.map(Vector3::from);
        let apart = second - first;
        // Both wheels lie in the plane across the axis through the place of the first joint: that of the second bears a moment where it is beside it.
        let beside = axis * axis.dot(&apart);
        let apart = apart - beside;
        let (distance, along) = (apart.norm(), apart.normalize());
        let across = axis.cross(&along);
        let nothing = Vector3::zeros();
        let both = |force: Vector3<f64>| Push { force, borne: [[-force, nothing], [force, force.cross(&beside)]] };
        match &self.kind {
            Transmission::Teeth { share, slope } => {
                let push = moment / (share * distance);
                // Teeth push each other apart: a wheel outside of the other, or inside of a ring, towards its own axis, the rim of a ring outwards.
                let apart = if *share > 1.0 { 1.0 } else { -share.signum() };
                both(push * across + apart * slope * push.abs() * along)
            }
            Transmission::Belt { radius, rise, pretension } => {
                let (difference, rise) = (moment / radius, rise / distance);
                let sum = (2.0 * pretension).max(difference.abs());
                both(sum * (1.0 - rise * rise).max(0.0).sqrt() * along + difference * rise * across)
            }
            Transmission::Rack { way, radius, slope } => {
                let way = if dim == 2 { place_of(way, x, dim).into() } else { direction(way, x) };
                let to_pitch = way.cross(&axis);
                let push = moment / radius;
                let apart = -radius.signum() * slope * push.abs() * to_pitch;
                let force = push * way + apart;
                let arm = first + *radius * to_pitch - second;
                Push { force, borne: [[-force, nothing], [apart, arm.cross(&force)]] }
            }
        }
    }
}

fn direction(terms: &[Term], x: &[f64]) -> Vector3<f64> {
    Vector3::from(place_of(terms, x, 3)).normalize()
}
