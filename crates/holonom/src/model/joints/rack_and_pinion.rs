use super::coupler::{JOINTS, couple, two};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "rack-and-pinion",
    doc: "a wheel that rolls along a toothed rail: the displacement of the one joint is the radius times the angle of the other",
    equations: "s − r θ = 0, θ counted over any number of turns",
    keys: &[JOINTS, Key::required("radius", Shape::Number, "m", "displacement over angle; negative when they count against each other")],
    example: r#"
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
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let (joints, radius) = (two(assembly, entry, Some([true, false])), entry.number("radius"));
    let ([angle, displacement], radius) = (joints?, radius?);
    if radius == 0.0 {
        return Err(entry.refuse("radius", "a radius of zero locks the rack and frees the pinion", "give the radius of the pinion"));
    }
    couple(assembly, entry, &[(displacement, 1.0), (angle, -radius)])
}
