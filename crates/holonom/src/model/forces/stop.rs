use std::collections::HashMap;
use std::sync::Arc;

use super::coordinate_laws::{Buffer, Impact};
use super::joint::acted_on;
use crate::model::adrift::measured;
use crate::model::assembly::Assembly;
use crate::model::bodies::short;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::joints::coordinate;

/// Share of the size of a coordinate within which it counts as at its limit.
const ROUNDED: f64 = 1e-9;

/// buffers at the ends of a joint's way: springs that act beyond its limits only, with what an impact takes out
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "stop",
    equations = "beyond a limit by p: V = ½ k p², effort −k d p q̇, which takes at most all of the spring's (Hunt and Crossley)",
    example = r#"
[body.flap]
mass = 1
shape = { box = [0.4, 0.2, 0.01] }
position = [0.2, 0, 0]
angular_velocity = [0, 1, 0]
velocity = [0, 0, -0.2]

[joint.hinge]
type = "revolute"
between = ["ground", "flap"]
at = [0, 0, 0]
axis = [0, 1, 0]

[force.buffer]
type = "stop"
joint = "hinge"
lower = -0.02
upper = 0.01
stiffness = 50
dissipation = 0.2
"#
)]
pub struct Stop {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// smallest coordinate without contact, counted from the start
    #[key(unit = "rad or m", default = "none")]
    pub lower: Option<Number>,
    /// largest coordinate without contact
    #[key(unit = "rad or m", default = "none")]
    pub upper: Option<Number>,
    /// k
    #[key(unit = "N·m/rad or N/m")]
    pub stiffness: Number,
    /// d; what it takes is booked as work
    #[key(unit = "s/rad or s/m", default = "0")]
    pub dissipation: Option<Number>,
}

/// A limit of a coordinate, which may be beyond it at the start.
pub(in crate::model) struct Limit {
    path: String,
    coordinate: String,
    buffer: Buffer,
    /// Which of repeated entries it is of.
    told: String,
}

/// Notes stops that push from the start, where that is by more than the rounding of places.
pub(in crate::model) fn note_pushing(assembly: &Assembly<'_>) {
    if assembly.limits.is_empty() {
        return;
    }
    let (system, measured) = measured(&assembly.builder);
    let numbers: HashMap<&str, usize> = system.gauges().iter().enumerate().map(|(k, name)| (name.as_str(), k)).collect();
    for Limit { path, coordinate, buffer: Buffer { stiffness, limit, sign }, told } in &assembly.limits {
        let Some(&k) = numbers.get(coordinate.as_str()) else { continue };
        let (q, is_angle) = (measured.value[k], system.is_angle(k));
        let size = if is_angle { 1.0 } else { assembly.builder.size() };
        if sign * (q - limit) > ROUNDED * size {
            let [from, to, force] = [q, *limit, stiffness * (q - limit).abs()].map(short);
            let (side, unit) = (if *sign < 0.0 { "below" } else { "above" }, if is_angle { "N·m" } else { "N" });
            let message = || {
                format!("`{coordinate}` starts at {from}, {side} its limit {to}: the stop pushes with {force} {unit} from the start{told}")
            };
            assembly.sink.note(path, message);
        }
    }
}

impl Element for Stop {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let coordinate = coordinate(assembly, entry, "joint".into(), &self.joint);
        let [lower, upper] =
            [("lower", &self.lower), ("upper", &self.upper)].map(|(key, limit)| entry.optional(key, limit, Number::number));
        let stiffness = self.stiffness.positive(entry, "stiffness");
        let dissipation = entry.optional("dissipation", &self.dissipation, Number::not_negative);
        let (coordinate, lower, upper, stiffness, dissipation) = (coordinate?, lower?, upper?, stiffness?, dissipation?);
        match (lower, upper) {
            (None, None) => {
                return Err(entry.refuse_all(format!("the stop `{}` has no limit", entry.name), "add lower, upper, or both"));
            }
            (Some(lower), Some(upper)) if lower >= upper => {
                let cure = if lower > upper { "exchange them" } else { "take them apart, or a `torsion` spring about that place" };
                return Err(entry.refuse("lower", format!("the lower limit {lower} is not below the upper one {upper}"), cure));
            }
            _ => (),
        }
        let q = acted_on(assembly, &coordinate);
        for (key, limit, sign) in [("lower", lower, -1.0), ("upper", upper, 1.0)] {
            let Some(limit) = limit else { continue };
            let buffer = || Buffer { stiffness, limit, sign };
            let (path, told) = (entry.path_of(key.into()), entry.told(String::new()));
            assembly.limits.push(Limit { path, coordinate: format!("{}.{}", coordinate.joint, coordinate.name), buffer: buffer(), told });
            assembly.builder.law(entry.name, &[q], Arc::new(buffer()));
            if let Some(dissipation) = dissipation.filter(|&dissipation| dissipation > 0.0) {
                assembly.builder.law(entry.name, &[q], Arc::new(Impact { buffer: buffer(), dissipation }));
            }
        }
        Ok(())
    }
}
