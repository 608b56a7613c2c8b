use std::sync::Arc;

use super::profile::Profile;
use crate::model::assembly::{Assembly, Effort};
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::model::lengths::DrivenLength;
use crate::model::start::Target;
use crate::model::stroke::from_start;
use crate::record::LineKind;
use crate::system::{HalfSquare, Signal};

/// a cylinder that keeps two points as far apart as it is told
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "distance",
    equations = "½ |x_b − x_a|² − ½ L(t)² = 0; it pushes with −λ L",
    example = r#"
[body.boom]
mass = 10
shape = { box = [2, 0.1, 0.1] }
position = [1, 0, 0]

[body.boom.points]
lug = [0, 0, 0]

[joint.hinge]
type = "revolute"
between = ["ground", "boom"]
at = [0, 0, 0]
axis = [0, 1, 0]

[drive.cylinder]
type = "distance"
between = [[1, 0, -1], "boom.lug"]
profile = "1 + 0.1*sin(t)"
"#
)]
pub struct Distance {
    /// the two points, or places of bodies
    #[key(shape = Shape::Ends(2, 2))]
    pub between: List<Place>,
    /// distance as a formula of t, or { table = [[t, L], …] }
    #[key(unit = "m", default = "this or `stroke`")]
    pub profile: Option<Profile>,
    /// by how much the distance differs from that of the start, in the same spellings; zero at the start
    #[key(unit = "m", default = "this or `profile`")]
    pub stroke: Option<Profile>,
}

impl Element for Distance {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let profile = entry.optional("profile", &self.profile, Profile::signal);
        let stroke = entry.optional("stroke", &self.stroke, Profile::signal);
        let (ends, profile, stroke) = (ends?, profile?, stroke?);
        let [a, b] = &ends;
        let is_moved = assembly.starts.iter().any(Target::is_placed);
        let (length, stroke): (Arc<dyn Signal>, _) = match (profile, stroke) {
            (Some(profile), None) => {
                let (given, start) = (profile.at(0.0)[0], norm(difference(a, b)));
                if given <= 0.0 {
                    let cure = "it must be above 0; by how much it differs from that of the start is a `stroke`";
                    return Err(entry.refuse("profile", format!("the distance is {given} at t = 0"), cure));
                }
                let contradiction = || format!("the distance is {given} m at t = 0, but `{}` and `{}` are {start} m apart", a.name, b.name);
                // Where joints are put elsewhere the ends may be as far apart as that there.
                if !is_moved {
                    assembly.check_start(entry, start - given, given, contradiction)?;
                }
                (profile, None)
            }
            (None, Some(stroke)) => (from_start(entry, &ends, stroke.clone(), "profile")?, Some(stroke)),
            (None, None) => {
                let cure = "add stroke = … to count from the start, or profile = … with the distance itself";
                return Err(entry.refuse_all(format!("`{}` has neither `profile` nor `stroke`", entry.name), cure));
            }
            (Some(_), Some(_)) => {
                return Err(entry.refuse_key("stroke", "the distance is given by `profile` already", "keep one of the two"));
            }
        };
        let half_square = assembly.builder.square(&from_to(a, b));
        let row = assembly.builder.rows();
        assembly.lengths.push(DrivenLength { row, effort: assembly.efforts.len(), stroke });
        assembly.efforts.push(Effort { name: entry.name.to_string(), row, length: Some(Arc::clone(&length)), is_moment: false });
        assembly.builder.row(entry.name, half_square, Arc::new(HalfSquare(length)));
        assembly.draw(entry, LineKind::Cylinder, a, b);
        Ok(())
    }
}
