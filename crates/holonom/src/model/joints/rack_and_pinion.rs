use super::coupler::{couple, two};
use super::transmission::{Seats, slope};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::record::{Transmission, WheelsKind};

/// a wheel that rolls along a toothed rail: the displacement of the one joint is the radius times the angle of the other
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "rack-and-pinion",
    equations = "s − r θ = 0, θ counted over any number of turns",
    example = r#"
[body.pinion]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 2]

[body.rack]
mass = 2
shape = { box = [1, 0.02, 0.02] }
position = [0, -0.1, 0]
velocity = [0.2, 0, 0]

[joint.axle]
type = "revolute"
between = ["ground", "pinion"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.rail]
type = "prismatic"
between = ["ground", "rack"]
axis = [1, 0, 0]

[joint.teeth]
type = "rack-and-pinion"
joints = ["axle", "rail"]
radius = 0.1
"#
)]
pub struct RackAndPinion {
    /// two joints in either order, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
    #[key(shape = Shape::Coordinates)]
    pub joints: List<String>,
    /// displacement over angle; negative when they count against each other
    #[key(unit = "m")]
    pub radius: Number,
    /// angle between what teeth push with and the way of the rack; with it the force of the teeth is recorded, and the bearings feel it
    #[key(unit = "rad", default = "teeth are left out")]
    pub pressure_angle: Option<Number>,
}

impl Element for RackAndPinion {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let joints = two(assembly, entry, &self.joints, Some([true, false]));
        let radius = self.radius.number(entry, "radius");
        let ([angle, displacement], radius) = (joints?, radius?);
        if radius == 0.0 {
            return Err(entry.refuse("radius", "a radius of zero locks the rack and frees the pinion", "give the radius of the pinion"));
        }
        let seats = Seats::find(assembly, entry, [&angle, &displacement])?;
        if let Ok(seats) = &seats {
            seats.draw(assembly, entry, WheelsKind::Gear, [Some(radius.abs()), None]);
        }
        if let Some(pressure) = entry.optional("pressure_angle", &self.pressure_angle, |angle, entry, key| angle.number(entry, key))? {
            let slope = slope(entry, pressure)?;
            let seats = Seats::wanted(seats, entry, "pressure_angle")?;
            let [a, b] = seats.senses;
            let way = seats.way(assembly);
            seats.record(assembly, entry, -radius, Transmission::Rack { way, radius: a * b * radius, slope });
        }
        couple(assembly, entry, &[(displacement, 1.0), (angle, -radius)])
    }
}
