use super::body_load::{self, AXES, Given, VARIABLES, add};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "torque",
    doc: "a torque on a body, which may react on another one, as formulas of time and of the motion of the body",
    equations: "Q of each body axis e_k: ½ n × e_k; booked as work",
    keys: &[
        Key::required("body", Shape::Text, "", "the body it acts on"),
        Key::required(
            "torque",
            Shape::Torque(VARIABLES),
            "N·m",
            "three formulas of t, of x, y, z and vx, vy, vz of the centre of mass and of the angular velocity wx, wy, wz; in a \
             planar model one, with w for the angular velocity",
        ),
        AXES,
        Key::optional("reaction", Shape::Text, "none", "", "the body that takes the opposite torque"),
    ],
    example: r#"
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
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let body = body_load::body(assembly, entry, "body");
    let other = entry.optional("reaction", |entry, key| body_load::body(assembly, entry, key));
    let (body, other) = (body?, other?);
    if other == Some(body) {
        return Err(entry.refuse("reaction", "a torque that reacts on its own body does nothing", "name another body, or none"));
    }
    let at = assembly.body_end(body, assembly.bodies[body].position, "");
    add(assembly, entry, &Given { body, at, other, key: "torque", is_torque: true })
}
