use std::sync::Arc;

use super::coordinate_laws::{Dry, Resisting, Viscous};
use super::joint::acted_on;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::joints::coordinate;

/// friction in a joint: an effort of one size against the motion, smooth at rest, so that what should stick creeps slowly; and one
/// in proportion to the speed
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "friction",
    equations = "effort −F tanh(q̇/v) − c q̇",
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

[force.rust]
type = "friction"
joint = "hinge"
effort = 0.2
speed = 0.5
damping = 0.1
"#
)]
pub struct Friction {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// F, the size of the friction when the joint moves
    #[key(unit = "N·m or N")]
    pub effort: Number,
    /// v, the speed at which three quarters of it are reached: well below those of the motion
    #[key(unit = "rad/s or m/s")]
    pub speed: Number,
    /// c
    #[key(unit = "N·m·s/rad or N·s/m", default = "0")]
    pub damping: Option<Number>,
}

impl Element for Friction {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let coordinate = coordinate(assembly, entry, "joint".into(), &self.joint);
        let (effort, speed) = (self.effort.not_negative(entry, "effort"), self.speed.positive(entry, "speed"));
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        let (coordinate, effort, speed, damping) = (coordinate?, effort?, speed?, damping?);
        let q = acted_on(assembly, &coordinate);
        assembly.builder.law(entry.name, &[q], Arc::new(Resisting(Dry { effort, speed })));
        if let Some(damping) = damping.filter(|&damping| damping > 0.0) {
            assembly.builder.law(entry.name, &[q], Arc::new(Resisting(Viscous(damping))));
        }
        Ok(())
    }
}
