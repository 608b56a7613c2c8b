use std::f64::consts::TAU;

use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Site};
use crate::model::key::Shape;

/// a nut on a spindle: a cylindrical joint that moves along its axis by the pitch with every turn
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "screw",
    equations = "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, d·u_A − pitch θ/2π = 0, θ counted over any number of turns",
    example = r#"
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
"#
)]
pub struct Screw {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// its direction at the start: a vector, "BODY.AXIS", or one for each body
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    pub axis: Option<Site>,
    /// displacement of the second body with each turn, right-handed when positive
    #[key(unit = "m")]
    pub pitch: Number,
}

impl Joint for Screw {
    const LAYOUT: Layout = Layout {
        freedom: [Some(1), None],
        at: Seat::Given,
        directions: [1, 1],
        shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let pitch = self.pitch.number(pair.entry, "pitch")?;
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
}
