use super::pair::Pair;
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a pin in a slot: a point of the second body moves along a line of the first; the second may be a point
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "point-on-line",
    equations = "d·v_A = 0, d·w_A = 0; in the plane d·v_A = 0",
    example = r#"
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
"#
)]
pub struct PointOnLine {
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

impl Joint for PointOnLine {
    const LAYOUT: Layout =
        Layout { freedom: [Some(4), Some(2)], at: Seat::Given, directions: [1, 1], shares: [&[], &[]], takes_point: true };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.stay(1);
        if !pair.is_planar() {
            pair.stay(2);
        }
        pair.displacement("displacement", 0);
        Ok(())
    }
}
