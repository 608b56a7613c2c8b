use std::sync::Arc;

use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::expression::TimeProgram;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::model::stroke::{apart_at_start, from_start};
use crate::record::{LineKind, RecordedRod};
use crate::system::{Constant, HalfSquare, Signal};

/// keeps two points a distance apart: a massless rod, or with a length that depends on time an actuator
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "distance",
    equations = "½ |x_b − x_a|² − ½ L(t)² = 0",
    example = r#"
[point.bob]
mass = 1
position = [1, 0, 0]

[constraint.rod]
type = "distance"
between = ["ground", "bob"]
length = "1 + 0.1*sin(t)"
"#
)]
pub struct Distance {
    /// the two points
    #[key(shape = Shape::Ends(2, 2))]
    pub between: List<Place>,
    /// number, or formula of the time t
    #[key(unit = "m", default = "the distance at the start", shape = Shape::Formula(&["t"]))]
    pub length: Option<Number>,
    /// by how much the distance differs from that of the start, as a formula of t; instead of a length, and zero at the start
    #[key(unit = "m", default = "none", shape = Shape::Formula(&["t"]))]
    pub stroke: Option<Number>,
}

impl Element for Distance {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let length = entry.optional("length", &self.length, |length, entry, key| length.formula(entry, key, &["t"]));
        let stroke = entry.optional("stroke", &self.stroke, |stroke, entry, key| stroke.formula(entry, key, &["t"]));
        let (ends, length, stroke) = (ends?, length?, stroke?);
        let [a, b] = &ends;
        if length.is_none() && stroke.is_none() {
            assembly.kept_apart.push([a.name.clone(), b.name.clone()]);
        }
        let target: Arc<dyn Signal> = match (length, stroke) {
            (Some(_), Some(_)) => {
                return Err(entry.refuse_key("stroke", "the distance is given by `length` already", "keep one of the two"));
            }
            (None, None) => Arc::new(Constant(apart_at_start(entry, &ends)?)),
            (None, Some(stroke)) => from_start(entry, &ends, Arc::new(TimeProgram(stroke)), "length")?,
            (Some(length), None) => {
                let length = TimeProgram(length);
                let (at_start, start) = (length.at(0.0)[0], norm(difference(a, b)));
                if at_start == 0.0 {
                    let cure = "to keep two points together use type = \"fixed\" with between";
                    return Err(entry.refuse("length", "a distance of zero has no direction", cure));
                }
                if !(at_start > 0.0 && at_start.is_finite()) {
                    return Err(entry.refuse("length", format!("the length at the start is {at_start}"), "it must be above 0"));
                }
                let contradiction =
                    || format!("the length is {at_start} m, but at the start `{}` and `{}` are {start} m apart", a.name, b.name);
                assembly.check_start(entry, start - at_start, at_start, contradiction)?;
                Arc::new(length)
            }
        };
        let half_square = assembly.builder.square(&from_to(a, b));
        assembly.rods.push(RecordedRod { name: entry.name.into(), row: assembly.builder.rows(), length: Arc::clone(&target) });
        assembly.builder.row(entry.name, half_square, Arc::new(HalfSquare(target)));
        assembly.draw(entry, LineKind::Rod, a, b);
        Ok(())
    }
}
