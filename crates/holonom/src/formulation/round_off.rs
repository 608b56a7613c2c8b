//! What of a residual is round-off: every node's forces and every row's value against the sizes of the terms that they are
//! sums of (the backward error of Oettli and Prager 1964), whatever their directions. Neither masses nor units nor other parts of the mechanism matter.

use super::rank::Rank;
use super::stage::Stage;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::{Direction, System, scatter, scatter_rows};

/// Residual of a node's forces over the sum of its terms' sizes that is round-off: each term is itself a sum of some products.
const FORCES: f64 = 32.0 * f64::EPSILON;

/// The same of rows. Redundant ones may miss each other by the rounding of the constants of a model.
const ROWS: f64 = 128.0 * f64::EPSILON;

/// A share of the mechanism's size, over [`FORCES`], that is nothing: what stands still moves by that much of round-off.
const NOTHING: f64 = 0.1 * f64::EPSILON / FORCES;

impl Workspace {
    /// A length that is nothing beside the mechanism's, over [`FORCES`].
    pub(super) fn nothing(&self) -> f64 {
        NOTHING * self.scales.length
    }

    /// Whether the residual of a stage, in `unknowns`, is round-off.
    pub(super) fn is_met(&mut self, system: &System, stage: &Stage, moves: bool, unknowns: &[f64], rank: &Rank) -> bool {
        let n = system.coordinates();
        self.size_forces(system, stage);
        self.size_rows(system);
        let (forces, rows) = unknowns.split_at(n);
        (!moves || are_forces_round_off(forces, &self.full[..n])) && rank.are_rows_round_off(rows, &self.rows)
    }

    /// Leaves the sizes of the terms of M d in `inertial`, known nodes moving by `inertia` times their accelerations, and of Gᵀλ
    /// in `full`.
    fn size_parts(&mut self, system: &System, inertia: f64) {
        let (n, dim) = (system.coordinates(), system.dim);
        for (i, size) in self.full.iter_mut().enumerate() {
            let step = if i < n { self.d[i].abs().max(self.prediction.drift[i].abs()) } else { (inertia * self.a[i]).abs() };
            *size = step.max(NOTHING * self.scales.length);
        }
        system.mass.times_sizes(dim, &self.full, &mut self.inertial);
        let Self { rows, lambda, sampled, full, sizes, .. } = self;
        rows.iter_mut().zip(&*lambda).for_each(|(row, lambda)| *row = lambda.abs());
        sizes.iter_mut().zip(&sampled.at.gradient).for_each(|(size, g)| *size = g.abs());
        full.fill(0.0);
        scatter_rows(dim, &system.slots.by_row, rows, sizes, full);
    }

    /// Leaves the sizes of the terms of M d + Gᵀλ in `full`, of free nodes alone.
    pub(super) fn size_increments(&mut self, system: &System) {
        self.size_parts(system, 0.0);
        let n = system.coordinates();
        self.full.iter_mut().zip(&self.inertial).for_each(|(size, inertial)| *size += inertial);
        let nothing = self.nothing();
        for (node, massless) in self.full[..n].chunks_exact_mut(system.dim).zip(&self.scales.massless) {
            node.iter_mut().for_each(|size| *size += massless * nothing);
        }
        spread(system.dim, &mut self.full[..n]);
    }

    /// Leaves the sizes of the terms of ϖ (M a + f) in `full`.
    pub(super) fn size_forces(&mut self, system: &System, stage: &Stage) {
        let (n, dim, inertia) = (system.coordinates(), system.dim, stage.inertia);
        self.size_parts(system, inertia);
        for (law, response) in system.laws.iter().zip(&self.forces.responses) {
            for (k, &id) in law.invariants.iter().enumerate() {
                // A stiff law is as exact as its argument.
                let give: f64 = (0..law.invariants.len())
                    .map(|j| (response.by_value[k][j] * self.sampled.at.value[law.invariants[j].0 as usize]).abs())
                    .sum();
                let pull = response.force[k].abs() + give;
                for s in system.invariants.slots_of(id) {
                    let node = system.slots.nodes[s] as usize * dim;
                    (0..dim).for_each(|c| self.full[node + c] += pull * self.sizes[s * dim + c]);
                }
            }
        }
        let mut first = 0;
        for load in &system.loads {
            for (k, node) in load.nodes.iter().enumerate() {
                let (from, to) = (first + k * dim, node.index() * dim);
                (0..dim).for_each(|c| self.full[to + c] += self.forces.of_loads[from + c].abs());
            }
            first += load.nodes.len() * dim;
        }
        for (i, size) in self.full[..n].iter_mut().enumerate() {
            *size = inertia * (*size + self.forces.weight[i].abs()) + self.inertial[i];
        }
        spread(dim, &mut self.full[..n]);
    }

