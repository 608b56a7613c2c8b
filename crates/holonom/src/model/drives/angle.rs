use super::coordinate::drive;
use super::profile::Profile;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::Keys;

/// a motor that turns a joint as it is told, counted from the start over any number of turns
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "angle",
    equations = "θ − θ(t) = 0; its torque is −λ",
    example = r#"
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
"#
)]
pub struct Angle {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// angle as a formula of t, or { table = [[t, angle], …] }; zero at the start
    #[key(unit = "rad")]
    pub profile: Profile,
}

impl Element for Angle {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        drive(assembly, entry, &self.joint, &self.profile, true)
    }
}
