//! The joint coordinate that a force acts along.

use crate::model::assembly::Assembly;
use crate::model::joints::Coordinate;
use crate::system::FunctionId;

/// A coordinate as a quantity of the equations.
pub(super) fn quantity(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let part = assembly.builder.part(&coordinate.form);
    assembly.builder.sum(&[(part, 1.0)])
}
