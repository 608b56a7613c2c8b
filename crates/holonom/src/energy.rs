//! The energy audit: T, V, what was done on the system, and momenta (the paper's §6).

mod unsure;

pub(crate) use unsure::unsure_work;

use crate::formulation::{Moment, Sampling, Stage, Workspace};
use crate::linalg::largest;
use crate::system::{Evaluation, InvariantId, LawEntry, Response, System};

/// Kinetic energy ½ vᵀ M v, J.
pub fn kinetic(system: &System, v: &[f64]) -> f64 {
    system.mass.half_product(system.dim, v, v)
}

/// Kinetic energy of `v` minus that of `before`, as (29) has it, J. Leaves v − before in `scratch`.
pub fn kinetic_difference(system: &System, v: &[f64], before: &[f64], scratch: &mut [f64]) -> f64 {
    for ((out, v), b) in scratch.iter_mut().zip(v).zip(before) {
        *out = v - b;
    }
    system.mass.half_product(system.dim, v, scratch) + system.mass.half_product(system.dim, before, scratch)
}

/// Potential energy of gravity and of the laws, and with a penalty that of the rows (14), J.
pub fn potential(system: &System, weight: &[f64], x: &[f64], at: &Evaluation, penalty: Option<(f64, &[f64])>) -> f64 {
    let mut energy: f64 = weight.iter().zip(x).map(|(w, x)| w * x).sum();
    for law in system.laws.iter().filter(|law| law.law.conservative()) {
        energy += law.law.energy(&system.arguments(law, at)[..law.arguments.len()]);
    }
    if let Some((alpha, phi)) = penalty {
        energy += 0.5 * alpha * phi.iter().map(|phi| phi * phi).sum::<f64>();
    }
    energy
}

/// The sizes of the terms that the potential energy is a sum of, and of what rounded arguments of the laws make of it, J.
pub fn size(system: &System, work: &Workspace, x: &[f64]) -> f64 {
    let mut size: f64 = work.forces.weight.iter().zip(x).map(|(w, x)| (w * x).abs()).sum();
    for (law, response) in system.laws.iter().zip(&work.forces.responses) {
        if law.law.conservative() {
            size += law.law.energy(&system.arguments(law, &work.end.at)[..law.arguments.len()]).abs();
        }
        for (i, &id) in law.invariants.iter().enumerate() {
            let value = work.end.at.value[id.0 as usize].abs() + size_of_invariant(system, id, work, x);
            let rise = |j: usize| {
                let k = law.invariants[j].0 as usize;
                response.by_value[i][j] * (work.end.at.value[k] - work.start.at.value[k])
            };
            let pull = response.force[i].abs() + (0..law.invariants.len()).map(|j| rise(j).abs()).sum::<f64>();
            size += pull * value;
        }
    }
    size
}

/// The sizes of the terms of an invariant that are rounded with positions: of its gradient times these. Points whose motion is known are rounded in
/// the world, where formulas have them.
fn size_of_invariant(system: &System, id: InvariantId, work: &Workspace, x: &[f64]) -> f64 {
    let slots = system.invariants.slots_of(id);
    let of_slot = |s: usize| {
        let (g, node) = (s * system.dim, system.slots.nodes[s] as usize);
        let far = if node < system.free || !system.is_point[node] { 0.0 } else { largest(&system.origin) };
        largest(&work.end.at.gradient[g..g + system.dim]) * (far + largest(&x[node * system.dim..(node + 1) * system.dim]))
    };
    slots.map(of_slot).sum()
}

/// The sizes of the forces that do work, of loads and of laws without a potential, as they were last sampled, N.
pub fn size_of_working_forces(system: &System, work: &Workspace) -> f64 {
    let mut size: f64 = work.forces.of_loads.iter().map(|force| force.abs()).sum();
    for (law, response) in system.laws.iter().zip(&work.forces.responses).filter(|(law, _)| !law.law.conservative()) {
        for (&id, force) in law.invariants.iter().zip(&response.force) {
            let slots = system.invariants.slots_of(id);
            size += (force * largest(&work.sampled.at.gradient[slots.start * system.dim..slots.end * system.dim])).abs();
        }
    }
    size
}

