//! What people write: a description, read with all its faults at once and compiled to a system.
//!
//! No files, no clock, no printing. A description is a [`Value`] without places in a file; faults name paths in it, and
//! who has read the file knows where they are.

pub mod bodies;
pub mod constraints;
pub mod drives;
pub mod forces;
pub mod joints;

mod assembly;
mod bars;
mod ends;
mod entry;
mod expression;
mod fault;
mod fields;
mod finish;
mod geometry;
mod key;
mod parameters;
mod points;
mod references;
mod repeat;
mod schema;
mod section;
mod settings;
mod spline;
#[cfg(test)]
mod tests;
mod value;
mod written;

pub use assembly::{Axes, GROUND};
pub use bars::{Bar, BarInfo, KEYS as BAR_KEYS};
pub use bodies::{Body, BodyInfo, Inertia, KEYS as BODY_KEYS, Mesh, Meshes, NoMeshes, Orientation, RigidBody, Solid};
pub use entry::{Entry, Spot};
pub use fault::{Fault, Faults, Read, Refused, nearest};
pub use fields::{Described, Field, Keys, List, Map, Number, Place, Rows, Site, Turn};
pub use key::{Key, Kind, REPEAT, Shape};
pub use points::{KEYS as POINT_KEYS, Point};
pub use schema::schema;
pub use settings::{OUTPUT as OUTPUT_KEYS, Output, OutputKeys, ProjectionKeys, SIMULATION as SIMULATION_KEYS, Settings, SimulationKeys};
pub use value::{Table, Value, item_path, key_path};
pub use written::StartChange;

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use assembly::Assembly;
use expression::Scope;
use fault::Sink;
use section::Sections;

use crate::record::{Channels, PointKind, Scene};
use crate::system::{self, System, SystemBuilder};

/// The version of the model file that is read.
pub const SCHEMA: u32 = 1;

/// Gravity where a model does not say otherwise, in world axes, m/s².
pub const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Keys of the model itself; the sections of named entries are `point`, `bar`, `constraint` and `force`.
pub const MODEL_KEYS: &[Key] = &[
    Key::optional("schema", Shape::Whole, "1", "", "version of the model file"),
    Key::optional("title", Shape::Text, "none", "", "one line for people"),
    Key::optional("gravity", Shape::Vector, "[0, 0, -9.81]", "m/s²", "in the axes of the model, or all three of the world"),
    Key::optional(
        "plane",
        Shape::Choice(&["xy", "xz", "yz"]),
        "none: the model is in space",
        "",
        "makes the model planar, with two coordinates a point",
    ),
];

/// Names of the tables of a model.
const TABLES: [&str; 10] = ["parameters", "point", "body", "bar", "joint", "constraint", "drive", "force", "simulation", "output"];

/// A point of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct PointInfo {
    pub name: String,
    /// Its node, or where it is fixed, m.
    pub place: system::Place,
    /// Its own mass, kg.
    pub mass: f64,
    /// Velocity at the start as it was written, m/s; `None` where it is fixed or driven.
    pub velocity: Option<[f64; 3]>,
    pub kind: PointKind,
}

/// A model that is sound: compiled, with what is needed to run it and to name what comes out.
pub struct Model {
    pub title: String,
    /// Coordinates of a point: 3 in space, 2 in the plane.
    pub dimension: usize,
    /// World axes of the coordinates: `"xyz"`, or the plane.
    pub axes: &'static str,
    /// In world axes (3), m/s².
    pub gravity: [f64; 3],
    /// Shared with the simulations of it.
    pub system: Arc<System>,
    pub settings: Settings,
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
}

impl Model {
    /// Reads a description.
    ///
    /// # Errors
    /// Everything that is wrong with it, with paths into the description.
    pub fn from_value(value: &Value, meshes: &dyn Meshes) -> Result<Self, Faults> {
        let sink = Sink::default();
        let model = read(value, &sink, meshes);
        match (sink.finish(), model) {
            (Ok(()), Ok(model)) => Ok(model),
            (Err(faults), _) => Err(faults),
            (Ok(()), Err(Refused)) => unreachable!("what is refused has a fault"),
        }
    }
}

