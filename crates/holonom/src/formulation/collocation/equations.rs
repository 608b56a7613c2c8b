//! Coupled stages as Newton's iteration sees them.

use super::{Collocation, Timing, stage};
use crate::formulation::failure::Failure;
use crate::formulation::iteration::Multipliers;
use crate::formulation::level::Level;
use crate::formulation::newton::{Change, Equations, Newton, RESTARTS};
use crate::formulation::rank::{RHO, SINGULAR};
use crate::formulation::round_off::{are_forces_round_off, are_rows_round_off};
use crate::formulation::workspace::Workspace;
use crate::system::System;

/// Share of a row's own stiffness below which its pivot is that of a row that nothing moves, and ρ of such rows and of all others.
const IDLE: f64 = 1e-10;
const RHO_IDLE: f64 = 1e4;
const RHO_HELD: f64 = 1e13;

impl Collocation {
    /// Sizes of the terms of all residuals into `sizes`, in the order of the unknowns.
    fn size(&mut self, system: &System, timing: Timing<'_>, work: &mut Workspace) {
        let (s, n, r, dim, h) = (self.stages, system.coordinates(), work.lambda.len(), system.dim, timing.step);
        for i in 0..s {
            let t = self.place(system, timing, i, work);
            work.sample(system, t);
            work.end.at.copy_from(&work.sampled.at);
            work.prediction.drift.fill(0.0);
            for k in 0..n {
                work.end.x[k] = work.start.x[k] + self.d[i * n + k];
                work.d[k] = self.size_of_sum(i, k, &self.u, &self.r);
            }
            work.size_forces(system, &stage(t, h, h * h, 1.0 / h));
            work.size_rows(system);
            let momenta = self.kkt.fields - s + i;
            self.write_sizes(momenta, dim, work);
            if self.doubled {
                work.lambda.copy_from_slice(&self.nu[i * r..(i + 1) * r]);
                for k in 0..n {
                    work.d[k] = self.size_of_sum(i, k, &self.d, &self.p).max(self.u[i * n + k].abs());
                }
                work.size_increments(system);
                work.size_rows(system);
                self.write_sizes(i, dim, work);
            }
        }
    }

    /// The size of the terms of Σ_j b_ij x_j + constant, which cancel.
    fn size_of_sum(&self, i: usize, k: usize, values: &[f64], constant: &[f64]) -> f64 {
        let (s, n) = (self.stages, values.len() / self.stages);
        let terms = (0..s).map(|j| (self.rate[i * s + j] * values[j * n + k]).abs());
        terms.sum::<f64>() + constant[i * n + k].abs()
    }

    /// Takes over the sizes of a field's residuals from the workspace.
    fn write_sizes(&mut self, field: usize, dim: usize, work: &Workspace) {
        for k in 0..work.d.len() {
            let at = self.kkt.coordinate(k / dim, field, k % dim);
            self.sizes[at] = work.full[k];
        }
        for (row, &size) in work.rows.iter().enumerate() {
            let at = self.kkt.multiplier(row, field);
            self.sizes[at] = size;
        }
    }
}

/// The equations of all stages.
pub(super) struct Stages<'a> {
    pub own: &'a mut Collocation,
    pub system: &'a System,
    pub timing: Timing<'a>,
}

/// Whether positions stay on the rows: where they drift off, redundant ones become independent.
fn lets_go(newton: &Newton, work: &Workspace) -> bool {
    newton.settings.multipliers == Multipliers::Augmented(None) && work.level == Level::POSITION
}

impl Stages<'_> {
    /// Gives rows that nothing moves a δ of their own: their multipliers are round-off over δ, and more than light nodes weigh.
    /// All others have hardly any, as redundant rows have their part of it.
    fn let_go(&mut self, work: &Workspace) {
        let (softness, is_singular) = (work.scales.softness.iter().cycle(), self.own.singular > 0);
        for ((delta, softness), &idle) in self.own.delta.iter_mut().zip(softness).zip(&self.own.idle) {
            let rho = match (is_singular, idle) {
                (true, _) => RHO,
                (false, true) => RHO_IDLE,
                (false, false) => RHO_HELD,
            };
            *delta = softness / rho;
        }
    }
}

