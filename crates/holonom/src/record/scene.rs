//! How a mechanism is drawn: points and the lines between them. No coordinates of a run, only names.

use serde::Serialize;

/// What a viewer draws; the motion comes from the columns `NAME.x`, `NAME.y`, `NAME.z` of the recording.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scene {
    /// World axes that the recording holds: `"xyz"`, or the plane of a planar model (`"xy"`, `"xz"`, `"yz"`).
    pub axes: String,
    /// Direction and size of gravity in world axes (3), m/s².
    pub gravity: [f64; 3],
    pub points: Vec<ScenePoint>,
    pub lines: Vec<Line>,
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
}
