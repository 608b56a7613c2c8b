use std::sync::Arc;

use super::coordinate_laws::{Impact, Stop};
use super::joint::{JOINT, quantity, read};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "stop",
    doc: "buffers at the ends of a joint's way: springs that act beyond its limits only, with what an impact takes out",
    equations: "beyond a limit by p: V = ½ k p², effort −k d p q̇ (Hunt and Crossley)",
    keys: &[
        JOINT,
        Key::optional("lower", Shape::Number, "none", "rad or m", "smallest coordinate without contact, counted from the start"),
        Key::optional("upper", Shape::Number, "none", "rad or m", "largest coordinate without contact"),
        Key::required("stiffness", Shape::Number, "N·m/rad or N/m", "k"),
        Key::optional("dissipation", Shape::Number, "0", "s/rad or s/m", "d; what it takes is booked as work"),
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

[force.buffer]
type = "stop"
joint = "hinge"
lower = -0.02
upper = 0.01
stiffness = 50
dissipation = 0.2
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let coordinate = read(assembly, entry);
    let [lower, upper] = ["lower", "upper"].map(|key| entry.optional(key, Entry::number));
    let (stiffness, dissipation) = (entry.positive("stiffness"), entry.optional("dissipation", Entry::not_negative));
    let (coordinate, lower, upper, stiffness, dissipation) = (coordinate?, lower?, upper?, stiffness?, dissipation?);
    match (lower, upper) {
        (None, None) => {
            return Err(entry.refuse_all(format!("the stop `{}` has no limit", entry.name), "add lower, upper, or both"));
        }
        (Some(lower), Some(upper)) if lower >= upper => {
            return Err(entry.refuse("lower", format!("the lower limit {lower} is not below the upper one {upper}"), "exchange them"));
        }
        _ => (),
    }
    let q = quantity(assembly, &coordinate);
    for (limit, sign) in [(lower, -1.0), (upper, 1.0)] {
        let Some(limit) = limit else { continue };
        let stop = || Stop { stiffness, limit, sign };
        assembly.builder.law(entry.name, &[q], Arc::new(stop()));
        if let Some(dissipation) = dissipation.filter(|&dissipation| dissipation > 0.0) {
            assembly.builder.law(entry.name, &[q], Arc::new(Impact { stop: stop(), dissipation }));
        }
    }
    Ok(())
}
