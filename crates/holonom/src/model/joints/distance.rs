use super::pair::{Pair, Side};
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::geometry::{norm, subtract};
use crate::model::key::Shape;
use crate::record::LineKind;

/// a massless rod between a place of the one body and a place of the other; the two may be points
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "distance",
    equations = "½ d·d − ½ L² = 0 with the length L of the start",
    example = r#"
[body.load]
mass = 1
shape = { box = [0.2, 0.2, 0.2] }
position = [0, 0, -1]
velocity = [1, 0, 0]

[joint.rope]
type = "distance"
between = ["ground", "load"]
at = [[0, 0, 0], [0, 0, -0.9]]
"#
)]
pub struct Distance {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// a place of the first body and one of the second, at the start
    #[key(unit = "m")]
    pub at: Site,
}

impl Joint for Distance {
    const LAYOUT: Layout =
        Layout { freedom: [Some(5), Some(2)], at: Seat::Two, directions: [0, 0], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        rod(pair).map(|_| ())
    }
}

/// Adds the row of a massless rod between the two places of a joint, and draws it. Hands back its length, m.
pub(super) fn rod(pair: &mut Pair<'_, '_>) -> Read<f64> {
    let d = pair.d();
    let [a, b] = pair.geometry.at;
    let length = norm(subtract(b, a));
    if length == 0.0 {
        let cure = "give two places apart from each other, or use a spherical joint";
        return Err(pair.entry.refuse("at", "the two places are the same, and a distance of zero has no direction", cure));
    }
    let half_square = pair.assembly.builder.square(&d);
    pair.row(half_square, 0.5 * length * length, false);
    let (from, to) = (pair.end(Side::A), pair.end(Side::B));
    pair.assembly.draw(pair.entry, LineKind::Rod, &from, &to);
    Ok(length)
}
