//! The two levels of a stabilised step together: sweeps from one matrix to the other, and where they come no nearer by
//! themselves, the best combination of what they went through (reduced rank extrapolation, Mešina 1977).
//!
//! A change V of d and μ makes u and γ' change by E; what E pulls in the first equation makes d and μ change by V' = −T V.
//! The sum V + V' + V'' + … is what d and μ change by in all. Σ ξ_j V_j leaves V_0 − Σ ξ_j (V_j − V_{j+1}).

use super::iteration::{Failure, SolveSettings};
use super::stabilized::Stabilized;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::System;

/// What the sweeps may leave, over the first increment of d: as much as kept factors leave.
const SWEPT: f64 = 1e-4;

/// Sweeps between two extrapolations, and extrapolations of one iteration.
const SWEEPS: usize = 8;
const EXTRAPOLATIONS: usize = 8;

/// Most sweeps of an iteration in steps of equal cost.
const FEW: usize = 2;

/// Changes that an extrapolation combines are independent when this share of one is new.
const NEW: f64 = 1e-6;

/// What a series of sweeps went through: changes of d and μ, and of u and γ' with them (each n + r).
pub(super) struct Sweeps {
    first: Vec<Vec<f64>>,
    second: Vec<Vec<f64>>,
}

impl Sweeps {
    pub(super) fn new(size: usize) -> Self {
        Self { first: vec![vec![0.0; size]; SWEEPS + 1], second: vec![vec![0.0; size]; SWEEPS] }
    }
}

impl Stabilized {
    /// Replaces the residuals, of d and μ in the workspace's unknowns and of u and γ' in its own, by increments; the share
    /// of them that the sweeps leave. What `starts` a step takes the second level first, at the increment that was predicted.
    pub(super) fn sweep(&mut self, system: &System, settings: &SolveSettings, starts: bool, work: &mut Workspace) -> Result<f64, Failure> {
        let n = system.coordinates();
        let mut gamma = self.gamma.iter().zip(&self.gamma_change).map(|(gamma, change)| gamma + change);
        self.curves = gamma.any(|gamma| gamma.abs() > SWEPT * work.heaviest);
        if self.curves {
            self.kkt.start_with_mass(0.0);
            self.kkt.add_row_hessians(&self.gamma, 1.0);
            self.kkt.add_row_hessians(&self.gamma_change, 1.0);
        }
        let mut sweeps = std::mem::replace(&mut self.sweeps, Sweeps { first: Vec::new(), second: Vec::new() });
        let mut unknowns = std::mem::take(&mut self.unknowns);
        sweeps.second[0].copy_from_slice(&unknowns);
        unknowns.fill(0.0);
        if starts {
            self.kkt.solver.solve(&mut sweeps.second[0]);
            std::mem::swap(&mut unknowns, &mut sweeps.second[0]);
            self.pull(n, &unknowns);
            add(-1.0, &self.force[..n], &mut work.unknowns);
        }
        let solved = work.solve();
        sweeps.first[0].copy_from_slice(&work.unknowns);
        work.unknowns.fill(0.0);
        let left = solved.and_then(|()| self.add_sweeps(system, settings, &mut sweeps, &mut unknowns, work));
        (self.sweeps, self.unknowns) = (sweeps, unknowns);
        left
    }

