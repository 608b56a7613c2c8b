//! The conserving scheme with the rows at both levels: energy, momentum, Φ and Φ̇ exact (methods §9).

use super::conserving::midpoint_kinematics;
use super::history::{History, MOTION, MULTIPLIERS, is_same_length};
use super::{Integrator, Step, Work};
use crate::formulation::{Failure, Newton, RowsAt, Sampling, Stabilized, Workspace};
use crate::system::System;

pub(super) struct ConservingGgl {
    stabilized: Stabilized,
}

impl ConservingGgl {
    pub(super) fn new(system: &System, newton: &Newton) -> Self {
        Self { stabilized: Stabilized::new(system, newton) }
    }
}

/// What is kept from step to step.
struct Memory<'a> {
    /// Step of the last solution, s.
    step: &'a mut f64,
    /// Steps to come with both levels in one matrix.
    coupled: &'a mut f64,
    /// γ' of the last step and its change there (r each).
    gamma: History<'a, MULTIPLIERS>,
    /// By how much γ' makes the increment of the free coordinates exceed that of the mean velocity, Δq − h v̄ = M⁻¹Ḡᵀγ', m.
    slip: History<'a, MOTION>,
}

impl<'a> Memory<'a> {
    fn of(system: &System, memory: &'a mut [f64]) -> Self {
        let ([step, coupled], rest) = memory.split_first_chunk_mut().expect("there is room for a step");
        let (gamma, slip) = rest.split_at_mut(History::<MULTIPLIERS>::size(system.constraints()));
        Self { step, coupled, gamma: History::of(gamma), slip: History::of(slip) }
    }
}

impl Integrator for ConservingGgl {
    fn memory(&self, system: &System) -> usize {
        2 + History::<MULTIPLIERS>::size(system.constraints()) + History::<MOTION>::size(system.coordinates())
    }

    fn step(&mut self, system: &System, start: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let (n, h) = (system.coordinates(), step);
        let stage = midpoint_kinematics(system, start, h, Sampling::Between, RowsAt::End, work);
        newton.fit_dampers(system, start, h, work)?;
        let both = &mut self.stabilized;
        let memory = Memory::of(system, &mut work.memory);
        let follows = is_same_length(h, *memory.step);
        both.coupled_steps = *memory.coupled as u32;
        for i in 0..work.end.x.len() {
            if i < n {
                both.u[i] = work.d[i] - 0.5 * h * work.start.v[i];
                work.d[i] += if follows { memory.slip.value[i] + memory.slip.change[i] } else { 0.0 };
            } else {
                both.u[i] = 0.5 * h * work.end.v[i];
                work.a[i] = (work.end.x[i] - work.start.x[i] - h * work.start.v[i]) / stage.inertia;
            }
        }
        both.lambda_start.copy_from_slice(&work.lambda);
        // γ' and μ = ϖλ − γ' begin at zero; what they are expected to be is for the first iteration's matrices.
        for row in 0..both.mu.len() {
            let expected = if follows { memory.gamma.value[row] + memory.gamma.change[row] } else { 0.0 };
            (both.gamma[row], both.mu[row], both.gamma_change[row]) = (0.0, 0.0, expected);
            work.lambda[row] -= expected / stage.inertia;
        }
        both.solve(system, &stage, newton, work)?;
        for i in 0..work.end.x.len() {
            if i < n {
                work.end.v[i] = work.start.v[i] + 2.0 / h * (both.u[i] - 0.5 * work.prediction.drift[i]);
            }
            work.a[i] = (work.end.v[i] - work.start.v[i]) / h;
        }
        for row in 0..both.mu.len() {
            work.lambda[row] = (both.mu[row] + both.gamma[row]) / stage.inertia;
        }
        let mut memory = Memory::of(system, &mut work.memory);
        *memory.step = h;
        *memory.coupled = f64::from(both.coupled_steps.saturating_sub(1));
        memory.slip.remember(follows, |i| work.d[i] - both.u[i] - 0.5 * work.prediction.drift[i], |_| 1.0);
        memory.gamma.remember(follows, |row| both.gamma[row], |row| work.scales.reach[row].powi(2));
        let mut extra_work = 0.0;
        work.settle(system, &stage);
        if system.is_driven() {
            both.turn(system, &stage, work);
            extra_work = both.work(system, &stage, work);
        }
        Ok(Step { stage, work: Work::Between(extra_work), estimate: None })
    }
}
