use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "revolute",
        doc: "a hinge: the two bodies share a point and an axis and turn about it; in a planar model they share a point",
        equations: "d = 0, u_B·v_A = 0, u_B·w_A = 0",
        keys: &[BETWEEN, AT, AXIS],
        example: r#"
[body.door]
mass = 20
shape = { box = [1, 0.05, 2] }
position = [0.5, 0, 1]
angular_velocity = [0, 0, 1]

[joint.hinge]
type = "revolute"
between = ["ground", "door"]
at = [0, 0, 1]
axis = [0, 0, 1]
"#,
        build,
    },
    freedom: [Some(1), Some(1)],
    at: Site::Given,
    axes: [1, 0],
    shares: [&[Feature::Point, Feature::Axis(0)], &[Feature::Point]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.coincide();
    if !pair.is_planar() {
        pair.align();
    }
    pair.angle();
    Ok(())
}
