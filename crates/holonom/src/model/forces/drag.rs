use super::body_load::{self, Formulas, Given, add};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};

/// resistance of air or water to a body, against its velocity and as its square
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "drag",
    equations = "Q = −c |v| v, booked as work",
    example = r#"
[body.ball]
mass = 0.4
shape = { sphere = 0.11 }
position = [0, 0, 0]
velocity = [20, 0, 10]

[force.air]
type = "drag"
body = "ball"
coefficient = 0.006
"#
)]
pub struct Drag {
    /// the body it acts on, at its centre of mass
    pub body: String,
    /// c: half the density times the area across the flow times the drag coefficient
    #[key(unit = "kg/m")]
    pub coefficient: Number,
}

impl Element for Drag {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (body, c) = (body_load::body(assembly, entry, "body", &self.body), self.coefficient.not_negative(entry, "coefficient"));
        let (body, c) = (body?, c?);
        let at = assembly.body_end(body, assembly.bodies[body].position, "");
        let names = ["vx", "vy", "vz"].map(|name| name.to_string());
        let speed = "sqrt(vx^2 + vy^2 + vz^2)";
        let force: List<Number> = names.map(|name| format!("-{c}*{speed}*{name}")).into();
        add(assembly, entry, Given { body, at, other: None, formulas: Formulas::Force(&force), axes: None })
    }
}
