use super::coupler::{couple, two};
use super::transmission::Seats;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::record::{Transmission, WheelsKind};

/// two wheels with a belt between them
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "pulley",
    equations = "r_1 θ_1 − r_2 θ_2 = 0, crossed r_1 θ_1 + r_2 θ_2 = 0, angles counted over any number of turns",
    example = r#"
[body.wheel1]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 2]

[body.wheel2]
mass = 4
shape = { cylinder = [0.2, 0.02] }
position = [0.3, 0, 0]
angular_velocity = [0, 0, 1]

[joint.axle1]
type = "revolute"
between = ["ground", "wheel1"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.axle2]
type = "revolute"
between = ["ground", "wheel2"]
at = [0.3, 0, 0]
axis = [0, 0, 1]

[joint.belt]
type = "pulley"
joints = ["axle1", "axle2"]
radii = [0.1, 0.2]
"#
)]
pub struct Pulley {
    /// two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
    #[key(shape = Shape::Coordinates)]
    pub joints: List<String>,
    /// radii of the two wheels
    #[key(unit = "m", shape = Shape::Numbers(2, 2))]
    pub radii: List<Number>,
    /// whether the belt crosses itself, so that the wheels turn against each other, whichever way their joints are written
    #[key(default = "false")]
    pub crossed: Option<bool>,
    /// tension of the belt at rest, 0 for a chain; with it the force of the belt is recorded, and the bearings of the wheels feel it
    #[key(unit = "N", default = "the belt's pull is left out")]
    pub pretension: Option<Number>,
}

impl Element for Pulley {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let joints = two(assembly, entry, &self.joints, Some([true, true]));
        let radii = self.radii.sizes::<2>(entry, "radii");
        let ([first, second], [r1, r2]) = (joints?, radii?);
        let against = if self.crossed.unwrap_or(false) { 1.0 } else { -1.0 };
        // Wheels turn against each other, not the angles of joints that may be written either way; where axes are not parallel these are all there is.
        let seats = Seats::find(assembly, entry, [&first, &second])?;
        let sign = against * seats.as_ref().map_or(1.0, |Seats { senses: [a, b], .. }| a * b);
        if let Ok(seats) = &seats {
            let kind = if against > 0.0 { WheelsKind::CrossedBelt } else { WheelsKind::Belt };
            seats.draw(assembly, entry, kind, [Some(r1), Some(r2)]);
        }
        let pretension = entry.optional("pretension", &self.pretension, |tension, entry, key| tension.not_negative(entry, key))?;
        if let Some(pretension) = pretension {
            let seats = Seats::wanted(seats, entry, "pretension")?;
            let rise = if against > 0.0 { r1 + r2 } else { r1 - r2 };
            let distance = seats.distance;
            if distance <= rise.abs() {
                let message = format!("the axes are {distance} m apart, and no belt goes around both wheels");
                return Err(entry.refuse("radii", message, "check the radii, and where the joints are"));
            }
            seats.record(assembly, entry, r1, Transmission::Belt { radius: r1, rise, pretension });
        }
        couple(assembly, entry, &[(first, r1), (second, sign * r2)])
    }
}