fn read(value: &Value, sink: &Sink, meshes: &dyn Meshes) -> Read<Model> {
    let Value::Table(table) = value else {
        return Err(sink.report(|| Fault::new("", value.quoted(), "a model is a table", "")));
    };
    let parameters = match table.get("parameters") {
        Some(Value::Table(table)) => parameters::read(table, sink),
        _ => Default::default(),
    };
    let scope = Scope { parameters: Some(&parameters), indices: &[] };
    let root = Entry { name: "", path: "", table, scope, sink, meshes };
    refuse_unknown(&root);
    let _ = root.optional("parameters", Entry::table);
    let _ = root.optional("schema", schema_version);
    let title = root.optional("title", Entry::text).unwrap_or(None).unwrap_or("").to_string();
    let axes = axes(&root);
    let gravity = gravity(&root, axes).unwrap_or_default();

    let mut sections = Sections::new(sink, meshes, &parameters);
    let (specs, faulty) = points::read(&mut sections, table, axes);
    let (bodies, faulty_bodies) = read_bodies(&mut sections, table, axes);
    let mut assembly = Assembly {
        builder: SystemBuilder::new(axes.dimension(), gravity),
        axes,
        gravity,
        sink,
        points: Vec::new(),
        by_name: Default::default(),
        faulty: &faulty | &faulty_bodies,
        lines: Vec::new(),
        body_places: vec![Vec::new(); bodies.len()],
        body_names: bodies.iter().enumerate().map(|(k, body)| (body.name.clone(), k)).collect(),
        bodies,
        frames: Vec::new(),
        joints: Vec::new(),
        joint_names: HashMap::new(),
        driven: HashMap::new(),
        faulty_joints: Default::default(),
        scene_joints: Vec::new(),
        efforts: Vec::new(),
    };
    points::add(&mut assembly, &specs);
    make_bodies(&mut assembly, &root, &parameters, &specs);
    points::complete(&mut assembly, specs);
    let bars = bars::read(&mut sections, table, &mut assembly);
    let kinds: Vec<&Kind> = constraints::KINDS.iter().collect();
    build_kinds(&mut sections, table, "constraint", &kinds, &mut assembly);
    // Couplers name joints, which may stand behind them.
    build_joints(&mut sections, table, &mut assembly);
    let kinds: Vec<&Kind> = drives::KINDS.iter().collect();
    build_kinds(&mut sections, table, "drive", &kinds, &mut assembly);
    let kinds: Vec<&Kind> = forces::KINDS.iter().collect();
    build_kinds(&mut sections, table, "force", &kinds, &mut assembly);
    points::check_mass(&assembly);
    let settings = settings::read(&root, &assembly).unwrap_or_default();
    let output = settings::output(&root, &assembly).unwrap_or_default();
    if sink.count() > 0 {
        return Err(Refused);
    }
    for program in sink.switches.take() {
        assembly.builder.switch(std::sync::Arc::new(expression::TimeProgram(program)));
    }
    Ok(finish::finish(assembly, title, settings, output, bars))
}

fn read_bodies(sections: &mut Sections<'_>, root: &Table, axes: Axes) -> (Vec<RigidBody>, HashSet<String>) {
    let keys: Vec<&Key> = bodies::KEYS.iter().collect();
    let mut read = Vec::new();
    let check = |entry: &Entry<'_>| {
        let before = entry.sink.count();
        entry.refuse_unknown_keys("a body", &keys);
        if entry.sink.count() == before { Ok(()) } else { Err(Refused) }
    };
    let faulty = sections.read(root, "body", check, |entry| {
        read.push(bodies::read(entry, axes.dimension())?);
        Ok(())
    });
    (read, faulty)
}

/// Looks at the joints for what bodies can share, and makes the nodes. What is wrong with a joint is told when it is built.
fn make_bodies(assembly: &mut Assembly<'_>, root: &Entry<'_>, parameters: &HashMap<String, expression::Value>, specs: &[points::Spec]) {
    let share =
        !root.optional("output", Entry::table).ok().flatten().is_some_and(|output| output.get("reactions") == Some(&Value::Bool(true)));
    let unheard = Sink::default();
    let mut survey = joints::Survey::default();
    let mut sections = Sections::new(&unheard, root.meshes, parameters);
    sections.read(root.table, "joint", |_| Ok(()), |entry| joints::plan(assembly, entry, share, &mut survey));
    sections.read(
        root.table,
        "force",
        |_| Ok(()),
        |entry| {
            forces::needed(assembly, entry, &mut survey.needed);
            Ok(())
        },
    );
    // A named point beside a rod or a plate is held by nodes, too.
    for (k, body) in assembly.bodies.iter().enumerate() {
        survey.needed.extend(body.points.iter().map(|&(_, at)| (k, geometry::subtract(at, body.position))));
    }
    let places: Vec<Option<system::Place>> =
        assembly.points.iter().zip(specs).map(|(point, spec)| if points::is_driven(spec) { None } else { point.end.place() }).collect();
    let wanted = bodies::nodes::Wanted {
        bodies: &assembly.bodies,
        shared: &survey.shared,
        merged: &survey.merged,
        needed: &survey.needed,
        extent: survey.length(&assembly.bodies),
        length: survey.body_size(&assembly.bodies),
        points: &|k| places[k],
    };
    let size = if wanted.bodies.is_empty() { 0.0 } else { wanted.extent };
    assembly.builder.set_size(size);
    assembly.frames = bodies::nodes::make(&mut assembly.builder, &wanted);
}

