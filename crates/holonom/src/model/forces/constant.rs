use std::sync::Arc;

use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::{Read, Refused};
use crate::model::key::{Key, Kind, Shape};
use crate::system::{Load, NodeId, Place};

pub(super) const KIND: Kind = Kind {
    name: "constant",
    doc: "a force on a point that never changes, booked as work",
    equations: "Q = F",
    keys: &[
        Key::required("point", Shape::Point, "", "the point it acts on"),
        Key::required("force", Shape::Vector, "N", "the force, in the axes of the model"),
    ],
    example: r#"
[point.bob]
mass = 1
position = [1, 0, 0]

[force.wind]
type = "constant"
point = "bob"
force = [0, 2, 0]
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let (node, force) = (loaded(assembly, entry), entry.vector("force", assembly.dimension()));
    assembly.builder.load(entry.name, &[node?], Arc::new(Steady(force?)));
    Ok(())
}

/// The node of the point that a load acts on.
pub(super) fn loaded(assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<NodeId> {
    match assembly.point(entry, "point")?.place {
        Place::Node(node) => Ok(node),
        Place::Fixed(_) => Err(refused(entry)),
    }
}

fn refused(entry: &Entry<'_>) -> Refused {
    entry.refuse("point", "a force on a fixed point does nothing", "name a point that can move")
}

struct Steady([f64; 3]);

impl Load for Steady {
    fn force(&self, _x: &[f64], _v: &[f64], _t: f64, force: &mut [f64]) {
        force.copy_from_slice(&self.0[..force.len()]);
    }

    fn tangent(&self, _x: &[f64], _v: &[f64], _t: f64, _by_position: &mut [f64], _by_velocity: &mut [f64]) {}
}
