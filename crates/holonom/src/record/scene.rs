//! How a mechanism is drawn: points, the lines between them, rigid bodies and their joints. No coordinates of a run, only names.

use serde::{Serialize, Serializer};

/// What a viewer draws. The motion comes from the columns of the recording: `NAME.x`, `NAME.y`, `NAME.z` of a point and of the centre
/// of mass of a body; `NAME.qw`, `NAME.qx`, `NAME.qy`, `NAME.qz`, the unit quaternion from the axes of a body to those of the world;
/// in a planar model `NAME.angle`, by which a body has turned from the first axis of the plane towards the second.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scene {
    /// World axes that the recording holds: `"xyz"`, or the plane of a planar model (`"xy"`, `"xz"`, `"yz"`).
    pub axes: String,
    /// Direction and size of gravity in world axes (3), m/s².
    pub gravity: [f64; 3],
    pub points: Vec<ScenePoint>,
    pub lines: Vec<Line>,
    pub bodies: Vec<SceneBody>,
    pub joints: Vec<SceneJoint>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScenePoint {
    pub name: String,
    pub kind: PointKind,
    /// kg; 0 for a point whose mass comes from bars.
    pub mass: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PointKind {
    Free,
    Driven,
    Fixed,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    pub name: String,
    pub kind: LineKind,
    pub from: Anchor,
    pub to: Anchor,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineKind {
    /// A body with mass.
    Bar,
    /// A massless rod: a distance that is kept.
    Rod,
    /// A spring or damper.
    Spring,
    /// A line along which something slides, or that keeps points straight.
    Guide,
}

/// An end of a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Anchor {
    /// A point of the model, by name.
    Point(String),
    /// A fixed place in world axes (3), m.
    Fixed([f64; 3]),
    /// A place of a rigid body, in its axes from its centre of mass (3), m.
    Body { body: String, at: [f64; 3] },
}

/// A rigid body. Places are in body axes from the centre of mass, m; in a planar model these are the world axes turned by the angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneBody {
    pub name: String,
    /// kg.
    pub mass: f64,
    /// What it looks like; without, it is sketched from `places`.
    pub shape: Option<SceneShape>,
    /// Where joints, springs and named points are.
    pub places: Vec<[f64; 3]>,
}

/// The solid of a body around its centre of mass, lengths in m. In a planar model x and y of a shape lie along the first and the second
/// axis of the plane, and z goes across it; it is drawn flat.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum SceneShape {
    /// Full edges along x, y, z.
    Box {
        size: [f64; 3],
    },
    /// Axis along z.
    Cylinder {
        radius: f64,
        length: f64,
    },
    Sphere {
        radius: f64,
    },
    /// Slender, along x.
    Rod {
        length: f64,
    },
    /// A cylinder along z of the given length, with half a ball on either end.
    Capsule {
        radius: f64,
        length: f64,
    },
    /// Triangles as indices of vertices, counter-clockwise seen from outside.
    Mesh {
        #[serde(serialize_with = "as_singles")]
        vertices: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
    },
}

/// A joint, drawn as a symbol of its kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneJoint {
    pub name: String,
    /// As in a model file: `"revolute"`, `"point-on-line"`, ...
    pub kind: String,
    /// The body that carries the place and the axis; none: fixed in the world.
    pub body: Option<String>,
    /// What `body` is joined to, a body or a point; none: the world.
    pub other: Option<String>,
    /// Place in the axes of `body` from its centre of mass, or in the world (3), m.
    pub at: [f64; 3],
    /// Direction in the same axes, of any length.
    pub axis: Option<[f64; 3]>,
}

/// A picture needs no more digits, and a mesh has many numbers.
fn as_singles<S: Serializer>(vertices: &[[f64; 3]], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(vertices.iter().map(|vertex| vertex.map(|x| x as f32)))
}
