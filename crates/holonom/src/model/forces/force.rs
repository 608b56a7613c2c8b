use super::body_load::{self, Formulas, Given, VARIABLES, add};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::key::Shape;

/// a force at a place of a body, in the axes of the model or following the body, as formulas of time and of its motion
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "force",
    equations = "Q = F(t, x, v, ω), booked as work",
    example = r#"
[body.rocket]
mass = 3
shape = { cylinder = [0.1, 1] }
position = [0, 0, 0.5]

[body.rocket.points]
nozzle = [0.01, 0, -0.5]

[force.thrust]
type = "force"
body = "rocket"
at = "rocket.nozzle"
axes = "body"
force = ["0", "0.1*sin(t)", "40 - 0.2*vz^2 - x + 0.1*wy"]
"#
)]
pub struct Force {
    /// the body it acts on
    pub body: String,
    /// where it acts: a place at the start, or "BODY.POINT"
    #[key(unit = "m", default = "the centre of mass")]
    pub at: Option<Place>,
    /// its components as formulas of t, of x, y, z and vx, vy, vz of that place and of the angular velocity wx, wy, wz; in a planar
    /// model of those of its plane, with w for the angular velocity
    #[key(unit = "N", shape = Shape::Formulas(VARIABLES))]
    pub force: List<Number>,
    /// whether it is given in the axes of the model or of the body
    #[key(default = "\"world\"", shape = Shape::Choice(&["world", "body"]))]
    pub axes: Option<String>,
}

impl Element for Force {
    fn turns(&self) -> Vec<(&'static str, &str)> {
        vec![("body", &self.body)]
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let body = body_load::body(assembly, entry, "body", &self.body);
        let at = entry.optional("at", &self.at, |at, entry, key| assembly.place_at_start(entry, key, at));
        let (body, at) = (body?, at?);
        let place = at.unwrap_or(assembly.bodies[body].position);
        let at = assembly.body_end(body, place, "");
        let formulas = Formulas::Force(&self.force);
        add(assembly, entry, Given { body, at, other: None, formulas, axes: self.axes.as_deref() })
    }
}
