use std::sync::Arc;

use super::coordinate_laws::{Resisting, Spring, Viscous};
use super::joint::{JOINT, quantity, read};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};
use crate::system::Law;

pub(super) const KIND: Kind = Kind {
    name: "torsion",
    doc: "a spring, a damper, or both, along the coordinate of a joint: about a hinge, or along a rail",
    equations: "V = ½ k (q − q₀)², effort −c q̇ against the motion, q counted over any number of turns",
    keys: &[
        JOINT,
        Key::optional("stiffness", Shape::Number, "none", "N·m/rad or N/m", "k"),
        Key::optional("angle", Shape::Number, "0", "rad or m", "q₀, the coordinate without effort, counted from the start"),
        Key::optional("damping", Shape::Number, "none", "N·m·s/rad or N·s/m", "c; what it takes is booked as work"),
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

[force.closer]
type = "torsion"
joint = "hinge"
stiffness = 10
angle = 0.1
damping = 0.5
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let coordinate = read(assembly, entry);
    let stiffness = entry.optional("stiffness", Entry::not_negative);
    let rest = entry.optional("angle", Entry::number);
    let damping = entry.optional("damping", Entry::not_negative);
    if !entry.has("stiffness") && !entry.has("damping") {
        entry.refuse_all(format!("the torsion spring `{}` does nothing", entry.name), "add stiffness, or damping");
    }
    if entry.has("angle") && !entry.has("stiffness") {
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
    let q = quantity(assembly, &coordinate);
    laws.into_iter().for_each(|law| assembly.builder.law(entry.name, &[q], law));
    Ok(())
}
