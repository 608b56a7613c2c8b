//! Forces of a step between positions beside those at its ends: what jumps or has a peak between where they were looked at.

use super::stage::Stage;
use super::workspace::Workspace;
use crate::energy;
use crate::linalg::largest;
use crate::system::{LoadEntry, Local, Look, System};

/// Share of a step by which its ends are looked at inside of it.
const INSIDE: f64 = 1e-6;

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

    /// Forces of a load at both ends of a step, at these times (s).
    fn load_at_ends(&self, system: &System, load: &LoadEntry, t: [f64; 2]) -> [Local; 2] {
        [(&self.start, t[0]), (&self.end, t[1])].map(|(end, t)| {
            let mut force = Local::from_elem(0.0, load.nodes.len() * system.dim);
            system.load_forces(load, Look { x: &end.x, v: &end.v, t, at: &end.at, inputs: &self.inputs, span: None }, &mut force);
            force
        })
    }

    /// The same of a law that may have peaks.
    fn off_laws(&self, system: &System, stage: &Stage, t: f64) -> f64 {
        let dim = system.dim;
        let mut most = 0.0_f64;
        for (law, used) in system.peaked_laws().map(|k| (&system.laws[k], &self.forces.responses[k])) {
            let [start, end] = [(&self.start, stage.start), (&self.end, t)].map(|(end, t)| {
                let (_, own) = system.respond(law, &end.at, &end.v, t);
                system.by_invariants(law, own, &end.at, &end.at, &end.v)
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

    /// By how much the work of forces that may supply energy, as formulas do, is another in a step between positions by Simpson's rule, which has
    /// their power at both ends beside that between, J: of all together, and of the force that differs most its number among
    /// [`System::working_forces`] with its part.
    pub(crate) fn unsure_work(&self, system: &System, stage: &Stage) -> (f64, (usize, f64)) {
        let (h, dim) = (stage.step, system.dim);
        // What jumps at an end of the step has inside of it what it has in the step.
        let t = [stage.start + INSIDE * h, stage.end() - INSIDE * h];
        let (mut sum, mut most) = (0.0, (0, 0.0_f64));
        let mut differ = |number: usize, booked: f64, power: [f64; 2]| {
            let by = (0.5 * h * (power[0] + power[1]) - booked) / 3.0;
            sum += by;
            if by.abs() > most.1.abs() {
                most = (number, by);
            }
        };
        let laws = system.laws.iter().zip(&self.forces.responses).zip(&self.forces.damping).filter(|((law, _), _)| !law.law.conservative());
        let mut number = 0;
        for ((law, response), damping) in laws {
            // A law that is damped at the end of the step has another power at its start.
            if law.law.may_supply() && !damping.is_late() {
                let power = [(&self.start, t[0]), (&self.end, t[1])].map(|(end, t)| {
                    let (rates, own) = system.respond(law, &end.at, &end.v, t);
                    -own.force.iter().zip(&rates).map(|(force, rate)| force * rate).sum::<f64>()
                });
                differ(number, energy::work_of_law(system, law, response, stage, self), power);
            }
            number += 1;
        }
        let mut used = &self.forces.of_loads[..];
        for load in &system.loads {
            let (mut booked, mut power) = (0.0, [0.0; 2]);
            let ends = self.load_at_ends(system, load, t);
            for (k, node) in load.nodes.iter().enumerate().filter(|(_, node)| node.index() < system.free) {
                for c in 0..dim {
                    let (i, j) = (node.index() * dim + c, k * dim + c);
                    booked += used[j] * self.d[i];
                    power[0] += ends[0][j] * self.start.v[i];
                    power[1] += ends[1][j] * self.end.v[i];
                }
            }
            differ(number, booked, power);
            used = &used[load.nodes.len() * dim..];
            number += 1;
        }
        (sum, most)
    }
}
