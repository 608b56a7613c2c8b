//! What is not sure of the work of forces without a potential.

use super::work_of_law;
use crate::formulation::{Stage, Workspace};
use crate::system::{LawEntry, LoadEntry, Local, Look, Response, System};

/// Share of a step by which its ends are looked at inside of it: what jumps at an end has there what it has in the step.
const INSIDE: f64 = 1e-6;

/// By how much the work of forces that may supply energy, as formulas do, is another in a step between positions by Simpson's rule, which has their
/// power at both ends beside that between, J: of all together, and of the force that differs most its number among [`System::working_forces`] with
/// its part.
pub(crate) fn unsure_work(system: &System, stage: &Stage, work: &Workspace) -> (f64, (usize, f64)) {
    let (h, dim) = (stage.step, system.dim);
    let t = [stage.start + INSIDE * h, stage.end() - INSIDE * h];
    let (mut sum, mut most) = (0.0, (0, 0.0_f64));
    let mut differ = |number: usize, booked: f64, power: [f64; 2]| {
        let by = (0.5 * h * (power[0] + power[1]) - booked) / 3.0;
        sum += by;
        if by.abs() > most.1.abs() {
            most = (number, by);
        }
    };
    let laws = system.laws.iter().zip(&work.forces.responses).enumerate().filter(|(_, (law, _))| !law.law.conservative());
    let mut number = 0;
    for (k, (law, response)) in laws {
        // A law that is damped at the end of the step has another power at its start.
        if law.law.may_supply() && !work.forces.is_late(k) {
            let power = powers_at_ends(system, law, h, t, work);
            differ(number, work_of_law(system, law, response, stage, work), power);
        }
        number += 1;
    }
    let mut used = &work.forces.of_loads[..];
    for load in &system.loads {
        differ(number, along_free(system, load, used, &work.d), powers_of_load(system, load, h, t, work));
        used = &used[load.nodes.len() * dim..];
        number += 1;
    }
    (sum, most)
}

/// Power of a law at both ends of a step of length `h` (s), looked at at the times `t`, W. Of the rates there counts how far they are from their
/// mean: what turns by much in a step has rates of another size than it comes on by, and that is no error of the work, which follows the angle.
fn powers_at_ends(system: &System, law: &LawEntry, h: f64, t: [f64; 2], work: &Workspace) -> [f64; 2] {
    let m = law.arguments.len();
    let [mut start, mut end] = [&work.start, &work.end].map(|end| system.arguments_and_rates(law, &end.at, &end.v));
    for k in 0..m {
        let lag = 0.5 * (start[1][k] + end[1][k]) - (end[0][k] - start[0][k]) / h;
        start[1][k] -= lag;
        end[1][k] -= lag;
    }
    [(start, t[0]), (end, t[1])].map(|([values, rates], t)| {
        let mut own = Response::default();
        law.law.at(&values[..m], &rates[..m], t, &mut own);
        -own.force.iter().zip(&rates).map(|(force, rate)| force * rate).sum::<f64>()
    })
}

/// Forces of a load (D a node) along ways or velocities of all nodes, as far as these are free.
fn along_free(system: &System, load: &LoadEntry, force: &[f64], way: &[f64]) -> f64 {
    let dim = system.dim;
    let free = load.nodes.iter().zip(force.chunks_exact(dim)).filter(|(node, _)| node.index() < system.free);
    free.map(|(node, force)| (0..dim).map(|c| force[c] * way[node.index() * dim + c]).sum::<f64>()).sum()
}

/// The same of a load, with the rates of the coordinates that it reads.
fn powers_of_load(system: &System, load: &LoadEntry, h: f64, t: [f64; 2], work: &Workspace) -> [f64; 2] {
    let looks = [(&work.start, t[0]), (&work.end, t[1])].map(|(end, t)| Look {
        x: &end.x,
        v: &end.v,
        t,
        at: &end.at,
        inputs: &work.inputs,
        span: None,
    });
    let lag = system.lag_of_senses(load, h, looks);
    looks.map(|look| {
        let mut force = Local::from_elem(0.0, load.nodes.len() * system.dim);
        let beside = system.load_forces_behind(load, look, &lag, &mut force);
        along_free(system, load, &force, look.v) - beside
    })
}
