use super::body_load::{self, AXES, Given, VARIABLES, add};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "force",
    doc: "a force at a place of a body, in the axes of the model or following the body, as formulas of time and of its motion",
    equations: "Q = F(t, x, v, ω), booked as work",
    keys: &[
        Key::required("body", Shape::Text, "", "the body it acts on"),
        Key::optional("at", Shape::End, "the centre of mass", "m", "where it acts: a place at the start, or \"BODY.POINT\""),
        Key::required(
            "force",
            Shape::Formulas(VARIABLES),
            "N",
            "its components as formulas of t, of x, y, z and vx, vy, vz of that place and of the angular velocity wx, wy, wz; in a \
             planar model of those of its plane, with w for the angular velocity",
        ),
        AXES,
    ],
    example: r#"
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
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let body = body_load::body(assembly, entry, "body");
    let at = entry.optional("at", |entry, key| assembly.place_at_start(entry, key.into(), entry.value(key)?));
    let (body, at) = (body?, at?);
    let place = at.unwrap_or(assembly.bodies[body].position);
    let at = assembly.body_end(body, place, "");
    add(assembly, entry, &Given { body, at, other: None, key: "force", is_torque: false })
}
