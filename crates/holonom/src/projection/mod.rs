//! Coordinate projections of velocity and acceleration (10)–(13): the nearest ones that satisfy the rows, in a metric A.

use crate::formulation::{Block, Failure, RowsAt, Sampling, Stage, Workspace};
use crate::linalg::largest;
use crate::system::System;

/// The matrix A that measures the distance moved.
#[derive(Clone, Debug, PartialEq)]
pub enum Metric {
    /// A = M: never adds energy, keeps momenta (methods §3).
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
    pub velocity: bool,
    pub acceleration: bool,
    pub metric: Metric,
    pub solve: Solve,
    /// θ: v ← v* − θ(v* − v) (methods §3); 1 is the full projection.
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

/// Passes of the exact projection; the second one already meets round-off, more are for redundant rows.
const PASSES: usize = 4;

/// Largest metric whose violation is left alone, relative to the size of the velocities.
const ROUND_OFF: f64 = 1e-15;

/// A quantity that is projected: velocities or accelerations of all nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Level {
    Velocity,
    Acceleration,
}

impl Projection {
    /// Projects the velocities `v1` and the accelerations `a1` of a workspace at its end position. Where the rows are
    /// evaluated is `at_end`.
    pub fn apply(&self, system: &System, time: f64, step: f64, work: &mut Workspace) -> Result<(), Failure> {
        if !(self.velocity || self.acceleration) {
            return Ok(());
        }
        let scale = self.assemble(system, time, step, work);
        match self.solve {
            Solve::Exact => work.proximal(1.0, None),
            Solve::Penalty(alpha) => work.delta.fill(1.0 / alpha),
        }
        if self.solve == Solve::Exact {
            work.delta.iter_mut().for_each(|delta| *delta *= scale);
        }
        work.kkt.regularise(0, &work.delta);
        work.factorizations += 1;
        work.kkt.factor()?;
        if self.velocity {
            self.project(system, time, Level::Velocity, work);
        }
        if self.acceleration {
            self.project(system, time, Level::Acceleration, work);
        }
        let is_finite = work.v1.iter().chain(&work.a1).all(|value| value.is_finite());
        if is_finite { Ok(()) } else { Err(Failure::NotFinite) }
    }

    /// Writes [A Gᵀ; G 0]; says how much softer than M the metric lets the rows be.
    pub(crate) fn assemble(&self, system: &System, time: f64, step: f64, work: &mut Workspace) -> f64 {
        let block = Block(0, 0);
        work.kkt.clear();
        let mut scale = 1.0;
        match &self.metric {
            Metric::Mass => work.kkt.start_with_mass(1.0),
            Metric::Identity => {
                work.kkt.start_with_weights(std::iter::repeat(&1.0));
                scale = work.scales.heaviest;
            }
            Metric::Custom(weights) => {
                work.kkt.start_with_weights(weights);
                scale = work.scales.heaviest / weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            }
            Metric::Tangent => {
                work.kkt.start_with_mass(1.0);
                let stage = Stage {
                    sampling: Sampling::End,
                    rows: RowsAt::End,
                    start: time - step,
                    step,
                    inertia: 0.25 * step * step,
                    rate: 2.0 / step,
                };
                work.respond_at_end(system, &stage);
                work.add_laws(system, &stage, block);
                work.add_loads(system, &stage, block);
            }
        }
        work.kkt.write_sum(block);
        work.kkt.add_columns(block, &work.at_end.gradient, 1.0);
        work.kkt.add_rows(block, &work.at_end.gradient, 1.0);
        scale
    }

    fn project(&self, system: &System, time: f64, level: Level, work: &mut Workspace) {
        let n = system.coordinates();
        work.full[..n].fill(0.0);
        let passes = if self.solve == Solve::Exact { PASSES } else { 1 };
        for _ in 0..passes {
            let violation = self.violation(system, time, level, work);
            let values = if level == Level::Velocity { &work.v1 } else { &work.a1 };
            let size = largest(values);
            if violation <= ROUND_OFF * size {
                break;
            }
            work.unknowns[..n].fill(0.0);
            for (unknown, row) in work.unknowns[n..].iter_mut().zip(&work.rows) {
                *unknown = -row;
            }
            work.kkt.solve(&mut work.unknowns);
            let values = if level == Level::Velocity { &mut work.v1 } else { &mut work.a1 };
            for i in 0..n {
                values[i] += work.unknowns[i];
                work.full[i] += work.unknowns[i];
            }
        }
        if self.strength != 1.0 {
            let values = if level == Level::Velocity { &mut work.v1 } else { &mut work.a1 };
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
        let scaled = work.rows.iter().zip(&work.scales.gradient).map(|(row, scale)| row.abs() / scale);
        scaled.fold(0.0, f64::max)
    }
}
