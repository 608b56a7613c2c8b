//! Forces of a step between positions beside those at its ends: what jumps or has a peak between where they were looked at.

use super::stage::Stage;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::{LoadEntry, Local, Look, Response, System};

impl Workspace {
    /// Compares the loads of a step between positions, and the laws that may have peaks, with the mean of those at its ends, `t` (s) the later:
    /// where they jumped, or are many times larger for a short while, those between show nothing of it.
    pub(crate) fn compare_forces(&mut self, system: &System, stage: &Stage, t: f64) {
        self.estimate.loads = stage.step * self.off_loads(system, stage, t).max(self.off_laws(system, stage, t));
    }

    /// The largest difference of a load, as the acceleration of a node over what counts as one of the mechanism.
    fn off_loads(&self, system: &System, stage: &Stage, t: f64) -> f64 {
        let dim = system.dim;
        let mut largest = 0.0_f64;
        let mut used = &self.forces.of_loads[..];
        for load in &system.loads {
            let width = load.nodes.len() * dim;
            let ends = self.load_at_ends(system, load, [stage.start, t]);
            for (k, node) in load.nodes.iter().enumerate().filter(|(_, node)| node.index() < system.free) {
                for i in k * dim..(k + 1) * dim {
                    let off = 0.5 * (ends[0][i] + ends[1][i]) - used[i];
                    largest = largest.max((off * self.scales.agility[node.index()]).abs());
                }
            }
            used = &used[width..];
        }
        largest
    }

    /// The same of a law that may have peaks.
    fn off_laws(&self, system: &System, stage: &Stage, t: f64) -> f64 {
        let dim = system.dim;
        let mut most = 0.0_f64;
        for (law, used) in system.peaked_laws().map(|k| (&system.laws[k], &self.forces.responses[k])) {
            let [start, end] = [(&self.start, stage.start), (&self.end, t)].map(|(end, t)| {
                let mut response = Response::default();
                system.respond(law, &end.at, &end.v, t, &mut response);
                system.by_invariants(law, &mut response, &end.at, &end.at, &end.v);
                response
            });
            for (k, &id) in law.invariants.iter().enumerate() {
                let off = (0.5 * (start.force[k] + end.force[k]) - used.force[k]).abs();
                for s in system.invariants.slots_of(id) {
                    let node = system.slots.nodes[s] as usize;
                    if node < system.free {
                        let gradient = &self.end.at.gradient[s * dim..(s + 1) * dim];
                        most = most.max(off * largest(gradient) * self.scales.agility[node]);
                    }
                }
            }
        }
        most
    }

    /// Forces of a load at both ends of a step, at these times (s).
    pub(crate) fn load_at_ends(&self, system: &System, load: &LoadEntry, t: [f64; 2]) -> [Local; 2] {
        [(&self.start, t[0]), (&self.end, t[1])].map(|(end, t)| {
            let mut force = Local::from_elem(0.0, load.nodes.len() * system.dim);
            system.load_forces(load, Look { x: &end.x, v: &end.v, t, at: &end.at, inputs: &self.inputs, span: None }, &mut force);
            force
        })
    }
}