impl Equations for Stages<'_> {
    fn begin(&mut self, newton: &mut Newton, work: &mut Workspace) {
        let (h, own) = (self.timing.step, &mut *self.own);
        match newton.settings.multipliers {
            Multipliers::Penalty(alpha) => newton.delta.fill(work.level.scale(1.0 / h, h * h) / (h * h * alpha)),
            Multipliers::Augmented(penalty) => newton.proximal(h * h, penalty, &work.scales),
        }
        own.delta.chunks_exact_mut(newton.delta.len().max(1)).for_each(|delta| delta.copy_from_slice(&newton.delta));
        if lets_go(newton, work) {
            self.let_go(work);
        }
        self.own.singular = self.own.singular.saturating_sub(1);
    }

    fn restart(&mut self, again: usize, _newton: &mut Newton, work: &mut Workspace) -> bool {
        let Some(share) = RESTARTS.get(again) else { return false };
        let (n, h, own) = (self.system.coordinates(), self.timing.step, &mut *self.own);
        for (i, node) in self.timing.nodes.iter().enumerate() {
            for k in 0..n {
                own.d[i * n + k] = share * node * h * work.start.v[k];
                own.u[i * n + k] = h * work.start.v[k];
            }
        }
        own.lambda.fill(0.0);
        own.nu.fill(0.0);
        true
    }

    fn evaluate(&mut self, is_new: bool, newton: &mut Newton, work: &mut Workspace) {
        if is_new {
            self.own.kkt.clear();
        }
        let soft = if let Multipliers::Penalty(alpha) = newton.settings.multipliers { Some(alpha) } else { None };
        self.own.assemble(self.system, self.timing, soft, is_new, work);
    }

    fn is_met(&mut self, _moves: bool, _newton: &mut Newton, work: &mut Workspace) -> bool {
        self.own.size(self.system, self.timing, work);
        let first = self.own.kkt.multiplier(0, 0);
        let ((forces, rows), (of_forces, of_rows)) = (self.own.unknowns.split_at(first), self.own.sizes.split_at(first));
        are_forces_round_off(forces, of_forces) && are_rows_round_off(rows, of_rows)
    }

    fn factor(&mut self, _is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        let (rows, own) = (newton.delta.len(), &mut *self.own);
        let field = |k: usize| k / rows.max(1) * own.stages;
        for field in 0..own.kkt.fields {
            own.kkt.regularise(field, &own.delta[field / own.stages * rows..][..rows]);
        }
        newton.factorizations += 1;
        own.kkt.factor()?;
        own.changes_rank = false;
        for (k, idle) in own.idle.iter_mut().enumerate() {
            let pivot = own.kkt.solver.pivot(own.kkt.multiplier(k % rows, field(k))) - own.delta[k];
            let is = pivot < IDLE * work.scales.softness[k % rows];
            own.changes_rank |= std::mem::replace(idle, is) != is;
        }
        Ok(())
    }

    /// Near a singular position redundancy passes from row to row, and all have the δ of redundant ones.
    fn guards_rank(&mut self, newton: &mut Newton, work: &Workspace) -> bool {
        if !self.own.changes_rank || !lets_go(newton, work) {
            return false;
        }
        if std::mem::replace(&mut self.own.is_known, true) {
            self.own.singular = SINGULAR;
        }
        self.let_go(work);
        true
    }

    fn advance(&mut self, _is_first: bool, _newton: &mut Newton, work: &mut Workspace) -> Result<Change, Failure> {
        let own = &mut *self.own;
        own.kkt.solve(&mut own.unknowns);
        let increment = own.advance(self.system, work);
        match increment.is_finite() {
            true => Ok(Change { increment, multipliers: own.turned(work), left: 0.0 }),
            false => Err(Failure::NotFinite),
        }
    }
}
