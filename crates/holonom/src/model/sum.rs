//! Sums of nodes in the list of a load: places and directions, and the forces on them.

use crate::system::{NodeId, Number as AnyNumber, Place, Term};

/// A sum of nodes by their positions in the list of a load.
#[derive(Default)]
pub(super) struct Sum {
    terms: Vec<(usize, [f64; 2])>,
    fixed: [f64; 3],
}

impl Sum {
    /// Of these terms, whose nodes are in the list or are added to it.
    pub fn new(terms: &[Term], nodes: &mut Vec<NodeId>) -> Self {
        let mut sum = Self::default();
        for term in terms {
            match term.place {
                Place::Node(node) => {
                    let index = nodes.iter().position(|&known| known == node).unwrap_or_else(|| {
                        nodes.push(node);
                        nodes.len() - 1
                    });
                    sum.terms.push((index, [term.factor, term.turn]));
                }
                Place::Fixed(x) => {
                    (0..3).for_each(|c| sum.fixed[c] += term.factor * x[c]);
                    sum.fixed[0] -= term.turn * x[1];
                    sum.fixed[1] += term.turn * x[0];
                }
            }
        }
        sum
    }

    /// Its position, or with `fixed` 0 its velocity.
    pub fn at<N: AnyNumber>(&self, x: &[N], dim: usize, fixed: f64) -> [N; 3] {
        let mut sum = self.fixed.map(|c| N::from(fixed * c));
        for &(node, [f, g]) in &self.terms {
            let own = &x[node * dim..(node + 1) * dim];
            (0..dim).for_each(|c| sum[c] += own[c] * f);
            if g != 0.0 {
                sum[0] -= own[1] * g;
                sum[1] += own[0] * g;
            }
        }
        sum
    }

    /// Adds a force on it to those on the nodes.
    pub fn spread<N: AnyNumber>(&self, force: [N; 3], dim: usize, out: &mut [N]) {
        for &(node, [f, g]) in &self.terms {
            let own = &mut out[node * dim..(node + 1) * dim];
            (0..dim).for_each(|c| own[c] += force[c] * f);
            if g != 0.0 {
                own[0] += force[1] * g;
                own[1] -= force[0] * g;
            }
        }
    }
}

/// u × w
pub(super) fn cross<N: AnyNumber>(u: [N; 3], w: [N; 3]) -> [N; 3] {
    [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
}
