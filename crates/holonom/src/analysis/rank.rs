//! Rank of the constraints: which rows are redundant, and how near the others are to being so.

use crate::formulation::{INDEPENDENT, independence};
use crate::simulation::{ModelSize, Simulation};
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

/// Finds the rank of the rows at the positions `x` of all nodes and time `t`, by their geometry alone.
pub fn rank(system: &System, x: &[f64], t: f64) -> Rank {
    counted(system, &independence(system, x, t))
}

/// The same at the present state of a simulation, by what it has planned.
pub fn rank_of(simulation: &Simulation) -> Rank {
    counted(simulation.system(), &simulation.independence())
}

fn counted(system: &System, shares: &[f64]) -> Rank {
    let mut found = Rank { rank: 0, redundant: Vec::new(), weakest: None };
    for (name, &independence) in system.row_names().iter().zip(shares) {
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
