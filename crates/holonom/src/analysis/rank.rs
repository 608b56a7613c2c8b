//! Rank of the constraints: which rows are redundant, and how near the others are to being so.

use crate::formulation::{ALL, Block, Kkt, Workspace};
use crate::simulation::ModelSize;
use crate::system::System;

/// Rank of the rows at a position.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// Number of independent rows.
    pub rank: usize,
    /// Rows that follow from those before them in the elimination, by name.
    pub redundant: Vec<String>,
    /// Name and relative independence (0 … 1) of the row nearest to following from the others.
    pub weakest: Option<(String, f64)>,
}

/// What a row must add to those before it, over its own size, to count: well above round-off, well below any row that
/// holds something.
const INDEPENDENT: f64 = 1e-9;

/// Finds the rank of the rows at the positions `x` of all nodes and time `t`.
///
/// The matrix [M Gᵀ; G −δ] is factored with a vanishing δ: the pivot of a row is then minus the square of what its
/// gradient adds, in the metric of the mass, to those eliminated before it. Nodes without mass count as the heaviest: the
/// rank does not depend on the metric.
pub fn rank(system: &System, x: &[f64], t: f64) -> Rank {
    let mut work = Workspace::new(system);
    work.kkt = Kkt::with_mass(system, &system.mass.filled(work.heaviest), 1, ALL);
    let block = Block(0, 0);
    system.evaluate_again(x, t, &mut work.at_end);
    work.kkt.clear();
    work.kkt.start_with_mass(1.0);
    work.kkt.write_sum(block);
    work.kkt.add_columns(block, &work.at_end.gradient, 1.0);
    work.kkt.add_rows(block, &work.at_end.gradient, 1.0);
    work.delta.iter_mut().zip(&work.softness).for_each(|(delta, softness)| *delta = 1e-15 * softness);
    work.kkt.regularise(0, &work.delta);
    let factored = work.kkt.factor().is_ok();
    let mut found = Rank { rank: 0, redundant: Vec::new(), weakest: None };
    for (row, name) in system.row_names().iter().enumerate() {
        let independence = if factored { work.kkt.solver.pivot(work.kkt.multiplier(row, 0)) / work.softness[row] } else { 0.0 };
        if independence < INDEPENDENT {
            found.redundant.push(name.clone());
            continue;
        }
        found.rank += 1;
        if found.weakest.as_ref().is_none_or(|(_, least)| independence < *least) {
            found.weakest = Some((name.clone(), independence));
        }
    }
    found
}

impl Rank {
    /// The numbers of the summary.
    pub fn size(&self, system: &System) -> ModelSize {
        ModelSize {
            coordinates: system.coordinates(),
            constraints: system.constraints(),
            rank: self.rank,
            redundant: self.redundant.len(),
            dof: system.coordinates() - self.rank,
        }
    }
}
