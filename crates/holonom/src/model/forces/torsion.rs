use std::sync::Arc;

use super::coordinate_laws::{Resisting, Spring, Viscous};
use super::joint::acted_on;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::joints::coordinate;
use crate::system::Law;

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
    /// k
    #[key(unit = "N·m/rad or N/m", default = "none")]
    pub stiffness: Option<Number>,
    /// q₀, the coordinate without effort, counted from the start
    #[key(unit = "rad or m", default = "0")]
    pub angle: Option<Number>,
    /// c; what it takes is booked as work
    #[key(unit = "N·m·s/rad or N·s/m", default = "none")]
    pub damping: Option<Number>,
}

impl Element for Torsion {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let coordinate = coordinate(assembly, entry, "joint".into(), &self.joint);
        let stiffness = entry.optional("stiffness", &self.stiffness, Number::not_negative);
        let rest = entry.optional("angle", &self.angle, Number::number);
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        if self.stiffness.is_none() && self.damping.is_none() {
            entry.refuse_all(format!("the torsion spring `{}` does nothing", entry.name), "add stiffness, or damping");
        }
        if self.angle.is_some() && self.stiffness.is_none() {
            entry.refuse("angle", "an angle without effort means nothing without a stiffness", "add stiffness");
        }
        let (coordinate, stiffness, rest, damping) = (coordinate?, stiffness?, rest?, damping?);
        let mut laws: Vec<Arc<dyn Law>> = Vec::new();
        if let Some(stiffness) = stiffness {
            laws.push(Arc::new(Spring { stiffness, rest: rest.unwrap_or(0.0) }));
        }
        if let Some(damping) = damping {
            laws.push(Arc::new(Resisting(Viscous(damping))));
        }
        let q = acted_on(assembly, &coordinate);
        laws.into_iter().for_each(|law| assembly.builder.law(entry.name, &[q], law));
        Ok(())
    }
}
