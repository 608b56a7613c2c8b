//! What is known of a body when a model is complete.

use std::sync::Arc;

use nalgebra::Matrix3;

use super::RigidBody;
use super::frame::Frame;
use crate::model::Axes;
use crate::model::geometry::{norm, rest, scale, unit};
use crate::record::RecordedBody;

/// A body of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyInfo {
    /// With its index where it is repeated.
    pub name: String,
    /// kg
    pub mass: f64,
    /// Inertia tensor about the centre of mass in the axes of the model at the start, kg·m².
    pub inertia: Matrix3<f64>,
    /// Velocity of the centre of mass at the start as it was written, in the axes of the model, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity at the start as it was written, in the axes of the model, rad/s; in the plane its last number.
    pub angular_velocity: [f64; 3],
    /// How it is recorded, as the channels have it.
    pub recorded: Arc<RecordedBody>,
}

impl BodyInfo {
    pub(in crate::model) fn new(body: &RigidBody, frame: &Frame, axes: Axes) -> Self {
        let directions = directions(axes.dimension(), body, frame);
        let recorded =
            RecordedBody { name: body.name.clone(), centre: frame.point(body.position), directions, start: body.world_from_body };
        Self {
            name: body.name.clone(),
            mass: body.mass,
            inertia: body.inertia,
            velocity: body.velocity,
            angular_velocity: body.angular_velocity,
            recorded: recorded.into(),
        }
    }
}

/// Orthogonal directions that the nodes of a body span, in body axes and as nodes; in the plane the first axis.
fn directions(dim: usize, body: &RigidBody, frame: &Frame) -> Vec<([f64; 3], Vec<crate::system::Term>)> {
    let with_nodes = |local: [f64; 3]| (local, frame.vector(body.direction(local)));
    if dim == 2 {
        return vec![with_nodes(unit(0))];
    }
    if (0..3).all(|k| frame.holds(body.direction(unit(k)))) {
        return (0..3).map(|k| with_nodes(unit(k))).collect();
    }
    let Frame::Body { basis, .. } = frame else { unreachable!("a body has a frame of its own") };
    let mut spanned: Vec<[f64; 3]> = Vec::new();
    for edge in super::frame::edges(basis) {
        let local = rest(&spanned, body.local_direction(edge.reference));
        spanned.push(scale(local, 1.0 / norm(local)));
    }
    spanned.into_iter().map(with_nodes).collect()
}
