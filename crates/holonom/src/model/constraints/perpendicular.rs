use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Place};
use crate::model::geometry::{dot, norm};
use crate::model::key::Shape;
use crate::record::Acts;

/// keeps the directions of two pairs of points at a right angle
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "perpendicular",
    equations = "(x_b − x_a) · (x_d − x_c) = 0 for first = [a, b], second = [c, d]",
    example = r#"
[point.a]
mass = 1
position = [1, 0, 0]

[point.b]
mass = 1
position = [0, 2, 0]

[constraint.square]
type = "perpendicular"
first = ["ground", "a"]
second = ["ground", "b"]
"#
)]
pub struct Perpendicular {
    /// from one point to another
    #[key(shape = Shape::Ends(2, 2))]
    pub first: List<Place>,
    /// from one point to another
    #[key(shape = Shape::Ends(2, 2))]
    pub second: List<Place>,
}

impl Element for Perpendicular {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let first = assembly.pair(entry, "first", &self.first);
        let second = assembly.pair(entry, "second", &self.second);
        let ([a, b], [c, d]) = (first?, second?);
        assembly.require_free(entry, "first", &[a.clone(), b.clone(), c.clone(), d.clone()])?;
        let (u, w) = (difference(&a, &b), difference(&c, &d));
        for (key, length) in [("first", norm(u)), ("second", norm(w))] {
            if length == 0.0 {
                return Err(entry.refuse(key, "these two points start at the same place", "without a direction there is no angle"));
            }
        }
        let size = norm(u) * norm(w);
        let angle = || {
            format!("the two directions are at {:.4}° at the start, not at 90°", (dot(u, w) / size).clamp(-1.0, 1.0).acos().to_degrees())
        };
        assembly.check_start(entry, dot(u, w), size, angle)?;
        let (ways, first) = ([from_to(&a, &b), from_to(&c, &d)], assembly.builder.rows());
        let product = assembly.builder.dot(&ways[0], &ways[1]);
        assembly.builder.constant_row(entry.name, product, 0.0);
        assembly.hold(entry, "moment on the second pair of points", first, Acts::Square(ways));
        Ok(())
    }
}
