//! The joint coordinate that a force acts along.

use crate::model::assembly::Assembly;
use crate::model::joints::Coordinate;
use crate::record::{Along, Shows};
use crate::system::FunctionId;

/// A coordinate as a quantity of the equations. What acts along it is recorded.
pub(super) fn acted_on(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let along = along(assembly, coordinate);
    let q = along.coordinate;
    assembly.show(Shows::Along(vec![along]));
    q
}

/// A coordinate as a quantity of the equations, and what is recorded along it.
pub(super) fn along(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> Along {
    let words = format!("effort along the {} of {}", coordinate.name, coordinate.joint);
    let effort = ["effort".into(), words];
    Along { coordinate: quantity(assembly, coordinate), value: None, effort, is_angle: coordinate.is_angle }
}

/// A coordinate as a quantity of the equations.
pub(super) fn quantity(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let part = assembly.builder.part(&coordinate.form);
    assembly.builder.sum(&[(part, 1.0)])
}
