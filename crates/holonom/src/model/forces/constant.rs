use super::point_load;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::model::signals::Readings;
use crate::system::Reading;

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
        let dim = assembly.dimension();
        let (point, force) = (assembly.point(entry, "point", &self.point), self.force.vector(entry, "force", dim));
        let formulas = force?[..dim].iter().map(|&force| Program::constant(force)).collect();
        point_load::add(assembly, entry, &point?, Readings::new(dim, Reading::default()), formulas)
    }
}
