use super::point_load;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::model::signals::{Reader, Readings};
use crate::model::tables::require_inside;
use crate::system::Reading;

/// Time, and position and velocity in world axes.
const VARIABLES: &[&str] = &["t", "x", "y", "z", "vx", "vy", "vz"];

/// a force on a point as formulas of time, its position and its velocity, booked as work
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "expression",
    equations = "Q = F(t, x, v)",
    example = r#"
[point.bob]
mass = 1
position = [1, 0, 0]

[force.drag]
type = "expression"
point = "bob"
force = ["-0.1*vx*sqrt(vx^2 + vy^2 + vz^2 + 1e-12)", "sin(t)", "-z^3"]
"#
)]
pub struct Expression {
    /// the point it acts on
    #[key(shape = Shape::Point)]
    pub point: String,
    /// its components as formulas of t, x, y, z, vx, vy, vz; a planar model has those of its plane
    #[key(unit = "N", shape = Shape::Formulas(VARIABLES))]
    pub force: List<Number>,
}

impl Element for Expression {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let dim = assembly.dimension();
        let axes = assembly.axes.name;
        let here = |name: &&&str| **name == "t" || name.chars().last().is_some_and(|axis| axes.contains(axis));
        let variables: Vec<&str> = VARIABLES.iter().filter(here).copied().collect();
        let point = assembly.point(entry, "point", &self.point);
        let mut readings = Readings::new(dim, Reading::default());
        let mut reader = Reader::new(assembly, entry, &mut readings);
        let force = self.force.formulas_reading(entry, "force", dim, &variables, &mut reader);
        let (point, force) = (point?, force?);
        let start = point.start;
        let at: Vec<f64> = std::iter::once(0.0).chain(start[..dim].iter().copied()).chain([0.0; 3]).collect();
        for (k, component) in force.iter().enumerate().filter(|_| readings.len() == 0) {
            let value = component.evaluate(&at);
            if !value.is_finite() {
                let spot = Spot { key: "force", item: Some(k) };
                require_inside(entry, spot, component, &at)?;
                return Err(entry.refuse(
                    spot,
                    format!("this formula is {value} where the point starts, at rest and at t = 0"),
                    "it must be finite",
                ));
            }
        }
        point_load::add(assembly, entry, &point, readings, force)
    }
}
