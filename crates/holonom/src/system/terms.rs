//! Sums of nodes: points and directions of bodies, where they are and how they move.

use super::{Place, Term};

fn sum(terms: &[Term], x: &[f64], dim: usize, fixed: f64) -> [f64; 3] {
    match dim {
        2 => sum_in::<2>(terms, x, fixed),
        _ => sum_in::<3>(terms, x, fixed),
    }
}

fn sum_in<const D: usize>(terms: &[Term], x: &[f64], fixed: f64) -> [f64; 3] {
    let (nodes, mut sum) = (x.as_chunks::<D>().0, [0.0; 3]);
    for term in terms {
        let mut part = [0.0; 3];
        match term.place {
            Place::Node(node) => part[..D].copy_from_slice(&nodes[node.index()]),
            Place::Fixed(x) => (0..D).for_each(|c| part[c] = fixed * x[c]),
        }
        (0..D).for_each(|c| sum[c] += term.factor * part[c]);
        sum[0] -= term.turn * part[1];
        sum[1] += term.turn * part[0];
    }
    sum
}

/// Where a sum of nodes is.
pub(crate) fn place_of(terms: &[Term], x: &[f64], dim: usize) -> [f64; 3] {
    sum(terms, x, dim, 1.0)
}

/// How fast a sum of nodes moves.
pub(crate) fn rate_of(terms: &[Term], v: &[f64], dim: usize) -> [f64; 3] {
    sum(terms, v, dim, 0.0)
}