/// Work in a step with forces between its ends: loads, dissipation, and known motion through inertia, forces and rows,
/// J. The rows take part through their targets alone: work of a violated row is the integrator's (25)–(27). Adds to the
/// shares of the workspace what each worker did.
pub fn work_between(system: &System, stage: &Stage, work: &mut Workspace) -> f64 {
    let mut shares = std::mem::take(&mut work.shares);
    let sum = add_work_between(system, stage, work, &mut shares);
    work.shares = shares;
    sum
}

fn add_work_between(system: &System, stage: &Stage, work: &Workspace, shares: &mut [f64]) -> f64 {
    let (n, dim, h) = (system.coordinates(), system.dim, stage.step);
    let way = |i: usize| if i < n { work.d[i] } else { work.end.x[i] - work.start.x[i] };
    let [of_laws, of_loads, of_rows, of_nodes] = system.workers().split(shares);
    let mut sum = loads_along(system, work, way, [of_loads, of_nodes]);
    let laws = system.laws.iter().zip(&work.forces.responses).filter(|(law, _)| !law.law.conservative());
    for ((law, response), share) in laws.zip(of_laws) {
        let own = work_of_law(system, law, response, stage, work);
        (sum, *share) = (sum + own, *share + own);
    }
    for i in n..work.end.x.len() {
        let own = work.forces.sum[i] * way(i);
        (sum, of_nodes[(i - n) / dim]) = (sum + own, of_nodes[(i - n) / dim] + own);
    }
    for node in system.free..system.nodes() {
        for (b, mass) in system.mass.row(node) {
            let mut way = [[0.0; 3]; 2];
            for c in 0..dim {
                let (i, j) = (node * dim + c, b * dim + c);
                way[0][c] = 0.5 * (work.start.v[i] + work.end.v[i]);
                way[1][c] = work.end.v[j] - work.start.v[j];
            }
            let own = mass.product(&way[0], &way[1]);
            (sum, of_nodes[node - system.free]) = (sum + own, of_nodes[node - system.free] + own);
        }
    }
    for (&row, share) in system.driven_rows.iter().zip(of_rows) {
        let row = row as usize;
        let own = work.lambda[row]
            * match system.rows.get(row) {
                Some(row) => row.target(stage.start)[0] - row.target(stage.end())[0],
                None => h * system.explicit_rate(row, &work.sampled.at, stage.time()),
            };
        (sum, *share) = (sum + own, *share + own);
    }
    sum
}

/// Work of a law in such a step, from its response, J.
pub(crate) fn work_of_law(system: &System, law: &LawEntry, response: &Response, stage: &Stage, work: &Workspace) -> f64 {
    let of_invariant = |(id, force): (&InvariantId, &f64)| {
        let rise = match stage.sampling {
            Sampling::Between => work.end.at.value[id.0 as usize] - work.start.at.value[id.0 as usize],
            _ => stage.step * system.along(&system.invariants.slots_of(*id), &system.slots.nodes, &work.sampled.at, &work.sampled.v),
        };
        -force * rise
    };
    law.invariants.iter().zip(&response.force).map(of_invariant).sum()
}

/// What dampers that take their rates late make in a step between positions, J: of all together, and the law that makes most.
pub(crate) fn made_by_dampers(system: &System, stage: &Stage, work: &Workspace) -> (f64, Option<usize>) {
    let (mut sum, mut most) = (0.0, (0.0, None));
    for (k, (law, response)) in system.laws.iter().zip(&work.forces.responses).enumerate() {
        if !law.law.conservative() && !law.law.may_supply() && work.forces.is_late(k) {
            let made = work_of_law(system, law, response, stage, work);
            sum += made;
            if made > most.0 {
                most = (made, Some(k));
            }
        }
    }
    (sum, most.1)
}

/// Power of everything that [`work_between`] counts, at a moment of a workspace with its accelerations, W. Needs the state sampled. Leaves in the
/// workspace that of each worker.
pub fn power(system: &System, t: f64, moment: impl Fn(&Workspace) -> &Moment, work: &mut Workspace) -> f64 {
    let mut powers = std::mem::take(&mut work.powers);
    let sum = power_with(system, t, &moment(work).v, &work.a, work, &mut powers);
    work.powers = powers;
    sum
}

