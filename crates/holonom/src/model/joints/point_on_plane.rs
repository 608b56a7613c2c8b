use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "point-on-plane",
        doc: "a foot on a floor: a point of the second body stays on a plane of the first; the second may be a point",
        equations: "d·u_A = 0",
        keys: &[BETWEEN, AT, AXIS],
        example: r#"
[body.leg]
mass = 1
inertia = [0.1, 0.1, 0.01]
position = [0, 0, 0.5]
velocity = [1, 0, 0]

[joint.foot]
type = "point-on-plane"
between = ["ground", "leg"]
at = [0, 0, 0]
axis = [0, 0, 1]
"#,
        build,
    },
    freedom: [Some(5), None],
    at: Site::Given,
    axes: [1, 1],
    shares: [&[], &[]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.stay(0);
    pair.displacement("x", 1);
    pair.displacement("y", 2);
    Ok(())
}
