//! What became of the velocities that were written.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::Model;
use super::bodies::BodyInfo;
use crate::record::RecordedForce;
use crate::system::{Place, rate_of};

/// By how much the start has changed the velocity that was written of a body or point, so that constraints are met.
#[derive(Clone, Debug, PartialEq)]
pub struct StartChange {
    /// Of the body or point.
    pub name: String,
    /// Of the centre of mass, or of the point, m/s.
    pub velocity: f64,
    /// rad/s; 0 of a point. That of a rod about itself, which moves nothing, does not count.
    pub angular_velocity: f64,
    /// Whether it was written at rest, or nothing was: what it has then follows from drives and from the parts around it.
    pub was_at_rest: bool,
}

/// Change of a velocity, over the largest of the model, that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// Share of its size by which a mechanism is moved, or angle, that is none.
const STILL: f64 = 1e-12;

/// Velocity and angular velocity as written and as found.
type Pair = [[Vector3<f64>; 2]; 2];

/// Share of the fastest by which nodes of a beam that goes along as a whole differ.
const ALIKE: f64 = 1e-6;

impl Model {
    /// The bodies and points whose velocities at the start of a simulation, whose state is `x` (m) with `v` (m/s), are not those that
    /// were written, in file order, bodies first.
    pub fn start_changes(&self, x: &[f64], v: &[f64]) -> Vec<StartChange> {
        let dim = self.dimension;
        let world = self.system.in_world(x);
        let bodies = self.bodies.iter().map(|body| {
            let mut spin = Vector3::from(body.angular_velocity);
            if let Some(axis) = own_axis(body, dim) {
                spin -= axis * axis.dot(&spin);
            }
            (&body.name, [[body.velocity.into(), spin], body.recorded.velocity(&world, v, dim)])
        });
        let points = self.points.iter().filter_map(|point| {
            let (Place::Node(_), Some(written)) = (point.place, point.velocity) else { return None };
            let found = rate_of(&[(point.place, 1.0).into()], v, dim);
            Some((&point.name, [written, found].map(|velocity| [velocity.into(), Vector3::zeros()])))
        });
        let all: Vec<(&String, Pair)> = bodies.chain(points).collect();
        let largest = |k: usize| all.iter().flat_map(|(_, pair)| pair.iter().map(move |v| v[k].norm())).fold(0.0, f64::max);
        // What moves nothing as long as the run lasts is no change either.
        let size = x.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let turn = self.settings.end.map_or(0.0, |end| STILL / end);
        let least = [(ROUND_OFF * largest(0)).max(turn * size), (ROUND_OFF * largest(1)).max(turn)];
        let changes = all.iter().map(|&(name, [written, found])| {
            let [velocity, angular_velocity] = [0, 1].map(|k| {
                let change = (found[k] - written[k]).norm();
                if change > least[k] { change } else { 0.0 }
            });
            StartChange { name: name.clone(), velocity, angular_velocity, was_at_rest: written.iter().all(|v| v.norm() == 0.0) }
        });
        changes.filter(|change| change.velocity > 0.0 || change.angular_velocity > 0.0).collect()
    }

    /// Of these changes those of nodes of beams that do not go along as a whole: such a beam is struck.
    pub fn strikes<'a>(&self, changes: &'a [StartChange]) -> Vec<&'a StartChange> {
        let mut beams: BTreeMap<&str, (usize, Vec<&StartChange>)> = BTreeMap::new();
        for beam in self.channels.forces.iter().filter_map(RecordedForce::beam) {
            beams.entry(beam).or_insert((1, Vec::new())).0 += 1;
        }
        for change in changes {
            let beam = change.name.rfind('[').map(|at| &change.name[..at]);
            if let Some((_, changed)) = beam.and_then(|beam| beams.get_mut(beam)) {
                changed.push(change);
            }
        }
        let is_struck = |(nodes, changed): &(usize, Vec<&StartChange>)| {
            let differ = |of: fn(&StartChange) -> f64| {
                let all = changed.iter().map(|change| of(change)).chain((changed.len() < *nodes).then_some(0.0));
                let [least, most] = all.fold([f64::INFINITY, 0.0], |[least, most], of| [of.min(least), of.max(most)]);
                (most > 0.0).then_some(most - least > ALIKE * most)
            };
            // What turns as a whole does so at one rate, and has one velocity where it does not turn.
            differ(|change| change.angular_velocity).or_else(|| differ(|change| change.velocity)) == Some(true)
        };
        beams.into_values().filter(is_struck).flat_map(|(_, changed)| changed).collect()
    }

    /// Bodies that were written to turn about themselves with some inertia and do not, as they count as rods, in file order; with that spin, rad/s.
    pub fn spins_left_out(&self) -> Vec<(&str, f64)> {
        let spin = |body: &BodyInfo| {
            let axis = own_axis(body, self.dimension)?;
            let inertia = axis.dot(&(body.inertia * axis)) / body.inertia.trace();
            let spin = axis.dot(&Vector3::from(body.angular_velocity)).abs();
            (inertia > f64::EPSILON && spin > 0.0).then_some(spin)
        };
        self.bodies.iter().filter_map(|body| Some((body.name.as_str(), spin(body)?))).collect()
    }
}

/// The axis of a rod, of which nothing shows how far it has turned about itself.
fn own_axis(body: &BodyInfo, dim: usize) -> Option<Vector3<f64>> {
    match (&body.recorded.directions[..], dim) {
        ([(local, _)], 3) => Some(body.recorded.start * Vector3::from(*local)),
        _ => None,
    }
}
