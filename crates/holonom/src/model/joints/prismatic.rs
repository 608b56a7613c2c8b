use super::pair::{Pair, build};
use super::{AT_ANY, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "prismatic",
        doc: "a slider on a rail: the second body moves along an axis of the first and does not turn against it",
        equations: "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane d·v_A = 0, u_B·v_A = 0",
        keys: &[BETWEEN, AXIS, AT_ANY],
        example: r#"
[body.drawer]
mass = 2
shape = { box = [0.4, 0.5, 0.1] }
position = [0, 0, 1]
velocity = [0, 0.5, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "drawer"]
axis = [0, 1, 0]
"#,
        build,
    },
    freedom: [Some(1), Some(1)],
    at: Site::Any,
    axes: [1, 1],
    shares: [&[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)], &[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.stay(1);
    if !pair.is_planar() {
        pair.stay(2);
    }
    pair.lock_rotation();
    pair.displacement("displacement", 0);
    Ok(())
}
