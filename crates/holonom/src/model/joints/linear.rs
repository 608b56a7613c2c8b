use super::coupler::{coordinate, couple};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::entry::all;
use crate::model::fault::Read;
use crate::model::key::{Key, Kind, Shape};
use crate::system::MAX_ARGUMENTS;

pub(super) const KIND: Kind = Kind {
    name: "linear",
    doc: "a sum of joint coordinates that stays as it is: a differential, a tilting table, any linear coupling",
    equations: "Σ factor_k q_k = 0, angles counted over any number of turns",
    keys: &[Key::required("terms", Shape::Tables(&TERM), "", "the summands: { joint = \"JOINT\", factor = 1.0 }")],
    example: r#"
[body.wheel1]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 2]

[body.wheel2]
mass = 4
shape = { cylinder = [0.2, 0.02] }
position = [0.3, 0, 0]
angular_velocity = [0, 0, -1]

[joint.axle1]
type = "revolute"
between = ["ground", "wheel1"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.axle2]
type = "revolute"
between = ["ground", "wheel2"]
at = [0.3, 0, 0]
axis = [0, 0, 1]

[joint.sum]
type = "linear"
terms = [{ joint = "axle1", factor = 1 }, { joint = "axle2", factor = 2 }]
"#,
    build,
};

/// Keys of a term.
static TERM: [Key; 2] = [
    Key::required("joint", Shape::Text, "", "joint, or coordinate of a joint as \"JOINT.angle\""),
    Key::required("factor", Shape::Number, "", "its factor"),
];

fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let items = entry.tables("terms")?;
    if items.len() < 2 {
        return Err(entry.refuse("terms", "a coupling has at least two terms", "add { joint = \"JOINT\", factor = 1 }"));
    }
    let term = |inner: &Entry<'_>| {
        inner.refuse_unknown_keys("a term", &TERM.iter().collect::<Vec<_>>());
        let joint = inner.text("joint").and_then(|text| coordinate(assembly, inner, "joint".into(), text));
        let factor = inner.number("factor");
        Ok((joint?, factor?))
    };
    let terms = all(items.iter().enumerate().map(|(k, table)| entry.inside(&format!("terms[{k}]"), table, term)))?;
    let arguments: usize = terms.iter().map(|(coordinate, _)| if coordinate.is_angle { 2 } else { 1 }).sum();
    if arguments > MAX_ARGUMENTS {
        return Err(entry.refuse(
            "terms",
            "a coupling holds three angles, or six displacements",
            "couple in two steps, through a joint between",
        ));
    }
    couple(assembly, entry, &terms)
}
