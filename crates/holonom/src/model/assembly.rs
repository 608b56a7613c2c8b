//! What the readers of points, bars, constraints and forces build on: the system so far, and the points by name.

use std::cell::OnceCell;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use super::beams::Elastic;
use super::bodies::RigidBody;
use super::bodies::frame::Frame;
use super::bodies::nodes::Member;
use super::element::AnyElement;
use super::ends::End;
use super::entry::Entry;
use super::fault::{Read, Sink};
use super::forces::Limit;
use super::geometry::Vec3;
use super::joints::{Geometry, JointInfo};
use super::lengths::DrivenLength;
use super::signals::Signals;
use super::start::Target;
use crate::record::{
    Acts, Anchor, Line, LineKind, RecordedCoupling, RecordedForce, RecordedHold, RecordedRod, RecordedTransmission, SceneAxis, SceneJoint,
    SceneLoad, SceneWheels, Shows,
};
use crate::system::{Signal, SystemBuilder};

/// The name of the origin.
pub const GROUND: &str = "ground";

/// Largest relative contradiction between what a constraint says and where the points start.
pub const CONTRADICTION: f64 = 1e-6;

/// Share of the size of a mechanism below which a distance has no direction: rounding of places is 1e-4 of it.
const SHORTEST: f64 = 1e-12;

/// The world axes of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    /// `"xyz"`, `"xy"`, `"xz"` or `"yz"`.
    pub name: &'static str,
}

impl Axes {
    /// Three axes, or a plane of two.
    pub const ALL: [Self; 4] = [Self { name: "xyz" }, Self { name: "xy" }, Self { name: "xz" }, Self { name: "yz" }];

    /// Number of axes: coordinates of a point.
    pub fn dimension(self) -> usize {
        self.name.len()
    }

    /// The world coordinates (3) of coordinates in these axes.
    pub fn in_world(self, local: [f64; 3]) -> [f64; 3] {
        let mut world = [0.0; 3];
        for (k, axis) in self.name.bytes().enumerate() {
            world[usize::from(axis - b'x')] = local[k];
        }
        world
    }

    /// The part of a world vector in these axes, zeros behind it.
    pub fn of_world(self, world: [f64; 3]) -> [f64; 3] {
        let mut local = [0.0; 3];
        for (k, axis) in self.name.bytes().enumerate() {
            local[k] = world[usize::from(axis - b'x')];
        }
        local
    }
}

/// A point of the model, with what the system has of it.
#[derive(Clone, Debug)]
pub struct PlacedPoint {
    pub name: String,
    /// Where it is in the description.
    pub path: String,
    pub end: End,
    /// Its own mass, kg.
    pub mass: f64,
    /// At the start, where it is free, m/s.
    pub velocity: Option<[f64; 3]>,
    /// Whether a bar with mass is attached.
    pub carries_bar: bool,
}