/// The same with these velocities and accelerations; leaves in `shares` the power of each worker.
pub fn power_with(system: &System, t: f64, v: &[f64], a: &[f64], work: &Workspace, shares: &mut [f64]) -> f64 {
    let n = system.coordinates();
    shares.fill(0.0);
    let [of_laws, of_loads, _, of_nodes] = system.workers().split(shares);
    let mut sum = loads_along(system, work, |i| v[i], [of_loads, of_nodes]);
    let laws = system.laws.iter().zip(&work.forces.responses).filter(|(law, _)| !law.law.conservative());
    for ((law, response), share) in laws.zip(of_laws) {
        for (k, id) in law.invariants.iter().enumerate() {
            let own = response.force[k] * system.along(&system.invariants.slots_of(*id), &system.slots.nodes, &work.sampled.at, v);
            (sum, *share) = (sum - own, *share - own);
        }
    }
    let mut of_known = 0.0;
    for i in n..v.len() {
        let own = work.forces.sum[i] * v[i];
        (of_known, of_nodes[(i - n) / system.dim]) = (of_known + own, of_nodes[(i - n) / system.dim] + own);
    }
    add_power_of_known(system, t, &work.sampled.at, v, a, &work.lambda, sum + of_known, shares)
}

/// Adds to a sum, and to the shares of the workers, the power that known motion gives to masses with the accelerations `a`, and that of rows that
/// depend on time with the multipliers λ, W.
#[expect(clippy::too_many_arguments)] // the state, and where it goes
fn add_power_of_known(
    system: &System,
    t: f64,
    at: &Evaluation,
    v: &[f64],
    a: &[f64],
    lambda: &[f64],
    mut sum: f64,
    shares: &mut [f64],
) -> f64 {
    let dim = system.dim;
    let [_, _, of_rows, of_nodes] = system.workers().split(shares);
    for (node, share) in (system.free..system.nodes()).zip(of_nodes) {
        for (b, mass) in system.mass.row(node) {
            let own = mass.product(&v[node * dim..(node + 1) * dim], &a[b * dim..(b + 1) * dim]);
            (sum, *share) = (sum + own, *share + own);
        }
    }
    for (&row, share) in system.driven_rows.iter().zip(of_rows) {
        let own = lambda[row as usize] * system.explicit_rate(row as usize, at, t);
        (sum, *share) = (sum + own, *share + own);
    }
    sum
}

/// Power of moving rows and of known motion at the start of a step, as far as it comes of multipliers and accelerations, W. Leaves in the workspace that
/// of each worker.
pub fn power_of_rows(system: &System, t: f64, work: &mut Workspace) -> f64 {
    let (n, dim) = (system.coordinates(), system.dim);
    let Workspace { full, lambda, start, a, powers, .. } = work;
    full.fill(0.0);
    powers.fill(0.0);
    system.slots.add_forces(dim, lambda, &start.at.gradient, full);
    let [.., of_nodes] = system.workers().split(powers);
    (n..full.len()).for_each(|i| of_nodes[(i - n) / dim] += full[i] * start.v[i]);
    let sum = (n..full.len()).map(|i| full[i] * start.v[i]).sum();
    add_power_of_known(system, t, &start.at, &start.v, a, lambda, sum, powers)
}

/// Adds to the shares of the workers what the impulses of a projection of velocities at the end of a step did along rows that move, J, and to their
/// powers that of the forces of one of accelerations, W. The velocities are on the rows, so that ∂Φ/∂t is −G v.
pub fn add_of_projections(system: &System, work: &mut Workspace) {
    let dim = system.dim;
    let Workspace { end, impulses: [of_v, of_a], shares, powers, .. } = work;
    let [[_, _, shares, led], [_, _, powers, led_by]] = [shares, powers].map(|sums| system.workers().split(sums));
    for ((&row, share), power) in system.driven_rows.iter().zip(shares).zip(powers) {
        let row = row as usize;
        let rate = -system.along(&system.slots.rows[row], &system.slots.nodes, &end.at, &end.v);
        (*share, *power) = (*share + of_v[row] * rate, *power + of_a[row] * rate);
    }
    if system.motions.is_empty() {
        return;
    }
    for (row, slots) in system.slots.rows.iter().enumerate() {
        for s in slots.clone() {
            if let Some(k) = (system.slots.nodes[s] as usize).checked_sub(system.free) {
                let along: f64 = (0..dim).map(|c| end.at.gradient[s * dim + c] * end.v[(system.free + k) * dim + c]).sum();
                (led[k], led_by[k]) = (led[k] + of_v[row] * along, led_by[k] + of_a[row] * along);
            }
        }
    }
}

