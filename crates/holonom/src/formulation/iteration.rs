//! The nonlinear solve of a stage: exact Newton, and the paper's nested and simultaneous loops (§4).

use super::level::Level;
use super::stage::{RowsAt, Stage};
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
    pub multipliers: Multipliers,
    pub iteration: Iteration,
    /// Newton: estimated remaining increment relative to the size of the mechanism. The paper's loops: 2-norm of the
    /// increment, m (and of Φ in the outer loop).
    pub tolerance: f64,
    /// Most factorisations in one step.
    pub max_iterations: usize,
    /// Exactly so many Newton iterations with new factors each, whatever they leave: no step costs more than another.
    pub iterations: Option<usize>,
}

impl SolveSettings {
    /// Where Newton starts again: nowhere with a fixed number of iterations.
    pub(super) fn restarts(&self) -> &'static [f64] {
        if self.iterations.is_some() { &[] } else { &RESTARTS }
    }
}

/// Why a stage was not solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    #[error("the iteration did not converge in {0} steps")]
    NotConverged(usize),
    #[error("the iteration produced numbers that are not finite")]
    NotFinite,
    #[error("no step is short enough for the accuracy")]
    TooSmall,
}

/// Violation and momentum residual, relative, at which a stalled increment is accepted: near singular configurations
/// the nearly free directions keep moving while everything that matters is met (methods §11).
pub(super) const STALLED: f64 = 1e-12;

/// Dimensionless penalty of the paper's loops where the user gives none (methods §1.2).
const LOOP_RHO: f64 = 1e6;

/// Tolerance of the outer loop on ‖Φ‖ over that of the inner one on ‖Δq‖: λ moves by αΦ, so that with the paper's α
/// the force is only as exact as the position when Φ is this much smaller.
const OUTER_SHARE: f64 = 1e-3;

/// Shares of the free flight h v from which Newton starts again where the prediction led nowhere: with large steps the
/// acceleration of the last step says little of this one.
const RESTARTS: [f64; 3] = [1.0, 0.5, 0.0];

/// Solves a stage from the increment and multipliers in the workspace; says how many iterations it took.
pub fn solve(system: &System, stage: &Stage, settings: &SolveSettings, work: &mut Workspace) -> Result<usize, Failure> {
    match (settings.multipliers, settings.iteration) {
        (Multipliers::Penalty(alpha), _) => newton_from_predictions(system, stage, settings, Some(alpha), work),
        (Multipliers::Augmented(_), Iteration::Newton) => newton_from_predictions(system, stage, settings, None, work),
        (Multipliers::Augmented(alpha), Iteration::Simultaneous) => simultaneous(system, stage, settings, alpha, work),
        (Multipliers::Augmented(alpha), Iteration::Nested) => nested(system, stage, settings, alpha, work),
    }
}

/// Newton from the prediction in the workspace, and from the free flight and shares of it where that fails.
fn newton_from_predictions(
    system: &System,
    stage: &Stage,
    settings: &SolveSettings,
    soft: Option<f64>,
    work: &mut Workspace,
) -> Result<usize, Failure> {
    let mut outcome = newton(system, stage, settings, soft, work);
    let mut spent = 0;
    for &share in settings.restarts() {
        if outcome.is_ok() {
            break;
        }
        spent += settings.max_iterations;
        restart(share, work);
        outcome = newton(system, stage, settings, soft, work);
    }
    outcome.map(|iterations| spent + iterations)
}

/// Puts the increment at a share of the free flight, without multipliers.
pub(super) fn restart(share: f64, work: &mut Workspace) {
    for (d, drift) in work.d.iter_mut().zip(&work.drift) {
        *d = share * drift;
    }
    work.lambda.fill(0.0);
    work.lambda_change.fill(0.0);
}

