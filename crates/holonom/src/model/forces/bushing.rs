use std::sync::Arc;

use super::coordinate_laws::{Resisting, Spring, Viscous};
use crate::model::assembly::Assembly;
use crate::model::bodies::nodes::Member;
use crate::model::element::Element;
use crate::model::ends::subtract;
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::unit;
use crate::model::key::Shape;
use crate::record::{Along, Shows};
use crate::system::{FunctionId, Part};

/// a rubber bearing between two bodies: springs and dampers along and about three axes of the first body, which are those of the
/// model at the start; without force as the bodies start; for rotations well below a right angle
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "bushing",
    equations = "V = ½ Σ k q², effort −c q̇, with q = d·e_k(A) and about e_k the mean of e_j(A)·e_i(B) and −e_i(A)·e_j(B), (i, j, k) cyclic: the sine of a rotation about one axis alone",
    example = r#"
[body.engine]
mass = 50
shape = { box = [0.5, 0.4, 0.4] }
position = [0, 0, 0.5]
angular_velocity = [1, 0, 0]

[force.mount]
type = "bushing"
between = ["ground", "engine"]
at = [0.1, 0, 0.3]
stiffness = [2e3, 2e3, 5e3, 100, 120, 90]
damping = [20, 20, 50, 1, 1, 1]
"#
)]
pub struct Bushing {
    /// the two bodies, or "ground" and a body
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start
    #[key(unit = "m")]
    pub at: Place,
    /// along x, y, z and about x, y, z; in a planar model three: along both axes and about the normal
    #[key(unit = "N/m, N·m/rad", shape = Shape::Numbers(3, 6))]
    pub stiffness: List<Number>,
    /// in the same order; what it takes is booked as work
    #[key(unit = "N·s/m, N·m·s/rad", default = "none", shape = Shape::Numbers(3, 6))]
    pub damping: Option<List<Number>>,
}

impl Element for Bushing {
    fn turns(&self) -> Vec<(&'static str, &str)> {
        self.between.iter().map(|name| ("between", name.as_str())).collect()
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let count = if assembly.dimension() == 2 { 3 } else { 6 };
        let members = members(assembly, entry, &self.between);
        let at = assembly.place_at_start(entry, "at", &self.at);
        let stiffness = numbers(entry, "stiffness", &self.stiffness, count);
        let damping = entry.optional("damping", &self.damping, |damping, entry, key| numbers(entry, key, damping, count));
        let (members, at, stiffness, damping) = (members?, at?, stiffness?, damping?);
        if stiffness.iter().chain(damping.iter().flatten()).all(|&number| number == 0.0) {
            return Err(entry.refuse_all(format!("the bushing `{}` does nothing", entry.name), "give it a stiffness or a damping above 0"));
        }
        assembly.draw_bushing(entry, members, at);
        note_coupler(assembly, entry, members);
        let coordinates = coordinates(assembly, members, at);
        let axes = members.map(|member| (0..assembly.dimension()).map(|k| assembly.frame(member).vector(unit(k))).collect());
        assembly.show(Shows::Bushing { coordinates: shown(&coordinates, assembly.axes.name), axes });
        for (k, &q) in coordinates.iter().enumerate() {
            if stiffness[k] > 0.0 {
                assembly.builder.law(entry.name, &[q], Arc::new(Spring { stiffness: stiffness[k], rest: 0.0 }));
            }
            if let Some(damping) = damping.as_ref().map(|damping| damping[k]).filter(|&damping| damping > 0.0) {
                assembly.builder.law(entry.name, &[q], Arc::new(Resisting(Viscous(damping))));
            }
        }
        Ok(())
    }
}

/// Notes a coupler of wheels that a bushing lets yield against each other.
fn note_coupler(assembly: &Assembly<'_>, entry: &Entry<'_>, [a, b]: [Member; 2]) {
    let is_tied = |[first, second]: &[[Member; 2]; 2]| [[a, b], [b, a]].iter().any(|[a, b]| first.contains(a) && second.contains(b));
    if let Some((coupler, _)) = assembly.wheels_apart.iter().find(|(_, joints)| is_tied(joints)) {
        let message = format!(
            "the wheels of `{coupler}` yield here against each other, and a coupler of angles pushes no bearing: nothing yields under its force (write the way \
             that the bearing yields as one of the coordinates of a coupler of type = \"linear\")"
        );
        entry.note("between", message);
    }
}

