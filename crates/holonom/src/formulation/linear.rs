//! What the equations of motion are near a state at rest, by the tangent of a stage there.

use super::failure::Failure;
use super::newton::Newton;
use super::stage::Stage;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::{System, scatter};

/// Most solutions until δ no longer matters, the share of the first that is none, and that which may be left.
const PASSES: usize = 100;
const NOTHING: f64 = 1e-15;
const LITTLE: f64 = 1e-9;

impl Newton {
    /// Factors the tangent of a stage where a workspace has evaluated it, with the multipliers there.
    pub fn factor_there(&mut self, system: &System, stage: &Stage, work: &mut Workspace) -> Result<(), Failure> {
        // In a long step forces hold nodes far more than their masses do, and rows add little beside a larger δ.
        self.proximal_by_independence(system, stage.time(), work);
        work.tangent(system, stage, 1.0, &mut self.kkt);
        self.factor(&work.scales)
    }

    /// The increment of the coordinates (n) with the factors at hand for a right side of them (n), along which no row changes. `None` where the
    /// solutions that leave nothing of δ do not converge.
    pub fn solve_along_rows(&mut self, right: &[f64]) -> Option<Vec<f64>> {
        let n = right.len();
        self.unknowns[..n].copy_from_slice(right);
        self.unknowns[n..].fill(0.0);
        let (mut sum, mut left) = (vec![0.0; n], f64::INFINITY);
        for _ in 0..PASSES {
            self.kkt.solve(&mut self.unknowns);
            let (increments, multipliers) = self.unknowns.split_at_mut(n);
            sum.iter_mut().zip(&*increments).for_each(|(sum, increment)| *sum += increment);
            left = largest(increments) / largest(&sum).max(f64::MIN_POSITIVE);
            if left <= NOTHING {
                break;
            }
            increments.fill(0.0);
            multipliers.iter_mut().zip(&self.delta).for_each(|(multiplier, delta)| *multiplier *= -delta);
        }
        (left <= LITTLE).then_some(sum)
    }
}

impl Workspace {
    /// What forces resist velocities `v` (full) by, as they are sampled, where these are small: C v on all nodes, N.
    pub fn resistance(&mut self, system: &System, t: f64, v: &[f64]) -> Vec<f64> {
        let (dim, mut sum) = (system.dim, vec![0.0; v.len()]);
        for (law, response) in system.laws.iter().zip(&self.forces.responses).filter(|(law, _)| !law.law.conservative()) {
            let rates = system.rates(&law.invariants, &self.sampled.at, v);
            for (&id, by_rate) in law.invariants.iter().zip(&response.by_rate) {
                let slots = system.invariants.slots_of(id);
                let force = by_rate.iter().zip(&rates).map(|(by, rate)| by * rate).sum();
                let gradient = &self.sampled.at.gradient[slots.start * dim..slots.end * dim];
                scatter(dim, &system.slots.nodes[slots], force, gradient, &mut sum);
            }
        }
        for load in &system.loads {
            let [_, by_velocity] = self.load_tangents(system, load, t, None, 1.0);
            let entries: Vec<usize> = load.nodes.iter().flat_map(|node| (0..dim).map(|c| node.index() * dim + c)).collect();
            for (&i, line) in entries.iter().zip(by_velocity.chunks_exact(entries.len())) {
                sum[i] -= entries.iter().zip(line).map(|(&j, by)| by * v[j]).sum::<f64>();
            }
        }
        sum
    }
}