/// Newton on coordinates and multipliers together. With `soft` the rows are Φ − λ/α = 0, the penalty formulation.
fn newton(system: &System, stage: &Stage, settings: &SolveSettings, soft: Option<f64>, work: &mut Workspace) -> Result<usize, Failure> {
    let n = system.coordinates();
    match (soft, settings.multipliers) {
        (Some(alpha), _) => work.delta.fill(work.level.scale(stage.rate, stage.inertia) / (stage.inertia * alpha)),
        // Where violations are held, redundant rows that miss each other would not let their multipliers settle.
        (None, Multipliers::Augmented(None)) if work.level == Level::POSITION && stage.rows != RowsAt::Mean => {
            work.proximal_of_redundant();
            work.expect_multipliers();
        }
        (None, Multipliers::Augmented(penalty)) => work.proximal(stage.inertia, penalty),
        (None, Multipliers::Penalty(_)) => unreachable!("a penalty is soft"),
    }
    let kept = if work.is_factored_in_part(stage) { KEPT_IN_PART } else { KEPT };
    let mut convergence = Convergence::new(settings, work.shortest, kept);
    for iteration in 1..=settings.max_iterations {
        work.place(stage);
        work.evaluate(system, stage);
        if let Some(alpha) = soft {
            let softness = work.level.scale(stage.rate, stage.inertia) / alpha;
            work.phi.iter_mut().zip(&work.lambda).for_each(|(phi, lambda)| *phi -= softness * lambda);
        }
        work.residual(system, stage);
        if convergence.stalls() && is_met(n, work) {
            return Ok(iteration - 1);
        }
        if !convergence.keeps_factors() {
            work.factor_tangent(system, stage, iteration == 1)?;
        }
        work.solve()?;
        let increment = advance(n, work);
        work.lambda.iter_mut().zip(&work.unknowns[n..]).for_each(|(lambda, mu)| *lambda += mu / stage.inertia);
        let turned = work.turned(stage.inertia, n);
        if convergence.is_reached(increment, turned) {
            return Ok(iteration);
        }
    }
    Err(Failure::NotConverged(settings.max_iterations))
}

/// Iterations with kept factors that are cheaper than new ones of the whole matrix, and of a part of it.
pub(super) const KEPT: i32 = 4;
const KEPT_IN_PART: i32 = 2;

/// How a Newton iteration goes: sizes of its increments, relative to the mechanism.
pub(super) struct Convergence {
    tolerance: f64,
    shortest: f64,
    kept: i32,
    /// Iterations that are left where their number is fixed.
    left: Option<usize>,
    /// Last increment of the coordinates.
    increment: f64,
    /// Last increment of coordinates or multipliers, whichever was larger: what the matrix changes by.
    turn: f64,
    /// What the factors in use are off by.
    stale: f64,
    /// Share of an increment that the next one with the same factors came to.
    contraction: f64,
    stalls: bool,
}

impl Convergence {
    /// `shortest` is the length of the shortest row over that of the mechanism: it turns by so much more. Factors are kept for
    /// up to `kept` iterations.
    pub(super) fn new(settings: &SolveSettings, shortest: f64, kept: i32) -> Self {
        Self {
            shortest,
            kept,
            tolerance: settings.tolerance,
            left: settings.iterations,
            increment: f64::INFINITY,
            turn: f64::INFINITY,
            stale: 0.0,
            contraction: 0.0,
            stalls: false,
        }
    }

    /// Whether increments are small but no longer shrink.
    pub(super) fn stalls(&self) -> bool {
        self.stalls
    }

    /// Whether the factors serve the iterations to come: they are off by all that has turned since they were made, or by
    /// what increments with them left, and each leaves that much of the one before.
    pub(super) fn keeps_factors(&mut self) -> bool {
        let stale = (self.stale + self.turn).max(self.contraction);
        let keeps = self.left.is_none() && self.increment * stale.powi(self.kept) <= self.tolerance;
        (self.stale, self.contraction) = if keeps { (stale, self.contraction) } else { (0.0, 0.0) };
        keeps
    }

