use super::coupler::{couple, two};
use super::transmission::{Seats, slope};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::record::{Transmission, WheelsKind};

/// wheels that mesh, or any two coordinates of which one is a multiple of the other
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "gear",
    equations = "q_1 − ratio q_2 = 0, angles counted over any number of turns",
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
angular_velocity = [0, 0, -1]

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

[joint.mesh]
type = "gear"
joints = ["axle1", "axle2"]
ratio = -2
"#
)]
pub struct Gear {
    /// two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
    #[key(shape = Shape::Coordinates)]
    pub joints: List<String>,
    /// how many times the second coordinate the first is; negative for outside gears about parallel axes
    pub ratio: Number,
    /// angle between what teeth push with and the tangent of the pitch circles; with it the force of the teeth is recorded, and the bearings of
    /// wheels about parallel axes feel it
    #[key(unit = "rad", default = "teeth are left out")]
    pub pressure_angle: Option<Number>,
}

impl Element for Gear {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (joints, ratio) = (two(assembly, entry, &self.joints, None), self.ratio.number(entry, "ratio"));
        let ([first, second], ratio) = (joints?, ratio?);
        if ratio == 0.0 {
            return Err(entry.refuse("ratio", "a ratio of zero locks the first joint and frees the second", "give the ratio of the two"));
        }
        let seats = Seats::find(assembly, entry, [&first, &second])?;
        // Both wheels have one velocity at the pitch point.
        let share_of = |Seats { senses: [a, b], .. }: &Seats| b / (b - a * ratio);
        if let Ok(seats) = &seats
            && let (share, true) = (share_of(seats), seats.distance > 0.0 && second.is_angle)
            && share.is_finite()
        {
            let radii = [share, 1.0 - share].map(|share| Some(share.abs() * seats.distance));
            seats.draw(assembly, entry, WheelsKind::Gear, radii);
        }
        if let Some(angle) = entry.optional("pressure_angle", &self.pressure_angle, |angle, entry, key| angle.number(entry, key))? {
            let slope = slope(entry, angle)?;
            let seats = Seats::wanted(seats, entry, "pressure_angle")?;
            let share = share_of(&seats);
            if !share.is_finite() || seats.distance == 0.0 || !second.is_angle {
                let message = "wheels about one axis, or that turn alike, do not mesh, and a rail is no wheel";
                return Err(entry.refuse_key("pressure_angle", message, "leave `pressure_angle` out, or check the sign of `ratio`"));
            }
            seats.record(assembly, entry, 1.0, Transmission::Teeth { share, slope });
        }
        couple(assembly, entry, &[(first, 1.0), (second, -ratio)])
    }
}
