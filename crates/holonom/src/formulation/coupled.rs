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
use super::kkt::Kkt;
use super::newton::Newton;
use super::pattern::{Block, TWO_LEVELS};
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

    /// Assembles and factors the tangent at the unknowns and the multipliers that are expected, with its proximal term.
    pub(super) fn factor(
        &mut self,
        both: &Stabilized,
        system: &System,
        stage: &Stage,
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<(), Failure> {
        self.assemble(both, system, stage, work);
        let kkt = &mut self.kkt;
        (0..2).for_each(|field| kkt.regularise(field, &newton.delta));
        newton.factorizations += 1;
        let outcome = kkt.factor();
        newton.rank.classify(&outcome, kkt, &newton.delta, &work.scales);
        outcome
    }

    /// Assembles it without the proximal term.
    pub(super) fn assemble(&mut self, both: &Stabilized, system: &System, stage: &Stage, work: &mut Workspace) {
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
    }

    /// Place of the k-th number (coordinates, then rows) of a level among the unknowns.
    fn place(&self, n: usize, dim: usize, k: usize, field: usize) -> usize {
        if k < n { self.kkt.coordinate(k / dim, field, k % dim) } else { self.kkt.multiplier(k - n, field) }
    }

    /// The tangent's derivative of a residual by an unknown, those of d and μ first.
    pub(super) fn entry(&self, system: &System, residual: usize, unknown: usize) -> f64 {
        let (n, each) = (system.coordinates(), system.coordinates() + system.constraints());
        let place = |k: usize| self.place(n, system.dim, k % each, k / each);
        self.kkt.solver.entry(place(residual), place(unknown))
    }

    /// Replaces the residuals, of d and μ in `first` and of u and γ' in `second` (n + r each), by increments.
    pub(super) fn solve(&mut self, n: usize, dim: usize, first: &mut [f64], second: &mut [f64]) {
        let mut unknowns = std::mem::take(&mut self.unknowns);
        for (k, (first, second)) in first.iter().zip(&*second).enumerate() {
            unknowns[self.place(n, dim, k, 0)] = *first;
            unknowns[self.place(n, dim, k, 1)] = *second;
        }
        self.kkt.solve(&mut unknowns);
        for (k, (first, second)) in first.iter_mut().zip(second).enumerate() {
            *first = unknowns[self.place(n, dim, k, 0)];
            *second = unknowns[self.place(n, dim, k, 1)];
        }
        self.unknowns = unknowns;
    }
}
