use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a hinge: the two bodies share a point and an axis and turn about it; in a planar model they share a point
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "revolute",
    equations = "d = 0, u_B·v_A = 0, u_B·w_A = 0",
    example = r#"
[body.door]
mass = 20
shape = { box = [1, 0.05, 2] }
position = [0.5, 0, 1]
angular_velocity = [0, 0, 1]

[joint.hinge]
type = "revolute"
between = ["ground", "door"]
at = [0, 0, 1]
axis = [0, 0, 1]
"#
)]
pub struct Revolute {
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

impl Joint for Revolute {
    const LAYOUT: Layout = Layout {
        freedom: [Some(1), Some(1)],
        at: Seat::Given,
        directions: [1, 0],
        shares: [&[Feature::Point, Feature::Axis(0)], &[Feature::Point]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.coincide();
        if !pair.is_planar() {
            pair.align();
        }
        pair.angle();
        Ok(())
    }
}
