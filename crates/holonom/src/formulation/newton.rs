//! Newton's iteration, written once: for a single stage, for stages that are solved together, and for rows at both levels.

use super::dampers::Fit;
use super::failure::Failure;
use super::iteration::SolveSettings;
use super::kept::Kept;
use super::kkt::Kkt;
use super::pattern::ALL;
use super::rank::Rank;
use super::scales::Scales;
use super::workspace::Workspace;
use crate::system::System;

/// What solves the stages of a method: its settings, the matrix, and what is counted.
pub struct Newton {
    /// Numbers of the method that steer the solve.
    pub settings: SolveSettings,
    /// The matrix of a single stage.
    pub kkt: Kkt,
    /// Right side of the linear system, and its solution.
    pub unknowns: Vec<f64>,
    /// What a proximal term left of them.
    rest: Vec<f64>,
    /// δ of the proximal term (r).
    pub delta: Vec<f64>,
    /// Which rows are redundant.
    pub rank: Rank,
    /// What was last found of the dampers.
    pub fit: Fit,
    /// What the factors were last made of.
    pub(super) kept: Kept,
    /// Newton iterations so far, those of failed attempts included.
    pub iterations: u64,
    /// Factorisations so far, those of failed attempts included.
    pub factorizations: u64,
}

/// What quadratic equations leave of a first increment counts so many times, as it has the same sign in step after step.
pub(super) const SAME_SIGN: f64 = 1e3;

impl Newton {
    /// Plans the matrix of a system of these sizes.
    pub fn new(system: &System, scales: &Scales, settings: SolveSettings) -> Self {
        let kkt = Kkt::new(system, scales, 1, ALL);
        Self {
            settings,
            unknowns: vec![0.0; kkt.size()],
            rest: vec![0.0; kkt.size()],
            delta: vec![0.0; system.constraints()],
            rank: Rank::new(system.constraints(), system.coordinates()),
            fit: Fit::new(system),
            kept: Kept::new(system, kkt.is_changed_by_rows()),
            kkt,
            iterations: 0,
            factorizations: 0,
        }
    }

    /// Subtracts δ and factors the matrix; takes note of redundant rows.
    pub fn factor(&mut self, scales: &Scales) -> Result<(), Failure> {
        self.kkt.regularise(0, &self.delta);
        self.factorizations += 1;
        let outcome = self.kkt.factor();
        self.rank.classify(&outcome, &self.kkt, &self.delta, scales);
        outcome
    }

    /// Replaces the right side in `unknowns` by the solution.
    pub fn solve(&mut self) -> Result<(), Failure> {
        self.kkt.solve(&mut self.unknowns);
        if self.unknowns.iter().all(|u| u.is_finite()) { Ok(()) } else { Err(Failure::NotFinite) }
    }

    /// The same in the first iteration where proximal terms follow [from the rank](Newton::proximal_by_rank). Where they are more than
    /// hardly any, multipliers begin at zero, and every row is left off by δ times its multiplier, with the same sign in step after step. That
    /// is the right side of a second solution with the same factors.
    pub(super) fn solve_from_zero(&mut self) -> Result<(), Failure> {
        self.solve()?;
        if self.rank.is_full() {
            return Ok(());
        }
        let (coordinates, rows) = self.rest.split_at_mut(self.kkt.multiplier(0, 0));
        coordinates.fill(0.0);
        let multipliers = &self.unknowns[coordinates.len()..];
        rows.iter_mut().zip(&self.delta).zip(multipliers).for_each(|((row, delta), mu)| *row = -delta * mu);
        self.kkt.solve(&mut self.rest);
        self.unknowns.iter_mut().zip(&self.rest).for_each(|(unknown, rest)| *unknown += rest);
        Ok(())
    }

    /// Share of the first increment that is counted as left where rows have proximal terms [by rank](Newton::proximal_by_rank). Where nothing
    /// but rows with constant second derivatives bends, new factors leave its share of the shortest of them, and the share `multipliers` of their
    /// steps. Where a row hardly adds to the others, what is left moves positions by much, but so does what rounds the rows.
    pub(super) fn rest_of_first(&self, increment: f64, multipliers: f64, work: &Workspace) -> f64 {
        match (self.rank.is_full(), work.are_rows_quadratic()) {
            (true, true) => SAME_SIGN * (increment / work.scales.shortest).max(multipliers),
            (true, false) => 1.0,
            // The multipliers began at zero, and δ leaves a share of them that no increment shows.
            (false, _) => f64::INFINITY,
        }
    }
}

/// The equations of a step: unknowns, residual and tangent. Newton's iteration knows no more of them than this.
pub(super) trait Equations {
    /// Prepares the first iteration from the prediction in the workspace.
    fn begin(&mut self, newton: &mut Newton, work: &mut Workspace);

    /// Puts the unknowns where another attempt may begin, the `again`th after the first; no where there is no such place left.
    fn restart(&mut self, again: usize, newton: &mut Newton, work: &mut Workspace) -> bool;

