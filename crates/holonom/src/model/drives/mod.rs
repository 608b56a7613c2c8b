//! `[drive.NAME]`: motion that is imposed, with the effort it takes. A kind is one file here and its line in the table.

mod angle;
mod coordinate;
mod displacement;
mod distance;
mod point;
mod profile;

use super::key::Kind;

/// All kinds of drives.
pub const KINDS: &[Kind] = &[angle::KIND, displacement::KIND, distance::KIND, point::KIND];
