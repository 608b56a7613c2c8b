//! Coordinate projections of velocity and acceleration (10)–(13): the nearest ones that satisfy the rows, in a metric A. The same of
//! positions, where steps are chosen for an accuracy by a method that lets them drift.

use crate::formulation::{Block, Failure, Kkt, Newton, RowsAt, Sampling, Stage, Workspace};
use crate::linalg::largest;
use crate::system::System;

/// The matrix A that measures the distance moved.
#[derive(Clone, Debug, PartialEq)]
pub enum Metric {
    /// A = M: never adds energy, keeps momenta (methods §18).
    Mass,
    /// A = 1.
    Identity,
    /// A = M + ½h C + ¼h² K with the stiffness and damping of the applied forces, as classical codes have it.
    Tangent,
    /// A weight for each free node, times the unit matrix.
    Custom(Vec<f64>),
}

/// How the minimum is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solve {
    /// With multipliers, to round-off.
    Exact,
    /// With the paper's penalty α: (11) and (13).
    Penalty(f64),
}

/// Projections after each step.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Whether positions are projected: M Δq + Gᵀλ = 0 with Φ(q + Δq) = 0.
    pub position: bool,
    /// Whether velocities are projected (10).
    pub velocity: bool,
    /// Whether accelerations are projected (12).
    pub acceleration: bool,
    /// The matrix A, of both.
    pub metric: Metric,
    /// By multipliers or by a penalty.
    pub solve: Solve,
    /// θ: v ← v* − θ(v* − v) (methods §18); 1 is the full projection.
    pub strength: f64,
    /// Shows the projected values and goes on with the others.
    pub shadow: bool,
}

/// Name and one line of documentation of every metric a model file can name.
pub const METRICS: &[(&str, &str)] = &[
    ("mass", "A = M: dissipates, keeps momenta (default)"),
    ("identity", "A = 1"),
    ("tangent", "A = M + ½h C + ¼h² K of the applied forces"),
    ("custom", "a weight for each point (key weights)"),
];

/// Name and one line of documentation of every way of solving.
pub const SOLVES: &[(&str, &str)] =
    &[("exact", "multipliers, to round-off (default)"), ("penalty", "the paper's penalty α (11), (13) (key penalty)")];

/// Passes of the exact projection; the second one already meets round-off, more are for redundant rows, and for velocities where the matrix is that of
/// positions which have been projected since.
const PASSES: usize = 6;

/// Largest metric whose violation is left alone, relative to the size of the velocities.
const ROUND_OFF: f64 = 1e-15;

/// Violation of positions, over the size of the mechanism, that is their rounding.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Rows that hardly differ from others are met slowly: each pass leaves the same share of what is missed. Where two shares in a row differ by no more
/// than `STEADY` of themselves, and are below `SLOWEST`, a pass adds what all that follow would, as of a geometric series.
const STEADY: f64 = 0.05;
const SLOWEST: f64 = 0.95;

/// A quantity that is projected: velocities or accelerations of all nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Level {
    Velocity,
    Acceleration,
}

impl Projection {
    /// Whether it is the full projection in the metric of the mass.
    pub fn is_by_mass(&self) -> bool {
        self.metric == Metric::Mass && self.solve == Solve::Exact && self.strength == 1.0
    }

    /// Projects the positions at the end of a workspace's step, where the rows are evaluated. The matrix stays that of the positions as they
    /// were found, from which a step drifts by its error only. At a singular position, where that does not bring them closer to the rows,
    /// they stay where they are.
    pub fn place(&self, system: &System, time: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        if !self.position {
            return Ok(());
        }
        self.factor(system, time, step, newton, work)?;
        let n = system.coordinates();
        work.full[..n].copy_from_slice(&work.end.x[..n]);
        let (mut least, mut before) = (f64::INFINITY, 0.0);
        for _ in 0..=PASSES {
            system.constraint_values(&work.end.at, time, &mut work.phi);
            let violation = work.scaled_violation();
            if violation.is_nan() || violation >= least {
                work.end.x[..n].copy_from_slice(&work.full[..n]);
                system.evaluate(&work.end.x, time, &work.start.at, &mut work.end.at);
                break;
            }
            if violation <= ROUNDED {
                break;
            }
            let share = violation / least;
            let is_steady = share < SLOWEST && (share - before).abs() <= STEADY * share;
            let whole = if is_steady { 1.0 / (1.0 - share) } else { 1.0 };
            (least, before) = (violation, share);
            work.full[..n].copy_from_slice(&work.end.x[..n]);
            newton.unknowns[..n].fill(0.0);
            newton.unknowns[n..].iter_mut().zip(&work.phi).for_each(|(unknown, phi)| *unknown = -whole * phi);
            newton.kkt.solve(&mut newton.unknowns);
            work.end.x[..n].iter_mut().zip(&newton.unknowns).for_each(|(x, step)| *x += step);
            system.evaluate(&work.end.x, time, &work.start.at, &mut work.end.at);
        }
        for k in 0..n {
            work.d[k] = work.end.x[k] - work.start.x[k];
        }
        Ok(())
    }

