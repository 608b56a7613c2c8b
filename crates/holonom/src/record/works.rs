//! Who puts energy into a mechanism and who takes it out: what each drive and each force has done in a run.

use serde::Serialize;

use super::channels::{Channels, RecordedPoint, node};
use crate::simulation::Simulation;

/// What something has done on the mechanism since the start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Work {
    /// Of the drive or the force.
    pub name: String,
    /// Its work, J: above zero it puts energy into the mechanism.
    pub work: f64,
    /// By how much its own energy has grown, J, as that of a spring: what it took from the mechanism, or gave less, to hold it.
    pub stored: f64,
}

/// The work of a run by what did it, J: works with what is stored and the rest add up to the work of the audit.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Works {
    /// Of drives, then of constraints that depend on time, then of points with a motion.
    pub drives: Vec<Work>,
    /// Of forces, in the order of the file.
    pub forces: Vec<Work>,
    /// Of gravity, whose own energy the audit knows.
    pub gravity: f64,
    /// What the audit books beside them: round-off, and what steps by accuracy make of a corner of a force that they pass.
    pub rest: f64,
}

impl Works {
    /// The works up to the present state of a simulation. What has done nothing and stores nothing is left out.
    pub fn of(channels: &Channels, simulation: &Simulation) -> Self {
        let (done, system) = (simulation.done(), simulation.system());
        let effort_of = |row: usize| channels.efforts.iter().position(|effort| effort.row == row);
        let mut of_rows: Vec<(usize, String, f64)> = done
            .rows
            .iter()
            .map(|&(row, work)| match effort_of(row) {
                Some(drive) => (drive, channels.efforts[drive].name.clone(), work),
                None => (usize::MAX, system.row_names()[row].clone(), work),
            })
            .collect();
        of_rows.sort_by_key(|(drive, ..)| *drive);
        let of_points = done.nodes.iter().enumerate().map(|(k, work)| {
            let is_led = |point: &&RecordedPoint| node(point).is_some_and(|node| node.index() == system.free_nodes() + k);
            (channels.points.iter().find(is_led).map_or(String::new(), |point| point.name.clone()), *work)
        });
        let drives = of_rows.into_iter().map(|(_, name, work)| (name, work)).chain(of_points);
        let forces = channels.forces.iter().map(|force| {
            let [work, stored] = done.laws[force.laws.clone()].iter().fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
            let of_loads: f64 = done.loads[force.loads.clone()].iter().sum();
            Work { name: force.name.clone(), work: work + of_loads, stored }
        });
        let is_something = |own: &Work| own.work != 0.0 || own.stored != 0.0;
        Self {
            drives: drives.map(|(name, work)| Work { name, work, stored: 0.0 }).filter(is_something).collect(),
            forces: forces.filter(is_something).collect(),
            gravity: 0.0 + done.weight,
            rest: done.rest,
        }
    }
}
