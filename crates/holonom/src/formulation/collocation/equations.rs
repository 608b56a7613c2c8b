//! Coupled stages as Newton's iteration sees them.

use super::{Collocation, Timing};
use crate::formulation::failure::Failure;
use crate::formulation::iteration::Multipliers;
use crate::formulation::newton::{Change, Equations};
use crate::formulation::round_off::{are_forces_round_off, are_rows_round_off};
use crate::formulation::stage::{RowsAt, Sampling, Stage};
use crate::formulation::workspace::Workspace;
use crate::system::System;

impl Collocation {
    /// Sizes of the terms of all residuals into `sizes`, in the order of the unknowns.
    fn size(&mut self, system: &System, timing: Timing<'_>, work: &mut Workspace) {
        let (s, n, r, dim, h) = (self.stages, system.coordinates(), work.lambda.len(), system.dim, timing.step);
        for i in 0..s {
            let t = self.place(system, timing, i, work);
            work.sample(system, t);
            work.at_end.copy_from(&work.sampled);
            let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start: t - h, step: h, inertia: h * h, rate: 1.0 / h };
            for k in 0..n {
                // The size of the acceleration's terms, which cancel.
                let own = |values: &[f64]| (0..s).map(|j| (self.rate[i * s + j] * values[j * n + k]).abs()).sum::<f64>();
                let position = own(&self.d) + self.p[i * n + k].abs();
                let velocity = own(&self.u) + self.r[i * n + k].abs();
                (work.d[k], work.drift[k]) = (if self.doubled { velocity.max(position) } else { velocity }, 0.0);
                work.x1[k] = work.x0[k] + self.d[i * n + k];
            }
            for row in 0..r {
                work.lambda[row] = work.lambda[row].abs() + self.nu[i * r + row].abs() / (h * h);
            }
            work.size_forces(system, &stage);
            work.size_rows(system);
            for field in (i..self.kkt.fields).step_by(s) {
                for k in 0..n {
                    let at = self.kkt.coordinate(k / dim, field, k % dim);
                    self.sizes[at] = work.full[k];
                }
                for row in 0..r {
                    let at = self.kkt.multiplier(row, field);
                    self.sizes[at] = work.rows[row];
                }
            }
        }
    }
}

/// The equations of all stages.
pub(super) struct Stages<'a> {
    pub own: &'a mut Collocation,
    pub system: &'a System,
    pub timing: Timing<'a>,
    pub multipliers: Multipliers,
}

impl Stages<'_> {
    fn soft(&self) -> Option<f64> {
        if let Multipliers::Penalty(alpha) = self.multipliers { Some(alpha) } else { None }
    }
}

impl Equations for Stages<'_> {
    fn begin(&mut self, work: &mut Workspace) {
        let h = self.timing.step;
        match self.multipliers {
            Multipliers::Penalty(alpha) => work.delta.fill(work.level.scale(1.0 / h, h * h) / (h * h * alpha)),
            Multipliers::Augmented(penalty) => work.proximal(h * h, penalty),
        }
    }

    fn restart(&mut self, share: f64, work: &mut Workspace) {
        let (n, h, own) = (self.system.coordinates(), self.timing.step, &mut *self.own);
        for (i, node) in self.timing.nodes.iter().enumerate() {
            for k in 0..n {
                own.d[i * n + k] = share * node * h * work.v0[k];
                own.u[i * n + k] = h * work.v0[k];
            }
        }
        own.lambda.fill(0.0);
        own.nu.fill(0.0);
    }

    fn evaluate(&mut self, is_new: bool, work: &mut Workspace) {
        if is_new {
            self.own.kkt.clear();
        }
        let soft = self.soft();
        self.own.assemble(self.system, self.timing, soft, is_new, work);
    }

    fn is_met(&mut self, _moves: bool, work: &mut Workspace) -> bool {
        self.own.size(self.system, self.timing, work);
        let first = self.own.kkt.multiplier(0, 0);
        let ((forces, rows), (of_forces, of_rows)) = (self.own.unknowns.split_at(first), self.own.sizes.split_at(first));
        are_forces_round_off(forces, of_forces) && are_rows_round_off(rows, of_rows)
    }

    fn factor(&mut self, _is_first: bool, work: &mut Workspace) -> Result<(), Failure> {
        let kkt = &mut self.own.kkt;
        (0..kkt.fields).for_each(|field| kkt.regularise(field, &work.delta));
        work.factorizations += 1;
        kkt.factor()
    }

    fn advance(&mut self, _is_first: bool, work: &mut Workspace) -> Result<Change, Failure> {
        let own = &mut *self.own;
        own.kkt.solve(&mut own.unknowns);
        let increment = own.advance(self.system, work);
        match increment.is_finite() {
            true => Ok(Change { increment, multipliers: own.turned(work), left: 0.0 }),
            false => Err(Failure::NotFinite),
        }
    }
}
