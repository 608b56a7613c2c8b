use std::sync::Arc;

use super::coordinate_laws::{Dry, Resisting, Viscous};
use super::joint::{JOINT, quantity, read};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "friction",
    doc: "friction in a joint: an effort of one size against the motion, smooth at rest, so that what should stick creeps \
          slowly; and one in proportion to the speed",
    equations: "effort −F tanh(q̇/v) − c q̇",
    keys: &[
        JOINT,
        Key::required("effort", Shape::Number, "N·m or N", "F, the size of the friction when the joint moves"),
        Key::required(
            "speed",
            Shape::Number,
            "rad/s or m/s",
            "v, the speed at which three quarters of it are reached: well below those of the motion",
        ),
        Key::optional("damping", Shape::Number, "0", "N·m·s/rad or N·s/m", "c"),
    ],
    example: r#"
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
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let coordinate = read(assembly, entry);
    let (effort, speed) = (entry.not_negative("effort"), entry.positive("speed"));
    let damping = entry.optional("damping", Entry::not_negative);
    let (coordinate, effort, speed, damping) = (coordinate?, effort?, speed?, damping?);
    let q = quantity(assembly, &coordinate);
    assembly.builder.law(entry.name, &[q], Arc::new(Resisting(Dry { effort, speed })));
    if let Some(damping) = damping.filter(|&damping| damping > 0.0) {
        assembly.builder.law(entry.name, &[q], Arc::new(Resisting(Viscous(damping))));
    }
    Ok(())
}
