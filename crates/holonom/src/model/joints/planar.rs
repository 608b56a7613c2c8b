use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a body on a table: the second body slides in a plane of the first and turns about its normal
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "planar",
    equations = "d·u_A = 0, u_B·v_A = 0, u_B·w_A = 0",
    example = r#"
[body.puck]
mass = 0.2
shape = { cylinder = [0.05, 0.02] }
position = [1, 0, 0.01]
velocity = [0, 1, 0]
angular_velocity = [0, 0, 3]

[joint.table]
type = "planar"
between = ["ground", "puck"]
at = [1, 0, 0]
axis = [0, 0, 1]
"#
)]
pub struct Planar {
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

impl Joint for Planar {
    const LAYOUT: Layout = Layout {
        freedom: [Some(3), None],
        at: Seat::Given,
        directions: [1, 1],
        shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.stay(0);
        pair.align();
        pair.angle();
        pair.displacements_across();
        Ok(())
    }
}
