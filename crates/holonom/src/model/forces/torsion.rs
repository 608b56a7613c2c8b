use super::following::{Follows, any, not_negative};
use super::joint::acted_on;
use super::spring::{Acting, Parts};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::joints::coordinate;
use crate::model::key::Shape;
use crate::model::signals::Readings;
use crate::system::Reading;

/// a spring, a damper, or both, along the coordinate of a joint: about a hinge, or along a rail
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "torsion",
    equations = "V = ½ k (q − q₀)², effort −c q̇ against the motion, q counted over any number of turns",
    example = r#"
[body.flap]
mass = 1
shape = { box = [0.4, 0.2, 0.01] }
position = [0.2, 0, 0]
angular_velocity = [0, 1, 0]
velocity = [0, 0, -0.2]

[joint.hinge]
type = "revolute"
between = ["ground", "flap"]
at = [0, 0, 0]
axis = [0, 1, 0]

[force.closer]
type = "torsion"
joint = "hinge"
stiffness = 10
angle = 0.1
damping = 0.5
"#
)]
pub struct Torsion {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// k; as a formula of t, of inputs, measures and what moves, by the names of columns, its work is booked
    #[key(unit = "N·m/rad or N/m", default = "none", shape = Shape::Formula(&["t"]))]
    pub stiffness: Option<Number>,
    /// q₀, the coordinate without effort, counted from the start; as k it may be a formula
    #[key(unit = "rad or m", default = "0", shape = Shape::Formula(&["t"]))]
    pub angle: Option<Number>,
    /// c, which may be a formula; what it takes is booked as work
    #[key(unit = "N·m·s/rad or N·s/m", default = "none", shape = Shape::Formula(&["t"]))]
    pub damping: Option<Number>,
}

impl Element for Torsion {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let coordinate = coordinate(assembly, entry, "joint".into(), &self.joint);
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let stiffness = Follows::optional(assembly, &mut readings, (entry, "stiffness"), &self.stiffness, not_negative);
        let rest = Follows::optional(assembly, &mut readings, (entry, "angle"), &self.angle, any);
        let damping = Follows::optional(assembly, &mut readings, (entry, "damping"), &self.damping, not_negative);
        if self.stiffness.is_none() && self.damping.is_none() {
            entry.refuse_all(format!("the torsion spring `{}` does nothing", entry.name), "add stiffness, or damping");
        }
        if self.angle.is_some() && self.stiffness.is_none() {
            entry.refuse("angle", "an angle without effort means nothing without a stiffness", "add stiffness");
        }
        let (coordinate, stiffness, rest, damping) = (coordinate?, stiffness?, rest?, damping?);
        let acting = Acting { quantity: acted_on(assembly, &coordinate).into(), is_along: true, start: 0.0, shortest: 0.0 };
        let parts = Parts { stiffness, damping, ..Parts::default() };
        acting.build(assembly, entry, parts, rest.unwrap_or(Follows::Known(0.0)), readings)
    }
}
