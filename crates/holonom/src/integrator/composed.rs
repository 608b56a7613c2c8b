//! Symmetric compositions of a symmetric scheme of order 2: what it conserves stays exact (Hairer, Lubich and Wanner
//! 2006, §V.3).

use super::history::{History, MOTION, MULTIPLIERS, is_same_length};
use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Failure, Newton, Workspace};
use crate::system::System;

/// Suzuki 1990: five steps, 1/(4 − 4^⅓) = 0.4145, the middle one backwards; order 4.
fn suzuki() -> Vec<f64> {
    let outer = 1.0 / (4.0 - 4f64.cbrt());
    vec![outer, outer, 1.0 - 4.0 * outer, outer, outer]
}

/// Kahan and Li 1997: nine steps, order 6.
fn kahan_li() -> Vec<f64> {
    let half = [0.392_161_444_007_314_1, 0.332_599_136_789_359_4, -0.706_246_172_557_639_4, 0.082_213_596_293_550_8];
    let middle = 1.0 - 2.0 * half.iter().sum::<f64>();
    half.iter().copied().chain([middle]).chain(half.iter().rev().copied()).collect()
}

/// The parts of a step of some order, as shares of it.
fn shares(order: u8) -> Vec<f64> {
    match order {
        4 => suzuki(),
        6 => kahan_li(),
        _ => vec![1.0],
    }
}

/// The middles of the parts of a step, with the lengths of these.
pub(super) fn looks(order: u8) -> Vec<[f64; 2]> {
    let middle = |end: &mut f64, share: f64| {
        *end += share;
        Some([*end - 0.5 * share, share])
    };
    shares(order).into_iter().scan(0.0, middle).collect()
}

pub(super) struct Composed {
    inner: Box<dyn Integrator>,
    shares: Vec<f64>,
    start: Vec<f64>,
    /// The memory of the inner scheme in one of its steps.
    memory: Vec<f64>,
}

/// What is kept of each inner step for that of the next step, which comes nearer to it than the inner step before.
struct Memory<'a> {
    acceleration: History<'a, MOTION>,
    lambda: History<'a, MULTIPLIERS>,
    inner: &'a mut [f64],
}

impl<'a> Memory<'a> {
    fn of(system: &System, memory: &'a mut [f64]) -> Self {
        let (acceleration, rest) = memory.split_at_mut(History::<MOTION>::size(system.coordinates()));
        let (lambda, inner) = rest.split_at_mut(History::<MULTIPLIERS>::size(system.constraints()));
        Self { acceleration: History::of(acceleration), lambda: History::of(lambda), inner }
    }
}

impl Composed {
    /// A scheme of order 2 itself, or composed to order 4 or 6.
    pub(super) fn of(inner: Box<dyn Integrator>, order: u8, system: &System) -> Box<dyn Integrator> {
        let shares = shares(order);
        if shares.len() == 1 {
            return inner;
        }
        let memory = vec![0.0; inner.memory(system)];
        Box::new(Self { inner, shares, start: vec![0.0; system.nodes() * system.dim], memory })
    }
}

impl Integrator for Composed {
    fn memory(&self, system: &System) -> usize {
        1 + self.shares.len()
            * (History::<MOTION>::size(system.coordinates()) + History::<MULTIPLIERS>::size(system.constraints()) + self.memory.len())
    }

    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        self.start.copy_from_slice(&work.start.x);
        // What was predicted over the whole step says nothing of its parts.
        work.prediction.a_change.fill(0.0);
        work.prediction.lambda_change.fill(0.0);
        let mut memory = std::mem::take(&mut work.memory);
        let outcome = self.steps(system, start, h, &mut memory, newton, work);
        work.memory = memory;
        work.start.x.copy_from_slice(&self.start);
        outcome
    }
}

impl Composed {
    fn steps(
        &mut self,
        system: &System,
        start: f64,
        h: f64,
        memory: &mut [f64],
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<Step, Failure> {
        let n = system.coordinates();
        let (last_step, memory) = memory.split_first_mut().expect("there is room for a step");
        let follows = is_same_length(h, *last_step);
        let each = memory.len() / self.shares.len();
        let (mut done, mut passed) = (0.0, 0.0);
        let mut last = None;
        for (k, (share, memory)) in self.shares.iter().zip(memory.chunks_exact_mut(each)).enumerate() {
            if k > 0 {
                for i in 0..n {
                    work.end.x[i] = work.start.x[i] + work.d[i];
                }
                work.start.x.copy_from_slice(&work.end.x);
                work.start.v.copy_from_slice(&work.end.v);
                let t = start + passed * h;
                system.evaluate_again(&work.start.x, t, &mut work.start.at);
                system.constraint_values(&work.start.at, t, &mut work.phi_start);
            }
            let mut memory = Memory::of(system, memory);
            if follows {
                work.a[..n].copy_from_slice(memory.acceleration.value);
                work.prediction.a_change[..n].copy_from_slice(memory.acceleration.change);
                work.lambda.copy_from_slice(memory.lambda.value);
                work.prediction.lambda_change.copy_from_slice(memory.lambda.change);
            }
            self.memory.copy_from_slice(memory.inner);
            std::mem::swap(&mut self.memory, &mut work.memory);
            let outcome = self.inner.step(system, start + passed * h, share * h, newton, work);
            std::mem::swap(&mut self.memory, &mut work.memory);
            let step = outcome?;
            memory.inner.copy_from_slice(&self.memory);
            memory.acceleration.remember(follows, |i| work.a[i], |_| 1.0);
            memory.lambda.remember(follows, |row| work.lambda[row], |row| work.scales.reach[row].powi(2));
            if let Work::Between(extra) = step.work {
                done += energy::work_between(system, &step.stage, work) + extra;
            }
            passed += share;
            last = Some(step);
        }
        *last_step = h;
        let step = last.expect("a composition has steps");
        for i in 0..n {
            let end = work.start.x[i] + work.d[i];
            work.d[i] = end - self.start[i];
        }
        Ok(Step { stage: step.stage, work: Work::Sum(done), estimate: None })
    }
}
