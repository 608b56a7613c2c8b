//! Symmetric compositions of a symmetric scheme of order 2: what it conserves stays exact (Hairer, Lubich and Wanner,
//! Geometric Numerical Integration, §V.3).

use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Failure, SolveSettings, Workspace};
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

pub(super) struct Composed {
    inner: Box<dyn Integrator>,
    shares: Vec<f64>,
    start: Vec<f64>,
}

impl Composed {
    /// A scheme of order 2 itself, or composed to order 4 or 6.
    pub(super) fn of(inner: Box<dyn Integrator>, order: u8, system: &System) -> Box<dyn Integrator> {
        let shares = match order {
            2 => return inner,
            4 => suzuki(),
            _ => kahan_li(),
        };
        Box::new(Self { inner, shares, start: vec![0.0; system.nodes() * system.dim] })
    }
}

impl Integrator for Composed {
    fn memory(&self, system: &System) -> usize {
        self.inner.memory(system)
    }

    fn step(&mut self, system: &System, start: f64, h: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        self.start.copy_from_slice(&work.x0);
        // What was predicted over the whole step says nothing of its parts.
        work.a_change.fill(0.0);
        let (mut iterations, mut done, mut passed) = (0, 0.0, 0.0);
        let mut last = None;
        for (k, share) in self.shares.iter().enumerate() {
            if k > 0 {
                for i in 0..n {
                    work.x1[i] = work.x0[i] + work.d[i];
                }
                work.x0.copy_from_slice(&work.x1);
                work.v0.copy_from_slice(&work.v1);
                let t = start + passed * h;
                system.evaluate_again(&work.x0, t, &mut work.at_start);
                system.constraint_values(&work.at_start, t, &mut work.phi_start);
            }
            let step = match self.inner.step(system, start + passed * h, share * h, settings, work) {
                Ok(step) => step,
                Err(failure) => {
                    system.evaluate_again(&self.start, start, &mut work.at_start);
                    return Err(failure);
                }
            };
            iterations += step.iterations;
            if let Work::Between(extra) = step.work {
                done += energy::work_between(system, &step.stage, work) + extra;
            }
            passed += share;
            last = Some(step);
        }
        let step = last.expect("a composition has steps");
        for i in 0..n {
            let end = work.x0[i] + work.d[i];
            work.d[i] = end - self.start[i];
        }
        work.x0.copy_from_slice(&self.start);
        Ok(Step { iterations, stage: step.stage, work: Work::Sum(done), estimate: None })
    }
}
