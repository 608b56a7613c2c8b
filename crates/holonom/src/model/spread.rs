//! Mass that is spread between points and directions which are sums of nodes.

use super::assembly::Assembly;
use super::bodies::frame::Frame;
use crate::system::{SystemBuilder, Term};

/// A point or direction x = Σ (f + g J) x_i that carries mass together with others.
pub struct Moving {
    pub terms: Vec<Term>,
    /// Velocity at the start of what each term is, m/s.
    velocities: Vec<[f64; 3]>,
}

impl Moving {
    /// Velocities are those which the body that it is of is written with. Others that share a node may be written with another one, and what the
    /// ground holds is written as moving where its body is.
    pub fn new(assembly: &Assembly<'_>, terms: Vec<Term>, body: Option<usize>) -> Self {
        let of_body = body.map(|body| (&assembly.bodies[body], &assembly.frames[body]));
        let velocities = match of_body {
            Some((body, Frame::Body { basis, .. })) => {
                // Terms come in the order of the basis.
                let mut basis = basis.iter();
                let mut of = |place| {
                    let node = basis.find(|node| node.place == place);
                    node.map_or_else(|| assembly.builder.velocity_of(place), |node| node.velocity(body))
                };
                terms.iter().map(|term| of(term.place)).collect()
            }
            _ => terms.iter().map(|term| assembly.builder.velocity_of(term.place)).collect(),
        };
        Self { terms, velocities }
    }
}

/// Adds the entries (k, l), with k ≤ l, and (l, k) of the mass matrix of some of them, kg, without weight. Each product of two sums is one of all
/// their nodes.
pub fn spread(builder: &mut SystemBuilder, moving: &[Moving], entries: &[(usize, usize, f64)]) {
    for &(k, l, share) in entries {
        for (i, a) in moving[k].terms.iter().enumerate() {
            // Of a sum with itself each pair of nodes once, as a block comes with its transpose.
            let first = if k == l { i } else { 0 };
            for (b, velocity) in moving[l].terms.iter().zip(&moving[l].velocities).skip(first) {
                let m = share * (a.factor * b.factor + a.turn * b.turn);
                let s = share * (a.factor * b.turn - a.turn * b.factor);
                builder.couple([a.place, b.place], m, s, [moving[k].velocities[i], *velocity]);
                // Of a node that both have the block is its own transpose, which moves as the other.
                if k != l && a.place == b.place {
                    builder.couple([b.place, a.place], m, -s, [*velocity, moving[k].velocities[i]]);
                }
            }
        }
    }
}
