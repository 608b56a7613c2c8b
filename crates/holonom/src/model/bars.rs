//! `[bar.NAME]`: uniform rigid rods between two points, the two-node body of natural coordinates (methods §6).

use super::assembly::Assembly;
use super::ends::{End, difference, from_to};
use super::entry::Entry;
use super::fault::{Read, Refused};
use super::fields::{Keys, List, Number, Place};
use super::geometry::norm;
use super::key::Shape;
use crate::record::LineKind;
use crate::system;

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
    /// Nodes at both ends, or where one is fixed.
    pub ends: [system::Place; 2],
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
        let (Some(first), Some(second)) = (a.place(), b.place()) else {
            let cure = "give the bar ends of its own, [point.NAME], and join them, or use a body with shape = { rod = … }";
            return Err(entry.refuse("between", "a bar ends at points and fixed places, not at places of bodies", cure));
        };
        add_mass(assembly, [first, second], mass);
        ends.iter().filter_map(|end| end.point).for_each(|point| assembly.points[point].carries_bar = true);
        let half_square = assembly.builder.square(&from_to(a, b));
        assembly.builder.constant_row(entry.name, half_square, 0.5 * length * length);
        assembly.draw(entry, LineKind::Bar, a, b);
        Ok(BarInfo { name: entry.name.to_string(), ends: [first, second], mass, length })
    }
}

fn zero_length(entry: &Entry<'_>, [a, b]: &[End; 2]) -> Refused {
    let message = format!("the bar has no length: `{}` and `{}` start at the same place", a.name, b.name);
    entry.refuse("between", message, "move one of them, or use a point with mass")
}

fn add_mass(assembly: &mut Assembly<'_>, [a, b]: [system::Place; 2], mass: f64) {
    assembly.builder.mass(a, a, mass / 3.0);
    assembly.builder.mass(b, b, mass / 3.0);
    assembly.builder.mass(a, b, mass / 6.0);
}
