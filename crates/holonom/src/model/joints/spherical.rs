use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// a ball in its socket: the two bodies share a point and turn freely about it; also between points
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "spherical",
    equations = "d = r_B − r_A = 0",
    example = r#"
[body.bob]
mass = 1
inertia = [0.1, 0.2, 0.2]
position = [1, 0, 0]

[joint.ball]
type = "spherical"
between = ["ground", "bob"]
at = [0, 0, 0]
"#
)]
pub struct Spherical {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
}

impl Joint for Spherical {
    const LAYOUT: Layout = Layout {
        freedom: [Some(3), None],
        at: Seat::Given,
        directions: [0, 0],
        shares: [&[Feature::Point], &[Feature::Point]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.coincide();
        Ok(())
    }
}
