//! Sums of nodes: points and directions of bodies, where they are and how they move.

use super::{Place, Term};

fn sum(terms: &[Term], x: &[f64], dim: usize, fixed: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for term in terms {
        let mut part = [0.0; 3];
        match term.place {
            Place::Node(node) => part[..dim].copy_from_slice(&x[node.index() * dim..(node.index() + 1) * dim]),
            Place::Fixed(x) => (0..dim).for_each(|c| part[c] = fixed * x[c]),
        }
        (0..dim).for_each(|c| sum[c] += term.factor * part[c]);
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