/// A system while it is put together.
pub struct Assembly<'a> {
    /// Takes rows, laws, loads and coordinates of joints.
    pub builder: SystemBuilder,
    pub(in crate::model) axes: Axes,
    /// Gravity in the axes of the model, m/s².
    pub(in crate::model) gravity: [f64; 3],
    pub(in crate::model) sink: &'a Sink,
    /// All points, in file order.
    pub(in crate::model) points: Vec<PlacedPoint>,
    /// Position of each point in the list, by name.
    pub(in crate::model) by_name: HashMap<String, usize>,
    /// Names of entries of points that could not be read; what refers to them is no second fault.
    pub(in crate::model) faulty: HashSet<String>,
    pub(in crate::model) lines: Vec<Line>,
    /// All bodies, in file order, and where their nodes are made, their frames.
    pub(in crate::model) bodies: Vec<RigidBody>,
    pub(in crate::model) frames: Vec<Frame>,
    /// Position of each body in the list, by name.
    pub(in crate::model) body_names: HashMap<String, usize>,
    /// Position of each bar in the list, by name, and the ends of those that are built.
    pub(in crate::model) bar_names: BTreeMap<String, usize>,
    pub(in crate::model) bar_ends: Vec<Option<[End; 2]>>,
    /// Places of each body that something holds, in its axes, for the picture.
    pub(in crate::model) body_places: Vec<Vec<Vec3>>,
    /// All joints that are no couplers, in file order.
    pub(in crate::model) joints: Vec<JointInfo>,
    /// Position of each joint in the list, by name.
    pub(in crate::model) joint_names: HashMap<String, usize>,
    /// Coordinates of joints that are driven, as `JOINT.COORDINATE`, with the drive.
    pub(in crate::model) driven: HashMap<String, String>,
    /// Names of joints and couplers that could not be read.
    pub(in crate::model) faulty_joints: HashSet<String>,
    pub(in crate::model) scene_joints: Vec<SceneJoint>,
    pub(in crate::model) loads: Vec<SceneLoad>,
    pub(in crate::model) bushings: Vec<SceneLoad>,
    pub(in crate::model) wheels: Vec<SceneWheels>,
    /// Where joints are to be at the start.
    pub(in crate::model) starts: Vec<Target>,
    /// Distances that are driven.
    pub(in crate::model) lengths: Vec<DrivenLength>,
    /// Limits of stops.
    pub(in crate::model) limits: Vec<Limit>,
    /// Efforts of the drives.
    pub(in crate::model) efforts: Vec<Effort>,
    /// What couplers exert along the coordinates that they couple.
    pub(in crate::model) couplings: Vec<RecordedCoupling>,
    /// Couplers, by name, of wheels on parts of which none carries both: the members of the two joints.
    pub(in crate::model) wheels_apart: Vec<(String, [[Member; 2]; 2])>,
    /// Couplers whose forces bearings feel.
    pub(in crate::model) transmissions: Vec<RecordedTransmission>,
    /// Bars and constraints that keep a distance.
    pub(in crate::model) rods: Vec<RecordedRod>,
    /// What other constraints exert; the rows of formulas are counted from the first of those.
    pub(in crate::model) holds: Vec<RecordedHold>,
    /// Places, as they were written, whose distance bars and constraints keep as it is at the start.
    pub(in crate::model) kept_apart: Vec<[String; 2]>,
    /// Elements of beams.
    pub(in crate::model) elastic: Vec<Elastic>,
    /// What forces do, and what is to be shown of that which is built.
    pub(in crate::model) forces: Vec<RecordedForce>,
    shows: Shows,
    /// Inputs, and measures that forces may read.
    pub(in crate::model) signals: Signals,
    /// Where the joints of the entry are that is built.
    pub(in crate::model) geometries: std::vec::IntoIter<Geometry>,
    size: OnceCell<Option<f64>>,
}

/// What a drive exerts: −λ of its row, times the length where the row is one of half a square.
#[derive(Clone)]
pub struct Effort {
    pub name: String,
    pub row: usize,
    pub length: Option<Arc<dyn Signal>>,
    pub is_moment: bool,
}

impl Effort {
    /// The distance that is driven at the start, m.
    pub fn at_start(&self) -> f64 {
        self.length.as_ref().map_or(0.0, |length| length.at(0.0)[0])
    }
}

impl<'a> Assembly<'a> {
    /// With bodies whose nodes are not made yet, and nothing else.
    pub(super) fn new(builder: SystemBuilder, axes: Axes, gravity: [f64; 3], sink: &'a Sink, bodies: Vec<RigidBody>) -> Self {
        Self {
            builder,
            axes,
            gravity,
            sink,
            points: Vec::new(),
            by_name: HashMap::new(),
            faulty: HashSet::new(),
            lines: Vec::new(),
            body_places: vec![Vec::new(); bodies.len()],
            body_names: bodies.iter().enumerate().map(|(k, body)| (body.name.clone(), k)).collect(),
            bodies,
            frames: Vec::new(),
            bar_names: BTreeMap::new(),
            bar_ends: Vec::new(),
            joints: Vec::new(),
            joint_names: HashMap::new(),
            driven: HashMap::new(),
            faulty_joints: HashSet::new(),
            scene_joints: Vec::new(),
            loads: Vec::new(),
            bushings: Vec::new(),
            wheels: Vec::new(),
            starts: Vec::new(),
            lengths: Vec::new(),
            limits: Vec::new(),
            efforts: Vec::new(),
            couplings: Vec::new(),
            wheels_apart: Vec::new(),
            transmissions: Vec::new(),
            rods: Vec::new(),
            holds: Vec::new(),
            kept_apart: Vec::new(),
            elastic: Vec::new(),
            forces: Vec::new(),
            shows: Shows::Power,
            signals: Signals::default(),
            geometries: Vec::new().into_iter(),
            size: OnceCell::new(),
        }
    }
}

