//! The nonlinear solve of a stage: exact Newton, and the paper's nested and simultaneous loops (§4).

use super::failure::Failure;
use super::level::Level;
use super::newton::{Change, Equations, KEPT, Newton, RESTARTS, iterate};
use super::stage::{RowsAt, Sampling, Stage};
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::System;

/// Where multipliers come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Multipliers {
    /// λ = αΦ (5), (14), or α times the rows' condition (6).
    Penalty(f64),
    /// λ sought with Φ = 0 (7), (17); the penalty α steers the iteration only. Without one it follows from the step.
    Augmented(Option<f64>),
}

/// How the multipliers of the augmented Lagrangian are iterated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Iteration {
    /// Proximal-KKT Newton: coordinates and multipliers together, quadratic convergence.
    Newton,
    /// One loop; λ ← λ + αΦ after each Newton increment of the coordinates.
    Simultaneous,
    /// Newton on the coordinates at fixed λ inside, λ ← λ + αΦ outside.
    Nested,
}

/// Name, value and one line of documentation of every iteration.
pub const ITERATIONS: &[(&str, Iteration, &str)] = &[
    ("newton", Iteration::Newton, "proximal-KKT Newton: quadratic convergence, no penalty to tune (default)"),
    ("simultaneous", Iteration::Simultaneous, "the paper's single loop: λ ← λ + αΦ after every increment (§4)"),
    ("nested", Iteration::Nested, "the paper's two loops: Newton inside, λ ← λ + αΦ outside (§4)"),
];

/// Numbers that steer the solve.
#[derive(Clone, Copy, Debug)]
pub struct SolveSettings {
    /// Rows at position and velocity level, with a multiplier each.
    pub doubled: bool,
    /// The condition the rows stand for.
    pub level: Level,
    /// Whether λ is sought or follows from a penalty.
    pub multipliers: Multipliers,
    /// How λ is sought.
    pub iteration: Iteration,
    /// Newton: estimated remaining increment relative to the size of the mechanism. The paper's loops: 2-norm of the
    /// increment, m (and of Φ in the outer loop).
    pub tolerance: f64,
    /// Most factorisations in one step.
    pub max_iterations: usize,
    /// Exactly so many Newton iterations with new factors each, whatever they leave: no step costs more than another.
    pub iterations: Option<usize>,
}

/// Dimensionless penalty of the paper's loops where the user gives none (methods §3).
const LOOP_RHO: f64 = 1e6;

/// Tolerance of the outer loop on ‖Φ‖ over that of the inner one on ‖Δq‖: λ moves by αΦ, so that with the paper's α
/// the force is only as exact as the position when Φ is this much smaller.
const OUTER_SHARE: f64 = 1e-3;

/// Solves a stage from the increment and multipliers in the workspace.
pub fn solve(system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
    let multipliers = newton.settings.multipliers;
    match (multipliers, newton.settings.iteration) {
        (Multipliers::Augmented(alpha), Iteration::Simultaneous) => simultaneous(system, stage, alpha, newton, work),
        (Multipliers::Augmented(alpha), Iteration::Nested) => nested(system, stage, alpha, newton, work),
        _ => iterate(&mut OneStage { system, stage, multipliers }, newton, work),
    }
}

/// Coordinates and multipliers of one stage together. With a penalty the rows are Φ − λ/α = 0.
pub(super) struct OneStage<'a> {
    pub system: &'a System,
    pub stage: &'a Stage,
    pub multipliers: Multipliers,
}

/// Iterations with kept factors that are cheaper than new ones of a part of the matrix.
const KEPT_IN_PART: i32 = 2;

impl OneStage<'_> {
    /// Whether proximal terms follow from the rank. Where violations are held, redundant rows that miss each other would not let their
    /// multipliers settle.
    fn is_by_rank(&self, work: &Workspace) -> bool {
        self.multipliers == Multipliers::Augmented(None) && work.level == Level::POSITION && self.stage.rows != RowsAt::Mean
    }
}

