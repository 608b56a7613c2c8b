//! A force on a point that is a sum of nodes.

use std::sync::Arc;

use crate::model::assembly::Assembly;
use crate::model::ends::End;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::record::{Exerts, Shows};
use crate::system::{Differentiated, ForceFunction, NodeId, Number, Place};

/// A force on a point, spread over the nodes that it is made of: with x = Σ c_a x_a, Q_a = c_aᵀ F (methods §6).
struct PointLoad<F> {
    force: F,
    /// f + g J of each node.
    factors: Vec<[f64; 2]>,
    fixed: [f64; 3],
}

impl<F: ForceFunction> PointLoad<F> {
    /// The load, and its nodes.
    fn new(entry: &Entry<'_>, point: &End, force: F) -> Read<(Self, Vec<NodeId>)> {
        let (mut nodes, mut factors, mut fixed) = (Vec::new(), Vec::new(), [0.0; 3]);
        for term in &point.terms {
            match term.place {
                Place::Node(node) => {
                    nodes.push(node);
                    factors.push([term.factor, term.turn]);
                }
                Place::Fixed(x) => {
                    (0..3).for_each(|c| fixed[c] += term.factor * x[c]);
                    fixed[0] -= term.turn * x[1];
                    fixed[1] += term.turn * x[0];
                }
            }
        }
        if nodes.is_empty() {
            return Err(entry.refuse("point", "a force on a fixed point does nothing", "name a point that can move"));
        }
        Ok((Self { force, factors, fixed }, nodes))
    }
}

/// Adds a force on a point.
pub(super) fn add(assembly: &mut Assembly<'_>, entry: &Entry<'_>, point: &End, force: impl ForceFunction + 'static) -> Read<()> {
    let (load, nodes) = PointLoad::new(entry, point, force)?;
    let load = Arc::new(load);
    assembly.builder.load(entry.name, &nodes, Arc::new(Differentiated(load.clone())));
    assembly.show(Shows::Load { nodes, is_moment: false, exerts: load });
    Ok(())
}

impl<F: ForceFunction> PointLoad<F> {
    /// The force as it is given.
    fn given<N: Number>(&self, x: &[N], v: &[N], t: N) -> [N; 3] {
        let dim = x.len() / self.factors.len();
        let zero = N::from(0.0);
        let (mut at, mut rate, mut whole) = (self.fixed.map(N::from), [zero; 3], [zero; 3]);
        for (k, &[f, g]) in self.factors.iter().enumerate() {
            for (sum, own) in [(&mut at, &x[k * dim..(k + 1) * dim]), (&mut rate, &v[k * dim..(k + 1) * dim])] {
                (0..dim).for_each(|c| sum[c] += own[c] * f);
                if g != 0.0 {
                    sum[0] -= own[1] * g;
                    sum[1] += own[0] * g;
                }
            }
        }
        self.force.evaluate(&at[..dim], &rate[..dim], t, &mut whole[..dim]);
        whole
    }
}

impl<F: ForceFunction> Exerts for PointLoad<F> {
    fn exerted(&self, x: &[f64], v: &[f64], t: f64) -> [f64; 3] {
        self.given(x, v, t)
    }
}

impl<F: ForceFunction> ForceFunction for PointLoad<F> {
    fn evaluate<N: Number>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        let dim = x.len() / self.factors.len();
        let whole = self.given(x, v, t);
        for (k, &[f, g]) in self.factors.iter().enumerate() {
            let own = &mut force[k * dim..(k + 1) * dim];
            (0..dim).for_each(|c| own[c] = whole[c] * f);
            if g != 0.0 {
                own[0] += whole[1] * g;
                own[1] -= whole[0] * g;
            }
        }
    }
}
