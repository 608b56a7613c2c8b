//! What the audit says of a run in its summary.

use super::Audit;
use crate::simulation::{EnergySummary, MomentumSummary, ViolationSummary, WorkSummary};

impl Audit {
    /// The energies of the summary.
    pub fn energy_summary(&self) -> EnergySummary {
        let rise = self.energy() - self.initial;
        EnergySummary {
            initial: self.initial + self.lift,
            last: self.energy() + self.lift,
            max_drift: self.max_drift,
            max_rise: self.max_rise,
            integrator_total: self.integrator_total,
            projection_total: self.projection_total,
            work_total: self.work,
            audit_residual: (rise - self.work - self.integrator_total - self.projection_total).abs(),
        }
    }

    /// Drift of the momenta that nothing outside changes.
    pub fn momentum_summary(&self) -> MomentumSummary {
        let largest =
            |range: std::ops::Range<usize>| range.filter(|&k| self.kept_momenta[k]).map(|k| self.momentum_drift[k]).fold(0.0, f64::max);
        MomentumSummary { linear_drift: largest(0..3), angular_drift: largest(3..6) }
    }

    /// Largest violations so far.
    pub fn violation_summary(&self) -> ViolationSummary {
        self.violation.clone()
    }

    /// Work counters after `steps` nominal steps.
    pub fn work_summary(&self, steps: u64) -> WorkSummary {
        WorkSummary {
            steps_taken: self.taken,
            iterations: self.total_iterations,
            iterations_per_step: self.total_iterations as f64 / steps.max(1) as f64,
            factorizations: self.factorizations,
            rejected_steps: self.rejected,
        }
    }
}
