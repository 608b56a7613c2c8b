use std::sync::Arc;

use crate::model::assembly::{Assembly, CONTRADICTION};
use crate::model::element::Element;
use crate::model::ends::{End, difference, from_to};
use crate::model::entry::Entry;
use crate::model::expression::{Program, TimeProgram};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::record::LineKind;
use crate::system::{Constant, Signal};

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
        let start = norm(difference(a, b));
        let target: Arc<dyn Signal> = match (length, stroke) {
            (Some(_), Some(_)) => {
                return Err(entry.refuse_key("stroke", "the distance is given by `length` already", "keep one of the two"));
            }
            (None, None) => {
                let start = started(entry, &ends, start)?;
                Arc::new(Constant(0.5 * start * start))
            }
            (None, Some(stroke)) => {
                let (added, at_start) = (started(entry, &ends, start)?, TimeProgram(stroke.clone()).at(0.0)[0]);
                if at_start.is_nan() || at_start.abs() > CONTRADICTION * start {
                    let cure = "a stroke counts from the start: subtract its value at t = 0, or give the length itself";
                    return Err(entry.refuse("stroke", format!("the stroke is {at_start} m at t = 0"), cure));
                }
                Arc::new(HalfSquare { length: stroke, added })
            }
            (Some(length), None) => {
                let at_start = TimeProgram(length.clone()).at(0.0)[0];
                if at_start == 0.0 {
                    return Err(entry.refuse("length", "a distance of zero has no direction", ZERO_CURE));
                }
                if !(at_start > 0.0 && at_start.is_finite()) {
                    return Err(entry.refuse("length", format!("the length at the start is {at_start}"), "it must be above 0"));
                }
                let contradiction =
                    || format!("the length is {at_start} m, but at the start `{}` and `{}` are {start} m apart", a.name, b.name);
                assembly.check_start(entry, start - at_start, at_start, contradiction)?;
                match length.as_constant() {
                    Some(length) => Arc::new(Constant(0.5 * length * length)),
                    None => Arc::new(HalfSquare { length, added: 0.0 }),
                }
            }
        };
        let half_square = assembly.builder.square(&from_to(a, b));
        assembly.builder.row(entry.name, half_square, target);
        assembly.draw(entry, LineKind::Rod, a, b);
        Ok(())
    }
}

const ZERO_CURE: &str = "to keep two points together use type = \"fixed\" with between";

fn started(entry: &Entry<'_>, [a, b]: &[End; 2], start: f64) -> Read<f64> {
    if start > 0.0 {
        return Ok(start);
    }
    let message = format!("`{}` and `{}` start at the same place, and a distance of zero has no direction", a.name, b.name);
    Err(entry.refuse("between", message, ZERO_CURE))
}

/// ½ (L(t) + L₀)².
struct HalfSquare {
    length: Program,
    /// L₀, m
    added: f64,
}

impl Signal for HalfSquare {
    fn at(&self, t: f64) -> [f64; 3] {
        let length = self.length.evaluate(&[num_dual::Dual2_64::new(t, 1.0, 0.0)]) + self.added;
        let half = length * length * 0.5;
        [half.re, half.v1, half.v2]
    }
}
