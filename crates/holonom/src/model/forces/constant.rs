use std::sync::Arc;

use super::point_load::PointLoad;
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};
use crate::system::{Differentiated, ForceFunction, Number};

pub(super) const KIND: Kind = Kind {
    name: "constant",
    doc: "a force on a point, or on a place of a body, that never changes, booked as work",
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
    let (point, force) = (assembly.point(entry, "point"), entry.vector("force", assembly.dimension()));
    let (load, nodes) = PointLoad::new(entry, &point?, Steady(force?))?;
    assembly.builder.load(entry.name, &nodes, Arc::new(Differentiated(load)));
    Ok(())
}

struct Steady([f64; 3]);

impl ForceFunction for Steady {
    fn evaluate<N: Number>(&self, _x: &[N], _v: &[N], _t: N, force: &mut [N]) {
        force.iter_mut().zip(self.0).for_each(|(force, steady)| *force = N::from(steady));
    }
}
