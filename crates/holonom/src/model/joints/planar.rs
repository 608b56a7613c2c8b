use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "planar",
        doc: "a body on a table: the second body slides in a plane of the first and turns about its normal",
        equations: "d·u_A = 0, u_B·v_A = 0, u_B·w_A = 0",
        keys: &[BETWEEN, AT, AXIS],
        example: r#"
[body.puck]
mass = 0.2
shape = { cylinder = [0.05, 0.02] }
position = [1, 0, 0.01]
velocity = [0, 1, 0]
angular_velocity = [0, 0, 3]

[joint.table]
type = "planar"
between = ["ground", "puck"]
at = [1, 0, 0]
axis = [0, 0, 1]
"#,
        build,
    },
    freedom: [Some(3), None],
    at: Site::Given,
    axes: [1, 1],
    shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.stay(0);
    pair.align();
    pair.angle();
    pair.displacement("x", 1);
    pair.displacement("y", 2);
    Ok(())
}
