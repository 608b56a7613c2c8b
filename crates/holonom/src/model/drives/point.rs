use std::sync::Arc;

use crate::model::assembly::{Assembly, Effort};
use crate::model::element::Element;
use crate::model::ends::{difference, fixed};
use crate::model::entry::Entry;
use crate::model::expression::TimeProgram;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::model::geometry::{norm, unit};
use crate::model::key::Shape;
use crate::system::Signal;

/// a hand that leads a point, or a place of a body, along a path
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "point",
    equations = "x − x(t) = 0, a row an axis; its force is −λ",
    example = r#"
[body.hand]
mass = 1
shape = { box = [0.2, 0.1, 0.1] }
position = [0, 0, 0]

[body.hand.points]
grip = [0.1, 0, 0]

[drive.path]
type = "point"
point = "hand.grip"
profile = ["0.1*cos(t)", "0.1*sin(t)", 0]
"#
)]
pub struct Point {
    /// the point that is led
    #[key(shape = Shape::Point)]
    pub point: String,
    /// its coordinates as formulas of t
    #[key(unit = "m", shape = Shape::Formulas(&["t"]))]
    pub profile: List<Number>,
}

impl Element for Point {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let dim = assembly.dimension();
        let point = assembly.point(entry, "point", &self.point);
        let profile = self.profile.motions(entry, "profile", dim);
        let (point, profile) = (point?, profile?);
        assembly.require_free(entry, "point", std::slice::from_ref(&point))?;
        let mut start = [0.0; 3];
        profile.iter().zip(&mut start).for_each(|(program, start)| *start = TimeProgram(program.clone()).at(0.0)[0]);
        let begin = fixed(start, String::new());
        let off = norm(difference(&begin, &point));
        assembly.check_start(entry, off, norm(start).max(norm(point.start)), || {
            format!("the path begins at {:?} m, and `{}` starts at {:?} m", &start[..dim], point.name, &point.start[..dim])
        })?;
        for (c, program) in profile.into_iter().enumerate() {
            let axis = char::from(assembly.axes.name.as_bytes()[c]);
            let component = assembly.builder.linear(unit(c), &point.terms);
            let name = format!("{}.{axis}", entry.name);
            assembly.efforts.push(Effort { name, row: assembly.builder.rows(), length: None, is_moment: false });
            assembly.builder.row(format!("{}[{axis}]", entry.name), component, Arc::new(TimeProgram(program)));
        }
        Ok(())
    }
}
