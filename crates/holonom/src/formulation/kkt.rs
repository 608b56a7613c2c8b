//! The matrix of a stage: coordinates and multipliers of all nodes and rows, on a pattern planned once.
//!
//! A node carries one or two *fields* of coordinates (position; position and velocity) and a row as many multipliers.
//! Blocks of the first kind are node × node, and mostly multiples of the unit matrix: their factors are summed first
//! (one number a pair of nodes) and then written to the matrix.

use std::ops::{Deref, Range};
use std::sync::Arc;

use super::augmented::Augmented;
use super::failure::{Failure, Unknown};
use super::law_groups::{GroupSum, LawFactors, LawTangents};
use super::pattern::{Block, Coupling, NONE, Pattern};
use super::scales::Scales;
use crate::linalg::{Singular, Solver};
use crate::system::{Mass, System, cross, skew};

/// The planned matrix.
pub struct Kkt {
    /// Its numbers and their factors.
    pub solver: Solver,
    pattern: Arc<Pattern>,
    pair_mass: Vec<f64>,
    pair_sum: Vec<f64>,
    /// The e of the mass matrix of the pairs with full blocks, which quarter turns of the plane make, and of the sum at hand.
    full_mass: Vec<[f64; 3]>,
    full_sum: Vec<[f64; 3]>,
    /// The rows that enter the part of the coordinates, too.
    augmented: Vec<Augmented>,
    group_sum: GroupSum,
}

impl Deref for Kkt {
    type Target = Pattern;

    fn deref(&self) -> &Pattern {
        &self.pattern
    }
}

impl Kkt {
    /// Plans the matrix of a system with `fields` fields a node, of which rows and coordinates share blocks by `coupling`.
    pub fn new(system: &System, scales: &Scales, fields: usize, coupling: Coupling) -> Self {
        let pattern = Pattern::new(system, &scales.has_light, fields, coupling);
        let places = scales.has_light.contains(&true).then(|| pattern.plan.places());
        let light = (0..system.constraints()).filter(|&row| scales.has_light[row]);
        let light = light.flat_map(|row| (0..fields).map(move |field| (row, field)));
        let augment = |(row, field)| Some(pattern.augment(places.as_ref()?, row, field, 1.0 / scales.softness[row]));
        let augmented = light.filter_map(augment).collect();
        let mut kkt = Self::of(Arc::new(pattern), &system.mass, augmented);
        let mut units = vec![0.0; kkt.size()];
        for field in 0..fields {
            for (node, held) in scales.held.iter().enumerate() {
                (0..kkt.dim).for_each(|c| units[kkt.coordinate(node, field, c)] = held.sqrt());
            }
            for (row, softness) in scales.softness.iter().enumerate() {
                units[kkt.multiplier(row, field)] = 1.0 / softness.sqrt();
            }
        }
        kkt.solver.set_units(&units);
        kkt
    }

    fn of(pattern: Arc<Pattern>, mass: &Mass, augmented: Vec<Augmented>) -> Self {
        let of_pair = |&[a, b]: &[u32; 2]| mass.row(a as usize).find(|&(c, _)| c == b as usize).map(|(_, block)| block);
        let pair_mass: Vec<f64> = pattern.pair_nodes.iter().map(|pair| of_pair(pair).map_or(0.0, |block| block.m)).collect();
        let full = pattern.full_pairs.iter().map(|&pair| of_pair(&pattern.pair_nodes[pair as usize]));
        let full_mass: Vec<[f64; 3]> = full.map(|block| [0.0, 0.0, block.map_or(0.0, |block| -block.s)]).collect();
        Self {
            solver: Solver::new(pattern.plan.clone()),
            pair_sum: vec![0.0; pair_mass.len()],
            pair_mass,
            full_sum: vec![[0.0; 3]; full_mass.len()],
            full_mass,
            augmented,
            group_sum: GroupSum::new(&pattern.law_groups, pattern.dim),
            pattern,
        }
    }

