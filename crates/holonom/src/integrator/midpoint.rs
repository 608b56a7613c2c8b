//! The implicit midpoint rule with forces and rows at the midpoint (26).

use super::conserving::{finish, midpoint_kinematics};
use super::{Integrator, Step, Work};
use crate::formulation::{Failure, Newton, RowsAt, Sampling, Workspace, solve};
use crate::system::System;

pub(super) struct Midpoint;

impl Integrator for Midpoint {
    fn step(&mut self, system: &System, start: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let stage = midpoint_kinematics(system, start, step, Sampling::Middle, RowsAt::Middle, work);
        // Known nodes are where they are at the midpoint; the acceleration they impose is the mean one.
        let Workspace { sampled, full, .. } = work;
        system.place_known(stage.time(), &mut sampled.x, &mut sampled.v, full);
        solve(system, &stage, newton, work)?;
        finish(system, step, work);
        work.settle(system, &stage);
        Ok(Step { stage, work: Work::Between(0.0), estimate: None })
    }
}
