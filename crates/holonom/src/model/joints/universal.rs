use super::pair::{Pair, Side};
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::geometry::dot;
use crate::model::key::Shape;
use crate::system::Form;

/// a cardan joint: the two bodies share a point, and an axis of the one stays at a right angle to an axis of the other; angle1 is
/// the turn about the axis of the first body, angle2 that about the axis of the second
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "universal",
    equations = "d = 0, u_A·u_B = 0",
    example = r#"
[body.shaft]
mass = 1
shape = { cylinder = [0.05, 1] }
position = [0, 0, -0.5]
angular_velocity = [1, 0, 0]

[joint.cross]
type = "universal"
between = ["ground", "shaft"]
at = [0, 0, 0]
axes = [[1, 0, 0], [0, 1, 0]]
"#
)]
pub struct Universal {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// a direction of the first body and one of the second, at the start
    #[key(unit = "any", shape = Shape::Directions)]
    pub axes: Site,
}

/// Largest cosine between two axes that rounding explains.
const ROUNDED: f64 = 1e-6;

impl Joint for Universal {
    const LAYOUT: Layout = Layout {
        freedom: [Some(2), None],
        at: Seat::Given,
        directions: [2, 2],
        shares: [&[Feature::Point], &[Feature::Point]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        right_angle(pair.entry, pair.geometry.triad.map(|triad| triad[0]))?;
        pair.coincide();
        pair.perpendicular(0, 0);
        // With a ⟂ b at the start: b turns about a from where it was, and a about b.
        let ([a, b], [normal, _]) = (pair.geometry.triad.map(|triad| triad[0]), pair.geometry.triad.map(|triad| triad[1]));
        let turn = |from, to, moving: Vec<_>| Form::Angle { cosine: [from, moving.clone()], sine: [to, moving], near: 0.0 };
        let first = turn(pair.fixed_to(Side::A, b), pair.fixed_to(Side::A, normal), pair.fixed_to(Side::B, b));
        let second = turn(pair.fixed_to(Side::B, a), pair.fixed_to(Side::B, normal), pair.fixed_to(Side::A, a));
        pair.coordinate("angle1", first, true);
        pair.coordinate("angle2", second, true);
        Ok(())
    }
}

/// Refuses axes that are not at a right angle.
pub(super) fn right_angle(entry: &Entry<'_>, [a, b]: [[f64; 3]; 2]) -> Read<()> {
    let cosine = dot(a, b);
    if cosine.abs() <= ROUNDED {
        return Ok(());
    }
    let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
    Err(entry.refuse("axes", format!("the two axes are at {degrees:.4}° at the start"), "give two axes at a right angle"))
}
