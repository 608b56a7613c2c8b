//! The joint coordinate that a force acts along.

use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::joints::{Coordinate, coordinate};
use crate::model::key::{Key, Shape};
use crate::system::FunctionId;

/// The key of the joint.
pub(super) const JOINT: Key =
    Key::required("joint", Shape::Text, "", "the joint, or its coordinate as \"JOINT.angle\" or \"JOINT.displacement\"");

/// The coordinate at `joint`.
pub(super) fn read(assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<Coordinate> {
    coordinate(assembly, entry, "joint".into(), entry.text("joint")?)
}

/// A coordinate as a quantity of the equations.
pub(super) fn quantity(assembly: &mut Assembly<'_>, coordinate: &Coordinate) -> FunctionId {
    let part = assembly.builder.part(&coordinate.form);
    assembly.builder.sum(&[(part, 1.0)])
}
