//! Time stepping: what an integrator makes of velocities and accelerations. None of them names a constraint.

mod bdf;
mod composed;
mod conserving;
mod conserving_ggl;
mod dop853;
mod explicit;
mod generalized_alpha;
mod history;
mod midpoint;
mod newmark;
mod rattle;
mod runge_kutta;
mod table;

use crate::formulation::{Failure, Newton, RowsAt, Sampling, Stage, Workspace};
use crate::system::System;

pub(crate) use history::{Differences, MOTION, MULTIPLIERS, Squares, extrapolate, is_same_length};
pub use table::{Entry, Estimate, INTEGRATORS};

/// Time stepping from the start values in a workspace (position, velocity, acceleration, λ) to its end values.
pub trait Integrator: Send {
    /// Numbers to keep from step to step; all zero at the start, and kept with the state.
    fn memory(&self, _system: &System) -> usize {
        0
    }

    /// Whether its equations are those of one stage, in which rows that follow from others may ask for other motions than these.
    fn has_one_stage(&self) -> bool {
        true
    }

    /// Adds what else it knows from the steps before, of which the next step is made and which is not part of the state.
    fn carry(&self, _carried: &mut Vec<f64>) {}

    /// Goes on with what [`carry`](Self::carry) added.
    fn carry_on(&mut self, _carried: &[f64]) {}

    /// Takes one step; says where the work done in it is booked from. An estimate of the
    /// local errors, where the table promises one, is left in the workspace.
    fn step(&mut self, system: &System, start: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure>;

    /// Dense output: leaves in the workspace, put at the start of the last step again, what a step would leave that ended
    /// after the share `share` of it; says the work done up to there, J. Only called where the table says that there is one.
    fn interpolate(
        &mut self,
        _system: &System,
        _start: f64,
        _step: f64,
        _share: f64,
        _newton: &mut Newton,
        _work: &mut Workspace,
    ) -> Result<f64, Failure> {
        unreachable!("the table promises no dense output")
    }
}

/// Where the forces of a step were taken, and what is known of its work and errors.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The last stage whose forces the workspace holds.
    pub stage: Stage,
    /// Where the work of the step is read from.
    pub work: Work,
    /// Where the workspace has an estimate of the local errors: the order in use, and that of the estimate.
    pub estimate: Option<[u8; 2]>,
}

impl Step {
    /// Whether the end was evaluated where it is, at the time `t` (s), as [`Workspace::settle`] does between positions.
    pub(crate) fn has_settled_at(&self, t: f64, system: &System, work: &Workspace) -> bool {
        let is_between = self.stage.sampling == Sampling::Between && matches!(self.work, Work::Between(_));
        is_between && work.is_worked_on() && (self.stage.end() == t || system.custom.is_empty())
    }
}

/// Where the work that is done on the system in a step is to be read from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Work {
    /// The mean of the power at both ends, and what the forces at the start did beyond those of the end of the step before, J.
    AtEnds(f64),
    /// The forces of the stage along the step, and what known motion did beyond them, J.
    Between(f64),
    /// Known already, J.
    Sum(f64),
}

/// Numbers that the families of integrators take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
    /// HHT's α, 0 … 1/3.
    pub alpha: f64,
    /// Spectral radius ρ∞ of generalized-α, 0 … 1.
    pub rho: f64,
    /// Which positions the conserving scheme puts on the constraints.
    pub rows: RowsAt,
    /// Order of a family that has several.
    pub order: u8,
    /// Whether steps follow from an accuracy, and BDF's order with them.
    pub adapts: bool,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { beta: 0.25, gamma: 0.5, alpha: 0.1, rho: 0.8, rows: RowsAt::End, order: 2, adapts: false }
    }
}