    /// Adds to both unknowns what the change in `first[0]` leads to; the share of their forces that is left.
    fn add_sweeps(
        &mut self,
        system: &System,
        settings: &SolveSettings,
        sweeps: &mut Sweeps,
        unknowns: &mut [f64],
        work: &mut Workspace,
    ) -> Result<f64, Failure> {
        let n = system.coordinates();
        let Sweeps { first, second } = sweeps;
        let tolerance = settings.tolerance * work.heaviest * work.length;
        let mut whole = tolerance;
        for _ in 0..EXTRAPOLATIONS {
            for j in 0..SWEEPS {
                let inertia = self.follow(system, &first[j][..n], &mut second[j], &mut work.full, &mut work.inertial);
                whole = inertia.max(whole);
                let least = (SWEPT * whole).max(tolerance);
                let mut left = inertia;
                let mut met = j;
                // The first has a residual of its own to take away.
                if j == 0 || inertia > least {
                    self.kkt.solver.solve(&mut second[j]);
                    left = self.pull(n, &second[j]);
                    met = j + 1;
                }
                if left <= least || (settings.iterations.is_some() && j + 1 >= FEW) {
                    first[..=j].iter().for_each(|change| add(1.0, change, &mut work.unknowns));
                    second[..met].iter().for_each(|change| add(1.0, change, unknowns));
                    return Ok(left / whole);
                }
                if let Some(next) = second.get_mut(j + 1) {
                    next.fill(0.0);
                }
                first[j + 1].fill(0.0);
                add(-1.0, &self.force[..n], &mut first[j + 1]);
                work.kkt.solver.solve(&mut first[j + 1]);
            }
            let shares = combination(n, first);
            for (j, &share) in shares.iter().enumerate() {
                add(share, &first[j], &mut work.unknowns);
                add(share, &second[j], unknowns);
            }
            second[0].fill(0.0);
            let (start, others) = first.split_at_mut(1);
            let kept = 1.0 - shares[0];
            start[0].iter_mut().for_each(|value| *value *= kept);
            for (j, change) in others.iter().enumerate() {
                add(shares[j] - shares.get(j + 1).copied().unwrap_or(0.0), change, &mut start[0]);
            }
        }
        Err(Failure::NotConverged(SWEEPS * EXTRAPOLATIONS))
    }

    /// Adds to the right sides of u and γ' what a change of d brings there; the largest of its inertial forces.
    fn follow(&self, system: &System, change: &[f64], right: &mut [f64], full: &mut [f64], inertial: &mut [f64]) -> f64 {
        let n = change.len();
        full.fill(0.0);
        full[..n].copy_from_slice(change);
        system.mass.times(system.dim, full, inertial);
        add(1.0, inertial, right);
        if self.curves {
            self.kkt.add_sum_times(-0.5, change, right);
        }
        self.kkt.add_along(-1.0, &self.turned_u, full, &mut right[n..]);
        largest(inertial)
    }

    /// Leaves in `force` what a change of u and γ' brings to the first equation; the largest of it.
    fn pull(&mut self, n: usize, change: &[f64]) -> f64 {
        self.force.fill(0.0);
        self.kkt.add_forces(&change[n..], &self.pull, &mut self.force);
        if self.curves {
            self.kkt.add_sum_times(0.5, &change[..n], &mut self.force);
        }
        largest(&self.force[..n])
    }
}

/// target += factor · change, as far as the change goes.
fn add(factor: f64, change: &[f64], target: &mut [f64]) {
    target.iter_mut().zip(change).for_each(|(target, change)| *target += factor * change);
}

/// The ξ with the least ‖V_0 − Σ ξ_j (V_j − V_{j+1})‖ over the first `n` entries, by Cholesky's factors of the normal
/// equations; changes that bring nothing new have no part.
fn combination(n: usize, changes: &[Vec<f64>]) -> [f64; SWEEPS] {
    let product = |i: usize, j: usize| -> f64 { changes[i][..n].iter().zip(&changes[j]).map(|(a, b)| a * b).sum() };
    let step = |i: usize, j: usize| product(i, j) - product(i + 1, j) - product(i, j + 1) + product(i + 1, j + 1);
    let (mut lower, mut y) = ([[0.0; SWEEPS]; SWEEPS], [0.0; SWEEPS]);
    for i in 0..SWEEPS {
        for j in 0..=i {
            let rest = step(i, j) - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            lower[i][j] = match i == j {
                true if rest > NEW * NEW * step(i, i) => rest.sqrt(),
                false if lower[j][j] > 0.0 => rest / lower[j][j],
                _ => 0.0,
            };
        }
        let rest = product(i, 0) - product(i + 1, 0) - (0..i).map(|k| lower[i][k] * y[k]).sum::<f64>();
        y[i] = if lower[i][i] > 0.0 { rest / lower[i][i] } else { 0.0 };
    }
    for i in (0..SWEEPS).rev() {
        let rest = y[i] - (i + 1..SWEEPS).map(|k| lower[k][i] * y[k]).sum::<f64>();
        y[i] = if lower[i][i] > 0.0 { rest / lower[i][i] } else { 0.0 };
    }
    y
}
