use super::pair::{Pair, build};
use super::{AT_ANY, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "orientation",
        doc: "the second body does not turn against the first and moves freely otherwise",
        equations: "u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane u_B·v_A = 0",
        keys: &[BETWEEN, AT_ANY],
        example: r#"
[body.platform]
mass = 1
shape = { box = [0.4, 0.4, 0.05] }
position = [0, 0, 1]
velocity = [1, 0, 0]

[joint.upright]
type = "orientation"
between = ["ground", "platform"]
"#,
        build,
    },
    freedom: [Some(3), Some(2)],
    at: Site::Any,
    axes: [0, 0],
    shares: [&[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)], &[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.lock_rotation();
    Ok(())
}
