//! Numbers of a moment: what a step starts from and leaves.

use serde::{Deserialize, Serialize};

use crate::formulation::Workspace;
use crate::integrator::{Differences, MOTION, MULTIPLIERS, Squares, extrapolate, is_same_length};
use crate::system::{Look, System};

/// Numbers of a moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Predicted change of the accelerations in the next step (D × nodes), m/s²; zero where the last two steps were of
    /// different lengths.
    pub a_change: Vec<f64>,
    /// Backward differences of the accelerations up to the last step (D × nodes), m/s², zero in the same cases.
    pub a_differences: Vec<Differences<MOTION>>,
    /// Squares of these, summed over the coordinates, at the last step and the one before it, m²/s⁴.
    pub a_squares: Squares<MOTION>,
    /// Predicted change of the multipliers in the next step (r), zero in the same cases. Only a tangent is built with it: what
    /// redundant rows leave undetermined of the multipliers would run away.
    pub lambda_change: Vec<f64>,
    /// Backward differences of the multipliers up to the last step (r), zero in the same cases.
    pub lambda_differences: Vec<Differences<MULTIPLIERS>>,
    /// Squares of these, each times that of its row's reach, summed over the rows, at the last step and the one before it.
    pub lambda_squares: Squares<MULTIPLIERS>,
    /// Length of the last step, s.
    pub last_step: f64,
    /// What the integrator keeps from step to step.
    pub memory: Vec<f64>,
    /// Angles of joints and couplings, counted over all turns, rad.
    pub angle: Vec<f64>,
    /// The same of the angles that are measured beside the equations.
    pub measured: Vec<f64>,
    /// Numbers from outside, as they were set last.
    #[serde(default)]
    pub inputs: Vec<f64>,
}

impl State {
    /// The start that a workspace was put at, at the time `t` (s).
    pub(super) fn new(t: f64, work: &Workspace, measured: &[f64]) -> Self {
        Self {
            t,
            x: work.end.x.clone(),
            v: work.end.v.clone(),
            a: work.a.clone(),
            lambda: work.lambda.clone(),
            a_change: vec![0.0; work.a.len()],
            a_differences: vec![Differences::default(); work.a.len()],
            a_squares: Squares::default(),
            lambda_change: vec![0.0; work.lambda.len()],
            lambda_differences: vec![Differences::default(); work.lambda.len()],
            lambda_squares: Squares::default(),
            last_step: 0.0,
            memory: work.memory.clone(),
            angle: work.start.at.functions.angle.clone(),
            measured: measured.to_vec(),
            inputs: work.inputs.clone(),
        }
    }

    /// Whether it is one of `system`, but for what the integrator keeps.
    pub(super) fn fits(&self, system: &System) -> bool {
        let all = system.nodes() * system.dim;
        [&self.x, &self.v, &self.a, &self.a_change].iter().all(|values| values.len() == all)
            && self.a_differences.len() == all
            && [&self.lambda, &self.lambda_change].iter().all(|values| values.len() == system.constraints())
            && self.lambda_differences.len() == system.constraints()
            && self.angle.len() == system.evaluation().functions.angle.len()
            && self.inputs.len() == system.inputs.len()
            && self.measured.len() == system.gauge_values().counted().len()
    }

    /// Whether where it is, and when, are numbers.
    pub(super) fn is_finite(&self) -> bool {
        let numbers = [&self.x, &self.v, &self.angle, &self.inputs];
        self.t.is_finite() && numbers.into_iter().flatten().all(|number| number.is_finite())
    }

    /// Takes over another state of the same run, without allocating.
    pub(super) fn copy_from(&mut self, other: &Self) {
        (self.t, self.last_step) = (other.t, other.last_step);
        (self.a_squares, self.lambda_squares) = (other.a_squares, other.lambda_squares);
        self.a_differences.copy_from_slice(&other.a_differences);
        self.lambda_differences.copy_from_slice(&other.lambda_differences);
        let accelerations = [(&mut self.a, &other.a), (&mut self.a_change, &other.a_change)];
        let rest = [
            (&mut self.lambda, &other.lambda),
            (&mut self.lambda_change, &other.lambda_change),
            (&mut self.memory, &other.memory),
            (&mut self.angle, &other.angle),
            (&mut self.measured, &other.measured),
            (&mut self.inputs, &other.inputs),
        ];
        let places = [(&mut self.x, &other.x), (&mut self.v, &other.v)];
        places.into_iter().chain(accelerations).chain(rest).for_each(|(own, other)| own.copy_from_slice(other));
    }

    /// Copies the start of a step into a workspace.
    pub(super) fn load(&self, work: &mut Workspace) {
        work.start.x.copy_from_slice(&self.x);
        work.start.v.copy_from_slice(&self.v);
        work.end.x.copy_from_slice(&self.x);
        work.end.v.copy_from_slice(&self.v);
        work.a.copy_from_slice(&self.a);
        work.lambda.copy_from_slice(&self.lambda);
        work.prediction.a_change.copy_from_slice(&self.a_change);
        work.prediction.lambda_change.copy_from_slice(&self.lambda_change);
        work.memory.copy_from_slice(&self.memory);
        work.inputs.copy_from_slice(&self.inputs);
        work.start.at.functions.angle.copy_from_slice(&self.angle);
    }

    /// The mechanism as it would be later by so much time, s, at its present velocities, at the end in a workspace.
    pub(super) fn look_ahead<'a>(&'a self, by: f64, system: &System, work: &'a mut Workspace) -> Look<'a> {
        let (t, end) = (self.t + by, &mut work.end);
        end.x.iter_mut().zip(self.x.iter().zip(&self.v)).for_each(|(end, (x, v))| *end = x + by * v);
        end.v.copy_from_slice(&self.v);
        system.place_known(t, &mut end.x, &mut end.v, &mut work.a);
        system.evaluate(&end.x, t, &work.start.at, &mut end.at);
        Look { x: &end.x, v: &end.v, t, at: &end.at, inputs: &self.inputs, span: None }
    }

    /// Remembers how accelerations, `a` at the end, and multipliers changed in a step, for the prediction of the next.
    pub(super) fn remember(&mut self, step: f64, a: &[f64], work: &Workspace) {
        let follows = is_same_length(step, self.last_step);
        extrapolate(&mut self.a_differences, &mut self.a_squares, &mut self.a_change, follows, |k| a[k] - self.a[k], |_| 1.0);
        let (lambda, reach) = (|k: usize| work.lambda[k] - self.lambda[k], |k: usize| work.scales.reach[k].powi(2));
        extrapolate(&mut self.lambda_differences, &mut self.lambda_squares, &mut self.lambda_change, follows, lambda, reach);
        self.last_step = step;
    }

    /// Takes over the end of a step: its position, evaluated there, its acceleration `a` and multipliers.
    pub(super) fn land(&mut self, target: f64, a: &[f64], work: &Workspace) {
        self.angle.copy_from_slice(&work.end.at.functions.angle);
        self.t = target;
        self.x.copy_from_slice(&work.end.x);
        self.a.copy_from_slice(a);
        self.lambda.copy_from_slice(&work.lambda);
        self.memory.copy_from_slice(&work.memory);
    }
}
