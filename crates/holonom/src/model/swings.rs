//! What moves when nodes have given velocities, by names of columns, and in the picture.

use std::collections::{HashMap, HashSet};

use super::Model;
use crate::system::{Place, place_of, rate_of};

/// Velocity of a body, a point or a coordinate of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// What moves, such as `chassis.z` or `hinge.angle`.
    pub name: String,
    /// m/s, or rad/s.
    pub rate: f64,
    /// Whether it turns.
    pub is_angle: bool,
}

/// A point or a body of the picture at the start, with a velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    /// As in the scene.
    pub name: String,
    /// Its place along the axes of the model, m. Of a body that is the centre of mass, and its orientation follows: the unit quaternion (w, x, y, z) from
    /// its axes to those of the world, or in a plane its angle, rad.
    pub pose: Vec<f64>,
    /// Velocity along the axes of the model, m/s; of a body its angular velocity follows, rad/s: along x, y, z or across the plane.
    pub rate: Vec<f64>,
}

impl Model {
    /// The points and the bodies of the picture, where all nodes are at the start and have the velocities `v` (D × nodes), m/s.
    pub fn sways(&self, v: &[f64]) -> [Vec<Sway>; 2] {
        let (dim, x) = (self.dimension, self.system.in_world(self.system.start_position()));
        let drawn: HashSet<&str> = self.scene.points.iter().map(|point| point.name.as_str()).collect();
        let points = self.channels.points.iter().filter(|point| drawn.contains(point.name.as_str())).map(|point| {
            let [pose, rate] = [place_of(&point.terms, &x, dim), rate_of(&point.terms, v, dim)].map(|of| of[..dim].to_vec());
            Sway { name: point.name.clone(), pose, rate }
        });
        let mut gauges = self.system.gauge_values();
        self.system.measure(self.system.start_position(), v, &mut gauges);
        let angles: HashMap<&str, f64> = self.system.gauges().iter().map(String::as_str).zip(gauges.value).collect();
        let bodies = self.bodies.iter().map(|body| {
            let [velocity, spin] = body.recorded.velocity(&x, v, dim);
            let (orientation, spin) = match dim {
                2 => (vec![angles.get(&*format!("{}.angle", body.name)).copied().unwrap_or_default()], vec![spin.z]),
                _ => {
                    let turned = body.recorded.turned(&x, v).0;
                    (vec![turned.w, turned.i, turned.j, turned.k], spin.as_slice().to_vec())
                }
            };
            let place = body.recorded.place(&x, dim);
            let [pose, rate] = [(place, orientation), (velocity, spin)].map(|(of, turn)| [&of.as_slice()[..dim], &turn].concat());
            Sway { name: body.name.clone(), pose, rate }
        });
        [points.collect(), bodies.collect()]
    }

    /// Velocities of centres of bodies along the axes of the model and angular velocities in space, of points, and rates of joint coordinates, where all
    /// nodes are at the start and have the velocities `v` (D × nodes), m/s.
    pub fn swings(&self, v: &[f64]) -> Vec<Swing> {
        let (dim, x) = (self.dimension, self.system.in_world(self.system.start_position()));
        let along = |name: &str, rate: [f64; 3], before: &str, is_angle: bool| {
            let axes = self.axes.chars().zip(rate);
            axes.map(|(axis, rate)| Swing { name: format!("{name}.{before}{axis}"), rate, is_angle }).collect::<Vec<_>>()
        };
        let bodies = self.bodies.iter().flat_map(|body| {
            let [velocity, spin] = body.recorded.velocity(&x, v, dim);
            // The angle of a body of the plane is measured as those of joints.
            let turn = if dim == 2 { Vec::new() } else { along(&body.name, spin.into(), "w", true) };
            along(&body.name, velocity.into(), "", false).into_iter().chain(turn)
        });
        let free = self.points.iter().filter(|point| matches!(point.place, Place::Node(_)) && point.velocity.is_some());
        let points = free.flat_map(|point| along(&point.name, rate_of(&[(point.place, 1.0).into()], v, dim), "", false));
        let mut gauges = self.system.gauge_values();
        self.system.measure(self.system.start_position(), v, &mut gauges);
        let joints = self.system.gauges().iter().enumerate();
        let joints = joints.map(|(k, name)| Swing { name: name.clone(), rate: gauges.rate[k], is_angle: self.system.is_angle(k) });
        joints.chain(bodies).chain(points).collect()
    }
}
