use std::f64::consts::TAU;

use super::pair::{Pair, build};
use super::{AT, AXIS, BETWEEN, Feature, JointKind, Site};
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "screw",
        doc: "a nut on a spindle: a cylindrical joint that moves along its axis by the pitch with every turn",
        equations: "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, d·u_A − pitch θ/2π = 0, θ counted over any number of turns",
        keys: &[
            BETWEEN,
            AT,
            AXIS,
            Key::required("pitch", Shape::Number, "m", "displacement of the second body with each turn, right-handed when positive"),
        ],
        example: r#"
[body.nut]
mass = 1
shape = { cylinder = [0.1, 0.1] }
position = [0, 0, 0]

[joint.spindle]
type = "screw"
between = ["ground", "nut"]
at = [0, 0, 0]
axis = [0, 0, 1]
pitch = 0.1
"#,
        build,
    },
    freedom: [Some(1), None],
    at: Site::Given,
    axes: [1, 1],
    shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    let pitch = pair.entry.number("pitch")?;
    if pitch == 0.0 {
        return Err(pair.entry.refuse(
            "pitch",
            "a screw without pitch does not move along its axis",
            "give a pitch, or use a revolute joint",
        ));
    }
    pair.stay(1);
    pair.stay(2);
    pair.align();
    pair.angle();
    pair.displacement("displacement", 0);
    pair.couple(&[("displacement", 1.0), ("angle", -pitch / TAU)]);
    Ok(())
}
