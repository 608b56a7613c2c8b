use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a slider on a rail: the second body moves along an axis of the first and does not turn against it
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "prismatic",
    equations = "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane d·v_A = 0, u_B·v_A = 0",
    example = r#"
[body.drawer]
mass = 2
shape = { box = [0.4, 0.5, 0.1] }
position = [0, 0, 1]
velocity = [0, 0.5, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "drawer"]
axis = [0, 1, 0]
"#
)]
pub struct Prismatic {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// its direction at the start: a vector, "BODY.AXIS", or one for each body
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    pub axis: Option<Site>,
    /// where displacements and moments are measured: a place, "BODY.POINT", or one for each body
    #[key(unit = "m", default = "the centre of the second body")]
    pub at: Option<Site>,
}

impl Joint for Prismatic {
    const LAYOUT: Layout = Layout {
        freedom: [Some(1), Some(1)],
        at: Seat::Any,
        directions: [1, 1],
        shares: [&[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)], &[Feature::Axis(0), Feature::Axis(1), Feature::Axis(2)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.stay(1);
        if !pair.is_planar() {
            pair.stay(2);
        }
        pair.lock_rotation();
        pair.displacement("displacement", 0);
        Ok(())
    }
}
