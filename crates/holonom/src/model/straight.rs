//! Rows that keep two differences of points parallel: u × w = 0.

use std::sync::Arc;

use crate::model::assembly::Assembly;
use crate::model::geometry::unit;
use crate::system::{Differentiated, FollowedFunction, InvariantId, Number, Part, Term};

/// The rows of u × w = 0: one in the plane. In space the three of the paper where u and w keep their lengths, as one of these follows from the
/// others, also within a step of a conserving scheme. Where points slide along the line it does not there, and would push: two rows are taken.
pub fn rows(assembly: &mut Assembly<'_>, names: &mut impl FnMut() -> String, u: &[Term], w: &[Term], keep_lengths: bool) {
    let builder = &mut assembly.builder;
    let in_space = assembly.axes.dimension() == 3;
    let products: Vec<InvariantId> = (0..if in_space { 3 } else { 1 }).map(|k| builder.cross(unit(k), u, w)).collect();
    if !in_space || keep_lengths {
        products.into_iter().for_each(|product| builder.constant_row(names(), product, 0.0));
        return;
    }
    let of: Vec<InvariantId> = products.into_iter().chain((0..3).map(|k| builder.linear(unit(k), u))).collect();
    for which in 1..3 {
        let part = Part::Followed { of: of.clone(), function: Arc::new(Differentiated(Across { which })) };
        let sum = builder.sum(&[(part, 1.0)]);
        builder.constant_row(names(), sum, 0.0);
    }
}

/// How many rows these are.
pub fn count(dimension: usize, keep_lengths: bool) -> usize {
    match (dimension, keep_lengths) {
        (3, true) => 3,
        (3, false) => 2,
        _ => 1,
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