fn members(assembly: &Assembly<'_>, entry: &Entry<'_>, names: &[String]) -> Read<[Member; 2]> {
    let [first, second] = names else {
        return Err(entry.refuse("between", "a bushing is between two bodies", "write between = [\"A\", \"B\"]"));
    };
    let member = |k: usize, name: &str| {
        let spot = Spot { key: "between", item: Some(k) };
        match assembly.member(entry, spot, name)? {
            Member::Point(_) => Err(entry.refuse(spot, format!("`{name}` is a point and does not turn"), "name a body, or use springs")),
            Member::Bar(_) => Err(entry.refuse(spot, format!("`{name}` is a bar, and a body is wanted here"), "name a body")),
            member => Ok(member),
        }
    };
    let (a, b) = (member(0, first), member(1, second));
    let members = [a?, b?];
    if members[0] == members[1] {
        return Err(entry.refuse("between", format!("`{first}` is joined to itself"), "name two different bodies"));
    }
    Ok(members)
}

fn numbers(entry: &Entry<'_>, key: &str, items: &[Number], count: usize) -> Read<Vec<f64>> {
    if items.len() != count {
        return Err(entry.refuse(
            key,
            format!("`{key}` wants {count} numbers, and this has {}", items.len()),
            if count == 3 { "give one for each of x, y and the rotation" } else { "give one for each of x, y, z, rx, ry, rz" },
        ));
    }
    all(items.iter().enumerate().map(|(k, item)| item.not_negative(entry, Spot { key, item: Some(k) })))
}

/// The coordinates with the names of their columns.
fn shown(coordinates: &[FunctionId], axes: &str) -> Vec<Along> {
    let letters: Vec<String> = axes.chars().map(String::from).collect();
    let turns = if letters.len() == 2 { vec![String::new()] } else { letters.clone() };
    let of = |is_angle: bool, letter: &String| {
        let about = if letter.is_empty() { "about the normal".into() } else { format!("about {letter} of the first body") };
        let along = format!("along {letter} of the first body");
        match is_angle {
            true => [
                [format!("r{letter}"), format!("sine of the rotation {about}, and no angle")],
                [format!("t{letter}"), format!("moment on the second body {about}")],
            ],
            false => {
                [[format!("d{letter}"), format!("deflection {along}")], [format!("f{letter}"), format!("force on the second body {along}")]]
            }
        }
    };
    let all = letters.iter().map(|letter| (false, letter)).chain(turns.iter().map(|letter| (true, letter)));
    let along = all.zip(coordinates).map(|((is_angle, letter), &coordinate)| {
        let [value, effort] = of(is_angle, letter);
        Along { coordinate, value: Some(value), effort, is_angle }
    });
    along.collect()
}

/// Displacements and rotations, zero at the start.
fn coordinates(assembly: &mut Assembly<'_>, members: [Member; 2], at: [f64; 3]) -> Vec<FunctionId> {
    let [a, b] = members.map(|member| assembly.frame(member));
    let d = subtract(&b.point(at), &a.point(at));
    let dim = assembly.dimension();
    let mut sums: Vec<FunctionId> = Vec::new();
    for k in 0..dim {
        let product = assembly.builder.dot(&d, &a.vector(unit(k)));
        sums.push(assembly.builder.sum(&[(Part::Invariant(product), 1.0)]));
    }
    for k in if dim == 2 { 2..3 } else { 0..3 } {
        let (i, j) = (unit((k + 1) % 3), unit((k + 2) % 3));
        let forth = assembly.builder.dot(&a.vector(j), &b.vector(i));
        let back = assembly.builder.dot(&a.vector(i), &b.vector(j));
        sums.push(assembly.builder.sum(&[(Part::Invariant(forth), 0.5), (Part::Invariant(back), -0.5)]));
    }
    sums
}
