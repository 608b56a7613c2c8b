use super::pair::{Pair, Side, build};
use super::{AT, AXES, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::geometry::dot;
use crate::model::key::Kind;
use crate::system::Form;

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "constant-velocity",
        doc: "two shafts that share a point and turn at the same speed however they are bent against each other",
        equations: "d = 0, w_A·v_B − v_A·w_B = 0 with v_A = v_B at right angles to both shafts at the start: no turn about u_A + u_B",
        keys: &[BETWEEN, AT, AXES],
        example: r#"
[body.input]
mass = 1
shape = { cylinder = [0.02, 1] }
position = [0, 0, -0.5]
angular_velocity = [0, 0, 3]

[body.output]
mass = 1
shape = { cylinder = [0.02, 1] }
position = [0, 0.25, 0.4330127018922193]
orientation = { axis = [1, 0, 0], angle_deg = -30 }
angular_velocity = [0, 1.5, 2.598076211353316]

[joint.cage]
type = "constant-velocity"
between = ["input", "output"]
at = [0, 0, 0]
axes = [[0, 0, 1], [0, 0.5, 0.8660254037844386]]
"#,
        build,
    },
    freedom: [Some(2), None],
    at: Site::Given,
    axes: [2, 2],
    shares: [&[Feature::Point], &[Feature::Point]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    let [a, b] = pair.geometry.triad.map(|triad| triad[0]);
    if dot(a, b) < -1.0 + 1e-9 {
        return Err(pair.entry.refuse(
            "axes",
            "the two shafts point against each other at the start",
            "let both point along the way of the power",
        ));
    }
    pair.coincide();
    // w_A·v_B and v_A·w_B may differ by a constant only, as both vanish at the start.
    let first = Form::Product([pair.e(Side::A, 2), pair.e(Side::B, 1)]);
    let second = Form::Product([pair.e(Side::A, 1), pair.e(Side::B, 2)]);
    pair.difference(&first, &second);
    Ok(())
}
