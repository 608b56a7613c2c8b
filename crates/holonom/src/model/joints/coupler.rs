//! What couplers have in common: rows that are sums of coordinates of joints.

use crate::model::assembly::Assembly;
use crate::model::entry::{Entry, Spot};
use crate::model::fault::{Read, suggest};
use crate::model::references::split_place;
use crate::record::RecordedCoupling;
use crate::system::Part;

use super::pair::Coordinate;

/// The coordinate that a text names: that of a joint with one, or `JOINT.COORDINATE`.
pub fn coordinate(assembly: &Assembly<'_>, entry: &Entry<'_>, spot: Spot<'_>, text: &str) -> Read<Coordinate> {
    let (name, wanted) = match split_place(text) {
        Some((name, wanted)) => (name, Some(wanted)),
        None => (text, None),
    };
    let joint = assembly.joint(entry, spot, name)?;
    let names = || joint.coordinates.iter().map(|coordinate| coordinate.name);
    match (wanted, &joint.coordinates[..]) {
        (_, []) => Err(entry.refuse(
            spot,
            format!("the {} joint `{name}` has no coordinate", joint.kind),
            "name a joint with an angle or a displacement, such as a revolute or a prismatic one",
        )),
        (None, [only]) => Ok(only.clone()),
        (None, several) => {
            let cure = format!("write \"{name}.{}\", or another of {}", several[0].name, names().collect::<Vec<_>>().join(", "));
            Err(entry.refuse(spot, format!("the joint `{name}` has more than one coordinate"), cure))
        }
        (Some(wanted), known) => known.iter().find(|coordinate| coordinate.name == wanted).cloned().ok_or_else(|| {
            entry.refuse(spot, format!("the {} joint `{name}` has no coordinate `{wanted}`", joint.kind), suggest(wanted, names()))
        }),
    }
}

/// Two coordinates at the key `joints`, each of the kind that `angles` says. Of two kinds they may be named in either order, as the kinds tell which is which.
pub(super) fn two(assembly: &Assembly<'_>, entry: &Entry<'_>, texts: &[String], angles: Option<[bool; 2]>) -> Read<[Coordinate; 2]> {
    let [first, second] = texts else {
        return Err(entry.refuse(
            "joints",
            format!("two joints are wanted, and this names {}", texts.len()),
            "write joints = [\"A\", \"B\"]",
        ));
    };
    let spot = |k| Spot { key: "joints", item: Some(k) };
    if first == second {
        return Err(entry.refuse(spot(1), format!("`{first}` is coupled to itself"), "name two different joints"));
    }
    let (a, b) = (coordinate(assembly, entry, spot(0), first), coordinate(assembly, entry, spot(1), second));
    let mut pair = [a?, b?];
    if pair[0].joint == pair[1].joint && pair[0].name == pair[1].name {
        return Err(entry.refuse(spot(1), format!("`{first}` is coupled to itself"), "name two different joints"));
    }
    if angles.is_some_and(|[one, other]| one != other && [pair[0].is_angle, pair[1].is_angle] == [other, one]) {
        pair.swap(0, 1);
        return Ok(pair);
    }
    for (k, wanted) in angles.into_iter().flatten().enumerate() {
        if pair[k].is_angle != wanted {
            let what = if wanted { "an angle" } else { "a displacement" };
            let message = format!("{what} is wanted here, and this is the {} of `{}`", pair[k].name, [first, second][k]);
            return Err(entry.refuse(spot(k), message, if wanted { "name a revolute joint" } else { "name a prismatic joint" }));
        }
    }
    Ok(pair)
}

/// Adds the row Σ factor · coordinate = 0.
pub(super) fn couple(assembly: &mut Assembly<'_>, entry: &Entry<'_>, terms: &[(Coordinate, f64)]) -> Read<()> {
    let parts: Vec<_> = terms.iter().map(|(coordinate, factor)| (assembly.builder.part(&coordinate.form), *factor)).collect();
    let mut factors: Vec<(&Coordinate, f64)> = Vec::new();
    for (coordinate, factor) in terms {
        match factors.iter_mut().find(|(known, _)| known.joint == coordinate.joint && known.name == coordinate.name) {
            Some((_, sum)) => *sum += factor,
            None => factors.push((coordinate, *factor)),
        }
    }
    factors.into_iter().for_each(|(coordinate, factor)| record(assembly, entry, coordinate, factor, None));
    hold(assembly, entry, &parts, 0.0);
    Ok(())
}

/// Adds the row Σ factor · part = target.
pub(super) fn hold(assembly: &mut Assembly<'_>, entry: &Entry<'_>, parts: &[(Part, f64)], target: f64) {
    let sum = assembly.builder.sum(parts);
    assembly.builder.constant_row(entry.name, sum, target);
}

/// Has recorded what the row that is added next exerts along a coordinate, whose factor there is times the slope of the part `curve`.
pub(super) fn record(assembly: &mut Assembly<'_>, entry: &Entry<'_>, coordinate: &Coordinate, factor: f64, curve: Option<usize>) {
    assembly.couplings.push(RecordedCoupling {
        name: format!("{}.{}.{}", entry.name, coordinate.joint, coordinate.name),
        row: assembly.builder.rows(),
        factor,
        curve,
        is_moment: coordinate.is_angle,
    });
}
