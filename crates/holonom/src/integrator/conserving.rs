//! The energy-momentum conserving scheme (14)–(18): midpoint kinematics with discrete gradients (methods §5).

use super::{Integrator, Step, Work};
use crate::formulation::{Failure, Multipliers, Newton, RowsAt, Sampling, Stage, Workspace, predict, solve};
use crate::system::System;

pub(super) struct Conserving {
    pub rows: RowsAt,
}

impl Integrator for Conserving {
    fn step(&mut self, system: &System, start: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        // λ = αΦ̄ in the penalty formulation: its energy ½αΦ² is then kept (14).
        let rows = if matches!(newton.settings.multipliers, Multipliers::Penalty(_)) { RowsAt::Mean } else { self.rows };
        let stage = midpoint_kinematics(system, start, step, Sampling::Between, rows, work);
        newton.fit_dampers(system, start, step, work)?;
        solve(system, &stage, newton, work)?;
        finish(system, step, work);
        work.settle(system, &stage);
        Ok(Step { stage, work: Work::Between(0.0), estimate: None })
    }
}

/// Sets up v̄ = Δq/h and M Δv/h: the start of every scheme with midpoint kinematics. The prediction follows the mean
/// accelerations of the steps before.
pub(super) fn midpoint_kinematics(system: &System, start: f64, h: f64, sampling: Sampling, rows: RowsAt, work: &mut Workspace) -> Stage {
    let n = system.coordinates();
    let stage = Stage { sampling, rows, start, step: h, inertia: 0.5 * h * h, rate: 1.0 / h };
    for i in 0..n {
        work.prediction.drift[i] = h * work.start.v[i];
        work.prediction.offset[i] = 0.0;
    }
    predict(&stage, work);
    system.place_known(stage.end(), &mut work.end.x, &mut work.end.v, &mut work.a);
    for i in n..work.end.x.len() {
        work.sampled.x[i] = 0.5 * (work.start.x[i] + work.end.x[i]);
        work.sampled.v[i] = (work.end.x[i] - work.start.x[i]) / h;
        work.a[i] = (work.end.v[i] - work.start.v[i]) / h;
    }
    stage
}

/// Velocity at the end and mean acceleration from the increment. Of the rounded 2/h only the change has a part, as an error
/// of the whole velocity would be the same in each step and the energy drift with it.
pub(super) fn finish(system: &System, h: f64, work: &mut Workspace) {
    for i in 0..system.coordinates() {
        work.end.v[i] = work.start.v[i] + 2.0 / h * (work.d[i] - work.prediction.drift[i]);
        work.a[i] = (work.end.v[i] - work.start.v[i]) / h;
    }
}
