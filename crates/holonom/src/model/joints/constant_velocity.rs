use super::pair::{Pair, Side};
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::geometry::dot;
use crate::model::key::Shape;
use crate::system::Form;

/// two shafts that share a point and turn at the same speed however they are bent against each other
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "constant-velocity",
    equations = "d = 0, w_A·v_B − v_A·w_B = 0 with v_A = v_B at right angles to both shafts at the start: no turn about u_A + u_B",
    example = r#"
[body.input]
mass = 1
shape = { cylinder = [0.02, 1] }
position = [0, 0, -0.5]
angular_velocity = [0, 0, 3]

[body.output]
mass = 1
shape = { cylinder = [0.02, 1] }
position = [0, 0.25, 0.4330127018922193]
orientation = { axis = [1, 0, 0], angle_deg = -30 }
angular_velocity = [0, 1.5, 2.598076211353316]

[joint.cage]
type = "constant-velocity"
between = ["input", "output"]
at = [0, 0, 0]
axes = [[0, 0, 1], [0, 0.5, 0.8660254037844386]]
"#
)]
pub struct ConstantVelocity {
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

impl Joint for ConstantVelocity {
    const LAYOUT: Layout = Layout {
        freedom: [Some(2), None],
        at: Seat::Given,
        directions: [2, 2],
        shares: [&[Feature::Point], &[Feature::Point]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let [a, b] = pair.geometry.triad.map(|triad| triad[0]);
        if dot(a, b) < -1.0 + 1e-9 {
            return Err(pair.entry.refuse(
                "axes",
                "the two shafts point against each other at the start",
                "let both point along the way of the power",
            ));
        }
        pair.coincide();
        // w_A·v_B and v_A·w_B may differ by a constant only, as both vanish at the start.
        let first = Form::Product([pair.e(Side::A, 2), pair.e(Side::B, 1)]);
        let second = Form::Product([pair.e(Side::A, 1), pair.e(Side::B, 2)]);
        pair.difference(&first, &second);
        Ok(())
    }
}
