use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "point-on-line",
        doc: "a pin in a slot: a point of the second body moves along a line of the first; the second may be a point",
        equations: "d·v_A = 0, d·w_A = 0; in the plane d·v_A = 0",
        keys: &[BETWEEN, AT, AXIS],
        example: r#"
[body.pin]
mass = 1
inertia = [0.01, 0.01, 0.01]
position = [0, 0, -0.3]
velocity = [1, 0, 0]

[joint.slot]
type = "point-on-line"
between = ["ground", "pin"]
at = [0, 0, 0]
axis = [1, 0, 0]
"#,
        build,
    },
    freedom: [Some(4), Some(2)],
    at: Site::Given,
    axes: [1, 1],
    shares: [&[], &[]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.stay(1);
    if !pair.is_planar() {
        pair.stay(2);
    }
    pair.displacement("displacement", 0);
    Ok(())
}
