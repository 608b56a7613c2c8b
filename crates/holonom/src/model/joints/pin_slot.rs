use super::pair::Pair;
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Site};
use crate::model::geometry::{cross, dot, norm, scale};
use crate::model::key::Shape;

/// a pin of the second body in a straight slot of the first: it slides along the slot and turns about itself
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "pin-slot",
    equations = "d·u_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0 with the slot along v_A",
    example = r#"
[body.lever]
mass = 1
shape = { box = [0.4, 0.05, 0.02] }
position = [0.2, 0, 0]
velocity = [1, 0, 0]
angular_velocity = [0, 0, 2]

[joint.slot]
type = "pin-slot"
between = ["ground", "lever"]
at = [0.2, 0, 0]
axis = [0, 0, 1]
slot = [1, 0, 0]
"#
)]
pub struct PinSlot {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where the pin sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// direction of the pin at the start: a vector, "BODY.AXIS", or one for each body
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    pub axis: Option<Site>,
    /// direction of the slot at the start, across the pin
    #[key(unit = "any", shape = Shape::Vector)]
    pub slot: List<Number>,
}

impl Joint for PinSlot {
    const LAYOUT: Layout = Layout { freedom: [Some(2), None], at: Seat::Given, directions: [1, 1], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let slot = self.slot.vector(pair.entry, "slot", 3)?;
        let u = pair.geometry.triad[0][0];
        let w = cross(u, slot);
        if norm(w) <= 1e-6 * norm(slot) || dot(slot, slot) == 0.0 {
            return Err(pair.entry.refuse(
                "slot",
                "the slot has no direction across the pin",
                "give a direction at right angles to the axis",
            ));
        }
        let w = scale(w, 1.0 / norm(w));
        pair.geometry.triad = [[u, cross(w, u), w]; 2];
        pair.stay(0);
        pair.stay(2);
        pair.align();
        pair.displacement("displacement", 1);
        pair.angle();
        Ok(())
    }
}
