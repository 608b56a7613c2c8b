use super::distance::rod;
use super::pair::{Pair, Side};
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::geometry::{cross, dot, scale, subtract};
use crate::model::key::Shape;
use crate::system::Form;

/// a massless link with a hinge on the first body and a ball on the second, which may be a point: the link turns about the axis of
/// the first, at a right angle to it
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "revolute-spherical",
    equations = "½ d·d − ½ L² = 0 with the length L of the start, d·u_A = 0",
    example = r#"
[body.load]
mass = 1
shape = { box = [0.3, 0.2, 0.1] }
position = [0.6, 0, -0.2]
velocity = [0, 0.3, 0]

[joint.link]
type = "revolute-spherical"
between = ["ground", "load"]
at = [[0, 0, 0], [0.5, 0, -0.2]]
axis = [0, 1, 0]
"#
)]
pub struct RevoluteSpherical {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// the hinge on the first body and the ball on the second, at the start
    #[key(unit = "m")]
    pub at: Site,
    /// of the hinge, fixed in the first body, at the start
    #[key(unit = "any", shape = Shape::Direction)]
    pub axis: Site,
}

/// Largest cosine between link and axis that rounding explains.
const ROUNDED: f64 = 1e-6;

impl Joint for RevoluteSpherical {
    const LAYOUT: Layout = Layout { freedom: [Some(4), None], at: Seat::Two, directions: [1, 1], shares: [&[], &[]], takes_point: true };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let length = rod(pair)?;
        let ([a, b], u) = (pair.geometry.at, pair.geometry.triad[0][0]);
        let link = scale(subtract(b, a), 1.0 / length);
        let cosine = dot(link, u);
        if cosine.abs() > ROUNDED {
            let message = format!("the link is at {:.4}° to the axis at the start", cosine.clamp(-1.0, 1.0).acos().to_degrees());
            return Err(pair.entry.refuse("axis", message, "give two places that are apart at a right angle to the axis"));
        }
        pair.stay(0);
        let d = pair.d();
        let [along, across] = [link, cross(u, link)].map(|e| pair.fixed_to(Side::A, e));
        pair.coordinate("angle", Form::Angle { cosine: [along, d.clone()], sine: [across, d], near: 0.0 }, true);
        Ok(())
    }
}
