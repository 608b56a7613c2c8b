use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{End, difference, fixed, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Place};
use crate::model::geometry::unit;
use crate::model::key::Shape;
use crate::record::Acts;

/// keeps a point where it starts, or two points as far apart and in the direction in which they start
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "fixed",
    equations = "x − x(0) = 0, or (x_b − x_a) − (x_b − x_a)(0) = 0; one row an axis, linear",
    example = r#"
[point.a]
mass = 1
position = [1, 0, 0]

[point.b]
mass = 1
position = [1, 0, 0]

[constraint.pin]
type = "fixed"
between = ["a", "b"]
"#
)]
pub struct Fixed {
    /// the point that stays
    #[key(default = "none: this or between is needed", shape = Shape::Point)]
    pub point: Option<String>,
    /// the two points whose offset stays
    #[key(default = "none", shape = Shape::Ends(2, 2))]
    pub between: Option<List<Place>>,
}

impl Element for Fixed {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (key, [a, b]) = self.ends(assembly, entry)?;
        assembly.require_free(entry, key, &[a.clone(), b.clone()])?;
        let offset = difference(&a, &b);
        let (first, axes) = (assembly.builder.rows(), assembly.axes.name.as_bytes());
        for (c, &axis) in axes.iter().enumerate() {
            let component = assembly.builder.linear(unit(c), &from_to(&a, &b));
            assembly.builder.constant_row(format!("{}[{}]", entry.name, char::from(axis)), component, offset[c]);
        }
        let what = if key == "point" { "force of the constraint on the point" } else { "force of the constraint on the second point" };
        assembly.hold(entry, what, first, Acts::Along((0..axes.len()).map(unit).collect()));
        Ok(())
    }
}

impl Fixed {
    /// What stays, with the key that names it.
    fn ends(&self, assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<(&'static str, [End; 2])> {
        match (&self.point, &self.between) {
            (Some(_), Some(_)) => Err(entry.refuse("between", "`point` and `between` exclude each other", "keep one of the two")),
            (Some(point), None) => Ok(("point", [fixed([0.0; 3], "ground".into()), assembly.point(entry, "point", point)?])),
            (None, Some(between)) => Ok(("between", assembly.pair(entry, "between", between)?)),
            (None, None) => Err(entry.refuse_all(format!("`{}` has neither `point` nor `between`", entry.name), "add one of them")),
        }
    }
}
