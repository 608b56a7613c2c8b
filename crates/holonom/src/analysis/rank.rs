//! Rank of the constraints: which rows are redundant, and how near the others are to being so.

use crate::formulation::{independence, independent};
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

/// Finds the rank of the rows at the positions `x` of all nodes and time `t`, by their geometry alone. Points of curves are looked for from where they are
/// at the start.
pub fn rank(system: &System, x: &[f64], t: f64) -> Rank {
    counted(system, &independence(system, x, &system.evaluation().functions.angle, t))
}

/// The same at the present state of a simulation, by what it has planned.
pub fn rank_of(simulation: &mut Simulation) -> Rank {
    let shares = simulation.independence();
    counted(simulation.system(), &shares)
}

fn counted(system: &System, shares: &[f64]) -> Rank {
    let mut found = Rank { rank: 0, redundant: Vec::new(), weakest: None };
    let least = independent(system.coordinates());
    for (name, &independence) in system.row_names().iter().zip(shares) {
        if independence < least {
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

/// Independence of a row below which a mechanism is near a singular position, where it has no more coordinates than `FEW`. At the base of
/// open chains rows add less, as the inverse cube of the number of links, and hold all the same.
const NEAR_SINGULAR: f64 = 1e-4;
const FEW: f64 = 100.0;

impl Rank {
    /// The weakest row where the mechanism is near a singular position.
    pub fn near_singular(&self, system: &System) -> Option<&(String, f64)> {
        let bound = NEAR_SINGULAR * (FEW / system.coordinates() as f64).min(1.0).powi(3);
        self.weakest.as_ref().filter(|(_, independence)| *independence < bound)
    }

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
