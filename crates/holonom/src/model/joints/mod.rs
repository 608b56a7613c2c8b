//! `[joint.NAME]`: what ties bodies together. A kind is one file here and its line in the table.

use std::fmt::Debug;

mod coupler;
mod curve;
mod geometry;
pub(super) mod pair;

mod cam;
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
mod revolute_spherical;
mod rolling;
mod screw;
mod spherical;
mod transmission;
mod universal;

pub use cam::Cam;
pub use constant_velocity::ConstantVelocity;
pub use coupler::coordinate;
pub use cylindrical::Cylindrical;
pub use distance::Distance;
pub use fixed::Fixed;
pub use gear::Gear;
pub use generic::Generic;
pub use geometry::Geometry;
pub(super) use geometry::{Survey, survey};
pub use linear::{Linear, Term};
pub use orientation::Orientation;
pub use pair::{Coordinate, JointInfo, Pair};
pub use parallel::Parallel;
pub use perpendicular::Perpendicular;
pub use planar::Planar;
pub use point_on_curve::PointOnCurve;
pub use point_on_line::PointOnLine;
pub use point_on_plane::PointOnPlane;
pub use prismatic::Prismatic;
pub use pulley::Pulley;
pub use rack_and_pinion::RackAndPinion;
pub use revolute::Revolute;
pub use revolute_spherical::RevoluteSpherical;
pub use rolling::Rolling;
pub use screw::Screw;
pub use spherical::Spherical;
pub use universal::Universal;

pub use holonom_derive::Sides;

use super::fault::Read;
use super::fields::{Described, Site};
use super::key::Kind;

/// What to use in place of a joint that a planar model does not have.
pub(super) const OTHERS_IN_PLANE: &str = "use one of those in the plane: revolute, prismatic, fixed, point-on-line, point-on-curve, orientation, distance, or a rack-and-pinion for a wheel that rolls along a line";

/// A joint between two bodies, beside its keys.
pub trait Joint: Described + Sides + Debug + Send + Sync + 'static {
    /// How it sits between its bodies.
    const LAYOUT: Layout;

    /// Adds the rows and coordinates.
    ///
    /// # Errors
    /// What is wrong with its keys; the faults are recorded.
    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()>;
}

/// How a joint sits between its bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Degrees of freedom that two bodies keep against each other, in space and in the plane; none where a planar model
    /// has no such joint.
    pub freedom: [Option<usize>; 2],
    /// Whether it needs a place, and how many.
    pub at: Seat,
    /// How many directions it has, in space and in the plane: none, one of both bodies (`axis`), or one of each (`axes`).
    pub directions: [usize; 2],
    /// What both bodies have in common, in space and in the plane.
    pub shares: [&'static [Feature]; 2],
    /// Whether the second side may be a point. A joint that has a direction or holds rotation needs two bodies, unless, as that of a
    /// point on a line, all of this belongs to the first.
    pub takes_point: bool,
}

impl Layout {
    /// Whether it holds or follows how a side is turned, and not one place of it alone.
    pub fn turns(&self, side: usize) -> bool {
        let holds_places = self.directions[0] == 0 && (self.at == Seat::Two || self.shares[0] == [Feature::Point]);
        let is_point = side == 1 && self.takes_point;
        !holds_places && !is_point
    }
}

/// The keys that joints have in common; `#[derive(Sides)]` implements it for a struct with a field `between` and, where the joint
/// has them, fields `at` and `axis` or `axes`.
pub trait Sides {
    /// The names of the two bodies: `between`.
    fn between(&self) -> &[String];

    /// Where it sits: `at`.
    fn at(&self) -> Option<&Site>;

    /// How it is directed: `axis` or `axes`.
    fn directions(&self) -> Option<&Site>;
}

/// A joint of any kind.
pub trait AnyJoint: Sides {
    /// What `type` says.
    fn name(&self) -> &'static str;

    /// How it sits between its bodies.
    fn layout(&self) -> Layout;

    /// Adds the rows and coordinates.
    ///
    /// # Errors
    /// What is wrong with its keys; the faults are recorded.
    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()>;
}

impl<T: Joint> AnyJoint for T {
    fn name(&self) -> &'static str {
        T::NAME
    }

    fn layout(&self) -> Layout {
        T::LAYOUT
    }

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        Joint::rows(self, pair)
    }
}

/// What both bodies of a joint have in common and may share a node for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// The place of the joint.
    Point,
    /// The directions of the triad u, v, w.
    Axis(usize),
    /// Everything: the two bodies are one.
    All,
}

/// Where a joint sits: what its key `at` says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seat {
    /// `at` must be given.
    Given,
    /// The centre of the second body where `at` is not given.
    Any,
    /// Two places, one of each body.
    Two,
}

/// Joints between two bodies.
pub const JOINTS: &[Kind] = &[
    Kind::of::<Spherical>(),
    Kind::of::<Revolute>(),
    Kind::of::<Prismatic>(),
    Kind::of::<Cylindrical>(),
    Kind::of::<Universal>(),
    Kind::of::<Planar>(),
    Kind::of::<Fixed>(),
    Kind::of::<Screw>(),
    Kind::of::<ConstantVelocity>(),
    Kind::of::<PointOnLine>(),
    Kind::of::<PointOnPlane>(),
    Kind::of::<PointOnCurve>(),
    Kind::of::<Parallel>(),
    Kind::of::<Perpendicular>(),
    Kind::of::<Orientation>(),
    Kind::of::<Distance>(),
    Kind::of::<RevoluteSpherical>(),
    Kind::of::<Generic>(),
    Kind::of::<Rolling>(),
];

/// Couplers of the coordinates of other joints.
pub const COUPLERS: &[Kind] =
    &[Kind::of::<Gear>(), Kind::of::<RackAndPinion>(), Kind::of::<Pulley>(), Kind::of::<Linear>(), Kind::of::<Cam>()];

/// All that `type` may say.
pub fn kinds() -> impl Iterator<Item = &'static Kind> {
    JOINTS.iter().chain(COUPLERS)
}
