//! A rigid body when its keys have been evaluated.

use nalgebra::{Matrix3, Vector3};

use super::frame::Frame;
use crate::model::geometry::{Vec3, add, unit};
use crate::record::SceneShape;
use crate::system::{Form, Place};

/// A rigid body at the start.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// With its index where it is repeated.
    pub name: String,
    /// Where it is in the description.
    pub path: String,
    /// kg
    pub mass: f64,
    /// Inertia tensor about the centre of mass in the axes of the model, kg·m².
    pub inertia: Matrix3<f64>,
    /// Of the centre of mass, m.
    pub position: Vec3,
    /// From body axes to those of the model.
    pub world_from_body: Matrix3<f64>,
    /// In the plane the angle by which it is turned, as it is written, rad.
    pub turned: f64,
    /// m/s
    pub velocity: Vec3,
    /// In the axes of the model, rad/s; in the plane its last number.
    pub angular_velocity: Vec3,
    /// Named places: where they are at the start.
    pub points: Vec<(String, Vec3)>,
    /// Named directions at the start.
    pub axes: Vec<(String, Vec3)>,
    /// How it is drawn; `None` where only mass and inertia are known.
    pub shape: Option<SceneShape>,
}

impl RigidBody {
    /// The angle of a planar body with these nodes, from the first axis of the plane to the body's, counted from the one that is written.
    pub fn angle(&self, frame: &Frame) -> Form {
        let moving = frame.vector(self.direction(unit(0)));
        let product = |k| [vec![(Place::Fixed(unit(k)), 1.0).into()], moving.clone()];
        Form::Angle { cosine: product(0), sine: product(1), near: self.turned }
    }

    /// Where a place in body axes is at the start.
    pub fn place(&self, local: Vec3) -> Vec3 {
        add(self.position, self.direction(local))
    }

    /// A direction in body axes at the start.
    pub fn direction(&self, local: Vec3) -> Vec3 {
        (self.world_from_body * Vector3::from(local)).into()
    }

    /// A place at the start in body axes.
    pub fn local(&self, place: Vec3) -> Vec3 {
        (self.world_from_body.transpose() * (Vector3::from(place) - Vector3::from(self.position))).into()
    }

    /// A direction at the start in body axes.
    pub fn local_direction(&self, direction: Vec3) -> Vec3 {
        (self.world_from_body.transpose() * Vector3::from(direction)).into()
    }

    /// Velocity at the start of the place that is at `place`, m/s.
    pub fn velocity_at(&self, place: Vec3) -> Vec3 {
        let arm = Vector3::from(place) - Vector3::from(self.position);
        (Vector3::from(self.velocity) + Vector3::from(self.angular_velocity).cross(&arm)).into()
    }

    /// Rate of a direction of the body at the start.
    pub fn rate_of(&self, direction: Vec3) -> Vec3 {
        Vector3::from(self.angular_velocity).cross(&Vector3::from(direction)).into()
    }
}
