//! `[bar.NAME]`: uniform rigid rods between two points, the two-node body of natural coordinates (methods §6).

use std::sync::Arc;

use super::assembly::Assembly;
use super::bodies::frame::Frame;
use super::ends::{End, difference, from_to};
use super::entry::Entry;
use super::fault::{Read, Refused};
use super::fields::{Keys, List, Number, Place};
use super::geometry::norm;
use super::key::Shape;
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

/// Adds the mass of a bar. Where ends are sums of nodes, x = Σ (f + g J) x_i, each product of two ends is one of all their nodes.
fn add_mass(assembly: &mut Assembly<'_>, ends: &[End; 2], mass: f64) {
    let moving = ends.each_ref().map(|end| velocities(assembly, end));
    for (k, l, share) in [(0, 0, mass / 3.0), (1, 1, mass / 3.0), (0, 1, mass / 6.0)] {
        for (i, a) in ends[k].terms.iter().enumerate() {
            // Of an end with itself each pair of nodes once, as a block comes with its transpose.
            let first = if k == l { i } else { 0 };
            for (b, velocity) in ends[l].terms.iter().zip(&moving[l]).skip(first) {
                let m = share * (a.factor * b.factor + a.turn * b.turn);
                let s = share * (a.factor * b.turn - a.turn * b.factor);
                assembly.builder.couple([a.place, b.place], m, s, [moving[k][i], *velocity]);
                // Of a node that both ends have the block is its own transpose, which moves as the other end.
                if k != l && a.place == b.place {
                    assembly.builder.couple([b.place, a.place], m, -s, [*velocity, moving[k][i]]);
                }
            }
        }
        let weighed = if k == l { &ends[k..=k] } else { &ends[..] };
        weighed.iter().flat_map(|end| &end.terms).for_each(|&term| assembly.builder.weight(term, share));
    }
}

/// Velocities at the start of the nodes and fixed places that an end is made of, m/s: those which the body of the end is written with there. Others that
/// share a node may be written with another one, and what the ground holds is written as moving where its body is.
fn velocities(assembly: &Assembly<'_>, end: &End) -> Vec<[f64; 3]> {
    let of_body = end.body.map(|body| (&assembly.bodies[body], &assembly.frames[body]));
    let Some((body, Frame::Body { basis, .. })) = of_body else {
        return end.terms.iter().map(|term| assembly.builder.velocity_of(term.place)).collect();
    };
    // Terms come in the order of the basis.
    let mut basis = basis.iter();
    let mut of =
        |place| basis.find(|node| node.place == place).map_or_else(|| assembly.builder.velocity_of(place), |node| node.velocity(body));
    end.terms.iter().map(|term| of(term.place)).collect()
}