impl Assembly<'_> {
    /// Has the angles of planar bodies measured, from the first axis of the plane to that of the body: before the mechanism is moved to its start, so
    /// that their turns on the way there count as those of joints do.
    pub(in crate::model) fn measure_bodies(&mut self) {
        if self.dimension() == 2 {
            for (body, frame) in self.bodies.iter().zip(&self.frames) {
                self.builder.measure(format!("{}.angle", body.name), &body.angle(frame));
            }
        }
    }

    /// How many coordinates of joints are measured: they come before the angles of planar bodies.
    pub(in crate::model) fn joint_coordinates(&self) -> usize {
        let of_bodies = if self.dimension() == 2 { self.bodies.len() } else { 0 };
        self.builder.measured() - of_bodies
    }

    /// Coordinates of a point.
    pub fn dimension(&self) -> usize {
        self.axes.dimension()
    }

    /// Position of a body in the list, by name.
    pub fn body_by_name(&self, name: &str) -> Option<usize> {
        self.body_names.get(name).copied()
    }

    /// The frame of a side of a joint.
    pub(in crate::model) fn frame(&self, member: Member) -> Frame {
        match member {
            Member::Ground => Frame::Ground,
            Member::Point(k) => Frame::Particle(self.points[k].end.place().expect("a point is a node")),
            Member::Body(k) => self.frames[k].clone(),
            Member::Bar(k) => {
                let ends = self.bar_ends[k].as_ref().expect("what is of a bar with a fault is refused");
                Frame::Bar(ends.each_ref().map(|end| (end.terms.clone(), end.start)))
            }
        }
    }

    /// Whether a bar or a constraint keeps the distance of two places as it is.
    pub fn keeps_apart(&self, a: &End, b: &End) -> bool {
        self.kept_apart.iter().any(|[one, other]| [one, other] == [&a.name, &b.name] || [one, other] == [&b.name, &a.name])
    }

    /// What shorter distances count as for a force between places that are `start` apart at the start, with a length of `rest` without tension, m.
    pub(in crate::model) fn shortest(&self, start: f64, rest: f64) -> f64 {
        // What nodes do not show the force does; where it has no length any unit will do.
        let size = start.max(self.size().unwrap_or(rest));
        SHORTEST * if size > 0.0 { size } else { 1.0 }
    }

    /// How large the mechanism is when drives and forces are built, m, where its nodes show it.
    pub(in crate::model) fn size(&self) -> Option<f64> {
        *self.size.get_or_init(|| Some(self.builder.extent()).filter(|size| size.is_finite() && *size > 0.0))
    }

    /// Has this recorded of the laws and loads of the entry that is built. Of those of which nothing is said it is the power alone.
    pub fn show(&mut self, shows: Shows) {
        self.shows = shows;
    }

    /// Builds an entry, and has recorded what its laws and loads do.
    pub(in crate::model) fn build(&mut self, entry: &Entry<'_>, element: &dyn AnyElement) -> Read<()> {
        self.record(entry.name, |assembly| element.build(assembly, entry))
    }

    /// Has recorded what the laws and loads do that `build` adds.
    pub(in crate::model) fn record<T>(&mut self, name: &str, build: impl FnOnce(&mut Self) -> T) -> T {
        let (laws, loads) = (self.builder.laws(), self.builder.loads());
        let built = build(self);
        let shows = std::mem::replace(&mut self.shows, Shows::Power);
        let (laws, loads) = (laws..self.builder.laws(), loads..self.builder.loads());
        if !(laws.is_empty() && loads.is_empty()) {
            self.forces.push(RecordedForce { name: name.to_string(), laws, loads, shows });
        }
        built
    }

    /// Has recorded what the rows of a constraint exert, from the `first` on.
    pub(in crate::model) fn hold(&mut self, entry: &Entry<'_>, what: &'static str, first: usize, acts: Acts) {
        self.holds.push(RecordedHold { owners: vec![entry.name.to_string()], what, rows: first..self.builder.rows(), acts });
    }

    /// Draws a line between two ends.
    pub fn draw(&mut self, entry: &Entry<'_>, kind: LineKind, from: &End, to: &End) {
        self.draw_along(entry, kind, from, to, None);
    }

    /// Draws a line between two ends that acts along an axis.
    pub fn draw_along(&mut self, entry: &Entry<'_>, kind: LineKind, from: &End, to: &End, along: Option<SceneAxis>) {
        self.draw_line(entry.name, kind, from, to, along);
    }

    /// The same of what has this name.
    pub(in crate::model) fn draw_line(&mut self, name: &str, kind: LineKind, from: &End, to: &End, along: Option<SceneAxis>) {
        let line = Line { name: name.to_string(), kind, from: self.anchor(from), to: self.anchor(to), along };
        self.lines.push(line);
        for end in [from, to] {
            if let Some(k) = end.body {
                self.body_places[k].push(self.bodies[k].local(end.start));
            }
        }
    }

    /// Draws a force or moment at an end, of which columns are recorded.
    pub fn draw_load(&mut self, entry: &Entry<'_>, at: &End) {
        let load = SceneLoad { name: entry.name.to_string(), at: self.anchor(at) };
        self.loads.push(load);
    }

    /// Draws a bushing where it sits at the start.
    pub(in crate::model) fn draw_bushing(&mut self, entry: &Entry<'_>, members: [Member; 2], at: Vec3) {
        for member in members {
            if let Member::Body(k) = member {
                self.body_places[k].push(self.bodies[k].local(at));
            }
        }
        let at = match members[1] {
            Member::Body(k) => Anchor::Body { body: self.bodies[k].name.clone(), at: self.axes.in_world(self.bodies[k].local(at)) },
            _ => Anchor::Fixed(self.axes.in_world(at)),
        };
        self.bushings.push(SceneLoad { name: entry.name.to_string(), at });
    }

    /// Draws a drive or an effort along a coordinate of a joint.
    pub fn draw_drive(&mut self, entry: &Entry<'_>, joint: &str) {
        // A coupler has coordinates and no symbol.
        if let Some(joint) = self.scene_joints.iter_mut().find(|drawn| drawn.name == joint) {
            joint.drives.push(entry.name.to_string());
        }
    }

    fn anchor(&self, end: &End) -> Anchor {
        match (end.point, end.body) {
            (Some(k), _) => Anchor::Point(self.points[k].name.clone()),
            (None, Some(k)) => Anchor::Body { body: self.bodies[k].name.clone(), at: self.axes.in_world(self.bodies[k].local(end.start)) },
            (None, None) => Anchor::Fixed(self.axes.in_world(end.start)),
        }
    }

    /// Refuses a start that contradicts a constraint: `off` from where it should be, seen against `size`, both in m.
    pub fn check_start(&self, entry: &Entry<'_>, off: f64, size: f64, what: impl FnOnce() -> String) -> Read<()> {
        self.check_start_within(entry, off, size, CONTRADICTION, what)
    }

    /// The same with another share of the size.
    pub fn check_start_within(&self, entry: &Entry<'_>, off: f64, size: f64, share: f64, what: impl FnOnce() -> String) -> Read<()> {
        // Written so that a NaN is refused too.
        if off.abs() <= share * size.abs() {
            return Ok(());
        }
        Err(entry.refuse_all(what(), "correct the positions at the start, or what contradicts them here"))
    }

    /// The name of one of several rows of an entry.
    pub fn row_name(entry: &Entry<'_>, row: usize, rows: usize) -> String {
        if rows == 1 { entry.name.to_string() } else { format!("{}[{row}]", entry.name) }
    }
}
