use std::sync::Arc;

use super::profile::Profile;
use crate::model::assembly::{Assembly, CONTRADICTION, Effort};
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::record::LineKind;
use crate::system::Signal;

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
        let ([a, b], profile, stroke) = (ends?, profile?, stroke?);
        let start = norm(difference(&a, &b));
        let profile: Arc<dyn Signal> = match (profile, stroke) {
            (Some(profile), None) => profile,
            (None, Some(stroke)) => Arc::new(FromStart { start, stroke: begin_at_zero(entry, stroke, start)? }),
            (None, None) => {
                let cure = "add stroke = … to count from the start, or profile = … with the distance itself";
                return Err(entry.refuse_all(format!("`{}` has neither `profile` nor `stroke`", entry.name), cure));
            }
            (Some(_), Some(_)) => {
                return Err(entry.refuse_key("stroke", "the distance is given by `profile` already", "keep one of the two"));
            }
        };
        let given = profile.at(0.0)[0];
        if given <= 0.0 {
            return Err(entry.refuse("profile", format!("the distance is {given} at t = 0"), "it must be above 0"));
        }
        let contradiction = || format!("the distance is {given} m at t = 0, but `{}` and `{}` are {start} m apart", a.name, b.name);
        assembly.check_start(entry, start - given, given, contradiction)?;
        let half_square = assembly.builder.square(&from_to(&a, &b));
        let length = Some(Arc::clone(&profile));
        assembly.efforts.push(Effort { name: entry.name.to_string(), row: assembly.builder.rows(), length, is_moment: false });
        assembly.builder.row(entry.name, half_square, Arc::new(HalfSquare(profile)));
        assembly.draw(entry, LineKind::Cylinder, &a, &b);
        Ok(())
    }
}

/// Refuses a stroke that does not begin at zero but for rounding, seen against the length of the start.
fn begin_at_zero(entry: &Entry<'_>, stroke: Arc<dyn Signal>, start: f64) -> Read<Arc<dyn Signal>> {
    let at_start = stroke.at(0.0)[0];
    if at_start.abs() <= CONTRADICTION * start {
        return Ok(stroke);
    }
    let cure = "a stroke counts from the start: subtract its value at t = 0, or give the distance itself as profile";
    Err(entry.refuse("stroke", format!("the stroke is {at_start} m at t = 0"), cure))
}

/// The length of the start with a stroke added.
struct FromStart {
    start: f64,
    stroke: Arc<dyn Signal>,
}

impl Signal for FromStart {
    fn at(&self, t: f64) -> [f64; 3] {
        let [stroke, rate, bend] = self.stroke.at(t);
        [self.start + stroke, rate, bend]
    }
}

/// ½ L(t)².
struct HalfSquare(Arc<dyn Signal>);

impl Signal for HalfSquare {
    fn at(&self, t: f64) -> [f64; 3] {
        let [length, rate, bend] = self.0.at(t);
        [0.5 * length * length, length * rate, rate * rate + length * bend]
    }
}
