use super::pair::{Pair, build};
use super::universal::right_angle;
use super::{AT_ANY, AXES, BETWEEN, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "perpendicular",
        doc: "an axis of the one body stays at a right angle to an axis of the other",
        equations: "u_A·u_B = 0",
        keys: &[BETWEEN, AXES, AT_ANY],
        example: r#"
[body.arm]
mass = 1
shape = { box = [0.4, 0.05, 0.05] }
position = [0, 0, 1]
angular_velocity = [0, 0, 2]

[joint.square]
type = "perpendicular"
between = ["ground", "arm"]
axes = [[0, 0, 1], [1, 0, 0]]
"#,
        build,
    },
    freedom: [Some(5), None],
    at: Site::Any,
    axes: [2, 2],
    shares: [&[], &[]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    right_angle(pair.entry, pair.geometry.triad.map(|triad| triad[0]))?;
    pair.perpendicular(0, 0);
    Ok(())
}