    /// How fast [these](Self::pushes) would make the free node that they push most, m/s².
    pub fn pushed_at_most(&mut self, system: &System) -> f64 {
        self.pushes(system);
        self.farthest(system, &self.full[..system.coordinates()])
    }

    /// The forces on the free nodes at the sampled state and those of the rows, each by its size, N.
    pub fn pushes(&mut self, system: &System) -> &[f64] {
        let (n, dim) = (system.coordinates(), system.dim);
        let Self { full, forces, sampled, lambda, rows, sizes, .. } = self;
        full.iter_mut().zip(&forces.weight).for_each(|(full, weight)| *full = weight.abs());
        sizes.iter_mut().zip(&sampled.at.gradient).for_each(|(size, g)| *size = g.abs());
        rows.iter_mut().zip(lambda).for_each(|(row, lambda)| *row = lambda.abs());
        scatter_rows(dim, &system.slots.by_row, rows, sizes, full);
        for (law, response) in system.laws.iter().zip(&forces.responses) {
            for (&id, force) in law.invariants.iter().zip(&response.force) {
                let slots = system.invariants.slots_of(id);
                scatter(dim, &system.slots.nodes[slots.clone()], force.abs(), &sizes[slots.start * dim..slots.end * dim], full);
            }
        }
        let of_loads = system.loads.iter().flat_map(|load| &load.nodes).zip(forces.of_loads.chunks_exact(dim));
        of_loads.for_each(|(node, force)| (0..dim).for_each(|c| full[node.index() * dim + c] += force[c].abs()));
        &self.full[..n]
    }

    /// Leaves the sizes of the terms of Φ in `rows`: of gradients times positions, whose last digits are lost.
    pub fn size_rows(&mut self, system: &System) {
        self.rows.fill(0.0);
        for slot in &system.slots.by_row {
            let (g, x) = (slot.slot as usize * system.dim, slot.node as usize * system.dim);
            let (g, x) = (&self.end.at.gradient[g..g + system.dim], &self.end.x[x..x + system.dim]);
            self.rows[slot.row as usize] += largest(g) * largest(x);
        }
        for (size, g) in self.rows.iter_mut().zip(&self.scales.gradient) {
            *size += g * NOTHING * self.scales.length;
        }
        for (size, row) in self.rows.iter_mut().zip(&system.rows) {
            // Angles are counted over turns.
            *size += self.end.at.value[system.value_index(row.quantity)].abs();
        }
    }
}

impl Workspace {
    /// Leaves the sizes of the terms of Φ̇ at the end of the step in `rows`: of gradients times velocities, and of their changes
    /// times positions.
    pub fn size_rates(&mut self, system: &System) {
        let Self { end, turned, rows, .. } = self;
        system.turn(&end.at, &end.x, Direction::velocity(&end.v), 0.0, &mut turned.half, &mut turned.v);
        rows.fill(0.0);
        for slot in &system.slots.by_row {
            let (g, x) = (slot.slot as usize * system.dim, slot.node as usize * system.dim);
            let size = |g: &[f64], x: &[f64]| largest(g) * largest(x);
            let (g, x) = (g..g + system.dim, x..x + system.dim);
            rows[slot.row as usize] += size(&end.at.gradient[g.clone()], &end.v[x.clone()]) + size(&turned.v[g], &end.x[x]);
        }
    }
}

/// The largest of a node's components for all of them.
pub(super) fn spread(dim: usize, sizes: &mut [f64]) {
    for node in sizes.chunks_exact_mut(dim) {
        let largest = node.iter().copied().fold(0.0, f64::max);
        node.fill(largest);
    }
}

/// Whether each of some forces is round-off of terms of the sizes beside it.
pub(super) fn are_forces_round_off(forces: &[f64], sizes: &[f64]) -> bool {
    forces.iter().zip(sizes).all(|(force, size)| force.abs() <= FORCES * size)
}

/// The same of values of rows.
pub(super) fn are_rows_round_off(rows: &[f64], sizes: &[f64]) -> bool {
    rows.iter().zip(sizes).all(|(row, size)| is_row_round_off(*row, *size))
}

/// The same of the value of one row.
fn is_row_round_off(row: f64, size: f64) -> bool {
    row.abs() <= ROWS * size
}

impl Rank {
    /// The same of values of all rows but redundant ones. No multiplier moves these: they are what the rounding of positions makes
    /// of them, much near a singular position.
    pub(super) fn are_rows_round_off(&self, rows: &[f64], sizes: &[f64]) -> bool {
        rows.iter().zip(sizes).enumerate().all(|(k, (row, size))| !self.is_regular(k) || is_row_round_off(*row, *size))
    }
}
