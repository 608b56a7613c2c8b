use super::coordinate::{JOINT, drive};
use super::profile;
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const KIND: Kind = Kind {
    name: "angle",
    doc: "a motor that turns a joint as it is told, counted from the start over any number of turns",
    equations: "θ − θ(t) = 0; its torque is −λ",
    keys: &[JOINT, profile::key("rad", "angle as a formula of t, or { table = [[t, angle], …] }; zero at the start")],
    example: r#"
[body.wheel]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]

[joint.axle]
type = "revolute"
between = ["ground", "wheel"]
at = [0, 0, 0]
axis = [0, 0, 1]

[drive.motor]
type = "angle"
joint = "axle"
profile = "t^2"
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    drive(assembly, entry, true)
}
