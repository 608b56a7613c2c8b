use super::pair::Pair;
use super::{Feature, Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Site};
use crate::model::key::Shape;

/// two bodies as one
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "fixed",
    equations = "d = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; none where their reactions are not asked for: the two then are one body",
    example = r#"
[body.handle]
mass = 0.5
shape = { box = [0.2, 0.02, 0.02] }
position = [0.1, 0, 0]

[body.head]
mass = 1
shape = { box = [0.05, 0.1, 0.05] }
position = [0.2, 0, 0]

[joint.weld]
type = "fixed"
between = ["handle", "head"]
"#
)]
pub struct Fixed {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where displacements and moments are measured: a place, "BODY.POINT", or one for each body
    #[key(unit = "m", default = "the centre of the second body")]
    pub at: Option<Site>,
}

impl Joint for Fixed {
    const LAYOUT: Layout = Layout {
        freedom: [Some(0), Some(0)],
        at: Seat::Any,
        directions: [0, 0],
        shares: [&[Feature::All], &[Feature::All]],
        takes_point: false,
    };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.coincide();
        pair.lock_rotation();
        Ok(())
    }
}