    /// Takes note of an increment of coordinates and of multipliers; says whether what remains is within tolerance. The
    /// remainder is as much smaller as the increment was than the one before, and no less than its product with the
    /// turn, which Newton's linearisation of Gᵀλ leaves out.
    pub(super) fn is_reached(&mut self, increment: f64, multipliers: f64) -> bool {
        if let Some(left) = &mut self.left {
            *left -= 1;
            return *left == 0;
        }
        let contraction = if self.increment.is_finite() { (increment / self.increment).min(1.0) } else { 1.0 };
        let remaining = increment * contraction.max(multipliers).max(self.stale);
        self.contraction = if self.stale > 0.0 { self.contraction.max(contraction) } else { 0.0 };
        self.stalls = increment < 1e-6 && increment > 0.1 * self.increment;
        (self.increment, self.turn) = (increment, (increment / self.shortest).max(multipliers));
        remaining <= self.tolerance
    }
}

/// Adds the solution to the increment; its largest entry over the size of the mechanism.
fn advance(n: usize, work: &mut Workspace) -> f64 {
    work.d.iter_mut().zip(&work.unknowns).for_each(|(d, step)| *d += step);
    largest(&work.unknowns[..n]) / work.length
}

/// Whether rows and momentum are met although increments go on.
fn is_met(n: usize, work: &Workspace) -> bool {
    largest(&work.unknowns[..n]) <= STALLED * work.heaviest * work.length && work.scaled_violation() <= STALLED
}

/// Sets δ to what a penalty stands for, and says how λ changes with Φ: α for each row.
fn penalties(stage: &Stage, penalty: Option<f64>, work: &mut Workspace) {
    let scale = work.level.scale(stage.rate, stage.inertia);
    for (delta, &softness) in work.delta.iter_mut().zip(&work.softness) {
        *delta = penalty.map_or(softness / LOOP_RHO, |alpha| scale / (stage.inertia * alpha));
    }
}

/// One increment of the coordinates at the multipliers λ + αΦ; its 2-norm, m.
fn increment(system: &System, stage: &Stage, work: &mut Workspace) -> Result<f64, Failure> {
    work.place(stage);
    work.evaluate(system, stage);
    work.residual(system, stage);
    work.tangent(system, stage, 0.0);
    work.factor()?;
    work.solve()?;
    let n = system.coordinates();
    advance(n, work);
    Ok(work.unknowns[..n].iter().map(|u| u * u).sum::<f64>().sqrt())
}

/// λ ← λ + αΦ at the present position; the 2-norm of Φ.
fn update_multipliers(system: &System, stage: &Stage, work: &mut Workspace) -> f64 {
    work.place(stage);
    work.evaluate(system, stage);
    for ((lambda, phi), delta) in work.lambda.iter_mut().zip(&work.phi).zip(&work.delta) {
        *lambda += phi / (delta * stage.inertia);
    }
    work.phi.iter().map(|phi| phi * phi).sum::<f64>().sqrt()
}

fn simultaneous(
    system: &System,
    stage: &Stage,
    settings: &SolveSettings,
    penalty: Option<f64>,
    work: &mut Workspace,
) -> Result<usize, Failure> {
    penalties(stage, penalty, work);
    for iteration in 1..=settings.max_iterations {
        let size = increment(system, stage, work)?;
        update_multipliers(system, stage, work);
        if size < settings.tolerance {
            return Ok(iteration);
        }
    }
    Err(Failure::NotConverged(settings.max_iterations))
}

fn nested(system: &System, stage: &Stage, settings: &SolveSettings, penalty: Option<f64>, work: &mut Workspace) -> Result<usize, Failure> {
    penalties(stage, penalty, work);
    let mut iterations = 0;
    loop {
        loop {
            iterations += 1;
            if iterations > settings.max_iterations {
                return Err(Failure::NotConverged(settings.max_iterations));
            }
            if increment(system, stage, work)? < settings.tolerance {
                break;
            }
        }
        if update_multipliers(system, stage, work) < OUTER_SHARE * settings.tolerance {
            return Ok(iterations);
        }
    }
}