    /// Projects velocities and accelerations of a workspace at the end of its step, where the rows are evaluated.
    pub fn apply(&self, system: &System, time: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        if !(self.velocity || self.acceleration) {
            return Ok(());
        }
        work.impulses.iter_mut().for_each(|impulses| impulses.fill(0.0));
        // What is left of both equations is solved for with the matrix that is there.
        if !self.position {
            self.factor(system, time, step, newton, work)?;
        }
        if self.velocity {
            self.project(system, time, Level::Velocity, newton, work);
        }
        if self.acceleration {
            self.project(system, time, Level::Acceleration, newton, work);
        }
        let is_finite = work.end.v.iter().chain(&work.a).all(|value| value.is_finite());
        if is_finite { Ok(()) } else { Err(Failure::NotFinite) }
    }

    /// Writes [A Gᵀ; G −δ] and factors it.
    fn factor(&self, system: &System, time: f64, step: f64, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        let scale = self.assemble(system, time, step, &mut newton.kkt, work);
        match self.solve {
            Solve::Exact => newton.proximal(1.0, None, &work.scales),
            Solve::Penalty(alpha) => newton.delta.fill(1.0 / alpha),
        }
        if self.solve == Solve::Exact {
            newton.delta.iter_mut().for_each(|delta| *delta *= scale);
        }
        newton.kkt.regularise(0, &newton.delta);
        newton.factorizations += 1;
        newton.kkt.factor()?;
        Ok(())
    }

    /// Writes [A Gᵀ; G 0]; says how much softer than M the metric lets the rows be.
    pub(crate) fn assemble(&self, system: &System, time: f64, step: f64, kkt: &mut Kkt, work: &mut Workspace) -> f64 {
        let block = Block(0, 0);
        kkt.clear();
        let mut scale = 1.0;
        match &self.metric {
            Metric::Mass => kkt.start_with_mass(1.0),
            Metric::Identity => {
                kkt.start_with_weights(std::iter::repeat(&1.0));
                scale = work.scales.heaviest;
            }
            Metric::Custom(weights) => {
                kkt.start_with_weights(weights);
                scale = work.scales.heaviest / weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            }
            Metric::Tangent => {
                kkt.start_with_mass(1.0);
                let stage = Stage {
                    sampling: Sampling::End,
                    rows: RowsAt::End,
                    start: time - step,
                    step,
                    inertia: 0.25 * step * step,
                    rate: 2.0 / step,
                };
                work.respond_at_end(system, time);
                work.add_laws(system, &stage, block, kkt);
                work.add_loads(system, &stage, block, kkt);
            }
        }
        kkt.write_sum(block);
        kkt.add_columns(block, &work.end.at.gradient, 1.0);
        kkt.add_rows(block, &work.end.at.gradient, 1.0);
        scale
    }

    fn project(&self, system: &System, time: f64, level: Level, newton: &mut Newton, work: &mut Workspace) {
        let n = system.coordinates();
        work.full[..n].fill(0.0);
        let passes = if self.solve == Solve::Exact { PASSES } else { 1 };
        for _ in 0..passes {
            let violation = self.violation(system, time, level, work);
            let values = if level == Level::Velocity { &work.end.v } else { &work.a };
            let size = largest(values);
            if violation <= ROUND_OFF * size {
                break;
            }
            newton.unknowns[..n].fill(0.0);
            for (unknown, row) in newton.unknowns[n..].iter_mut().zip(&work.rows) {
                *unknown = -row;
            }
            newton.kkt.solve(&mut newton.unknowns);
            let values = if level == Level::Velocity { &mut work.end.v } else { &mut work.a };
            for i in 0..n {
                values[i] += newton.unknowns[i];
                work.full[i] += newton.unknowns[i];
            }
            work.impulses[level as usize].iter_mut().zip(&newton.unknowns[n..]).for_each(|(impulse, unknown)| *impulse += unknown);
        }
        if self.strength != 1.0 {
            let values = if level == Level::Velocity { &mut work.end.v } else { &mut work.a };
            for i in 0..n {
                values[i] += (self.strength - 1.0) * work.full[i];
            }
        }
    }

    /// Leaves Φ̇ or Φ̈ at the end of the step in `rows`; its largest entry over the size of the row's gradient.
    fn violation(&self, system: &System, time: f64, level: Level, work: &mut Workspace) -> f64 {
        match level {
            Level::Velocity => work.rate_violation(system, time),
            Level::Acceleration => work.acceleration_violation(system, time),
        }
        work.scaled(&work.rows)
    }
}
