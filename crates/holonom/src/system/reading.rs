//! What loads read of a state: coordinates of nodes, quantities with their rates, and numbers from outside; and how their forces and
//! derivatives by these come to the nodes.

use super::evaluate::{Local, gather};
use super::{Evaluation, HessianBlock, LoadEntry, NodeId, Quantity, System};

/// What a load reads beside the time. A load sees these numbers as its coordinates: those of its nodes, D a node, then its senses; as its
/// velocities those of its nodes, then the rates of its senses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Nodes.
    pub nodes: Vec<NodeId>,
    /// Quantities and numbers from outside.
    pub senses: Vec<Sense>,
}

/// A number beside the coordinates of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// A quantity of the system, with its rate. A force on it acts along its gradient.
    Quantity(Quantity),
    /// The input of this number, whose rate is zero.
    Input(usize),
}

/// Where a system is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    /// Positions and velocities of all nodes, from the origin of the system.
    pub x: &'a [f64],
    pub v: &'a [f64],
    pub t: f64,
    /// Values and gradients there.
    pub at: &'a Evaluation,
    pub inputs: &'a [f64],
    /// Of a step between two positions, the values at both and its length, s: quantities have the rates that lead from one to the other.
    pub span: Option<(&'a [f64], &'a [f64], f64)>,
}

/// How what a load reads changes with the nodes, for its tangent.
#[derive(Clone, Copy)]
pub(crate) struct Slopes<'a> {
    /// Gradients by which quantities change (D a slot): those there, or between two positions those at the second.
    pub gradient: &'a [f64],
    /// H v (D a slot), by which rates change with positions; none between two positions.
    pub motion: Option<&'a [f64]>,
    /// What the change of the gradients of quantities is multiplied by beside.
    pub bend: f64,
}

impl LoadEntry {
    /// Where a node is among those that it acts on or that move what it reads.
    fn place(&self, node: u32) -> Option<usize> {
        self.nodes.iter().position(|known| known.0 == node)
    }

    /// Numbers that [`System::load_tangents`] needs room for.
    pub fn room(&self, dim: usize) -> usize {
        let (k, w) = (self.nodes.len() * dim, self.reading.nodes.len() * dim + self.reading.senses.len());
        let inner = if self.reading.senses.is_empty() { 0 } else { 2 * w * w + 5 * w * k };
        2 * k * k + inner
    }
}

impl System {
    /// The numbers that are read, with their rates.
    pub(crate) fn read(&self, reading: &Reading, look: Look<'_>) -> [Local; 2] {
        let mut read = [gather(self.dim, &reading.nodes, look.x), gather(self.dim, &reading.nodes, look.v)];
        let [x, v] = &mut read;
        for (x, _) in x.chunks_exact_mut(self.dim).zip(&reading.nodes).filter(|(_, node)| self.is_point[node.index()]) {
            x.iter_mut().zip(self.origin).for_each(|(x, origin)| *x += origin);
        }
        for sense in &reading.senses {
            let [value, rate] = match *sense {
                Sense::Input(k) => [look.inputs[k], 0.0],
                Sense::Quantity(quantity) => {
                    let k = self.value_index(quantity);
                    let rate = match look.span {
                        Some((from, to, step)) => (to[k] - from[k]) / step,
                        None => self.along(&self.slots_of(quantity), &self.slots.nodes, look.at, look.v),
                    };
                    [look.at.value[k], rate]
                }
            };
            x.push(value);
            v.push(rate);
        }
        read
    }

    /// Forces of a load on all of its nodes (D a node), N.
    pub(crate) fn load_forces(&self, load: &LoadEntry, look: Look<'_>, out: &mut [f64]) {
        self.load_forces_behind(load, look, &[], out);
    }

