//! Rows that keep two differences of points parallel: u × w = 0.

use std::sync::Arc;

use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::geometry::unit;
use crate::system::{Differentiated, FollowedFunction, InvariantId, Number, Part, Quantity, Term};

/// What is zero where u × w is: one quantity in the plane. In space the three of the paper where u and w keep their lengths, as one of these follows
/// from the others, also within a step of a conserving scheme. Where points slide along the line it does not there, and would push: two are taken.
pub fn parallel(assembly: &mut Assembly<'_>, [u, w]: [&[Term]; 2], keep_lengths: bool) -> Vec<Quantity> {
    let (in_space, builder) = (assembly.axes.dimension() == 3, &mut assembly.builder);
    let products: Vec<InvariantId> = (0..if in_space { 3 } else { 1 }).map(|k| builder.cross(unit(k), u, w)).collect();
    if !in_space || keep_lengths {
        return products.into_iter().map(Quantity::from).collect();
    }
    let of: Vec<InvariantId> = products.into_iter().chain((0..3).map(|k| builder.linear(unit(k), u))).collect();
    let across = |which| {
        let part = Part::Followed { of: of.clone(), function: Arc::new(Differentiated(Across { which })) };
        builder.sum(&[(part, 1.0)]).into()
    };
    (1..3).map(across).collect()
}

/// Adds the rows that these quantities are zero.
pub fn hold(assembly: &mut Assembly<'_>, entry: &Entry<'_>, quantities: &[Quantity]) {
    for (row, &quantity) in quantities.iter().enumerate() {
        assembly.builder.constant_row(Assembly::row_name(entry, row, quantities.len()), quantity, 0.0);
    }
}

/// Of (u × w, u) the component of the product that is so many axes after one along which u is long. That axis is followed: it changes where u gets
/// short along it, from one row of zeros to another.
struct Across {
    which: usize,
}

/// Share of the longest component that the axis in use may have.
const SHORT: f64 = 0.5;

impl FollowedFunction for Across {
    fn locate(&self, value: &[f64], near: f64) -> f64 {
        let along = |axis: usize| value[3 + axis].abs();
        let longest = if along(1) > along(0) { 1 } else { 0 };
        let longest = if along(2) > along(longest) { 2 } else { longest };
        let axis = near.round() as usize % 3;
        (if along(axis) >= SHORT * along(longest) { axis } else { longest }) as f64
    }

    fn evaluate<N: Number>(&self, value: &[N], at: f64) -> N {
        value[(at as usize + self.which) % 3]
    }
}
