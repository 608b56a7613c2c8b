//! What moves when nodes have given velocities, by names of columns.

use super::Model;
use crate::system::{Place, rate_of};

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

impl Model {
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
