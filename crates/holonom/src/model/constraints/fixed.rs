use crate::model::assembly::Assembly;
use crate::model::ends::{End, difference, fixed, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::geometry::unit;
use crate::model::key::{Key, Kind, Shape};

pub(super) const KIND: Kind = Kind {
    name: "fixed",
    doc: "keeps a point where it starts, or two points as far apart and in the direction in which they start",
    equations: "x − x(0) = 0, or (x_b − x_a) − (x_b − x_a)(0) = 0; one row an axis, linear",
    keys: &[
        Key::optional("point", Shape::Point, "none: this or between is needed", "", "the point that stays"),
        Key::optional("between", Shape::Ends(2, 2), "none", "", "the two points whose offset stays"),
    ],
    example: r#"
[point.a]
mass = 1
position = [1, 0, 0]

[point.b]
mass = 1
position = [1, 0, 0]

[constraint.pin]
type = "fixed"
between = ["a", "b"]
"#,
    build,
};

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let (key, [a, b]) = ends(assembly, entry)?;
    assembly.require_free(entry, key, &[a.clone(), b.clone()])?;
    let offset = difference(&a, &b);
    let axes = assembly.axes.name.as_bytes();
    for (c, &axis) in axes.iter().enumerate() {
        let component = assembly.builder.linear(unit(c), &from_to(&a, &b));
        assembly.builder.constant_row(format!("{}[{}]", entry.name, char::from(axis)), component, offset[c]);
    }
    Ok(())
}

fn ends(assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<(&'static str, [End; 2])> {
    match (entry.has("point"), entry.has("between")) {
        (true, true) => Err(entry.refuse("between", "`point` and `between` exclude each other", "keep one of the two")),
        (true, false) => Ok(("point", [fixed([0.0; 3], "ground".into()), assembly.point(entry, "point")?])),
        (false, true) => Ok(("between", assembly.pair(entry, "between")?)),
        (false, false) => Err(entry.refuse_all(format!("`{}` has neither `point` nor `between`", entry.name), "add one of them")),
    }
}
