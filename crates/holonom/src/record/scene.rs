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
    /// Points of the model, in file order.
    pub points: Vec<ScenePoint>,
    /// Bars, rods, springs and guides.
    pub lines: Vec<Line>,
    /// Rigid bodies, in file order.
    pub bodies: Vec<SceneBody>,
    /// Joints between bodies.
    pub joints: Vec<SceneJoint>,
    /// Forces and moments on points and bodies.
    pub loads: Vec<SceneLoad>,
    /// Bushings, where they sit on their second body.
    pub bushings: Vec<SceneLoad>,
    /// Wheels that couplers tie.
    pub wheels: Vec<SceneWheels>,
}

/// A point of the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScenePoint {
    /// As in the columns of its motion.
    pub name: String,
    /// What moves it, if anything.
    pub kind: PointKind,
    /// kg; 0 for a point whose mass comes from bars.
    pub mass: f64,
}

/// What moves a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PointKind {
    /// The forces on it: its motion is sought.
    Free,
    /// A drive: its motion is given over time.
    Driven,
    /// Nothing: it stays where it is.
    Fixed,
}

/// A straight line between two places.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Of the bar, force, drive, joint or constraint that it stands for.
    pub name: String,
    /// What it stands for, and so what it looks like.
    pub kind: LineKind,
    /// Where it begins.
    pub from: Anchor,
    /// Where it ends.
    pub to: Anchor,
    /// What a spring acts along where that is not the line itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<SceneAxis>,
}

/// A direction of unit length.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneAxis {
    /// The body that turns it; none: it stays.
    pub body: Option<String>,
    /// In the axes of the body, or of the world (3).
    pub axis: [f64; 3],
}

/// What a line stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineKind {
    /// A body with mass.
    Bar,
    /// A massless rod: a distance that is kept.
    Rod,
    /// A spring.
    Spring,
    /// A distance that is driven, or a damper or a force between two places: a rod that slides in a barrel.
    Cylinder,
    /// A stretch of a rope.
    Rope,
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
    /// A place of a rigid body, which moves with it.
    Body {
        /// Name of the body.
        body: String,
        /// Place in body axes from the centre of mass (3), m.
        at: [f64; 3],
    },
}

/// A rigid body. Places are in body axes from the centre of mass, m; in a planar model these are the world axes turned by the angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneBody {
    /// As in the columns of its motion.
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
        /// Lengths of the edges.
        size: [f64; 3],
    },
    /// Axis along z.
    Cylinder {
        /// From the axis to the surface.
        radius: f64,
        /// From one flat end to the other.
        length: f64,
    },
    /// A full ball.
    Sphere {
        /// From the centre to the surface.
        radius: f64,
    },
    /// Slender, along x.
    Rod {
        /// From end to end.
        length: f64,
    },
    /// A cylinder along z of the given length, with half a ball on either end.
    Capsule {
        /// Of the cylinder and of both half balls.
        radius: f64,
        /// Of the cylinder alone.
        length: f64,
    },
    /// Triangles as indices of vertices, counter-clockwise seen from outside.
    Mesh {
        /// Places of the corners (3 each), written in single precision.
        #[serde(serialize_with = "as_singles")]
        vertices: Vec<[f64; 3]>,
        /// Three vertices each.
        triangles: Vec<[u32; 3]>,
    },
}

/// A joint, drawn as a symbol of its kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneJoint {
    /// As in the model, with its index where it is repeated.
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
    /// Whether the columns of its force are on `other` and not on `body`.
    pub acts_on_other: bool,
    /// Drives and efforts along its coordinates, by name.
    pub drives: Vec<String>,
    /// Of the disc that rolls on a plane, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Places along the curve that a point follows, in the axes of `body` from its centre of mass, or in the world (3 each), m.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<[f64; 3]>,
}

/// Two wheels with teeth or a belt between them, or a wheel and a rack.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneWheels {
    /// Of the coupler.
    pub name: String,
    /// What ties them.
    pub kind: WheelsKind,
    /// The joints that they turn about; the second may be the rail of a rack.
    pub joints: [String; 2],
    /// The bodies that they are on; none: fixed in the world.
    pub bodies: [Option<String>; 2],
    /// Radii, of gears those of the pitch circles, m; none of a rack.
    pub radii: [Option<f64>; 2],
}

/// What ties two wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WheelsKind {
    /// Teeth.
    Gear,
    /// A belt around both.
    Belt,
    /// A belt that crosses itself.
    CrossedBelt,
}

/// A force or moment of which columns are recorded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneLoad {
    /// As in its columns.
    pub name: String,
    /// Where it acts.
    pub at: Anchor,
}

/// A picture needs no more digits, and a mesh has many numbers.
fn as_singles<S: Serializer>(vertices: &[[f64; 3]], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(vertices.iter().map(|vertex| vertex.map(|x| x as f32)))
}
