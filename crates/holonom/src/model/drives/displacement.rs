use super::coordinate::drive;
use super::profile::Profile;
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::Keys;

/// a drive that moves a joint along its axis as it is told, counted from the start
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "displacement",
    equations = "s − s(t) = 0; its force is −λ",
    example = r#"
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
"#
)]
pub struct Displacement {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// displacement as a formula of t, or { table = [[t, s], …] }; zero at the start
    #[key(unit = "m")]
    pub profile: Profile,
}

impl Element for Displacement {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        drive(assembly, entry, &self.joint, &self.profile, false)
    }
}
