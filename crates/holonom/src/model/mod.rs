//! What people write: a description, read with all its faults at once and compiled to a system.
//!
//! No files, no clock, no printing. A description is a [`Value`] without places in a file; faults name paths in it, and
//! who has read the file knows where they are.

pub mod constraints;
pub mod forces;

mod assembly;
mod bars;
mod entry;
mod expression;
mod fault;
mod key;
mod parameters;
mod points;
mod repeat;
mod schema;
mod section;
mod settings;
#[cfg(test)]
mod tests;
mod value;

pub use assembly::{Axes, GROUND};
pub use bars::{BarInfo, KEYS as BAR_KEYS};
pub use fault::{Fault, Faults, nearest};
pub use key::{Key, Kind, REPEAT, Shape};
pub use points::KEYS as POINT_KEYS;
pub use schema::schema;
pub use settings::{
    OUTPUT as OUTPUT_KEYS, Output, PROJECTION as PROJECTION_KEYS, ProjectionSettings, SIMULATION as SIMULATION_KEYS, Settings,
};
pub use value::{Table, Value, item_path, key_path};

use assembly::Assembly;
use entry::Entry;
use expression::Scope;
use fault::{Read, Refused, Sink};
use section::Sections;

use crate::record::{PointKind, Scene, ScenePoint};
use crate::system::{Place, System, SystemBuilder};

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
const TABLES: [&str; 7] = ["parameters", "point", "bar", "constraint", "force", "simulation", "output"];

/// A point of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct PointInfo {
    pub name: String,
    /// Its node, or where it is fixed, m.
    pub place: Place,
    /// Its own mass, kg.
    pub mass: f64,
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
    pub system: System,
    pub settings: Settings,
    pub output: Output,
    /// How it is drawn.
    pub scene: Scene,
    /// In file order.
    pub points: Vec<PointInfo>,
    /// In file order.
    pub bars: Vec<BarInfo>,
}

impl Model {
    /// Reads a description.
    ///
    /// # Errors
    /// Everything that is wrong with it, with paths into the description.
    pub fn from_value(value: &Value) -> Result<Self, Faults> {
        let sink = Sink::default();
        let model = read(value, &sink);
        match (sink.finish(), model) {
            (Ok(()), Ok(model)) => Ok(model),
            (Err(faults), _) => Err(faults),
            (Ok(()), Err(Refused)) => unreachable!("what is refused has a fault"),
        }
    }
}

fn read(value: &Value, sink: &Sink) -> Read<Model> {
    let Value::Table(table) = value else {
        return Err(sink.report(|| Fault::new("", value.quoted(), "a model is a table", "")));
    };
    let parameters = match table.get("parameters") {
        Some(Value::Table(table)) => parameters::read(table, sink),
        _ => Default::default(),
    };
    let scope = Scope { parameters: Some(&parameters), indices: &[] };
    let root = Entry { name: "", path: "", table, scope, sink };
    refuse_unknown(&root);
    let _ = root.optional("parameters", Entry::table);
    let _ = root.optional("schema", schema_version);
    let title = root.optional("title", Entry::text).unwrap_or(None).unwrap_or("").to_string();
    let axes = axes(&root);
    let gravity = gravity(&root, axes).unwrap_or_default();

    let mut sections = Sections::new(sink, &parameters);
    let (specs, faulty) = points::read(&mut sections, table, axes);
    let mut assembly = Assembly {
        builder: SystemBuilder::new(axes.dimension(), gravity),
        axes,
        gravity,
        sink,
        points: Vec::new(),
        by_name: Default::default(),
        faulty,
        lines: Vec::new(),
    };
    points::add(&mut assembly, specs);
    let bars = bars::read(&mut sections, table, &mut assembly);
    build_kinds(&mut sections, table, "constraint", constraints::KINDS, &mut assembly);
    build_kinds(&mut sections, table, "force", forces::KINDS, &mut assembly);
    points::check_mass(&assembly);
    let settings = settings::read(&root, &assembly).unwrap_or_default();
    let output = settings::output(&root, &assembly).unwrap_or_default();
    if sink.count() > 0 {
        return Err(Refused);
    }
    Ok(finish(assembly, title, settings, output, bars))
}

/// Puts together what has been read without a fault.
fn finish(assembly: Assembly<'_>, title: String, settings: Settings, output: Output, bars: Vec<BarInfo>) -> Model {
    let Assembly { builder, axes, gravity, points, lines, .. } = assembly;
    let kind = |point: &assembly::Point| match (point.end.place, point.end.free) {
        (Place::Fixed(_), _) => PointKind::Fixed,
        (_, true) => PointKind::Free,
        (_, false) => PointKind::Driven,
    };
    let scene = Scene {
        axes: axes.name.to_string(),
        gravity: axes.in_world(gravity),
        points: points.iter().map(|point| ScenePoint { name: point.name.clone(), kind: kind(point), mass: point.mass }).collect(),
        lines,
    };
    let points = points
        .into_iter()
        .map(|point| PointInfo { kind: kind(&point), name: point.name, place: point.end.place, mass: point.mass })
        .collect();
    Model {
        title,
        dimension: axes.dimension(),
        axes: axes.name,
        gravity: scene.gravity,
        system: builder.build(),
        settings,
        output,
        scene,
        points,
        bars,
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
fn build_kinds(sections: &mut Sections<'_>, root: &Table, section: &str, kinds: &[Kind], assembly: &mut Assembly<'_>) {
    let type_key = Key::required("type", Shape::Text, "", "");
    let kind_of = |entry: &Entry<'_>| {
        if !entry.has("type") {
            let known: Vec<String> = kinds.iter().map(|kind| format!("\"{}\"", kind.name)).collect();
            return Err(entry.refuse_all(format!("`{}` has no `type`", entry.name), format!("add type = {}", known.join(" or "))));
        }
        let text = entry.text("type")?;
        let known = kinds.iter().find(|kind| kind.name == text);
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
    });
}
