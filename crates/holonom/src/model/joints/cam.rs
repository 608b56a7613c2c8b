use std::f64::consts::TAU;
use std::sync::Arc;

use super::coupler::{hold, record, two};
use crate::model::assembly::Assembly;
use crate::model::bodies::short;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::expression::TimeProgram;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::jumps::corner;
use crate::model::key::Shape;
use crate::model::tables::require_inside;
use crate::system::{Part, Signal};

/// a coordinate that follows another by a formula or a table: a cam with a groove, a Geneva wheel, gears that are not round
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "cam",
    equations = "q_2 − f(q_1) + f(0) = 0, angles counted over any number of turns",
    example = r#"
[body.shaft]
mass = 1
shape = { cylinder = [0.05, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 10]

[body.follower]
mass = 0.2
shape = { box = [0.02, 0.2, 0.02] }
position = [0, 0.2, 0]

[joint.axle]
type = "revolute"
between = ["ground", "shaft"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.guide]
type = "prismatic"
between = ["ground", "follower"]
axis = [0, 1, 0]

[joint.groove]
type = "cam"
joints = ["axle", "guide"]
lift = "0.02*(1 - cos(q))"
"#
)]
pub struct Cam {
    /// two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement": the one that leads, and the one that follows
    #[key(shape = Shape::Coordinates)]
    pub joints: List<String>,
    /// the second coordinate over the first, q; only its differences count, as both are zero at the start
    #[key(unit = "m or rad", shape = Shape::Formula(&["q"]))]
    pub lift: Number,
}

/// How far from the start corners are looked for where the first coordinate is a displacement, in sizes of what is built so far.
const SIZES: f64 = 10.0;

impl Element for Cam {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (joints, lift) = (two(assembly, entry, &self.joints, None), self.lift.formula(entry, "lift", &["q"]));
        let ([first, second], lift) = (joints?, lift?);
        let [value, slope, bend] = TimeProgram(lift.clone()).at(0.0);
        if ![value, slope, bend].iter().all(|number| number.is_finite()) {
            require_inside(entry, "lift", &lift, &[0.0])?;
            let message = format!("at q = 0, the start, this is {value}, its slope {slope} and its second derivative {bend}");
            return Err(entry.refuse("lift", message, "all three must be finite"));
        }
        let reach = if first.is_angle { TAU } else { SIZES * assembly.builder.extent() };
        if let Some(at) = corner(&lift, reach) {
            let message = format!("this has a corner or a jump at q = {}, where the speed of what follows would jump", short(at));
            let cure = "round it off; in a table write interpolation = \"cubic\" or \"monotone\", and outside = \"line\" or \"periodic\" for its ends";
            return Err(entry.refuse("lift", message, cure));
        }
        let [leading, following] = [&first, &second].map(|coordinate| assembly.builder.part(&coordinate.form));
        let follows = Part::Curve { of: Box::new(leading), curve: Arc::new(TimeProgram(lift)) };
        record(assembly, entry, &first, -1.0, Some(1));
        record(assembly, entry, &second, 1.0, None);
        hold(assembly, entry, &[(following, 1.0), (follows, -1.0)], -value);
        Ok(())
    }
}
