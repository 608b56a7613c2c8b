//! `[constraint.NAME]`: rows of points. A kind is one file here and its line in the table.

mod collinear;
mod distance;
mod expression;
mod fixed;
mod perpendicular;
mod point_on_line;
mod point_on_plane;

pub use collinear::Collinear;
pub use distance::Distance;
pub use expression::Expression;
pub use fixed::Fixed;
pub use perpendicular::Perpendicular;
pub use point_on_line::PointOnLine;
pub use point_on_plane::PointOnPlane;

use super::key::Kind;

/// All kinds of constraints.
pub const KINDS: &[Kind] = &[
    Kind::of::<Distance>(),
    Kind::of::<Collinear>(),
    Kind::of::<Perpendicular>(),
    Kind::of::<PointOnLine>(),
    Kind::of::<PointOnPlane>(),
    Kind::of::<Fixed>(),
    Kind::of::<Expression>(),
];
