use super::pair::Pair;
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a foot on a floor: a point of the second body stays on a plane of the first; the second may be a point
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "point-on-plane",
    equations = "d·u_A = 0",
    example = r#"
[body.leg]
mass = 1
inertia = [0.1, 0.1, 0.01]
position = [0, 0, 0.5]
velocity = [1, 0, 0]

[joint.foot]
type = "point-on-plane"
between = ["ground", "leg"]
at = [0, 0, 0]
axis = [0, 0, 1]
"#
)]
pub struct PointOnPlane {
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

impl Joint for PointOnPlane {
    const LAYOUT: Layout = Layout { freedom: [Some(5), None], at: Seat::Given, directions: [1, 1], shares: [&[], &[]], takes_point: true };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.stay(0);
        pair.displacements_across();
        Ok(())
    }
}
