//! Both levels of a stabilised step in one matrix, for where going back and forth between them does not contract: light parts
//! under tension, which would turn many times in a step.
//! ```text
//! [ A           ½K_Φ(γ')   Ḡᵀ   Pᵀ ] [Δd ]
//! [ −M + ½K_Φ(γ')   M      0    Ḡᵀ ] [Δu ]
//! [ G           0          −δ   0  ] [Δμ ]
//! [ H u         G          0    −δ ] [Δγ']
//! ```
//! P is what γ' pulls with in the first equation; rows and columns of a node or row follow one another.

use super::failure::Failure;
use super::kkt::{Block, Kkt, TWO_LEVELS};
use super::newton::Newton;
use super::scales::Scales;
use super::stabilized::Stabilized;
use super::stage::Stage;
use super::workspace::Workspace;
use crate::system::System;

/// The matrix of both levels, and its right side and solution.
pub(super) struct Coupled {
    kkt: Kkt,
    unknowns: Vec<f64>,
}

impl Coupled {
    pub(super) fn new(system: &System) -> Self {
        let kkt = Kkt::new(system, &Scales::new(system), 2, TWO_LEVELS);
        Self { unknowns: vec![0.0; kkt.size()], kkt }
    }

    /// Assembles and factors the tangent at the unknowns and the multipliers that are expected.
    pub(super) fn factor(
        &mut self,
        both: &Stabilized,
        system: &System,
        stage: &Stage,
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<(), Failure> {
        let kkt = &mut self.kkt;
        work.expected_tangent(system, stage, kkt);
        let mut curve = |mass: f64, block: Block| {
            kkt.start_with_mass(mass);
            kkt.add_row_hessians(&both.gamma, 0.5);
            kkt.add_row_hessians(&both.gamma_change, 0.5);
            kkt.write_sum(block);
        };
        curve(0.0, Block(0, 1));
        curve(-1.0, Block(1, 0));
        kkt.start_with_mass(1.0);
        kkt.write_sum(Block(1, 1));
        kkt.add_columns(Block(0, 1), &both.pull, 1.0);
        kkt.add_columns(Block(1, 1), &both.velocity_gradient, 1.0);
        kkt.add_rows(Block(1, 0), &both.turned_u, 1.0);
        kkt.add_rows(Block(1, 1), &work.end.at.gradient, 1.0);
        (0..2).for_each(|field| kkt.regularise(field, &newton.delta));
        newton.factorizations += 1;
        let outcome = kkt.factor();
        newton.rank.classify(&outcome, kkt, &newton.delta, &work.scales);
        outcome
    }

    /// Replaces the residuals, of d and μ in `first` and of u and γ' in `second` (n + r each), by increments.
    pub(super) fn solve(&mut self, n: usize, dim: usize, first: &mut [f64], second: &mut [f64]) {
        let (kkt, rows) = (&self.kkt, first.len() - n);
        let place = |k: usize, field| if k < n { kkt.coordinate(k / dim, field, k % dim) } else { kkt.multiplier(k - n, field) };
        for k in 0..n + rows {
            self.unknowns[place(k, 0)] = first[k];
            self.unknowns[place(k, 1)] = second[k];
        }
        let mut unknowns = std::mem::take(&mut self.unknowns);
        self.kkt.solve(&mut unknowns);
        let kkt = &self.kkt;
        let place = |k: usize, field| if k < n { kkt.coordinate(k / dim, field, k % dim) } else { kkt.multiplier(k - n, field) };
        for k in 0..n + rows {
            first[k] = unknowns[place(k, 0)];
            second[k] = unknowns[place(k, 1)];
        }
        self.unknowns = unknowns;
    }
}
