use super::pair::{Pair, build};
use super::{AT_ANY, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "parallel",
        doc: "an axis of the one body stays parallel to an axis of the other",
        equations: "u_B·v_A = 0, u_B·w_A = 0",
        keys: &[BETWEEN, AXIS, AT_ANY],
        example: r#"
[body.tray]
mass = 1
shape = { box = [0.4, 0.3, 0.02] }
position = [0, 0, 1]
angular_velocity = [0, 0, 2]

[joint.level]
type = "parallel"
between = ["ground", "tray"]
axis = [0, 0, 1]
"#,
        build,
    },
    freedom: [Some(4), None],
    at: Site::Any,
    axes: [1, 1],
    shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.align();
    pair.angle();
    Ok(())
}
