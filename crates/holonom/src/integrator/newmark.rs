//! Newmark's family; β = 1/4, γ = 1/2 is the trapezoidal rule (methods §15).

use super::{Integrator, Step, Work};
use crate::formulation::{Failure, Newton, RowsAt, Sampling, Stage, Workspace, solve};
use crate::system::System;

pub(super) struct Newmark {
    pub beta: f64,
    pub gamma: f64,
}

/// The stage of Newmark's formulas: ϖ = βh², ∂v/∂q = γ/(βh).
pub(super) fn newmark_stage(start: f64, step: f64, beta: f64, gamma: f64) -> Stage {
    Stage { sampling: Sampling::End, rows: RowsAt::End, start, step, inertia: beta * step * step, rate: gamma / (beta * step) }
}

impl Integrator for Newmark {
    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let (n, beta, gamma) = (system.coordinates(), self.beta, self.gamma);
        let stage = newmark_stage(start, h, beta, gamma);
        for i in 0..n {
            let (v, a) = (work.start.v[i], work.a[i]);
            work.prediction.drift[i] = h * v + h * h * (0.5 - beta) * a;
            work.prediction.offset[i] = v + h * (1.0 - gamma) * a - stage.rate * work.prediction.drift[i];
            work.d[i] = h * v + h * h * (0.5 * a + beta * work.prediction.a_change[i]);
            work.inertial[i] = v + h * (1.0 - gamma) * a;
        }
        // `inertial` is scratch of the residual, so the velocity without its new acceleration moves to v1.
        work.end.v[..n].copy_from_slice(&work.inertial);
        system.place_known(stage.end(), &mut work.end.x, &mut work.end.v, &mut work.a);
        work.sampled.x[n..].copy_from_slice(&work.end.x[n..]);
        work.sampled.v[n..].copy_from_slice(&work.end.v[n..]);
        solve(system, &stage, newton, work)?;
        for i in 0..n {
            work.a[i] = (work.d[i] - work.prediction.drift[i]) / stage.inertia;
            work.end.v[i] += h * gamma * work.a[i];
        }
        work.settle(system, &stage);
        Ok(Step { stage, work: Work::AtEnds(0.0), estimate: None })
    }
}
