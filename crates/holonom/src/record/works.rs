//! Who puts energy into a mechanism and who takes it out: what each drive and each force has done in a run.

use std::collections::BTreeMap;

use serde::Serialize;

use super::channels::{Channels, node};
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

/// Share of all energy that could move below which a work is round-off.
const ROUNDED: f64 = 1e-12;

impl Works {
    /// The works up to the present state of a simulation. Beside drives, what has done nothing and stores nothing is left out.
    pub fn of(channels: &Channels, simulation: &Simulation) -> Self {
        let (done, system) = (simulation.done(), simulation.system());
        let (least, mut rest) = (ROUNDED * simulation.audit().supply()[1], done.rest);
        let mut named = |name: &str, work: f64, stored: f64| {
            let is_rounded = work.abs() <= least && stored.abs() <= least;
            rest += if is_rounded { work + stored } else { 0.0 };
            let [work, stored] = if is_rounded { [0.0; 2] } else { [work, stored] };
            Work { name: name.to_string(), work, stored }
        };
        let mut rows: BTreeMap<usize, f64> = done.rows.iter().copied().collect();
        let efforts = channels.efforts.iter();
        let mut drives: Vec<Work> = efforts.map(|effort| named(&effort.name, rows.remove(&effort.row).unwrap_or(0.0), 0.0)).collect();
        let mut others: Vec<Work> = rows.into_iter().map(|(row, work)| named(&system.row_names()[row], work, 0.0)).collect();
        let led = channels.points.iter().filter_map(|point| Some((point, node(point)?.index().checked_sub(system.free_nodes())?)));
        others.extend(led.map(|(point, k)| named(&point.name, done.nodes[k], 0.0)));
        // The elements of a beam stand behind each other and are told together.
        let parts = channels.forces.chunk_by(|a, b| a.beam().is_some() && a.beam() == b.beam());
        let forces = parts.map(|parts| {
            let [mut work, mut stored] = [0.0; 2];
            for force in parts {
                let of_laws = &done.laws[force.laws.clone()];
                work += of_laws.iter().map(|own| own[0]).sum::<f64>() + done.loads[force.loads.clone()].iter().sum::<f64>();
                stored += of_laws.iter().map(|own| own[1]).sum::<f64>();
            }
            named(parts[0].beam().unwrap_or(&parts[0].name), work, stored)
        });
        let mut forces: Vec<Work> = forces.collect();
        [&mut others, &mut forces].into_iter().for_each(|own| own.retain(|own| own.work != 0.0 || own.stored != 0.0));
        drives.append(&mut others);
        Self { drives, forces, gravity: if done.weight.abs() > least { done.weight } else { 0.0 }, rest }
    }
}
