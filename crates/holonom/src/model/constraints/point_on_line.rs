use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{End, difference, fixed, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::{across, cross, dot, norm};
use crate::model::key::Shape;
use crate::model::straight;
use crate::record::{Acts, LineKind, Straight};

/// keeps a point on a line of fixed direction, or on the line through two points
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "point-on-line",
    equations = "e_k · (x − x_through) = 0 with e_k ⊥ direction: 2 rows in space, 1 in the plane; \
                 with line = [a, b]: (x_b − x_a) × (x − x_a) = 0, in space 3 rows with one redundant, or 2 where points slide",
    example = r#"
[point.slider]
mass = 1
position = [1, 0, 0]

[constraint.rail]
type = "point-on-line"
point = "slider"
direction = [1, 0, 0]
"#
)]
pub struct PointOnLine {
    /// the point that slides
    #[key(shape = Shape::Point)]
    pub point: String,
    /// direction of the line
    #[key(unit = "any", default = "none: this or a line is needed", shape = Shape::Vector)]
    pub direction: Option<List<Number>>,
    /// a point of the line of that direction
    #[key(default = "where the point starts")]
    pub through: Option<Place>,
    /// two points that the line goes through, instead of direction and through
    #[key(default = "none", shape = Shape::Ends(2, 2))]
    pub line: Option<List<Place>>,
}

/// What is recorded of it.
const ON_POINT: &str = "force of the line on the point";

impl Element for PointOnLine {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        match &self.line {
            Some(line) => self.between_points(assembly, entry, line),
            None => self.along_direction(assembly, entry),
        }
    }
}

impl PointOnLine {
    fn along_direction(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let dim = assembly.dimension();
        let point = assembly.point(entry, "point", &self.point);
        let through = entry.optional("through", &self.through, |through, entry, key| assembly.end(entry, key, through));
        let direction = match &self.direction {
            Some(direction) => direction.vector(entry, "direction", dim),
            None => Err(entry.refuse_all(format!("`{}` has neither `direction` nor `line`", entry.name), "add one of them")),
        };
        let (point, direction) = (point?, direction?);
        let through = through?.unwrap_or_else(|| fixed(point.start, "its start".into()));
        assembly.require_free(entry, "point", &[point.clone(), through.clone()])?;
        let length = norm(direction);
        if length == 0.0 {
            return Err(entry.refuse("direction", "the direction is zero", "give the direction of the line"));
        }
        let across = across(direction.map(|c| c / length), dim);
        let d = difference(&through, &point);
        let off = across.iter().map(|&e| dot(e, d).powi(2)).sum::<f64>().sqrt();
        let size = norm(d).max(norm(point.start));
        assembly.check_start(entry, off, size, || format!("`{}` starts {off} m beside the line", point.name))?;
        let first = assembly.builder.rows();
        for (row, &e) in across.iter().enumerate() {
            let component = assembly.builder.linear(e, &from_to(&through, &point));
            assembly.builder.constant_row(Assembly::row_name(entry, row, across.len()), component, 0.0);
        }
        assembly.hold(entry, ON_POINT, first, Acts::Along(across));
        let (back, forth) =
            ([-1.0, 1.0].map(|s| fixed(std::array::from_fn(|c| through.start[c] + s * direction[c]), String::new()))).into();
        if through.point.is_none() {
            assembly.draw(entry, LineKind::Guide, &back, &forth);
        }
        Ok(())
    }

    fn between_points(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, line: &[Place]) -> Read<()> {
        for (key, given) in [("direction", self.direction.is_some()), ("through", self.through.is_some())] {
            if given {
                entry.refuse(key, format!("`{key}` and `line` exclude each other"), "keep one of the two");
            }
        }
        let (point, line) = (assembly.point(entry, "point", &self.point), assembly.pair(entry, "line", line));
        let (point, [a, b]) = (point?, line?);
        assembly.require_free(entry, "point", &[point.clone(), a.clone(), b.clone()])?;
        let (u, w) = (difference(&a, &b), difference(&a, &point));
        check(assembly, entry, [&point, &a, &b], norm(u), norm(cross(u, w)))?;
        let keep_lengths = [&b, &point].into_iter().all(|end| assembly.keeps_apart(&a, end));
        let (ways, first) = ([from_to(&a, &b), from_to(&a, &point)], assembly.builder.rows());
        let quantities = straight::parallel(assembly, ways.each_ref().map(Vec::as_slice), keep_lengths);
        straight::hold(assembly, entry, &quantities);
        assembly.hold(entry, ON_POINT, first, Acts::Straight(vec![Straight { quantities, ways, on: vec![(0, 1, 1.0)] }]));
        assembly.draw(entry, LineKind::Guide, &a, &b);
        Ok(())
    }
}

fn check(assembly: &Assembly<'_>, entry: &Entry<'_>, [point, a, b]: [&End; 3], length: f64, product: f64) -> Read<()> {
    if length == 0.0 {
        return Err(entry.refuse(
            "line",
            format!("`{}` and `{}` start at the same place", a.name, b.name),
            "a line needs two different places",
        ));
    }
    for other in [a, b] {
        if other.terms == point.terms {
            return Err(entry.refuse("line", format!("`{}` is on this line anyway", point.name), "name two other points"));
        }
    }
    let off = product / length;
    assembly
        .check_start(entry, off, length, || format!("`{}` starts {off} m beside the line from `{}` to `{}`", point.name, a.name, b.name))
}
