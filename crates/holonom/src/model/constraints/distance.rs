use std::sync::Arc;

use crate::model::assembly::Assembly;
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
}

impl Element for Distance {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let length = entry.optional("length", &self.length, |length, entry, key| length.formula(entry, key, &["t"]));
        let (ends, length) = (ends?, length?);
        let [a, b] = &ends;
        let start = norm(difference(a, b));
        let target: Arc<dyn Signal> = match length {
            None => {
                let start = started(entry, &ends, start)?;
                Arc::new(Constant(0.5 * start * start))
            }
            Some(length) => {
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
                    None => Arc::new(HalfSquare(length)),
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

/// ½ L(t)².
struct HalfSquare(Program);

impl Signal for HalfSquare {
    fn at(&self, t: f64) -> [f64; 3] {
        let length = self.0.evaluate(&[num_dual::Dual2_64::new(t, 1.0, 0.0)]);
        let half = length * length * 0.5;
        [half.re, half.v1, half.v2]
    }
}
