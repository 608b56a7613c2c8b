use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "cylindrical",
        doc: "a sleeve on a shaft: the second body slides along an axis of the first and turns about it",
        equations: "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0",
        keys: &[BETWEEN, AT, AXIS],
        example: r#"
[body.sleeve]
mass = 1
shape = { cylinder = [0.1, 0.3] }
position = [0, 0, 0]
angular_velocity = [0, 0, 5]

[joint.shaft]
type = "cylindrical"
between = ["ground", "sleeve"]
at = [0, 0, 0]
axis = [0, 0, 1]
"#,
        build,
    },
    freedom: [Some(2), None],
    at: Site::Given,
    axes: [1, 1],
    shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.stay(1);
    pair.stay(2);
    pair.align();
    pair.angle();
    pair.displacement("displacement", 0);
    Ok(())
}
