//! Generalized-α for constrained systems (Arnold and Brüls 2007) and its members: the equations of motion hold at the end
//! of the step with the true acceleration v̇, and Newmark's formulas take an auxiliary one,
//! (1 − α_m) a_{n+1} + α_m a_n = (1 − α_f) v̇_{n+1} + α_f v̇_n (methods §15).

use super::newmark::newmark_stage;
use super::{Integrator, Step, Work};
use crate::formulation::{Failure, Newton, Workspace, solve};
use crate::system::System;

pub(super) struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl GeneralizedAlpha {
    /// Spectral radius ρ∞ at infinite frequency, 0 … 1.
    pub(super) fn with_radius(rho: f64) -> Self {
        Self::new((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// HHT-α: α_m = 0, α_f = α in 0 … 1/3.
    pub(super) fn hht(alpha: f64) -> Self {
        Self::new(0.0, alpha)
    }

    fn new(alpha_m: f64, alpha_f: f64) -> Self {
        let gamma = 0.5 + alpha_f - alpha_m;
        Self { alpha_m, alpha_f, beta: 0.25 * (gamma + 0.5) * (gamma + 0.5), gamma }
    }

    /// One step from the auxiliary acceleration a_n = v̇_n + h `lag`.
    fn attempt(&self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        let Self { alpha_m, alpha_f, beta, gamma } = *self;
        // a_{n+1} = σ v̇_{n+1} + known
        let sigma = (1.0 - alpha_f) / (1.0 - alpha_m);
        let mut stage = newmark_stage(start, h, beta, gamma);
        stage.inertia *= sigma;
        for i in 0..n {
            let (v, dv) = (work.start.v[i], work.a[i]);
            let a = dv + h * work.memory[i];
            let known = (alpha_f * dv - alpha_m * a) / (1.0 - alpha_m);
            let free = h * v + h * h * (0.5 - beta) * a;
            work.prediction.drift[i] = free + beta * h * h * known;
            work.prediction.offset[i] = v + h * (1.0 - gamma) * a - stage.rate * free;
            work.d[i] = h * v + h * h * (0.5 * dv + beta * work.prediction.a_change[i]);
        }
        system.place_known(stage.end(), &mut work.end.x, &mut work.end.v, &mut work.a);
        work.sampled.x[n..].copy_from_slice(&work.end.x[n..]);
        work.sampled.v[n..].copy_from_slice(&work.end.v[n..]);
        let (before, after) = work.memory.split_at_mut(n);
        for i in 0..n {
            after[i] = work.a[i];
            before[i] = work.a[i] + h * before[i];
        }
        solve(system, &stage, newton, work)?;
        work.place(&stage);
        for i in 0..n {
            let (a, dv) = (work.memory[i], work.memory[n + i]);
            let new = (work.d[i] - work.prediction.drift[i]) / stage.inertia;
            let auxiliary = ((1.0 - alpha_f) * new + alpha_f * dv - alpha_m * a) / (1.0 - alpha_m);
            work.a[i] = new;
            work.end.v[i] = work.sampled.v[i];
            work.memory[i] = (auxiliary - new) / h;
        }
        Ok(Step { stage, work: Work::AtEnds(0.0), estimate: None })
    }
}

/// An acceleration at the start that is so many times that of an implicit step lasts for no step.
const SHORT: f64 = 3.0;

impl GeneralizedAlpha {
    /// Leaves the acceleration to start with in `estimate.q` and `a`. Where something stiff is not at rest, the true one is far
    /// larger than any that lasts for a step, and would throw the mechanism; then that of x₁ = x₀ + h v₀ + ½ h² a₁, v₁ = v₀ + h a₁
    /// takes its place. It errs by the first order of a step once, which leaves the order of the scheme.
    fn calm(&self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        let n = system.coordinates();
        let implicit = Self { alpha_m: 0.0, alpha_f: 0.0, beta: 0.5, gamma: 1.0 };
        implicit.attempt(system, start, h, newton, work)?;
        let [true_one, lasting] = [&work.estimate.q, &work.a[..n]].map(|a| {
            work.full.fill(0.0);
            work.full[..n].copy_from_slice(a);
            system.mass.half_product(system.dim, &work.full, &work.full)
        });
        if true_one > SHORT * SHORT * lasting {
            work.estimate.q.copy_from_slice(&work.a[..n]);
        }
        work.a[..n].copy_from_slice(&work.estimate.q);
        work.memory.fill(0.0);
        Ok(())
    }
}

impl Integrator for GeneralizedAlpha {
    /// (a_n − v̇_n)/h, scratch for v̇_n, and whether a step was taken.
    fn memory(&self, system: &System) -> usize {
        2 * system.coordinates() + 1
    }

    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        if work.memory[2 * n] == 0.0 {
            // Without (a_0 − v̇_0)/h = (α_m − α_f) d v̇/dt the multipliers begin with an error of first order: a trial step
            // shows the derivative.
            work.memory.fill(0.0);
            work.estimate.q.copy_from_slice(&work.a[..n]);
            self.calm(system, start, h, newton, work)?;
            self.attempt(system, start, h, newton, work)?;
            for i in 0..n {
                work.memory[i] = (self.alpha_m - self.alpha_f) * (work.a[i] - work.estimate.q[i]) / h;
                work.a[i] = work.estimate.q[i];
            }
            work.memory[2 * n] = 1.0;
        }
        let step = self.attempt(system, start, h, newton, work)?;
        work.settle(system, &step.stage);
        Ok(step)
    }
}
