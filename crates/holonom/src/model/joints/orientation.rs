use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// the second body does not turn against the first and moves freely otherwise
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "orientation",
    equations = "u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane u_B·v_A = 0",
    example = r#"
[body.platform]
mass = 1
shape = { box = [0.4, 0.4, 0.05] }
position = [0, 0, 1]
velocity = [1, 0, 0]

[joint.upright]
type = "orientation"
between = ["ground", "platform"]
"#
)]
pub struct Orientation {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where displacements and moments are measured: a place, "BODY.POINT", or one for each body
    #[key(unit = "m", default = "the centre of the second body")]
    pub at: Option<Site>,
}

impl Joint for Orientation {
    const LAYOUT: Layout = Layout {
        freedom: [Some(3), Some(2)],
        at: Seat::Any,
        directions: [0, 0],
        shares: [&[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)], &[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.lock_rotation();
        Ok(())
    }
}
