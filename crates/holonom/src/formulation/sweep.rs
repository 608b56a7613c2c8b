//! The two levels of a stabilised step one after the other: sweeps from one matrix to the other until nothing is left.
//!
//! A change V of d and μ makes u and γ' change by E; what E pulls in the first equation makes d and μ change by V' = −T V.
//! The sum V + V' + V'' + … is what d and μ change by in all. It converges while parts turn little in a step; where it does not,
//! both levels are solved in one matrix.

use super::failure::Failure;
use super::newton::{Newton, SAME_SIGN};
use super::stabilized::Stabilized;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::System;

/// What the sweeps may leave, over the first increment of d. More would call for another iteration or for new factors, which cost more
/// than a sweep.
const SWEPT: f64 = 1e-5;

/// The same of the last iteration, over the tolerance: what is left has the same sign in step after step, and the energy would drift with it.
/// Near a singular position it is all of the tolerance: the rounding of positions moves them by more.
const LAST: f64 = 0.06;

/// Share of the mechanism that γ' must turn a node by for the curvature of its rows to count.
const CURVED: f64 = 1e-4;

/// Most sweeps of an iteration; one matrix for both levels is cheaper than more.
const SWEEPS: usize = 8;

/// Changes of so many tolerances are round-off.
const NOISE: f64 = 1e6;

/// Most sweeps of an iteration in steps of equal cost.
const FEW: usize = 2;

/// A change of d and μ, and of u and γ' with it (each n + r).
pub(super) struct Sweeps {
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Sweeps {
    pub(super) fn new(size: usize) -> Self {
        Self { first: vec![0.0; size], second: vec![0.0; size] }
    }
}

impl Stabilized {
    /// Replaces the residuals, of d and μ in the unknowns of `newton` and of u and γ' in its own, by increments; the share
    /// of them that the sweeps leave, or none where they do not contract. Where multipliers begin at zero, and beside light parts, what
    /// `starts` a step takes the second level first, at the increment that was predicted, so that the first feels how γ' pulls.
    pub(super) fn sweep(
        &mut self,
        system: &System,
        starts: bool,
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<Option<f64>, Failure> {
        let n = system.coordinates();
        let gamma = self.gamma.iter().zip(&self.gamma_change).map(|(gamma, change)| gamma + change);
        let bend = work.scaled_multipliers(gamma);
        self.curves = bend > CURVED;
        // What the sweeps leave out.
        let bend = if self.curves { 0.0 } else { bend };
        if self.curves {
            self.kkt.start_with_mass(0.0);
            self.kkt.add_row_hessians(&self.gamma, 1.0);
            self.kkt.add_row_hessians(&self.gamma_change, 1.0);
        }
        let mut sweeps = std::mem::replace(&mut self.sweeps, Sweeps { first: Vec::new(), second: Vec::new() });
        let mut unknowns = std::mem::take(&mut self.unknowns);
        sweeps.second.copy_from_slice(&unknowns);
        unknowns.fill(0.0);
        if starts && (work.scales.are_light || !newton.rank.is_full()) {
            self.kkt.solve(&mut sweeps.second);
            std::mem::swap(&mut unknowns, &mut sweeps.second);
            self.pull(system, &unknowns);
            add(-1.0, &self.force[..n], &mut newton.unknowns);
        }
        let solved = if starts { newton.solve_from_zero() } else { newton.solve() };
        sweeps.first.copy_from_slice(&newton.unknowns);
        newton.unknowns.fill(0.0);
        let left = solved.map(|()| {
            let ends = starts && work.are_rows_quadratic() && {
                let increment = largest(&sweeps.first[..n]) / work.scales.unit;
                let multipliers = work.scaled_multipliers(sweeps.first[n..].iter().copied()).max(bend);
                increment * newton.rest_of_first(increment, multipliers, work) <= newton.settings.tolerance
            };
            self.add_sweeps(system, ends, &mut sweeps, &mut unknowns, newton, work)
        });
        (self.sweeps, self.unknowns) = (sweeps, unknowns);
        Ok(left?.map(|left| left.max(bend)))
    }

    /// Adds to both unknowns what the change in `first` leads to; the share of it that is left, which is less where the iteration `ends` with it.
    fn add_sweeps(
        &mut self,
        system: &System,
        ends: bool,
        sweeps: &mut Sweeps,
        unknowns: &mut [f64],
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Option<f64> {
        let n = system.coordinates();
        let Sweeps { first, second } = sweeps;
        let tolerance = newton.settings.tolerance * work.scales.unit;
        let mut whole = largest(&first[..n]).max(tolerance);
        let floor = if newton.rank.is_full() { LAST * tolerance } else { tolerance };
        let mut last = f64::INFINITY;
        for sweep in 1..=SWEEPS {
            add(1.0, first, &mut newton.unknowns);
            self.follow(system, &first[..n], second, &mut work.full, &mut work.inertial);
            self.kkt.solve(second);
            add(1.0, second, unknowns);
            self.pull(system, second);
            let left = work.farthest(system, &self.force);
            let least = if ends { tolerance / SAME_SIGN } else { (SWEPT * whole).max(floor) };
            if left <= least || (newton.settings.iterations.is_some() && sweep >= FEW) {
                return Some(left / whole);
            }
            second.fill(0.0);
            first.fill(0.0);
            add(-1.0, &self.force[..n], first);
            newton.kkt.solve(first);
            let change = largest(&first[..n]);
            if change > last {
                break;
            }
            // The first may be smaller than what the residual of the second level leads to.
            (whole, last) = (whole.max(change), change);
            if change <= least {
                add(1.0, first, &mut newton.unknowns);
                return Some(change / whole);
            }
        }
        // What round-off leaves does not contract.
        (whole <= NOISE * tolerance).then_some(1.0)
    }

    /// Adds to the right sides of u and γ' what a change of d brings there.
    fn follow(&self, system: &System, change: &[f64], right: &mut [f64], full: &mut [f64], inertial: &mut [f64]) {
        let n = change.len();
        full.fill(0.0);
        full[..n].copy_from_slice(change);
        system.mass.times(system.dim, full, inertial);
        add(1.0, inertial, right);
        if self.curves {
            self.kkt.add_sum_times(-0.5, change, right);
        }
        system.slots.add_along(system.dim, -1.0, &self.turned_u, full, &mut right[n..]);
    }

    /// Leaves in `force` what a change of u and γ' brings to the first equation.
    fn pull(&mut self, system: &System, change: &[f64]) {
        let n = system.coordinates();
        self.force.fill(0.0);
        system.slots.add_forces(system.dim, &change[n..], &self.pull, &mut self.force);
        if self.curves {
            self.kkt.add_sum_times(0.5, &change[..n], &mut self.force);
        }
    }
}

/// target += factor · change, as far as the change goes.
fn add(factor: f64, change: &[f64], target: &mut [f64]) {
    target.iter_mut().zip(change).for_each(|(target, change)| *target += factor * change);
}
