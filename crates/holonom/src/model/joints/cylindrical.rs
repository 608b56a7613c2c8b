use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a sleeve on a shaft: the second body slides along an axis of the first and turns about it
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "cylindrical",
    equations = "d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0",
    example = r#"
[body.sleeve]
mass = 1
shape = { cylinder = [0.1, 0.3] }
position = [0, 0, 0]
angular_velocity = [0, 0, 5]

[joint.shaft]
type = "cylindrical"
between = ["ground", "sleeve"]
at = [0, 0, 0]
axis = [0, 0, 1]
"#
)]
pub struct Cylindrical {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// its direction at the start: a vector, "BODY.AXIS", or one for each body
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    pub axis: Option<Site>,
}

impl Joint for Cylindrical {
    const LAYOUT: Layout = Layout {
        freedom: [Some(2), None],
        at: Seat::Given,
        directions: [1, 1],
        shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.stay(1);
        pair.stay(2);
        pair.align();
        pair.angle();
        pair.displacement("displacement", 0);
        Ok(())
    }
}
