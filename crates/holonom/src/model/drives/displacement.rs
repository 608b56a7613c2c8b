use super::coordinate::{JOINT, drive};
use super::profile;
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const KIND: Kind = Kind {
    name: "displacement",
    doc: "a drive that moves a joint along its axis as it is told, counted from the start",
    equations: "s − s(t) = 0; its force is −λ",
    keys: &[JOINT, profile::key("m", "displacement as a formula of t, or { table = [[t, s], …] }; zero at the start")],
    example: r#"
[body.carriage]
mass = 1
shape = { box = [0.2, 0.1, 0.1] }
position = [0, 0, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "carriage"]
axis = [1, 0, 0]

[drive.spindle]
type = "displacement"
joint = "rail"
profile = { table = [[0, 0], [1, 0.2], [2, 0]] }
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    drive(assembly, entry, false)
}
