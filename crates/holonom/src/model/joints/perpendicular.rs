use super::pair::Pair;
use super::universal::right_angle;
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// an axis of the one body stays at a right angle to an axis of the other
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "perpendicular",
    equations = "u_A·u_B = 0",
    example = r#"
[body.arm]
mass = 1
shape = { box = [0.4, 0.05, 0.05] }
position = [0, 0, 1]
angular_velocity = [0, 0, 2]

[joint.square]
type = "perpendicular"
between = ["ground", "arm"]
axes = [[0, 0, 1], [1, 0, 0]]
"#
)]
pub struct Perpendicular {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// a direction of the first body and one of the second, at the start
    #[key(unit = "any", shape = Shape::Directions)]
    pub axes: Site,
    /// where displacements and moments are measured: a place, "BODY.POINT", or one for each body
    #[key(unit = "m", default = "the centre of the second body")]
    pub at: Option<Site>,
}

impl Joint for Perpendicular {
    const LAYOUT: Layout = Layout { freedom: [Some(5), None], at: Seat::Any, directions: [2, 2], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        right_angle(pair.entry, pair.geometry.triad.map(|triad| triad[0]))?;
        pair.perpendicular(0, 0);
        Ok(())
    }
}
