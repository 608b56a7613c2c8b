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
    #[key(unit = "m")]
    pub profile: Profile,
}

impl Element for Distance {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let profile = self.profile.signal(entry, "profile");
        let ([a, b], profile) = (ends?, profile?);
        let (start, given) = (norm(difference(&a, &b)), profile.at(0.0)[0]);
        if given <= 0.0 {
            return Err(entry.refuse("profile", format!("the distance is {given} at t = 0"), "it must be above 0"));
        }
        let contradiction = || format!("the distance is {given} m at t = 0, but `{}` and `{}` are {start} m apart", a.name, b.name);
        assembly.check_start(entry, start - given, given, contradiction)?;
        let half_square = assembly.builder.square(&from_to(&a, &b));
        let length = Some(Arc::clone(&profile));
        assembly.efforts.push(Effort { name: entry.name.to_string(), row: assembly.builder.rows(), length, is_moment: false });
        assembly.builder.row(entry.name, half_square, Arc::new(HalfSquare(profile)));
        assembly.draw(entry, LineKind::Rod, &a, &b);
        Ok(())
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
