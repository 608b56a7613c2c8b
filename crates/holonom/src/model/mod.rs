//! What people write: a description, read with all its faults at once and compiled to a system.
//!
//! No files, no clock, no printing. A [`Description`] knows nothing of places in a file; faults name paths in it, and who has read
//! the file knows where they are.
//!
//! Joints, constraints, drives and forces of one's own are structs as those here: their fields are the keys, a joint is a [`Joint`](joints::Joint), and all
//! others are an [`Element`]. They go into a description by hand or, pushed to [`Kinds`], are read from files.
//!
//! ```
//! use std::sync::Arc;
//!
//! use holonom::model::joints::{Joint, Layout, Pair, Seat, Sides};
//! use holonom::model::{Assembly, Body, Description, Element, Entry, Keys, List, Number, Place, Read, Shape, SimulationKeys, Site, Solid, from_to};
//! use holonom::simulation::Status;
//! use holonom::system::{Law, Reach, Response};
//!
//! /// a pin: both bodies share a point, and keep its axis
//! #[derive(Clone, Debug, PartialEq, Keys, Sides)]
//! #[kind(name = "pin", equations = "d = 0, u_B·v_A = 0, u_B·w_A = 0", example = "")]
//! struct Pin {
//!     /// the two bodies, or a body and "ground"
//!     #[key(shape = Shape::Members)]
//!     between: List<String>,
//!     /// where it sits at the start
//!     #[key(unit = "m")]
//!     at: Site,
//!     /// its direction at the start
//!     #[key(unit = "any", default = "needed", shape = Shape::Direction)]
//!     axis: Option<Site>,
//! }
//!
//! impl Joint for Pin {
//!     const LAYOUT: Layout =
//!         Layout { freedom: [Some(1), Some(1)], at: Seat::Given, directions: [1, 0], shares: [&[], &[]], takes_point: false };
//!
//!     fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
//!         pair.coincide();
//!         pair.align();
//!         pair.angle();
//!         Ok(())
//!     }
//! }
//!
//! /// a spring whose force grows with the cube of its length: V = ½ k π², where π is half the square of the length
//! #[derive(Clone, Debug, PartialEq, Keys)]
//! #[kind(name = "cubic", equations = "V = k r⁴/8", example = "")]
//! struct Cubic {
//!     /// its ends
//!     #[key(shape = Shape::Ends(2, 2))]
//!     between: List<Place>,
//!     /// k
//!     #[key(unit = "N/m³")]
//!     stiffness: Number,
//! }
//!
//! impl Element for Cubic {
//!     fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
//!         let [a, b] = assembly.moving_pair(entry, "between", &self.between)?;
//!         let half_square = assembly.builder.square(&from_to(&a, &b));
//!         let law = Quadratic { stiffness: self.stiffness.positive(entry, "stiffness")? };
//!         assembly.builder.law(entry.name, &[half_square], Arc::new(law));
//!         Ok(())
//!     }
//! }
//!
//! struct Quadratic {
//!     stiffness: f64,
//! }
//!
//! impl Law for Quadratic {
//!     fn energy(&self, value: &[f64]) -> f64 {
//!         0.5 * self.stiffness * value[0].powi(2)
//!     }
//!
//!     fn conservative(&self) -> bool {
//!         true
//!     }
//!
//!     fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
//!         out.force[0] = self.stiffness * value[0];
//!         out.by_value[0][0] = self.stiffness;
//!     }
//!
//!     // ΔV/Δπ, and its derivative by π at the end.
//!     fn between(&self, reach: Reach<'_>, out: &mut Response) {
//!         out.force[0] = 0.5 * self.stiffness * (reach.from[0] + reach.to[0]);
//!         out.by_value[0][0] = 0.5 * self.stiffness;
//!     }
//! }
//!
//! let mut door = Description::new("Door");
//! door.body("door", Body::new([0.5, 0.0, 1.0]).mass(20).shape(Solid::cuboid([1.0, 0.05, 2.0])));
//! door.joint("hinge", Pin::new(["ground", "door"], [0.0, 0.0, 1.0]).axis([0.0, 0.0, 1.0]));
//! door.force("spring", Cubic::new([Place::from([0.0, 1.0, 1.0]), Place::from("door")], 30));
//! door.simulation = Some(SimulationKeys::new().step(0.01));
//! let mut simulation = door.compile()?.simulation()?;
//! assert_eq!(simulation.step_to(0.5), Status::Completed);
//! let [angle, rate] = simulation.coordinate("hinge.angle").expect("the hinge is there");
//! // What the spring has lost is in the door: π = (1 + ¼ − sin φ)/2, J = m (b² + t²)/12 + m b²/4.
//! let v = |angle: f64| 15.0 * (0.5 * (1.25 - angle.sin())).powi(2);
//! assert!(rate > 0.1 && (v(0.0) - v(angle) - 0.5 * 6.670833 * rate.powi(2)).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bodies;
pub mod constraints;
pub mod drives;
pub mod forces;
pub mod joints;

mod adrift;
mod apart;
mod assembly;
mod bars;
mod beams;
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
mod instances;
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
mod rest;
mod schema;
mod sections;
mod settings;
mod signals;
mod spin;
mod spinless;
mod spline;
mod spread;
mod start;
mod straight;
mod stroke;
mod sum;
mod swings;
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
pub use beams::{Beam, Section};
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
pub use start::{EQUILIBRIUM, Start};
pub use swings::{Sway, Swing};
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
    pub channels: Arc<Channels>,
    /// What looks like a slip and was taken all the same, each with its place in the description.
    pub notes: Vec<String>,
    /// Whether it begins where all forces balance.
    pub at_equilibrium: bool,
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
        Self::compile(value, kinds, files, None)
    }

    fn compile(value: &Value, kinds: &Kinds, files: &dyn Files, shared: Option<&Self>) -> Result<Self, Faults> {
        let sink = Sink::default();
        match sections::read(value, kinds, &sink) {
            Ok(sections::Partial { description, unread }) => compile::model(&description, &unread, files, shared, sink),
            Err(Refused) => Err(sink.finish().expect_err("what is refused has a fault")),
        }
    }
}