    /// The same where the rates of what it reads are less by `lag`, one for each of its senses, and the power of its forces along that, W.
    pub(crate) fn load_forces_behind(&self, load: &LoadEntry, look: Look<'_>, lag: &[f64], out: &mut [f64]) -> f64 {
        let [x, v] = &mut self.read(&load.reading, look);
        let own = load.reading.nodes.len() * self.dim;
        out.fill(0.0);
        if load.reading.senses.is_empty() {
            load.load.force(x, v, look.t, out);
            return 0.0;
        }
        v[own..].iter_mut().zip(lag).for_each(|(rate, lag)| *rate -= lag);
        let mut force = Local::from_elem(0.0, x.len());
        load.load.force(x, v, look.t, &mut force);
        out[..own].copy_from_slice(&force[..own]);
        self.spread_senses(load, &look.at.gradient, |line, sense, slope| line[0] += force[own + sense] * slope, out, 1);
        force[own..].iter().zip(lag).map(|(force, lag)| force * lag).sum()
    }

    /// By how much the mean of the rates at both ends of a step of length `h` (s) is more than what each sense of a load comes on by.
    pub(crate) fn lag_of_senses(&self, load: &LoadEntry, h: f64, [start, end]: [Look<'_>; 2]) -> Local {
        if load.reading.senses.is_empty() {
            return Local::new();
        }
        let own = load.reading.nodes.len() * self.dim;
        let [[from, before], [to, after]] = [start, end].map(|look| self.read(&load.reading, look));
        let lag = |k: usize| match load.reading.senses[k - own] {
            Sense::Input(_) => 0.0,
            Sense::Quantity(_) => 0.5 * (before[k] + after[k]) - (to[k] - from[k]) / h,
        };
        (own..from.len()).map(lag).collect()
    }

    /// Calls `add` with each line of `out` (`width` numbers for each coordinate of all nodes of the load), each sense that acts, and the
    /// slope of the one by the other.
    fn spread_senses(
        &self,
        load: &LoadEntry,
        gradient: &[f64],
        mut add: impl FnMut(&mut [f64], usize, f64),
        out: &mut [f64],
        width: usize,
    ) {
        for (k, sense) in load.reading.senses.iter().enumerate() {
            let Sense::Quantity(quantity) = *sense else { continue };
            for s in self.slots_of(quantity) {
                let Some(node) = load.place(self.slots.nodes[s]) else { continue };
                for c in 0..self.dim {
                    let line = (node * self.dim + c) * width;
                    add(&mut out[line..line + width], k, gradient[s * self.dim + c]);
                }
            }
        }
    }

    /// Derivatives of the forces of a load on all of its nodes by their positions and by their velocities (k × k each, k = D · nodes), one
    /// after the other at the beginning of `room`.
    pub(crate) fn load_tangents(&self, load: &LoadEntry, look: Look<'_>, slopes: Slopes<'_>, room: &mut [f64]) {
        let k = load.nodes.len() * self.dim;
        let (outer, inner) = room.split_at_mut(2 * k * k);
        let (by_position, by_velocity) = outer.split_at_mut(k * k);
        by_position.fill(0.0);
        by_velocity.fill(0.0);
        let [x, v] = &self.read(&load.reading, look);
        if load.reading.senses.is_empty() {
            load.load.tangent(x, v, look.t, by_position, by_velocity);
            return;
        }
        let (dim, w, own) = (self.dim, x.len(), load.reading.nodes.len() * self.dim);
        let inner = &mut inner[..2 * w * w + 5 * w * k];
        inner.fill(0.0);
        let (by_x, inner) = inner.split_at_mut(w * w);
        let (by_v, inner) = inner.split_at_mut(w * w);
        load.load.tangent(x, v, look.t, by_x, by_v);
        // What is read by the nodes: w lines of k numbers, by positions, of the rates by positions, of the rates by velocities.
        let (read, exerted) = inner.split_at_mut(3 * w * k);
        for i in 0..own {
            read[i * k + i] = 1.0;
            read[(2 * w + i) * k + i] = 1.0;
        }
        for (sense, _) in load.reading.senses.iter().enumerate() {
            let Sense::Quantity(quantity) = load.reading.senses[sense] else { continue };
            let line = (own + sense) * k;
            for s in self.slots_of(quantity) {
                let Some(node) = load.place(self.slots.nodes[s]) else { continue };
                for c in 0..dim {
                    let at = line + node * dim + c;
                    read[at] += slopes.gradient[s * dim + c];
                    read[2 * w * k + at] += slopes.gradient[s * dim + c];
                    if let Some(motion) = slopes.motion {
                        read[w * k + at] += motion[s * dim + c];
                    }
                }
            }
        }
        // Derivatives of what the load exerts on what it reads, by the nodes.
        for i in 0..w {
            for j in 0..w {
                let (stiffness, damping) = (by_x[i * w + j], by_v[i * w + j]);
                if stiffness != 0.0 || damping != 0.0 {
                    for c in 0..k {
                        exerted[i * k + c] += stiffness * read[j * k + c] + damping * read[(w + j) * k + c];
                        exerted[(w + i) * k + c] += damping * read[(2 * w + j) * k + c];
                    }
                }
            }
        }
        by_position[..own * k].copy_from_slice(&exerted[..own * k]);
        by_velocity[..own * k].copy_from_slice(&exerted[w * k..(w + own) * k]);
        for (out, first) in [(by_position, 0), (by_velocity, w)] {
            let of = |sense: usize| &exerted[(first + own + sense) * k..(first + own + sense + 1) * k];
            let add =
                |line: &mut [f64], sense: usize, slope: f64| line.iter_mut().zip(of(sense)).for_each(|(line, of)| *line += slope * of);
            self.spread_senses(load, &look.at.gradient, add, out, k);
        }
        let mut force = Local::from_elem(0.0, w);
        load.load.force(x, v, look.t, &mut force);
        let by_position = &mut room[..k * k];
        for (sense, force) in load.reading.senses.iter().zip(&force[own..]).filter(|(_, force)| **force != 0.0) {
            if let Sense::Quantity(quantity) = sense {
                self.add_hessian(load, *quantity, *force, look.at, slopes, by_position);
            }
        }
    }

    /// Adds `factor` times the second derivatives of a quantity to a matrix over all nodes of a load (k × k).
    fn add_hessian(&self, load: &LoadEntry, quantity: Quantity, factor: f64, at: &Evaluation, slopes: Slopes<'_>, out: &mut [f64]) {
        let (dim, k) = (self.dim, load.nodes.len() * self.dim);
        let invariants = match quantity {
            Quantity::Invariant(id) => vec![(id, 1.0)],
            Quantity::Function(id) => {
                let local = &at.functions.local[id.0 as usize];
                let base = self.functions.base(id);
                for (i, &u) in base.iter().enumerate() {
                    for (j, &w) in base.iter().enumerate() {
                        let bend = factor * slopes.bend * local.hessian[i][j];
                        for s in self.invariants.slots_of(u) {
                            for t in self.invariants.slots_of(w) {
                                let places = [s, t].map(|slot| load.place(self.slots.nodes[slot]));
                                let [Some(a), Some(b)] = places else { continue };
                                for c in 0..dim {
                                    for d in 0..dim {
                                        out[(a * dim + c) * k + b * dim + d] +=
                                            bend * at.gradient[s * dim + c] * slopes.gradient[t * dim + d];
                                    }
                                }
                            }
                        }
                    }
                }
                base.iter().copied().zip(local.gradient).collect()
            }
        };
        for (id, gradient) in invariants {
            for (a, b, block) in self.invariants.hessian(id) {
                let (Some(a), Some(b)) = (load.place(a), load.place(b)) else { continue };
                let mut add = |c: usize, d: usize, h: f64| out[(a * dim + c) * k + b * dim + d] += factor * gradient * h;
                match block {
                    HessianBlock::Isotropic(h) => (0..dim).for_each(|c| add(c, c, h)),
                    HessianBlock::Skew(h, e) => {
                        let skew = super::skew(&e);
                        for c in 0..dim {
                            for d in 0..dim {
                                add(c, d, h * skew[c][d]);
                            }
                        }
                    }
                }
            }
        }
    }
}
