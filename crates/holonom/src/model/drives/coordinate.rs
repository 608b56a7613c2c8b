//! Drives of a joint coordinate.

use super::profile::Profile;
use crate::model::assembly::{Assembly, Effort};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::joints::coordinate;
use crate::model::start;

/// Adds the row that keeps a coordinate, which must be an angle or a displacement, as a profile has it.
pub(super) fn drive(assembly: &mut Assembly<'_>, entry: &Entry<'_>, joint: &str, profile: &Profile, is_angle: bool) -> Read<()> {
    let profile = profile.signal(entry, "profile");
    let coordinate = coordinate(assembly, entry, "joint".into(), joint)?;
    let profile = profile?;
    if coordinate.is_angle != is_angle {
        let [is, has] = if is_angle { ["an angle", "a displacement"] } else { ["a displacement", "an angle"] };
        let kind = if is_angle { "displacement" } else { "angle" };
        return Err(entry.refuse(
            "joint",
            format!("this drives {is}, and `{joint}` has {has}"),
            format!("use type = \"{kind}\", or another joint"),
        ));
    }
    let start = profile.at(0.0)[0];
    if start.abs() > LARGEST_START * if is_angle { 1.0 } else { assembly.size().unwrap_or(1.0) } {
        let cure = if profile.at(0.0) == profile.at(1.0) {
            "a profile says where the joint is over time: a speed is written \"SPEED*t\""
        } else {
            "coordinates of joints count from the start: subtract the value at t = 0, and give a joint that begins elsewhere its place in [start]"
        };
        return Err(entry.refuse("profile", format!("the profile is {start} at t = 0, and the joint is at 0"), cure));
    }
    let driven = format!("{}.{}", coordinate.joint, coordinate.name);
    if let Some(other) = assembly.driven.insert(driven, entry.name.to_string()) {
        let message = format!("`{}` is driven by `{other}` already", coordinate.joint);
        return Err(entry.refuse("joint", message, "remove one of the two drives"));
    }
    let profile = start::profile(assembly, &coordinate, profile);
    let part = assembly.builder.part(&coordinate.form);
    let sum = assembly.builder.sum(&[(part, 1.0)]);
    assembly.efforts.push(Effort { name: entry.name.to_string(), row: assembly.builder.rows(), length: None, is_moment: is_angle });
    assembly.builder.row(entry.name, sum, profile);
    assembly.draw_drive(entry, &coordinate.joint);
    Ok(())
}

/// Largest value of a profile at the start that is taken for rounding and corrected, rad, or over the size of the mechanism.
const LARGEST_START: f64 = 1e-3;
