//! What each drive, force and moving point has done since the start: the work of the audit, split.

use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::formulation::Workspace;
use crate::system::{Evaluation, LawEntry, System};

/// Work and power of each worker of the system, and where energies began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Shares {
    /// What each has done since the start, J.
    done: Vec<f64>,
    /// Their power at the present state, W, of methods that go on from that.
    pub powers: Vec<f64>,
    /// The energy of each law at the start, J.
    first: Vec<f64>,
    /// That of gravity.
    first_weight: f64,
}

impl Shares {
    /// At a start, whose evaluation and powers the workspace has.
    pub fn new(system: &System, x: &[f64], work: &Workspace) -> Self {
        Self {
            done: vec![0.0; work.shares.len()],
            powers: work.powers.clone(),
            first: (0..system.laws.len()).map(|law| energy_of(system, law, &work.start.at)).collect(),
            first_weight: of_weight(x, work),
        }
    }

    /// Takes over what is booked of another state of the run.
    pub fn copy_from(&mut self, other: &Self) {
        self.done.copy_from_slice(&other.done);
        self.powers.copy_from_slice(&other.powers);
    }

    /// Adds what was done in a step.
    pub fn add(&mut self, work: &Workspace) {
        self.done.iter_mut().zip(&work.shares).for_each(|(done, share)| *done += share);
        self.powers.copy_from_slice(&work.powers);
    }
}

fn energy_of(system: &System, law: usize, at: &Evaluation) -> f64 {
    let law = &system.laws[law];
    if law.law.conservative() { law.law.energy(&system.arguments(law, at)[..law.arguments.len()]) } else { 0.0 }
}

fn of_weight(x: &[f64], work: &Workspace) -> f64 {
    work.forces.weight.iter().zip(x).map(|(weight, x)| weight * x).sum()
}

/// What has been done on the mechanism since the start, J.
pub(crate) struct Done<'a> {
    /// Of each law its work, and by how much the energy that it stores has grown.
    pub laws: Vec<[f64; 2]>,
    /// Of each load.
    pub loads: &'a [f64],
    /// Of each row that depends on time, by its number.
    pub rows: Vec<(usize, f64)>,
    /// Of each node that moves as time has it.
    pub nodes: &'a [f64],
    /// Of gravity.
    pub weight: f64,
    /// What the audit has beside them.
    pub rest: f64,
}

impl Simulation {
    /// What has been done on the mechanism since the start.
    pub(crate) fn done(&self) -> Done<'_> {
        let (system, own) = (&self.system, &self.shares);
        let (of_laws, others) = own.done.split_at(system.dissipative);
        let (loads, others) = others.split_at(system.loads.len());
        let (of_rows, nodes) = others.split_at(system.driven_rows.len());
        let mut of_laws = of_laws.iter();
        let law = |(k, law): (usize, &LawEntry)| {
            let stored = energy_of(system, k, &self.work.start.at) - own.first[k];
            if law.law.conservative() { [-stored, stored] } else { [*of_laws.next().expect("each has a share"), 0.0] }
        };
        Done {
            laws: system.laws.iter().enumerate().map(law).collect(),
            loads,
            rows: system.driven_rows.iter().map(|row| *row as usize).zip(of_rows.iter().copied()).collect(),
            nodes,
            weight: own.first_weight - of_weight(&self.state.x, &self.work),
            rest: self.audit.work - own.done.iter().sum::<f64>(),
        }
    }
}
