//! `[body.NAME]`: rigid bodies in natural coordinates.

pub(super) mod frame;
pub mod inertia;
mod inertia_key;
mod info;
mod mesh;
pub(super) mod nodes;
mod orientation;
mod placed;
mod read;
mod rigid;
mod shape;
mod shape_key;

use std::sync::Arc;

pub(super) use inertia::short;
pub use inertia_key::Inertia;
pub use info::BodyInfo;
pub use mesh::Mesh;
pub use orientation::Orientation;
pub(super) use placed::Placing;
pub use read::Body;
pub use rigid::RigidBody;
pub use shape::{MassProperties, Shape};
pub use shape_key::Solid;

/// Where the files that a model names come from.
pub trait Files {
    /// The mesh of a file, by the name it has in the model.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    fn mesh(&self, name: &str) -> Result<Arc<Mesh>, String>;

    /// The numbers of a CSV file, by the name it has in the model.
    ///
    /// # Errors
    /// What is wrong with the file, in words, and the cure.
    fn numbers(&self, name: &str) -> Result<Arc<NumberFile>, [String; 2]>;
}

/// Columns of numbers with their names, as of a CSV file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberFile {
    /// As in its header.
    pub names: Vec<String>,
    /// One for each name, of equal length.
    pub columns: Vec<Vec<f64>>,
}

/// No files: of a description that comes from no file.
pub struct NoFiles;

const NONE: &str = "there are no files beside this model";

impl Files for NoFiles {
    fn mesh(&self, _name: &str) -> Result<Arc<Mesh>, String> {
        Err(NONE.into())
    }

    fn numbers(&self, _name: &str) -> Result<Arc<NumberFile>, [String; 2]> {
        Err([NONE.into(), "read the model from a file".into()])
    }
}