impl Equations for OneStage<'_> {
    fn begin(&mut self, newton: &mut Newton, work: &mut Workspace) {
        let Stage { rate, inertia, .. } = *self.stage;
        match self.multipliers {
            Multipliers::Penalty(alpha) => newton.delta.fill(work.level.scale(rate, inertia) / (inertia * alpha)),
            _ if self.is_by_rank(work) => {
                newton.proximal_by_rank(&work.scales);
                work.expect_multipliers(newton.rank.is_full());
            }
            Multipliers::Augmented(penalty) => {
                newton.proximal(inertia, penalty, &work.scales);
                newton.leave_out(&work.scales);
            }
        }
        [&mut work.lambda, &mut work.prediction.lambda_change].into_iter().for_each(|multipliers| newton.rank.leave_out_of(multipliers));
    }

    fn restart(&mut self, again: usize, _newton: &mut Newton, work: &mut Workspace) -> bool {
        RESTARTS.get(again).map(|&share| restart(share, work)).is_some()
    }

    /// The share of the free flight that misses the rows least, if one misses them by less than the prediction: parts that turn
    /// often in a step are nowhere near where their last accelerations lead. The expected multipliers stay.
    fn reconsider(&mut self, newton: &mut Newton, work: &mut Workspace) -> bool {
        if self.stage.sampling != Sampling::Between || work.level != Level::POSITION {
            return false;
        }
        let (mut least, mut best) = (work.scaled_violation(), None);
        for share in RESTARTS {
            fly(share, work);
            self.evaluate(true, newton, work);
            let missed = work.scaled_violation();
            if missed < least {
                (least, best) = (missed, Some(share));
            }
        }
        match best {
            Some(share) => fly(share, work),
            None => predict(self.stage, work),
        }
        true
    }

    fn evaluate(&mut self, _is_new: bool, newton: &mut Newton, work: &mut Workspace) {
        work.place(self.stage);
        work.evaluate(self.system, self.stage);
        if let Multipliers::Penalty(alpha) = self.multipliers {
            let softness = work.level.scale(self.stage.rate, self.stage.inertia) / alpha;
            work.phi.iter_mut().zip(&work.lambda).for_each(|(phi, lambda)| *phi -= softness * lambda);
        }
        work.residual(self.system, self.stage, &mut newton.unknowns);
    }

    fn is_met(&mut self, moves: bool, newton: &mut Newton, work: &mut Workspace) -> bool {
        // Only the schemes between two positions have an energy that shows what forces leave.
        work.is_met(self.system, self.stage, moves || self.stage.sampling != Sampling::Between, &newton.unknowns, &newton.rank)
    }

    fn factor(&mut self, is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        newton.factor_tangent(self.system, self.stage, is_first, work)
    }

    fn guards_rank(&mut self, newton: &mut Newton, work: &Workspace) -> bool {
        newton.guards_rank(&work.scales)
    }

    fn advance(&mut self, is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<Change, Failure> {
        let inertia = self.stage.inertia;
        if is_first && self.is_by_rank(work) {
            newton.solve_from_zero()?
        } else {
            newton.solve()?
        };
        let (increments, mu) = newton.unknowns.split_at(self.system.coordinates());
        let increment = advance(increments, work);
        work.lambda.iter_mut().zip(mu).for_each(|(lambda, mu)| *lambda += mu / inertia);
        Ok(Change { increment, multipliers: work.turned(inertia, mu), left: 0.0 })
    }

    fn rest_of_first(&self, change: &Change, newton: &Newton, work: &Workspace) -> f64 {
        match self.stage.sampling {
            Sampling::Between if self.is_by_rank(work) => newton.rest_of_first(change.increment, change.multipliers, work),
            _ => 1.0,
        }
    }

    fn kept(&self, newton: &Newton, work: &Workspace) -> i32 {
        if newton.is_factored_in_part(self.stage, work.level) { KEPT_IN_PART } else { KEPT }
    }
}

