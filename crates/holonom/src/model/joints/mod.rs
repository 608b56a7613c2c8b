//! `[joint.NAME]`: what ties bodies together. A kind is one file here and its line in the table.

mod coupler;
mod curve;
mod geometry;
mod pair;

mod constant_velocity;
mod cylindrical;
mod distance;
mod fixed;
mod gear;
mod generic;
mod linear;
mod orientation;
mod parallel;
mod perpendicular;
mod planar;
mod point_on_curve;
mod point_on_line;
mod point_on_plane;
mod prismatic;
mod pulley;
mod rack_and_pinion;
mod revolute;
mod rolling;
mod screw;
mod spherical;
mod universal;

pub use coupler::coordinate;
pub use geometry::{Geometry, Survey, plan};
pub use pair::{Coordinate, Joint, Pair};

use super::key::{Key, Kind};

/// A joint between two bodies: what `type` may say, beside couplers of other joints.
pub struct JointKind {
    pub kind: Kind,
    /// Degrees of freedom that two bodies keep against each other, in space and in the plane; none where a planar model
    /// has no such joint.
    pub freedom: [Option<usize>; 2],
    /// Where it sits.
    at: Site,
    /// How many directions it has, in space and in the plane: none, one of both bodies, or one of each.
    axes: [usize; 2],
    /// What both bodies have in common, in space and in the plane.
    shares: [&'static [Feature]; 2],
    rows: fn(&mut Pair<'_, '_>) -> super::fault::Read<()>,
}

/// What both bodies of a joint have in common and may share a node for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Feature {
    Point,
    /// The directions of the triad u, v, w.
    Axis(usize),
    /// Everything: the two bodies are one.
    All,
}

/// Where a joint sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Site {
    /// `at` must be given.
    Given,
    /// The centre of the second body where `at` is not given.
    Any,
    /// Two places, one of each body.
    Two,
}

/// Joints between two bodies.
pub const JOINTS: &[JointKind] = &[
    spherical::JOINT,
    revolute::JOINT,
    prismatic::JOINT,
    cylindrical::JOINT,
    universal::JOINT,
    planar::JOINT,
    fixed::JOINT,
    screw::JOINT,
    constant_velocity::JOINT,
    point_on_line::JOINT,
    point_on_plane::JOINT,
    point_on_curve::JOINT,
    parallel::JOINT,
    perpendicular::JOINT,
    orientation::JOINT,
    distance::JOINT,
    generic::JOINT,
    rolling::JOINT,
];

/// Couplers of the coordinates of other joints.
pub const COUPLERS: &[Kind] =
    &[Kind::of::<gear::Gear>(), Kind::of::<rack_and_pinion::RackAndPinion>(), Kind::of::<pulley::Pulley>(), Kind::of::<linear::Linear>()];

/// All that `type` may say.
pub fn kinds() -> Vec<&'static Kind> {
    JOINTS.iter().map(|joint| &joint.kind).chain(COUPLERS).collect()
}

const BETWEEN: Key = Key::required("between", super::key::Shape::Members, "", "the two bodies, or a body and \"ground\"");
const AT: Key =
    Key::required("at", super::key::Shape::Site, "m", "where it sits at the start: a place, \"BODY.POINT\", or one for each body");
const AT_ANY: Key = Key::optional(
    "at",
    super::key::Shape::Site,
    "the centre of the second body",
    "m",
    "where displacements and moments are measured: a place, \"BODY.POINT\", or one for each body",
);
const AXIS: Key = Key::optional(
    "axis",
    super::key::Shape::Direction,
    "needed",
    "any",
    "its direction at the start: a vector, \"BODY.AXIS\", or one for each body",
);
const AXES: Key =
    Key::required("axes", super::key::Shape::Directions, "any", "a direction of the first body and one of the second, at the start");
