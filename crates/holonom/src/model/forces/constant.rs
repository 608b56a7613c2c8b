use super::point_load;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::system::{self, ForceFunction};

/// a force on a point, or on a place of a body, that never changes, booked as work
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "constant",
    equations = "Q = F",
    example = r#"
[point.bob]
mass = 1
position = [1, 0, 0]

[force.wind]
type = "constant"
point = "bob"
force = [0, 2, 0]
"#
)]
pub struct Constant {
    /// the point it acts on
    #[key(shape = Shape::Point)]
    pub point: String,
    /// the force, in the axes of the model
    #[key(unit = "N", shape = Shape::Vector)]
    pub force: List<Number>,
}

impl Element for Constant {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (point, force) = (assembly.point(entry, "point", &self.point), self.force.vector(entry, "force", assembly.dimension()));
        point_load::add(assembly, entry, &point?, Steady(force?))
    }
}

struct Steady([f64; 3]);

impl ForceFunction for Steady {
    fn evaluate<N: system::Number>(&self, _x: &[N], _v: &[N], _t: N, force: &mut [N]) {
        force.iter_mut().zip(self.0).for_each(|(force, steady)| *force = N::from(steady));
    }
}
