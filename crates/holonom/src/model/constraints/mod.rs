//! `[constraint.NAME]`: rows between points. A kind is one file here and its line in the table.

mod collinear;
mod distance;
mod fixed;
mod perpendicular;
mod point_on_line;
mod point_on_plane;

use super::key::Kind;

/// All kinds of constraints.
pub const KINDS: &[Kind] = &[distance::KIND, collinear::KIND, perpendicular::KIND, point_on_line::KIND, point_on_plane::KIND, fixed::KIND];
