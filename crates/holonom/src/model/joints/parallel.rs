use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// an axis of the one body stays parallel to an axis of the other
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "parallel",
    equations = "u_B·v_A = 0, u_B·w_A = 0",
    example = r#"
[body.tray]
mass = 1
shape = { box = [0.4, 0.3, 0.02] }
position = [0, 0, 1]
angular_velocity = [0, 0, 2]

[joint.level]
type = "parallel"
between = ["ground", "tray"]
axis = [0, 0, 1]
"#
)]
pub struct Parallel {
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

impl Joint for Parallel {
    const LAYOUT: Layout = Layout {
        freedom: [Some(4), None],
        at: Seat::Any,
        directions: [1, 1],
        shares: [&[Feature::Axis(0)], &[Feature::Axis(0)]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.align();
        pair.angle();
        Ok(())
    }
}