/// Puts the increment where the velocity at the start and the accelerations that are expected lead, with v̄ = Δq/h. Where these
/// lead farther than the mechanism is large, something stiff is not at rest: they will not last, and the velocity is the better guess.
pub fn predict(stage: &Stage, work: &mut Workspace) {
    let Workspace { d, a, prediction, scales, .. } = work;
    if stage.inertia.abs() * largest(&a[..d.len()]) > scales.length {
        d.copy_from_slice(&prediction.drift);
        return;
    }
    for (((d, drift), a), change) in d.iter_mut().zip(&prediction.drift).zip(a).zip(&prediction.a_change) {
        *d = *drift + stage.inertia * (*a + *change);
    }
}

/// Puts the increment at a share of the free flight.
fn fly(share: f64, work: &mut Workspace) {
    work.d.iter_mut().zip(&work.prediction.drift).for_each(|(d, drift)| *d = share * drift);
}

/// The same without multipliers.
pub(super) fn restart(share: f64, work: &mut Workspace) {
    fly(share, work);
    work.lambda.fill(0.0);
    work.prediction.lambda_change.fill(0.0);
}

/// Adds the solution to the increment; its largest entry over the size of the mechanism.
fn advance(increments: &[f64], work: &mut Workspace) -> f64 {
    work.d.iter_mut().zip(increments).for_each(|(d, step)| *d += step);
    largest(increments) / work.scales.unit
}

/// Sets δ to what a penalty stands for, and says how λ changes with Φ: α for each row.
fn penalties(stage: &Stage, penalty: Option<f64>, newton: &mut Newton, work: &Workspace) {
    let scale = work.level.scale(stage.rate, stage.inertia);
    for (delta, &softness) in newton.delta.iter_mut().zip(&work.scales.softness) {
        *delta = penalty.map_or(softness / LOOP_RHO, |alpha| scale / (stage.inertia * alpha));
    }
    newton.leave_out(&work.scales);
}

/// One increment of the coordinates at the multipliers λ + αΦ; its 2-norm, m.
fn increment(system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Result<f64, Failure> {
    work.place(stage);
    work.evaluate(system, stage);
    work.residual(system, stage, &mut newton.unknowns);
    work.tangent(system, stage, 0.0, &mut newton.kkt);
    newton.factor(&work.scales)?;
    newton.solve()?;
    let increments = &newton.unknowns[..system.coordinates()];
    advance(increments, work);
    newton.iterations += 1;
    Ok(increments.iter().map(|u| u * u).sum::<f64>().sqrt())
}

/// λ ← λ + αΦ at the present position; the 2-norm of Φ.
fn update_multipliers(system: &System, stage: &Stage, newton: &Newton, work: &mut Workspace) -> f64 {
    work.place(stage);
    work.evaluate(system, stage);
    for ((lambda, phi), delta) in work.lambda.iter_mut().zip(&work.phi).zip(&newton.delta) {
        *lambda += phi / (delta * stage.inertia);
    }
    work.phi.iter().map(|phi| phi * phi).sum::<f64>().sqrt()
}

fn simultaneous(system: &System, stage: &Stage, penalty: Option<f64>, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
    penalties(stage, penalty, newton, work);
    let settings = newton.settings;
    let mut size = f64::INFINITY;
    for _ in 0..settings.max_iterations {
        size = increment(system, stage, newton, work)?;
        update_multipliers(system, stage, newton, work);
        if size < settings.tolerance {
            return Ok(());
        }
    }
    Err(Failure::NotConverged { iterations: settings.max_iterations, increment: size / work.scales.length })
}

fn nested(system: &System, stage: &Stage, penalty: Option<f64>, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
    penalties(stage, penalty, newton, work);
    let settings = newton.settings;
    let mut size = f64::INFINITY;
    for _ in 0..settings.max_iterations {
        size = increment(system, stage, newton, work)?;
        if size < settings.tolerance && update_multipliers(system, stage, newton, work) < OUTER_SHARE * settings.tolerance {
            return Ok(());
        }
    }
    Err(Failure::NotConverged { iterations: settings.max_iterations, increment: size / work.scales.length })
}