/// Σ F·motion over the loads on free nodes. To the shares of loads that is added over all of their nodes, and what they push known nodes along by is
/// taken from the shares of these.
fn loads_along(system: &System, work: &Workspace, motion: impl Fn(usize) -> f64, [of_loads, of_nodes]: [&mut [f64]; 2]) -> f64 {
    let (mut sum, mut first) = (0.0, 0);
    for (load, share) in system.loads.iter().zip(of_loads) {
        for (k, node) in load.nodes.iter().enumerate() {
            for c in 0..system.dim {
                let own = work.forces.of_loads[first + k * system.dim + c] * motion(node.index() * system.dim + c);
                *share += own;
                match node.index().checked_sub(system.free) {
                    None => sum += own,
                    Some(known) => of_nodes[known] -= own,
                }
            }
        }
        first += load.nodes.len() * system.dim;
    }
    sum
}

/// Linear momentum (3) and angular momentum about the origin (3), kg·m/s and kg·m²/s.
pub fn momenta(system: &System, x: &[f64], v: &[f64], scratch: &mut [f64]) -> [f64; 6] {
    let dim = system.dim;
    system.mass.times(dim, v, scratch);
    let mut sum = [0.0; 6];
    for ((x, p), &is_point) in x.chunks_exact(dim).zip(scratch.chunks_exact(dim)).zip(&system.is_point) {
        let at = |v: &[f64], c: usize| if c < dim { v[c] } else { 0.0 };
        for c in 0..3 {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            sum[c] += if is_point { at(p, c) } else { 0.0 };
            sum[3 + c] += at(x, i) * at(p, j) - at(x, j) * at(p, i);
        }
    }
    sum
}

/// Moment or push that is round-off, over the sizes of its terms: some thousand roundings of each.
const CANCELLED: f64 = 1e-12;

/// Which of the six momenta nothing outside changes at the state sampled: the forces of gravity, laws, rows and loads
/// neither push nor turn that way, whatever their size. `kept` loses those that do. Places are rounded by their distance from the
/// origin and by the size of the mechanism: levers are compared with these, as a short one is no less of a lever.
pub fn drop_driven_momenta(system: &System, work: &Workspace, x: &[f64], kept: &mut [bool; 6]) {
    let (dim, length) = (system.dim, work.scales.length);
    for (k, kept) in kept.iter_mut().enumerate() {
        let moves_out = dim == 2 && (2..5).contains(&k);
        if moves_out || system.free < system.nodes() || !system.loads.is_empty() {
            *kept = false;
        }
        if !*kept {
            continue;
        }
        // What a force on a node adds to the momentum, and the size of what it is a sum of.
        let push = |node: usize, force: &[f64]| -> [f64; 2] {
            let (x, is_point) = (&x[node * dim..(node + 1) * dim], f64::from(u8::from(system.is_point[node])));
            let at = |v: &[f64], c: usize| if c < dim { v[c] } else { 0.0 };
            if k < 3 {
                return [at(force, k) * is_point, largest(force) * is_point];
            }
            let (i, j) = ((k - 2) % 3, (k - 1) % 3);
            [at(x, i) * at(force, j) - at(x, j) * at(force, i), largest(force) * (largest(x) + length)]
        };
        let is_driven = |pushes: &mut dyn Iterator<Item = [f64; 2]>| {
            let [sum, size] = pushes.fold([0.0, 0.0], |[sum, size]: [f64; 2], push| [sum + push[0], size + push[1]]);
            sum.abs() > CANCELLED * size
        };
        let rows = system.slots.rows.iter().cloned();
        let laws = system.laws.iter().flat_map(|law| law.invariants.iter().map(|&id| system.invariants.slots_of(id)));
        let gradient = &work.start.at.gradient;
        let of_slot = |s: usize| push(system.slots.nodes[s] as usize, &gradient[s * dim..(s + 1) * dim]);
        let is_pushed = rows.chain(laws).any(|slots| is_driven(&mut slots.map(of_slot)));
        let mut weights = work.forces.weight.chunks_exact(dim).enumerate().map(|(node, weight)| push(node, weight));
        *kept = !is_pushed && !is_driven(&mut weights);
    }
}