fn build_joints(sections: &mut Sections<'_>, root: &Table, assembly: &mut Assembly<'_>) {
    let is_coupler = |entry: &Value| match entry {
        Value::Table(table) => joints::COUPLERS.iter().any(|kind| table.get("type") == Some(&Value::text(kind.name))),
        _ => false,
    };
    let Some(Value::Table(entries)) = root.get("joint") else {
        build_kinds(sections, root, "joint", &joints::kinds(), assembly);
        return;
    };
    for couplers in [false, true] {
        let part: Table =
            entries.iter().filter(|(_, entry)| is_coupler(entry) == couplers).map(|(name, entry)| (name, entry.clone())).collect();
        let table: Table = [("joint", Value::Table(part))].into_iter().collect();
        let faulty = build_kinds(sections, &table, "joint", &joints::kinds(), assembly);
        assembly.faulty_joints.extend(faulty);
    }
}

fn refuse_unknown(root: &Entry<'_>) {
    let tables = TABLES.map(|name| Key::optional(name, Shape::Table(&[]), "", "", ""));
    let known: Vec<&Key> = MODEL_KEYS.iter().chain(&tables).collect();
    root.refuse_unknown_keys("a model", &known);
}

fn schema_version(root: &Entry<'_>, key: &str) -> Read<()> {
    match root.whole(key, 0)? {
        SCHEMA => Ok(()),
        other => {
            Err(root.refuse(key, format!("this program reads schema {SCHEMA}, and this is {other}"), format!("write schema = {SCHEMA}")))
        }
    }
}

fn axes(root: &Entry<'_>) -> Axes {
    let planes: Vec<&'static str> = Axes::ALL[1..].iter().map(|axes| axes.name).collect();
    let plane = root.optional("plane", |root, key| root.choice(key, &planes)).unwrap_or(None);
    Axes::ALL.into_iter().find(|axes| plane.is_some_and(|plane| axes.name == plane)).unwrap_or(Axes::ALL[0])
}

/// Gravity in the axes of the model.
fn gravity(root: &Entry<'_>, axes: Axes) -> Read<[f64; 3]> {
    if !root.has("gravity") {
        return Ok(axes.of_world(GRAVITY));
    }
    let items = root.list("gravity")?;
    match items.len() {
        3 => Ok(axes.of_world(root.numbers("gravity", items)?)),
        _ => root.vector("gravity", axes.dimension()),
    }
}

/// Builds the entries of a section whose `type` is a line of a table.
fn build_kinds(
    sections: &mut Sections<'_>,
    root: &Table,
    section: &str,
    kinds: &[&'static Kind],
    assembly: &mut Assembly<'_>,
) -> HashSet<String> {
    let type_key = Key::required("type", Shape::Text, "", "");
    let kind_of = |entry: &Entry<'_>| {
        if !entry.has("type") {
            let known: Vec<String> = kinds.iter().map(|kind| format!("\"{}\"", kind.name)).collect();
            return Err(entry.refuse_all(format!("`{}` has no `type`", entry.name), format!("add type = {}", known.join(" or "))));
        }
        let text = entry.text("type")?;
        let known = kinds.iter().copied().find(|kind| kind.name == text);
        known.ok_or_else(|| {
            entry.refuse(
                "type",
                format!("there is no {section} of type \"{text}\""),
                fault::suggest(text, kinds.iter().map(|kind| kind.name)),
            )
        })
    };
    let chosen = std::cell::Cell::new(None::<&Kind>);
    let check = |entry: &Entry<'_>| {
        chosen.set(None);
        let kind = kind_of(entry)?;
        chosen.set(Some(kind));
        let keys: Vec<&Key> = kind.keys.iter().chain([&type_key, &REPEAT]).collect();
        entry.refuse_unknown_keys(&format!("a {section} of type \"{}\"", kind.name), &keys);
        Ok(())
    };
    sections.read(root, section, check, |entry| match chosen.get() {
        Some(kind) => (kind.build)(assembly, entry),
        None => Err(Refused),
    })
}