    /// Another matrix for the same, without values.
    pub fn twin(&self) -> Self {
        Self {
            solver: self.solver.twin(),
            pattern: self.pattern.clone(),
            pair_mass: self.pair_mass.clone(),
            pair_sum: self.pair_sum.clone(),
            full_mass: self.full_mass.clone(),
            full_sum: self.full_sum.clone(),
            augmented: self.augmented.clone(),
            group_sum: GroupSum::new(&self.pattern.law_groups, self.dim),
        }
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.solver.values_mut().fill(0.0);
    }

    /// Starts the sum over pairs of nodes with `factor` times the mass matrix.
    pub fn start_with_mass(&mut self, factor: f64) {
        for (sum, &mass) in self.pair_sum.iter_mut().zip(&self.pair_mass) {
            *sum = factor * mass;
        }
        for (sum, mass) in self.full_sum.iter_mut().zip(&self.full_mass) {
            *sum = mass.map(|e| factor * e);
        }
    }

    /// Starts the sum over pairs of nodes with a weight for each free node.
    pub fn start_with_weights<'a>(&mut self, weights: impl IntoIterator<Item = &'a f64>) {
        self.pair_sum.fill(0.0);
        self.full_sum.fill([0.0; 3]);
        for (&pair, &weight) in self.pattern.own_pair.iter().zip(weights) {
            self.pair_sum[pair as usize] = weight;
        }
    }

    /// Adds `factor` Σ λ_k H_k of the invariant rows to the sum over pairs, which [`Kkt::write_sum`] has yet to write.
    pub fn add_row_hessians(&mut self, lambda: &[f64], factor: f64) {
        for &(row, pair, c) in &self.pattern.row_isotropic {
            self.pair_sum[pair as usize] += factor * lambda[row as usize] * c;
        }
        for &(row, turn) in &self.pattern.row_skew {
            turn.add(factor * lambda[row as usize], &mut self.full_sum);
        }
    }

    /// Adds the tangents of laws: f_i H_i, and ∇π_i (∂f_i/∂π_j ∇π_j + ∂f_i/∂π̇_j ∇π̇_j)ᵀ, each with its factor, or nothing of those without factors.
    pub fn add_laws(&mut self, block: Block, laws: Range<usize>, tangents: &LawTangents, factors: impl Fn(usize) -> Option<LawFactors>) {
        for (law, factors) in laws.clone().filter_map(|law| Some((law, factors(law)?))) {
            for (hessian, force) in self.pattern.law_hessian[law].iter().zip(&tangents.responses[law].force) {
                let weight = factors.force * force;
                for &(pair, c) in &hessian.isotropic {
                    self.pair_sum[pair as usize] += weight * c;
                }
                for turn in &hessian.skew {
                    turn.add(weight, &mut self.full_sum);
                }
            }
        }
        match self.dim {
            2 => self.add_outer_in::<2>(block, laws, tangents, factors),
            _ => self.add_outer_in::<3>(block, laws, tangents, factors),
        }
    }

    fn add_outer_in<const D: usize>(
        &mut self,
        block: Block,
        laws: Range<usize>,
        tangents: &LawTangents,
        factors: impl Fn(usize) -> Option<LawFactors>,
    ) {
        let Self { solver, pattern, group_sum, .. } = self;
        let values = solver.values_mut();
        for group in pattern.law_groups.iter().filter(|group| laws.contains(&group.first)) {
            if !group_sum.add_up::<D>(group, tangents, &factors) {
                continue;
            }
            let width = group.nodes * D;
            for (pairs, lines) in group.pairs.chunks_exact(group.nodes).zip(group_sum.matrix.chunks_exact(D * width)) {
                for (b, &pair) in pairs.iter().enumerate() {
                    for (positions, line) in pattern.full_block::<D>(block, pair).iter().zip(lines.chunks_exact(width)) {
                        positions.iter().zip(&line[b * D..]).for_each(|(&position, sum)| values[position as usize] += sum);
                    }
                }
            }
        }
    }

    /// Adds a dense tangent (k × k over the load's nodes, row-major) times `factor`.
    pub fn add_load(&mut self, block: Block, load: usize, tangent: &[f64], factor: f64) {
        self.add_group(block, |pattern| &pattern.load_pairs[load], tangent, factor);
    }

    /// Adds the second derivatives (k × k over the nodes of a custom entry, row-major) times `factor`.
    pub fn add_custom(&mut self, block: Block, entry: usize, hessian: &[f64], factor: f64) {
        self.add_group(block, |pattern| &pattern.custom_pairs[entry], hessian, factor);
    }

    fn add_group(&mut self, block: Block, pairs: impl Fn(&Pattern) -> &[u32], matrix: &[f64], factor: f64) {
        match self.dim {
            2 => self.add_group_in::<2>(block, pairs, matrix, factor),
            _ => self.add_group_in::<3>(block, pairs, matrix, factor),
        }
    }

    fn add_group_in<const D: usize>(&mut self, block: Block, pairs: impl Fn(&Pattern) -> &[u32], matrix: &[f64], factor: f64) {
        let Self { solver, pattern, .. } = self;
        let (values, pairs, matrix) = (solver.values_mut(), pairs(pattern), matrix.as_chunks::<D>().0);
        let nodes = pairs.len().isqrt();
        for (k, &pair) in pairs.iter().enumerate().filter(|&(_, &pair)| pair != NONE) {
            let (a, b) = (k / nodes, k % nodes);
            for (c, positions) in pattern.full_block::<D>(block, pair).iter().enumerate() {
                let line = &matrix[(a * D + c) * nodes + b];
                positions.iter().zip(line).for_each(|(&position, entry)| values[position as usize] += factor * entry);
            }
        }
    }

    /// Adds the sum over pairs to a block.
    pub fn write_sum(&mut self, Block(i, j): Block) {
        match self.dim {
            2 => self.write_sum_in::<2>(i * self.fields + j),
            _ => self.write_sum_in::<3>(i * self.fields + j),
        }
    }

    fn write_sum_in<const D: usize>(&mut self, combination: usize) {
        let Self { solver, pattern, .. } = self;
        let (values, blocks) = (solver.values_mut(), pattern.fields * pattern.fields);
        let positions = pattern.diagonal.as_chunks::<D>().0.iter().skip(combination).step_by(blocks);
        for (positions, &sum) in positions.zip(&self.pair_sum) {
            positions.iter().for_each(|&position| values[position as usize] += sum);
        }
        let positions = pattern.full.chunks_exact(D * D).skip(combination).step_by(blocks);
        for (positions, axis) in positions.zip(&self.full_sum).filter(|(_, axis)| **axis != [0.0; 3]) {
            for (c, line) in skew(axis).iter().take(D).enumerate() {
                (0..D).for_each(|d| values[positions[c * D + d] as usize] += line[d]);
            }
        }
    }

    /// Adds `factor` times the sum over pairs times `x` (free coordinates) to `out`.
    pub fn add_sum_times(&self, factor: f64, x: &[f64], out: &mut [f64]) {
        match self.dim {
            2 => self.add_sum_times_in::<2>(factor, x, out),
            _ => self.add_sum_times_in::<3>(factor, x, out),
        }
    }

    fn add_sum_times_in<const D: usize>(&self, factor: f64, x: &[f64], out: &mut [f64]) {
        let (x, out) = (x.as_chunks::<D>().0, out.as_chunks_mut::<D>().0);
        for (&[a, b], &sum) in self.pair_nodes.iter().zip(&self.pair_sum) {
            let (x, out) = (&x[b as usize], &mut out[a as usize]);
            (0..D).for_each(|c| out[c] += factor * sum * x[c]);
        }
        for (&pair, axis) in self.full_pairs.iter().zip(&self.full_sum) {
            let [a, b] = self.pair_nodes[pair as usize];
            let (turned, out) = (cross(&x[b as usize], axis), &mut out[a as usize]);
            (0..D).for_each(|c| out[c] += factor * turned[c]);
        }
    }

    /// Adds the gradients of all rows as columns of multipliers: block (coordinates of field i, multipliers of field j).
    pub fn add_columns(&mut self, block: Block, gradient: &[f64], factor: f64) {
        self.add_gradients(block, gradient, factor, 0);
    }

    /// Adds the gradients of all rows as rows: block (row of field i, coordinates of field j).
    pub fn add_rows(&mut self, Block(i, j): Block, gradient: &[f64], factor: f64) {
        self.add_gradients(Block(j, i), gradient, factor, 1);
    }

    fn add_gradients(&mut self, Block(i, j): Block, gradient: &[f64], factor: f64, side: usize) {
        let entries = &self.pattern.row_entries[(side * self.pattern.fields + i) * self.pattern.fields + j];
        let values = self.solver.values_mut();
        for &[slot, position] in entries {
            values[position as usize] += factor * gradient[slot as usize];
        }
    }

    /// Subtracts δ (r) from the diagonal of the rows of a field.
    pub fn regularise(&mut self, field: usize, delta: &[f64]) {
        let values = self.solver.values_mut();
        for (row, &delta) in delta.iter().enumerate() {
            values[self.pattern.row_diagonal[row * self.pattern.fields + field] as usize] -= delta;
        }
    }

    /// Whether rows change entries of the matrix one by one and it can be factored in part.
    pub fn is_changed_by_rows(&self) -> bool {
        self.fields == 1 && self.row_skew.is_empty() && self.augmented.is_empty() && self.solver.has_parts()
    }

    /// Adds what the matrix changes by with a row: `hessian` times its second derivatives and, in its columns and its rows, the
    /// factors times the change of its gradient.
    pub fn change_row(&mut self, row: usize, hessian: f64, [columns, rows]: [f64; 2], change: &[f64]) {
        let start = self.gradient_of(row).start as u32;
        let Self { solver, pattern, .. } = self;
        let values = solver.values_mut();
        let ([isotropic, first], [isotropic_end, end]) = (pattern.row_first[row], pattern.row_first[row + 1]);
        for &(_, pair, c) in &pattern.row_isotropic[isotropic as usize..isotropic_end as usize] {
            for &position in &pattern.diagonal[pair as usize * pattern.dim..][..pattern.dim] {
                values[position as usize] += hessian * c;
            }
        }
        for (entries, factor) in pattern.row_entries.iter().zip([columns, rows]) {
            for &[slot, position] in &entries[first as usize..end as usize] {
                values[position as usize] += factor * change[(slot - start) as usize];
            }
        }
    }

    /// Factors the matrix again where some rows changed it.
    pub fn factor_rows(&mut self, rows: &[usize]) -> Result<(), Failure> {
        let Self { solver, pattern, .. } = self;
        let Pattern { dim, free, slots, .. } = &**pattern;
        let coordinates = |s: usize| {
            let node = slots.nodes[s] as usize;
            (node * *dim..(node + 1) * *dim).take_while(|q| *q < *free * *dim)
        };
        let unknowns = rows.iter().flat_map(|&row| slots.rows[row].clone().flat_map(coordinates).chain([*free * *dim + row]));
        let outcome = solver.factor_with(unknowns);
        outcome.map_err(|singular| self.blame(singular))
    }

    /// Factors the matrix.
    pub fn factor(&mut self) -> Result<(), Failure> {
        let values = self.solver.values_mut();
        self.augmented.iter_mut().for_each(|row| row.add(values));
        let outcome = self.solver.factor();
        outcome.map_err(|singular| self.blame(singular))
    }

    /// Replaces a right side by the solution with the factors at hand.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.augmented.iter().for_each(|row| row.pull(b));
        self.solver.solve(b);
    }

    /// The node or row whose pivot is none, where its numbers are such.
    fn blame(&mut self, Singular { pivot }: Singular) -> Failure {
        if self.solver.values_mut().iter().any(|value| !value.is_finite()) {
            return Failure::NotFinite;
        }
        Failure::Singular(match pivot.checked_sub(self.multiplier(0, 0)) {
            Some(row) => Unknown::Row(row / self.fields),
            None => Unknown::Node(pivot / (self.fields * self.dim)),
        })
    }
}