    /// Where the prediction, evaluated, misses the rows by far: puts the unknowns where a better one may be. Whether it did.
    fn reconsider(&mut self, _newton: &mut Newton, _work: &mut Workspace) -> bool {
        false
    }

    /// Evaluates the residual at the unknowns; `is_new` says that the tangent is asked for next.
    fn evaluate(&mut self, is_new: bool, newton: &mut Newton, work: &mut Workspace);

    /// Whether the residual is nothing but round-off, row by row, and node by node unless the nodes no longer move
    /// and their energy shows what forces leave.
    fn is_met(&mut self, moves: bool, newton: &mut Newton, work: &mut Workspace) -> bool;

    /// Factors the tangent at the unknowns, for the first time in this attempt or again.
    fn factor(&mut self, is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure>;

    /// Solves for the residual and adds the solution to the unknowns.
    fn advance(&mut self, is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<Change, Failure>;

    /// Whether the rank turned out to be another one in the last factorisation: rows without a proximal term to speak of may have
    /// become redundant, whose pivots are round-off. Gives them one.
    fn guards_rank(&mut self, newton: &mut Newton, work: &Workspace) -> bool;

    /// Share of the first increment that may be left: all of it where nothing is known of it before there is a second.
    fn rest_of_first(&self, _change: &Change, _newton: &Newton, _work: &Workspace) -> f64 {
        1.0
    }

    /// Iterations with kept factors that are cheaper than new ones.
    fn kept(&self, _newton: &Newton, _work: &Workspace) -> i32 {
        KEPT
    }
}

/// By how much an iteration changed the unknowns.
pub(super) struct Change {
    /// Largest increment of a coordinate, over the size of the mechanism.
    pub increment: f64,
    /// Largest step of a multiplier: how far it would move a node of its row, over the same.
    pub multipliers: f64,
    /// Share of the equations that the solution with the factors left.
    pub left: f64,
}

/// Iterations with kept factors that are cheaper than new ones of the whole matrix.
pub(super) const KEPT: i32 = 4;

/// Shares of the free flight h v from which Newton starts again where the prediction led nowhere: with large steps the
/// acceleration of the last step says little of this one.
pub(super) const RESTARTS: [f64; 3] = [1.0, 0.5, 0.0];

/// Solves the equations from the prediction, and from where they can be started again while that fails. With a fixed number
/// of iterations there is one attempt.
pub(super) fn iterate(equations: &mut impl Equations, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
    let mut outcome = attempt(equations, true, newton, work);
    let mut again = 0;
    while outcome.is_err() && newton.settings.iterations.is_none() && equations.restart(again, newton, work) {
        outcome = attempt(equations, false, newton, work);
        again += 1;
    }
    outcome
}

/// One attempt from where the unknowns are, which `is_predicted` says are expected to be near the solution.
pub(super) fn attempt(
    equations: &mut impl Equations,
    is_predicted: bool,
    newton: &mut Newton,
    work: &mut Workspace,
) -> Result<(), Failure> {
    let settings = newton.settings;
    newton.rank.spares_regular = false;
    work.scales.measure_from(&work.start.x);
    equations.begin(newton, work);
    let mut convergence = Convergence::new(&settings, work.scales.shortest, equations.kept(newton, work));
    for iteration in 1..=settings.max_iterations {
        let keeps = convergence.keeps_factors();
        equations.evaluate(!keeps, newton, work);
        let is_astray = || work.scaled_violation() > ASTRAY * work.scales.shortest;
        if iteration == 1 && is_predicted && settings.iterations.is_none() && is_astray() && equations.reconsider(newton, work) {
            equations.evaluate(!keeps, newton, work);
        }
        if convergence.may_be_met(work.scales.are_light) && equations.is_met(convergence.moves(newton.rank.weakest), newton, work) {
            return Ok(());
        }
        if !keeps {
            equations.factor(iteration == 1, newton, work)?;
            if settings.iterations.is_none() && equations.guards_rank(newton, work) {
                equations.evaluate(true, newton, work);
                equations.factor(true, newton, work)?;
            }
        }
        let change = equations.advance(iteration == 1, newton, work)?;
        newton.iterations += 1;
        let rest_of_first = if iteration == 1 { equations.rest_of_first(&change, newton, work) } else { 1.0 };
        if convergence.is_reached(&change, rest_of_first, newton.rank.leaves()) {
            return Ok(());
        }
        if convergence.is_lost() {
            return Err(not_converged(iteration, change.increment, work));
        }
    }
    Err(not_converged(settings.max_iterations, convergence.increment, work))
}

/// A failure that tells an increment as a share of the mechanism's size, also where the unit of increments is more.
fn not_converged(iterations: usize, increment: f64, work: &Workspace) -> Failure {
    Failure::NotConverged { iterations, increment: increment * (work.scales.unit / work.scales.length) }
}

/// Increments of this share of the mechanism are the rounding of positions; what they leave of the energy is for its audit.
const ROUNDED: f64 = 2.0 * f64::EPSILON;

/// Increments no longer shrink where one is more than this share of that before. Near a singular position they fall slowly, and what
/// they leave is no round-off: only near the rounding of positions a fall may be chance.
const SLOW: f64 = 0.7;
const CHANCE: f64 = 0.1;
const NEAR_ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Round-off moves light nodes by up to this share of the mechanism: their residual says sooner than their increments that
/// nothing else is left.
const NEAR: f64 = 1e-11;

/// Share of the tolerance that may be left there.
const LEFT: f64 = 0.01;

/// A prediction that misses a row by more than this share of the shortest one is a guess like others.
const ASTRAY: f64 = 0.1;

/// An attempt whose increments have not halved in so many iterations leads nowhere.
const PATIENCE: usize = 10;

/// How a Newton iteration goes: sizes of its increments, relative to the mechanism.
struct Convergence {
    tolerance: f64,
    shortest: f64,
    kept: i32,
    /// Iterations that are left where their number is fixed.
    left: Option<usize>,
    /// Last increment of the coordinates.
    increment: f64,
    /// Last increment of coordinates or multipliers, whichever was larger: what the matrix changes by.
    turn: f64,
    /// What the last increment is expected to leave but for the rounding of the next: its product with the share that the
    /// linearisation or the solution with the factors leaves.
    left_over: f64,
    /// What the factors in use are off by.
    stale: f64,
    /// Share of an increment that the next one with the same factors came to.
    contraction: f64,
    stalls: bool,
    /// The increment that was last less than half of the one here before, and the iterations since.
    best: f64,
    since: usize,
}

impl Convergence {
    /// `shortest` is the length of the shortest row over that of the mechanism: it turns by so much more. Factors are kept for
    /// up to `kept` iterations.
    fn new(settings: &SolveSettings, shortest: f64, kept: i32) -> Self {
        Self {
            shortest,
            kept,
            tolerance: settings.tolerance,
            left: settings.iterations,
            increment: f64::INFINITY,
            turn: f64::INFINITY,
            left_over: f64::INFINITY,
            stale: 0.0,
            contraction: 0.0,
            stalls: false,
            best: f64::INFINITY,
            since: 0,
        }
    }

    /// Whether the residual may be nothing but round-off: increments no longer shrink, or come near the round-off of light nodes
    /// and leave hardly anything: what they leave has the same sign in step after step.
    fn may_be_met(&self, are_light: bool) -> bool {
        self.stalls || (are_light && self.increment < NEAR && self.left_over <= LEFT * self.tolerance)
    }

    /// Whether increments are more than the rounding of positions, or have not been that for a while. What a row hardly holds, which
    /// adds `weakest` to the others, is rounded by as much more.
    fn moves(&self, weakest: f64) -> bool {
        self.increment > ROUNDED / weakest.sqrt() || self.since < PATIENCE / 2
    }

    /// Whether increments have not shrunk for long.
    fn is_lost(&self) -> bool {
        self.left.is_none() && self.since >= PATIENCE
    }

    /// Whether the factors serve the iterations to come: they are off by all that has turned since they were made, or by
    /// what increments with them left, and each leaves that much of the one before.
    fn keeps_factors(&mut self) -> bool {
        let stale = (self.stale + self.turn).max(self.contraction);
        let keeps = self.left.is_none() && self.increment * stale.powi(self.kept) <= self.tolerance;
        (self.stale, self.contraction) = if keeps { (stale, self.contraction) } else { (0.0, 0.0) };
        keeps
    }

    /// Takes note of a change; says whether what remains is within tolerance. The remainder is as much smaller as the increment
    /// was than the one before, and no less than its product with that of the multipliers, which Newton's linearisation of Gᵀλ
    /// leaves out. Of the first increment the share `rest_of_first` may remain. Where the increment before was round-off the ratio says
    /// nothing, and proximal terms leave the share `leaves`.
    fn is_reached(&mut self, change: &Change, rest_of_first: f64, leaves: f64) -> bool {
        if let Some(left) = &mut self.left {
            *left -= 1;
            return *left == 0;
        }
        let (increment, multipliers) = (change.increment, change.multipliers.max(change.left));
        let contraction = match self.increment {
            before if before.is_infinite() => rest_of_first,
            before if before <= NEAR_ROUNDED => leaves,
            before => (increment / before).min(1.0),
        };
        let remaining = increment * contraction.max(multipliers).max(self.stale);
        self.left_over = increment * multipliers.max(self.stale);
        self.contraction = if self.stale > 0.0 { self.contraction.max(contraction) } else { 0.0 };
        (self.best, self.since) = if increment < 0.5 * self.best { (increment, 0) } else { (self.best, self.since + 1) };
        self.stalls = increment > self.increment * if increment > NEAR_ROUNDED { SLOW } else { CHANCE };
        (self.increment, self.turn) = (increment, (increment / self.shortest).max(multipliers));
        remaining <= self.tolerance
    }
}
