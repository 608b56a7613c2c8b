//! `[bar.NAME]`: uniform rigid rods between two points, the two-node body of natural coordinates (methods §6).

use std::sync::Arc;

use super::assembly::Assembly;
use super::ends::{End, difference, from_to};
use super::entry::Entry;
use super::fault::{Read, Refused};
use super::fields::{Keys, List, Number, Place};
use super::geometry::norm;
use super::key::Shape;
use super::spread::{Moving, spread};
use crate::record::{LineKind, RecordedRod};
use crate::system::{self, Constant};

/// A uniform rigid rod between two points.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a bar")]
pub struct Bar {
    /// its two ends
    #[key(shape = Shape::Ends(2, 2))]
    pub between: List<Place>,
    /// mass, spread evenly over its length
    #[key(unit = "kg")]
    pub mass: Number,
}

/// A bar of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct BarInfo {
    /// With its index where it is repeated.
    pub name: String,
    /// Nodes at both ends, or where one is fixed; none where an end is a place of a body.
    pub ends: Option<[system::Place; 2]>,
    /// kg
    pub mass: f64,
    /// m
    pub length: f64,
}

impl Bar {
    /// Builds a bar: M has m/3 at each end and m/6 between them, and ½|x_b − x_a|² = ½L² keeps the length.
    pub(super) fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<BarInfo> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let mass = self.mass.positive(entry, "mass");
        let (ends, mass) = (ends?, mass?);
        let [a, b] = &ends;
        let length = norm(difference(a, b));
        if length == 0.0 {
            return Err(zero_length(entry, &ends));
        }
        if a.body.is_some() && a.body == b.body {
            return Err(entry.refuse("between", "both ends are on the same body", "tie the bar to two bodies, or give the body its mass"));
        }
        let places = a.place().zip(b.place()).map(|(a, b)| [a, b]);
        add_mass(assembly, &ends, mass);
        ends.iter().filter_map(|end| end.point).for_each(|point| assembly.points[point].carries_bar = true);
        assembly.kept_apart.push([a.name.clone(), b.name.clone()]);
        let half_square = assembly.builder.square(&from_to(a, b));
        assembly.rods.push(RecordedRod { name: entry.name.into(), row: assembly.builder.rows(), length: Arc::new(Constant(length)) });
        assembly.builder.constant_row(entry.name, half_square, 0.5 * length * length);
        assembly.draw(entry, LineKind::Bar, a, b);
        let number = assembly.bar_names[entry.name];
        assembly.bar_ends[number] = Some(ends);
        Ok(BarInfo { name: entry.name.to_string(), ends: places, mass, length })
    }
}

fn zero_length(entry: &Entry<'_>, [a, b]: &[End; 2]) -> Refused {
    let message = format!("the bar has no length: `{}` and `{}` start at the same place", a.name, b.name);
    entry.refuse("between", message, "move one of them, or use a point with mass")
}

/// Adds the mass of a bar.
fn add_mass(assembly: &mut Assembly<'_>, ends: &[End; 2], mass: f64) {
    let moving = ends.each_ref().map(|end| Moving::new(assembly, end.terms.clone(), end.body));
    spread(&mut assembly.builder, &moving, &[(0, 0, mass / 3.0), (1, 1, mass / 3.0), (0, 1, mass / 6.0)]);
    for moving in &moving {
        moving.terms.iter().for_each(|&term| assembly.builder.weight(term, 0.5 * mass));
    }
}
