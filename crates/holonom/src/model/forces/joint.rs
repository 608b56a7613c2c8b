//! The joint coordinate that a force acts along.

use crate::model::assembly::Assembly;
use crate::model::joints::Coordinate;
use crate::record::{Along, Shows};
use crate::system::FunctionId;

/// A coordinate as a quantity of the equations. What acts along it is recorded.
pub(super) fn acted_on(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let q = quantity(assembly, coordinate);
    let words = format!("effort along the {} of {}", coordinate.name, coordinate.joint);
    let along = Along { coordinate: q, value: None, effort: ["effort".into(), words], is_angle: coordinate.is_angle };
    assembly.show(Shows::Along(vec![along]));
    q
}

/// A coordinate as a quantity of the equations.
pub(super) fn quantity(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let part = assembly.builder.part(&coordinate.form);
    assembly.builder.sum(&[(part, 1.0)])
}
