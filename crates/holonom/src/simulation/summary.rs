//! The summary of a run: the keys of `summary.json`.

use serde::{Deserialize, Serialize};

/// Everything a run is judged by. Keys are stable; additions are allowed.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    pub model: String,
    pub method: MethodSummary,
    /// `"completed"` or `"stopped"`.
    pub status: String,
    /// Time the run reached when it stopped early, s.
    pub stopped_at: Option<f64>,
    pub reason: Option<String>,
    /// Nominal step, s.
    pub step: f64,
    /// Time the run was asked to reach, s.
    pub end: f64,
    /// Nominal steps taken.
    pub steps: u64,
    #[serde(flatten)]
    pub size: ModelSize,
    pub energy: EnergySummary,
    pub momentum: MomentumSummary,
    pub violation: ViolationSummary,
    pub work: WorkSummary,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodSummary {
    pub name: String,
    pub formulation: String,
    pub index: u8,
    pub integrator: String,
    pub order: u8,
    pub iteration: String,
    /// Error of positions that steps were chosen for.
    pub accuracy: Option<f64>,
    pub projection: ProjectionSummary,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProjectionSummary {
    pub levels: Vec<String>,
    pub matrix: String,
    pub solve: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ModelSize {
    /// n
    pub coordinates: usize,
    /// r
    pub constraints: usize,
    pub rank: usize,
    pub redundant: usize,
    pub dof: usize,
}

/// All in J.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EnergySummary {
    pub initial: f64,
    #[serde(rename = "final")]
    pub last: f64,
    /// max |E(t) − E(0) − work done on the system|
    pub max_drift: f64,
    /// Largest rise of E in one step beyond the work done in it.
    pub max_rise: f64,
    pub integrator_total: f64,
    pub projection_total: f64,
    pub work_total: f64,
    /// |E(end) − E(0) − work − ΣΔE_i − ΣΔE_p|
    pub audit_residual: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MomentumSummary {
    /// Largest change of linear momentum, kg·m/s, in directions in which nothing outside acts.
    pub linear_drift: f64,
    /// Largest change of angular momentum about the origin, kg·m²/s, about axes about which nothing outside acts.
    pub angular_drift: f64,
}

/// Largest 2-norm over the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViolationSummary {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WorkSummary {
    /// Steps of the integrator: more than the nominal ones where these were taken in parts, fewer with dense output.
    pub steps_taken: u64,
    pub iterations: u64,
    pub iterations_per_step: f64,
    pub factorizations: u64,
    pub rejected_steps: u64,
}
