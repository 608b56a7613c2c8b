//! What people write: a description, read with all its faults at once and compiled to a system.
//!
//! No files, no clock, no printing. A [`Description`] knows nothing of places in a file; faults name paths in it, and who has read
//! the file knows where they are.

pub mod bodies;
pub mod constraints;
pub mod drives;
pub mod forces;
pub mod joints;

mod adrift;
mod apart;
mod assembly;
mod bars;
mod compile;
mod description;
mod element;
mod ends;
mod entries;
mod entry;
mod event;
mod expression;
mod fault;
mod fields;
mod finish;
mod geometry;
mod input;
mod jumps;
mod key;
mod knocks;
mod lengths;
mod measure;
mod parameters;
mod points;
mod reader;
mod references;
mod repeat;
mod schema;
mod settings;
mod signals;
mod spinless;
mod spline;
mod start;
mod straight;
mod stroke;
mod sum;
mod synonyms;
mod tables;
#[cfg(test)]
mod tests;
mod unseen;
mod value;
mod way;
mod written;

pub use assembly::{Assembly, Axes, GROUND};
pub use bars::{Bar, BarInfo};
pub use bodies::{Body, BodyInfo, Files, Inertia, Mesh, NoFiles, NumberFile, Orientation, RigidBody, Solid};
pub use description::{Description, ModelKeys};
pub use element::{AnyElement, Boxed, Element};
pub use ends::{End, from_to};
pub use entries::{Entries, Named};
pub use entry::{Entry, Spot, Written};
pub use event::Event;
pub use expression::{External, ExternalFunction, Functions, differences, is_formula_function};
pub use fault::{Fault, Faults, Read, Refused, nearest, nearest_few};
pub use fields::{Described, Field, Keys, List, Map, Number, Place, Rows, Site, Turn};
pub use input::Input;
pub use key::{Key, Kind, Kinds, REPEAT, Shape};
pub use measure::Measure;
pub use parameters::unused as unused_parameters;
pub use points::Point;
pub use reader::Reader;
pub use schema::schema;
pub use settings::{Output, OutputKeys, ProjectionKeys, Settings, SimulationKeys};
pub use start::Start;
pub use tables::Curve;
pub use value::{Table, Value, item_path, key_path};
pub use written::StartChange;

use std::sync::Arc;

use bodies::frame::Frame;
use fault::Sink;

use crate::record::{Channels, PointKind, Scene};
use crate::system::{self, System};

/// The version of the model file that is read.
pub const SCHEMA: u32 = 1;

/// Gravity where a model does not say otherwise, in world axes, m/s².
pub const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// A point of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct PointInfo {
    /// With its index where it is repeated.
    pub name: String,
    /// Its node, or where it is fixed, m.
    pub place: system::Place,
    /// Its own mass, kg.
    pub mass: f64,
    /// Velocity at the start as it was written, m/s; `None` where it is fixed or driven.
    pub velocity: Option<[f64; 3]>,
    /// What moves it, if anything.
    pub kind: PointKind,
}

/// A model that is sound: compiled, with what is needed to run it and to name what comes out.
pub struct Model {
    /// One line for people; empty where it has none.
    pub title: String,
    /// Coordinates of a point: 3 in space, 2 in the plane.
    pub dimension: usize,
    /// World axes of the coordinates: `"xyz"`, or the plane.
    pub axes: &'static str,
    /// In world axes (3), m/s².
    pub gravity: [f64; 3],
    /// Shared with the simulations of it.
    pub system: Arc<System>,
    /// How it is run, as far as it says.
    pub settings: Settings,
    /// What is recorded of it, as far as it says.
    pub output: Output,
    /// How it is drawn.
    pub scene: Scene,
    /// In file order.
    pub points: Vec<PointInfo>,
    /// In file order.
    pub bars: Vec<BarInfo>,
    /// In file order.
    pub bodies: Vec<BodyInfo>,
    /// Joints between bodies, in file order.
    pub joints: Vec<joints::JointInfo>,
    /// What is recorded of it.
    pub channels: Channels,
    /// What looks like a slip and was taken all the same, each with its place in the description.
    pub notes: Vec<String>,
    over_time: Vec<unseen::OverTime>,
    frames: Vec<Frame>,
}

impl Model {
    /// Reads and compiles a table as it stands in a file, with all kinds of this program.
    ///
    /// # Errors
    /// Everything that is wrong with it, with paths into the table.
    pub fn from_value(value: &Value, files: &dyn Files) -> Result<Self, Faults> {
        Self::from_value_with(value, &Kinds::default(), files)
    }

    /// The same with kinds that one knows oneself.
    ///
    /// # Errors
    /// Everything that is wrong with it, with paths into the table.
    pub fn from_value_with(value: &Value, kinds: &Kinds, files: &dyn Files) -> Result<Self, Faults> {
        let sink = Sink::default();
        match description::read(value, kinds, &sink) {
            Ok(description::Partial { description, unread }) => compile::model(&description, &unread, files, sink),
            Err(Refused) => Err(sink.finish().expect_err("what is refused has a fault")),
        }
    }
}
