//! RATTLE: half a kick, a drift onto the constraints, half a kick onto their rates; symplectic (Andersen 1983; methods
//! §15). Forces that depend on velocity are taken at the drift's, implicitly in the first kick.

use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Failure, Newton, RowsAt, Sampling, Stage, Workspace, solve};
use crate::linalg::largest;
use crate::system::System;

/// Passes of the velocity solve; the second already meets round-off, the third is for redundant rows, and more are for rows that hardly differ from
/// others, as beside a dead centre: there δ is much of what they hold, and is less in these.
const PASSES: usize = 3;
const MOST: usize = 9;

/// Violation of the rates, over their size, that is their rounding.
const ROUND_OFF: f64 = 1e-15;

pub(super) struct Rattle;

impl Integrator for Rattle {
    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        let inertia = 0.5 * h * h;
        let stage = Stage { sampling: Sampling::Start, rows: RowsAt::End, start, step: h, inertia, rate: 1.0 / h };
        for i in 0..n {
            work.prediction.drift[i] = h * work.start.v[i];
            work.prediction.offset[i] = 0.0;
            work.d[i] = h * work.start.v[i] + inertia * work.a[i];
        }
        let mut before = 0.0;
        if system.is_driven() {
            before = energy::power_of_rows(system, start, work);
            work.book_powers(-0.5 * h);
        }
        // The first kick takes place at the start, the rows at the end.
        let Workspace { sampled, a, .. } = work;
        system.place_known(start, &mut sampled.x, &mut sampled.v, a);
        let Workspace { end, full, .. } = work;
        system.place_known(stage.end(), &mut end.x, &mut end.v, full);
        solve(system, &stage, newton, work)?;
        work.place(&stage);
        let extra = if system.is_driven() {
            for i in 0..n {
                work.a[i] = (work.sampled.v[i] - work.start.v[i]) / (0.5 * h);
            }
            let extra = 0.5 * h * (energy::power_of_rows(system, start, work) - before);
            work.book_powers(0.5 * h);
            extra
        } else {
            0.0
        };
        kick(system, &stage, newton, work)?;
        Ok(Step { stage: Stage { sampling: Sampling::End, ..stage }, work: Work::AtEnds(extra), estimate: None })
    }
}

/// The second half: M (v_1 − v_½) + ½h (f(q_1, v_½) + G_1ᵀμ) = 0 with Φ̇ = 0.
fn kick(system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
    let (n, half) = (system.coordinates(), 0.5 * stage.step);
    for i in 0..n {
        work.end.v[i] = work.sampled.v[i];
        work.a[i] = 0.0;
    }
    let Workspace { end, a, .. } = work;
    system.place_known(stage.end(), &mut end.x, &mut end.v, a);
    work.sample_end(system, stage.end());
    if !newton.factor_inertia(work) {
        return Err(Failure::NotFinite);
    }
    for pass in 0..MOST {
        work.rate_violation(system, stage.end());
        if pass >= PASSES && work.scaled(&work.rows) <= ROUND_OFF * largest(&work.end.v) {
            break;
        }
        if pass == PASSES && !newton.factor_stiffer_inertia(work) {
            return Err(Failure::NotFinite);
        }
        if pass == 0 {
            system.mass.times(system.dim, &work.a, &mut work.inertial);
            for i in 0..n {
                newton.unknowns[i] = -half * (work.inertial[i] + work.forces.sum[i]);
            }
        } else {
            newton.unknowns[..n].fill(0.0);
        }
        newton.unknowns[n..].iter_mut().zip(&work.rows).for_each(|(unknown, rate)| *unknown = -rate);
        newton.solve()?;
        work.end.v[..n].iter_mut().zip(&newton.unknowns).for_each(|(v, step)| *v += step);
        work.lambda.iter_mut().zip(&newton.unknowns[n..]).for_each(|(lambda, step)| *lambda += step / half);
    }
    for i in 0..n {
        work.a[i] = (work.end.v[i] - work.sampled.v[i]) / half;
    }
    if work.is_worked_on() {
        work.sample_end(system, stage.end());
    }
    Ok(())
}
