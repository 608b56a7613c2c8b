//! `[body.NAME]`: rigid bodies in natural coordinates.

pub(super) mod frame;
pub mod inertia;
mod inertia_key;
mod info;
mod mesh;
pub(super) mod nodes;
mod orientation;
mod read;
mod rigid;
mod shape;
mod shape_key;

use std::sync::Arc;

pub use inertia_key::Inertia;
pub use info::BodyInfo;
pub use mesh::Mesh;
pub use orientation::Orientation;
pub use read::Body;
pub use rigid::RigidBody;
pub use shape::{MassProperties, Shape};
pub use shape_key::Solid;

/// Where the meshes that a model names come from.
pub trait Meshes {
    /// The mesh of a file, by the name it has in the model.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    fn mesh(&self, name: &str) -> Result<Arc<Mesh>, String>;
}

/// No meshes: of a description that comes from no file.
pub struct NoMeshes;

impl Meshes for NoMeshes {
    fn mesh(&self, _name: &str) -> Result<Arc<Mesh>, String> {
        Err("there are no files beside this model".into())
    }
}
