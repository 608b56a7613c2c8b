//! An observer that records a run: the columns of `trajectory.csv`.

use super::Recording;
use crate::simulation::{Observer, Simulation, Verdict};
use crate::system::Place;

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedPoint {
    pub name: String,
    pub place: Place,
}

/// The columns that every recording begins with.
pub const COLUMNS: [&str; 11] =
    ["t", "energy", "kinetic", "potential", "work", "dE_integrator", "dE_projection", "phi", "phi_dot", "phi_ddot", "iterations"];

/// Columns of the forces of constraints: the multiplier of each row, and the force on each point that moves.
pub fn reaction_columns(rows: &[String], points: &[RecordedPoint], axes: &str) -> Vec<String> {
    let multipliers = rows.iter().map(|row| format!("{row}.lambda"));
    let moving = points.iter().filter(|point| matches!(point.place, Place::Node(_)));
    multipliers.chain(moving.flat_map(|point| axes.chars().map(|axis| format!("{}.r{axis}", point.name)))).collect()
}

/// Records the start, every `every`-th step and nothing else. ΔE_i and ΔE_p of the steps between are summed into the
/// row that follows them, so that the columns add up whatever is left out.
pub struct Recorder {
    points: Vec<RecordedPoint>,
    every: u64,
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J.
    since: [f64; 2],
    has_reactions: bool,
    row: Vec<f64>,
    recording: Recording,
}

impl Recorder {
    /// Records points along the world axes `axes` (`"xyz"`, or two of them in the plane), and the forces of the constraint
    /// rows `rows` where the simulation finds them.
    pub fn new(points: Vec<RecordedPoint>, axes: &str, every: u64, rows: Option<&[String]>) -> Self {
        let common = COLUMNS.iter().map(|name| name.to_string());
        let of_points = points.iter().flat_map(|point| {
            let positions = axes.chars().map(|axis| format!("{}.{axis}", point.name));
            positions.chain(axes.chars().map(|axis| format!("{}.v{axis}", point.name))).collect::<Vec<_>>()
        });
        let of_rows = rows.map_or(Vec::new(), |rows| reaction_columns(rows, &points, axes));
        let recording = Recording::new(common.chain(of_points).chain(of_rows));
        Self {
            row: Vec::with_capacity(recording.columns().len()),
            points,
            every: every.max(1),
            seen: 0,
            since: [0.0; 2],
            has_reactions: rows.is_some(),
            recording,
        }
    }

    /// What was recorded so far.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Ends the recording.
    pub fn finish(self) -> Recording {
        self.recording
    }

    fn record(&mut self, simulation: &Simulation<'_>) {
        let (audit, state) = (simulation.audit(), simulation.state());
        let dim = simulation.system().dimension();
        self.row.clear();
        self.row.extend([state.t, audit.energy(), audit.kinetic, audit.potential, audit.work, self.since[0], self.since[1]]);
        self.since = [0.0; 2];
        self.row.extend([audit.phi, audit.phi_dot, audit.phi_ddot, audit.iterations as f64]);
        for point in &self.points {
            match point.place {
                Place::Node(node) => {
                    let range = node.index() * dim..(node.index() + 1) * dim;
                    self.row.extend_from_slice(&state.x[range.clone()]);
                    self.row.extend_from_slice(&simulation.velocities()[range]);
                }
                Place::Fixed(x) => {
                    self.row.extend_from_slice(&x[..dim]);
                    self.row.extend(std::iter::repeat_n(0.0, dim));
                }
            }
        }
        if let Some(reactions) = simulation.reactions().filter(|_| self.has_reactions) {
            self.row.extend_from_slice(&reactions.lambda);
            for point in &self.points {
                if let Place::Node(node) = point.place {
                    self.row.extend_from_slice(&reactions.force[node.index() * dim..(node.index() + 1) * dim]);
                }
            }
        }
        self.recording.push(&self.row);
    }
}

impl Observer for Recorder {
    fn after_step(&mut self, simulation: &Simulation<'_>) -> Verdict {
        self.since[0] += simulation.audit().integrator;
        self.since[1] += simulation.audit().projection;
        if self.seen.is_multiple_of(self.every) {
            self.record(simulation);
        }
        self.seen += 1;
        Verdict::GoOn
    }
}
