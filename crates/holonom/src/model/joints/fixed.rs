use super::pair::{Pair, build};
use super::{AT_ANY, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "fixed",
        doc: "two bodies as one",
        equations: "d = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; none where their reactions are not asked for: the two then are one body",
        keys: &[BETWEEN, AT_ANY],
        example: r#"
[body.handle]
mass = 0.5
shape = { box = [0.2, 0.02, 0.02] }
position = [0.1, 0, 0]

[body.head]
mass = 1
shape = { box = [0.05, 0.1, 0.05] }
position = [0.2, 0, 0]

[joint.weld]
type = "fixed"
between = ["handle", "head"]
"#,
        build,
    },
    freedom: [Some(0), Some(0)],
    at: Site::Any,
    axes: [0, 0],
    shares: [&[Feature::All], &[Feature::All]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.coincide();
    pair.lock_rotation();
    Ok(())
}
