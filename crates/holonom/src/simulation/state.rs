//! Numbers of a moment: what a step starts from and leaves.

use crate::formulation::Workspace;
use crate::system::System;

/// Numbers of a moment. A clone is a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// s
    pub t: f64,
    /// Positions of all nodes (D × nodes), m.
    pub x: Vec<f64>,
    /// Velocities of all nodes (D × nodes), m/s.
    pub v: Vec<f64>,
    /// Accelerations of all nodes (D × nodes), m/s²; with midpoint kinematics the mean of the last step.
    pub a: Vec<f64>,
    /// Multipliers λ (r), in N over the unit of the row's gradient.
    pub lambda: Vec<f64>,
    /// Change of the accelerations in the last step (D × nodes), m/s², from which the next is predicted; zero where the
    /// step before was of another length. Multipliers are not extrapolated: what redundant rows leave undetermined of
    /// them would run away.
    pub a_change: Vec<f64>,
    /// Length of the last step, s.
    pub last_step: f64,
    /// What the integrator keeps from step to step.
    pub memory: Vec<f64>,
    /// Angles of joints and couplings, counted over all turns, rad.
    pub angle: Vec<f64>,
}

impl State {
    /// The start that a workspace was put at.
    pub(super) fn new(work: &Workspace) -> Self {
        Self {
            t: 0.0,
            x: work.x1.clone(),
            v: work.v1.clone(),
            a: work.a1.clone(),
            lambda: work.lambda.clone(),
            a_change: vec![0.0; work.a1.len()],
            last_step: 0.0,
            memory: work.memory.clone(),
            angle: work.at_start.functions.angle.clone(),
        }
    }

    /// Takes over another state of the same run, without allocating.
    pub(super) fn copy_from(&mut self, other: &Self) {
        (self.t, self.last_step) = (other.t, other.last_step);
        let own = [&mut self.x, &mut self.v, &mut self.a, &mut self.lambda, &mut self.a_change, &mut self.memory, &mut self.angle];
        let others = [&other.x, &other.v, &other.a, &other.lambda, &other.a_change, &other.memory, &other.angle];
        own.into_iter().zip(others).for_each(|(own, other)| own.copy_from_slice(other));
    }

    /// Copies the start of a step into a workspace.
    pub(super) fn load(&self, work: &mut Workspace) {
        work.x0.copy_from_slice(&self.x);
        work.v0.copy_from_slice(&self.v);
        work.x1.copy_from_slice(&self.x);
        work.v1.copy_from_slice(&self.v);
        work.a1.copy_from_slice(&self.a);
        work.lambda.copy_from_slice(&self.lambda);
        work.a_change.copy_from_slice(&self.a_change);
        work.memory.copy_from_slice(&self.memory);
        work.at_start.functions.angle.copy_from_slice(&self.angle);
    }

    /// Remembers how the accelerations changed in a step, for the prediction of the next.
    pub(super) fn remember(&mut self, step: f64, work: &Workspace) {
        // Two steps of the same length tell of a third; round-off of the times is no other length.
        let same = if (step - self.last_step).abs() <= 1e-9 * step { 1.0 } else { 0.0 };
        for (change, (new, old)) in self.a_change.iter_mut().zip(work.a1.iter().zip(&self.a)) {
            *change = same * (new - old);
        }
        self.last_step = step;
    }

    /// Takes over the end of a step: its position, evaluated there, its acceleration and multipliers.
    pub(super) fn land(&mut self, system: &System, target: f64, work: &mut Workspace) {
        let n = system.coordinates();
        for i in 0..n {
            work.x1[i] = work.x0[i] + work.d[i];
        }
        system.evaluate(&work.x1, target, &work.at_start, &mut work.at_end);
        self.angle.copy_from_slice(&work.at_end.functions.angle);
        self.t = target;
        self.x.copy_from_slice(&work.x1);
        self.a.copy_from_slice(&work.a1);
        self.lambda.copy_from_slice(&work.lambda);
        self.memory.copy_from_slice(&work.memory);
    }
}
