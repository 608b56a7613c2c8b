use super::pair::{Pair, build};
use super::{AT, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::Kind;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "spherical",
        doc: "a ball in its socket: the two bodies share a point and turn freely about it; also between points",
        equations: "d = r_B − r_A = 0",
        keys: &[BETWEEN, AT],
        example: r#"
[body.bob]
mass = 1
inertia = [0.1, 0.2, 0.2]
position = [1, 0, 0]

[joint.ball]
type = "spherical"
between = ["ground", "bob"]
at = [0, 0, 0]
"#,
        build,
    },
    freedom: [Some(3), None],
    at: Site::Given,
    axes: [0, 0],
    shares: [&[Feature::Point], &[Feature::Point]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    pair.coincide();
    Ok(())
}
