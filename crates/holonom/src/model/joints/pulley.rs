use super::coupler::{JOINTS, couple, two};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "pulley",
    doc: "two wheels with a belt between them",
    equations: "r_1 θ_1 − r_2 θ_2 = 0, crossed r_1 θ_1 + r_2 θ_2 = 0, angles counted over any number of turns",
    keys: &[
        JOINTS,
        Key::required("radii", Shape::Numbers(2, 2), "m", "radii of the two wheels"),
        Key::optional("crossed", Shape::Flag, "false", "", "whether the belt crosses itself, so that the wheels turn against each other"),
    ],
    example: r#"
[body.wheel1]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 2]

[body.wheel2]
mass = 4
shape = { cylinder = [0.2, 0.02] }
position = [0.3, 0, 0]
angular_velocity = [0, 0, 1]

[joint.axle1]
type = "revolute"
between = ["ground", "wheel1"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.axle2]
type = "revolute"
between = ["ground", "wheel2"]
at = [0.3, 0, 0]
axis = [0, 0, 1]

[joint.belt]
type = "pulley"
joints = ["axle1", "axle2"]
radii = [0.1, 0.2]
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let joints = two(assembly, entry, Some([true, true]));
    let radii = entry.sizes::<2>("radii");
    let crossed = entry.optional("crossed", Entry::flag);
    let ([first, second], [r1, r2]) = (joints?, radii?);
    let sign = if crossed?.unwrap_or(false) { 1.0 } else { -1.0 };
    couple(assembly, entry, &[(first, r1), (second, sign * r2)])
}
