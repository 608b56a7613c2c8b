use super::body_load::{self, Formulas, Given, VARIABLES, add};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Turn};
use crate::model::key::Shape;

/// a torque on a body, which may react on another one, as formulas of time and of the motion of the body
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "torque",
    equations = "Q of each body axis e_k: ½ n × e_k; booked as work",
    example = r#"
[body.rotor]
mass = 1
inertia = [0.1, 0.1, 0.2, 0.01, 0, 0]
position = [0, 0, 0]
angular_velocity = [0.1, 0, 1]

[body.stator]
mass = 2
inertia = [0.3, 0.3, 0.4]
position = [0, 0, -0.3]

[force.motor]
type = "torque"
body = "rotor"
reaction = "stator"
axes = "body"
torque = ["-0.1*wx", "0", "0.033*cos(t) - 0.01*wz"]
"#
)]
pub struct Torque {
    /// the body it acts on
    pub body: String,
    /// three formulas of t, of x, y, z and vx, vy, vz of the centre of mass and of the angular velocity wx, wy, wz; in a planar
    /// model one, with w for the angular velocity
    #[key(unit = "N·m", shape = Shape::Torque(VARIABLES))]
    pub torque: Turn,
    /// whether it is given in the axes of the model or of the body
    #[key(default = "\"world\"", shape = Shape::Choice(&["world", "body"]))]
    pub axes: Option<String>,
    /// the body that takes the opposite torque
    #[key(default = "none")]
    pub reaction: Option<String>,
}

impl Element for Torque {
    fn turns(&self) -> Vec<(&'static str, &str)> {
        std::iter::once(("body", self.body.as_str())).chain(self.reaction.as_deref().map(|name| ("reaction", name))).collect()
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let body = body_load::body(assembly, entry, "body", &self.body);
        let other = entry.optional("reaction", &self.reaction, |name, entry, key| body_load::body(assembly, entry, key, name));
        let (body, other) = (body?, other?);
        if other == Some(body) {
            return Err(entry.refuse("reaction", "a torque that reacts on its own body does nothing", "name another body, or none"));
        }
        let at = assembly.body_end(body, assembly.bodies[body].position, "");
        let formulas = Formulas::Torque(&self.torque);
        add(assembly, entry, Given { body, at, other, formulas, axes: self.axes.as_deref() })
    }
}
