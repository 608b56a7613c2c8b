//! `[force.NAME]`: springs, dampers and loads. A kind is one file here and its line in the table.

mod constant;
mod expression;
mod laws;
mod point_load;
mod spring;

use super::key::Kind;

/// All kinds of forces.
pub const KINDS: &[Kind] = &[spring::KIND, constant::KIND, expression::KIND];
