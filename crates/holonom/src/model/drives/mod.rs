//! `[drive.NAME]`: motion that is imposed, with the effort it takes. A kind is one file here and its line in the table.

mod angle;
mod coordinate;
mod displacement;
mod distance;
mod point;
mod profile;

pub use angle::Angle;
pub use displacement::Displacement;
pub use distance::Distance;
pub use point::Point;
pub(in crate::model) use profile::rows;
pub use profile::{Profile, ProfileTable, Row};

use super::key::Kind;

/// All kinds of drives.
pub const KINDS: &[Kind] = &[Kind::of::<Angle>(), Kind::of::<Displacement>(), Kind::of::<Distance>(), Kind::of::<Point>()];
