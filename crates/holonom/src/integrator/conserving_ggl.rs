//! The conserving scheme with the rows at both levels: energy, momentum, Φ and Φ̇ exact (methods §2.4).

use super::conserving::midpoint_kinematics;
use super::{Integrator, Step, Work};
use crate::formulation::{Failure, RowsAt, Sampling, SolveSettings, Stabilized, Workspace};
use crate::system::System;

pub(super) struct ConservingGgl {
    stabilized: Stabilized,
    /// Step of the last solution, s: γ' grows with its cube.
    last_step: f64,
}

impl ConservingGgl {
    pub(super) fn new(system: &System) -> Self {
        Self { stabilized: Stabilized::new(system), last_step: 0.0 }
    }
}

impl Integrator for ConservingGgl {
    fn step(&mut self, system: &System, start: f64, step: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<Step, Failure> {
        let (n, h) = (system.coordinates(), step);
        let stage = midpoint_kinematics(system, start, h, Sampling::Between, RowsAt::End, work);
        let both = &mut self.stabilized;
        for i in 0..work.x1.len() {
            if i < n {
                both.u[i] = work.d[i] - 0.5 * h * work.v0[i];
            } else {
                both.u[i] = 0.5 * h * work.v1[i];
                work.a1[i] = (work.x1[i] - work.x0[i] - h * work.v0[i]) / stage.inertia;
            }
        }
        // A failed step leaves nothing to start from, and a step of another length little.
        let carried = if self.last_step == h { 1.0 } else { 0.0 };
        for row in 0..both.mu.len() {
            both.gamma[row] *= carried;
            // μ = ϖλ − γ' begins at zero; what it is expected to be is for the first tangent.
            both.mu[row] = 0.0;
            work.lambda[row] -= both.gamma[row] / stage.inertia;
        }
        self.last_step = 0.0;
        let iterations = both.solve(system, &stage, settings, work)?;
        self.last_step = h;
        for i in 0..work.x1.len() {
            if i < n {
                work.v1[i] = work.v0[i] + 2.0 / h * (both.u[i] - 0.5 * work.drift[i]);
            }
            work.a1[i] = (work.v1[i] - work.v0[i]) / h;
        }
        for row in 0..both.mu.len() {
            work.lambda[row] = (both.mu[row] + both.gamma[row]) / stage.inertia;
        }
        let mut extra_work = 0.0;
        if work.is_worked_on() {
            work.settle(system, &stage);
            both.turn(system, &stage, work);
            extra_work = both.work(system, &stage, work);
        }
        Ok(Step { iterations, stage, work: Work::Between(extra_work), estimate: None })
    }
}
