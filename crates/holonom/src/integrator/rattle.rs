//! RATTLE: half a kick, a drift onto the constraints, half a kick onto their rates; symplectic (Andersen 1983; methods
//! §6). Forces that depend on velocity are taken at the drift's, implicitly in the first kick.

use super::{Integrator, Step, Work};
use crate::formulation::{Failure, RowsAt, Sampling, SolveSettings, Stage, Workspace, solve};
use crate::system::System;

/// Passes of the velocity solve; the second already meets round-off, the third is for redundant rows.
const PASSES: usize = 3;

pub(super) struct Rattle;

impl Integrator for Rattle {
    fn step(&mut self, system: &System, start: f64, h: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        let inertia = 0.5 * h * h;
        let stage = Stage { sampling: Sampling::Start, rows: RowsAt::End, start, step: h, inertia, rate: 1.0 / h };
        for i in 0..n {
            work.drift[i] = h * work.v0[i];
            work.offset[i] = 0.0;
            work.d[i] = h * work.v0[i] + inertia * work.a1[i];
        }
        // The first kick takes place at the start, the rows at the end.
        let Workspace { xs, vs, a1, .. } = work;
        system.place_known(start, xs, vs, a1);
        let Workspace { x1, v1, full, .. } = work;
        system.place_known(stage.end(), x1, v1, full);
        solve(system, &stage, settings, work)?;
        work.place(&stage);
        kick(system, &stage, work)?;
        Ok(Step { stage: Stage { sampling: Sampling::End, ..stage }, work: Work::AtEnds, estimate: None })
    }
}

/// The second half: M (v_1 − v_½) + ½h (f(q_1, v_½) + G_1ᵀμ) = 0 with Φ̇ = 0.
fn kick(system: &System, stage: &Stage, work: &mut Workspace) -> Result<(), Failure> {
    let (n, half) = (system.coordinates(), 0.5 * stage.step);
    for i in 0..n {
        work.v1[i] = work.vs[i];
        work.a1[i] = 0.0;
    }
    let Workspace { x1, v1, a1, .. } = work;
    system.place_known(stage.end(), x1, v1, a1);
    work.sample_end(system, stage.end());
    if !work.factor_inertia() {
        return Err(Failure::NotFinite);
    }
    for pass in 0..PASSES {
        if pass == 0 {
            system.mass.times(system.dim, &work.a1, &mut work.inertial);
            for i in 0..n {
                work.unknowns[i] = -half * (work.inertial[i] + work.force[i]);
            }
        } else {
            work.unknowns[..n].fill(0.0);
        }
        work.rate_violation(system, stage.end());
        work.unknowns[n..].iter_mut().zip(&work.rows).for_each(|(unknown, rate)| *unknown = -rate);
        work.solve()?;
        work.v1[..n].iter_mut().zip(&work.unknowns).for_each(|(v, step)| *v += step);
        work.lambda.iter_mut().zip(&work.unknowns[n..]).for_each(|(lambda, step)| *lambda += step / half);
    }
    for i in 0..n {
        work.a1[i] = (work.v1[i] - work.vs[i]) / half;
    }
    if work.is_worked_on() {
        work.sample_end(system, stage.end());
    }
    Ok(())
}
