use super::profile;
use crate::model::assembly::{Assembly, Effort};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::joints::coordinate;
use crate::model::key::{Key, Kind, Shape};

const JOINT: Key = Key::required("joint", Shape::Text, "", "the joint, or its coordinate as \"JOINT.angle\" or \"JOINT.displacement\"");

pub(super) const ANGLE: Kind = Kind {
    name: "angle",
    doc: "a motor that turns a joint as it is told, counted from the start over any number of turns",
    equations: "θ − θ(t) = 0; its torque is −λ",
    keys: &[JOINT, profile::key("rad", "angle as a formula of t, or { table = [[t, angle], …] }; zero at the start")],
    example: r#"
[body.wheel]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]

[joint.axle]
type = "revolute"
between = ["ground", "wheel"]
at = [0, 0, 0]
axis = [0, 0, 1]

[drive.motor]
type = "angle"
joint = "axle"
profile = "t^2"
"#,
    build: angle,
};

pub(super) const DISPLACEMENT: Kind = Kind {
    name: "displacement",
    doc: "a drive that moves a joint along its axis as it is told, counted from the start",
    equations: "s − s(t) = 0; its force is −λ",
    keys: &[JOINT, profile::key("m", "displacement as a formula of t, or { table = [[t, s], …] }; zero at the start")],
    example: r#"
[body.carriage]
mass = 1
shape = { box = [0.2, 0.1, 0.1] }
position = [0, 0, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "carriage"]
axis = [1, 0, 0]

[drive.spindle]
type = "displacement"
joint = "rail"
profile = { table = [[0, 0], [1, 0.2], [2, 0]] }
"#,
    build: displacement,
};

fn angle(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    drive(assembly, entry, true)
}

fn displacement(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    drive(assembly, entry, false)
}

fn drive(assembly: &mut Assembly<'_>, entry: &Entry<'_>, is_angle: bool) -> Read<()> {
    let (text, profile) = (entry.text("joint"), profile::read(entry));
    let coordinate = coordinate(assembly, entry, "joint".into(), text?)?;
    let profile = profile?;
    if coordinate.is_angle != is_angle {
        let (have, kind) = if is_angle { ("a displacement", "displacement") } else { ("an angle", "angle") };
        return Err(entry.refuse("joint", format!("this joint coordinate is {have}"), format!("use type = \"{kind}\", or another joint")));
    }
    let start = profile.at(0.0)[0];
    if start.abs() > LARGEST_START {
        let cure = "coordinates of joints count from the start: subtract the value at t = 0, or move the bodies";
        return Err(entry.refuse("profile", format!("the profile is {start} at t = 0, and the joint is at 0"), cure));
    }
    let part = assembly.builder.part(&coordinate.form);
    let sum = assembly.builder.sum(&[(part, 1.0)]);
    assembly.efforts.push(Effort { name: entry.name.to_string(), row: assembly.builder.rows(), length: None });
    assembly.builder.row(entry.name, sum, profile);
    Ok(())
}

/// Largest value of a profile at the start that is taken for rounding and corrected.
const LARGEST_START: f64 = 1e-3;
