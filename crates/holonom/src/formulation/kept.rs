//! Factors that are made anew in part: what is far from linear in a step is often confined to few places of a mechanism.

use super::failure::Failure;
use super::level::Level;
use super::newton::Newton;
use super::stage::{RowsAt, Stage};
use super::workspace::Workspace;
use crate::system::System;

/// Rows that would leave less than this share of what any row leaves keep their part of the factors.
const LEFT: f64 = 1e-5;

/// The rows as the matrix has them.
pub(super) struct Kept {
    /// Whether the matrix changes with the rows alone, and can be factored in part.
    by_rows: bool,
    /// Their gradients at the end of the step (D a slot), and their multipliers.
    gradient: Vec<f64>,
    lambda: Vec<f64>,
    /// What each would leave, m.
    left: Vec<f64>,
    /// Those that are brought up to date.
    rows: Vec<usize>,
}

impl Kept {
    pub(super) fn new(system: &System, by_rows: bool) -> Self {
        let by_rows = by_rows && system.has_only_quadratic_rows();
        let rows = if by_rows { system.constraints() } else { 0 };
        let gradient = vec![0.0; if by_rows { system.slots.nodes.len() * system.dim } else { 0 }];
        Self { by_rows, gradient, lambda: vec![0.0; rows], left: vec![0.0; rows], rows: Vec::with_capacity(rows) }
    }
}

impl Newton {
    /// Whether all factorisations of a step but the first are in part.
    pub(super) fn is_factored_in_part(&self, stage: &Stage, level: Level) -> bool {
        self.kept.by_rows && level == Level::POSITION && stage.rows != RowsAt::Middle
    }

    /// Factors the tangent at the multipliers that are expected: as a whole in the first iteration of a step, later only
    /// where rows have turned since and the multipliers change.
    pub(super) fn factor_tangent(&mut self, system: &System, stage: &Stage, first: bool, work: &mut Workspace) -> Result<(), Failure> {
        let in_part = self.is_factored_in_part(stage, work.level);
        if in_part && !first {
            return self.factor_turned(stage, work);
        }
        work.expected_tangent(system, stage, &mut self.kkt);
        if in_part {
            self.kept.gradient.copy_from_slice(&work.end.at.gradient);
            for (kept, (lambda, change)) in self.kept.lambda.iter_mut().zip(work.lambda.iter().zip(&work.prediction.lambda_change)) {
                *kept = lambda + change;
            }
        }
        self.factor(&work.scales)
    }

    /// Brings the factors up to date where that matters. Without it a row, whose gradient g has turned by Δg and whose multiplier
    /// has changed by Δμ since, leaves a force Δgᵀμ', a force Δμ H d' and a violation Δg·d' of the next increments μ' and d'.
    /// These are taken to be as large as those since: |Δg| (Δμ/m + |Δg|/|g|), a length.
    fn factor_turned(&mut self, stage: &Stage, work: &Workspace) -> Result<(), Failure> {
        let Self { kkt, kept, .. } = self;
        let Workspace { end, lambda, scales, .. } = work;
        let Kept { gradient, lambda: kept_lambda, left, rows, .. } = kept;
        let mut most = 0.0_f64;
        for (row, left) in left.iter_mut().enumerate() {
            let slots = kkt.gradient_of(row);
            let changes = end.at.gradient[slots.clone()].iter().zip(&gradient[slots]).map(|(g, kept)| g - kept);
            let turned = changes.map(|change| change * change).sum::<f64>().sqrt();
            let pulled = stage.inertia * (lambda[row] - kept_lambda[row]).abs() * scales.reach[row] * scales.length / scales.gradient[row];
            *left = turned * (pulled + turned / scales.gradient[row]);
            most = most.max(*left);
        }
        rows.clear();
        rows.extend((0..left.len()).filter(|&row| left[row] > LEFT * most));
        let factors = [stage.share(), if stage.rows == RowsAt::Mean { 0.5 } else { 1.0 }];
        for &row in &*rows {
            let (slots, pull) = (kkt.gradient_of(row), lambda[row] - kept_lambda[row]);
            let (change, g) = (&mut gradient[slots.clone()], &end.at.gradient[slots]);
            change.iter_mut().zip(g).for_each(|(kept, g)| *kept = g - *kept);
            kkt.change_row(row, stage.inertia * stage.share() * pull, factors, change);
            change.copy_from_slice(g);
            kept_lambda[row] = lambda[row];
        }
        self.factorizations += 1;
        kkt.factor_rows(rows)
    }
}
