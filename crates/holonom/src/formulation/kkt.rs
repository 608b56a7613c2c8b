//! The matrix of a stage: coordinates and multipliers of all nodes and rows, on a pattern planned once.
//!
//! A node carries one or two *fields* of coordinates (position; position and velocity) and a row as many multipliers.
//! Blocks of the first kind are node × node, and mostly multiples of the unit matrix: their factors are summed first
//! (one number a pair of nodes) and then written to the matrix.

use std::ops::Range;

use crate::linalg::{Singular, Solver, fill_reducing_order};
use crate::system::{HessianBlock, InvariantId, MAX_ARGUMENTS, Response, System, skew};

const NONE: u32 = u32::MAX;

/// A block of the matrix: the field of its rows and the field of its columns.
#[derive(Clone, Copy, Debug)]
pub struct Block(pub usize, pub usize);

/// One term of the tangent of a law: ∇π_i (∂f_i/∂·) ∇π_jᵀ for a pair of slots.
struct OuterTerm {
    slot: [u32; 2],
    argument: [u8; 2],
    pair: u32,
}

/// Constant second derivatives of an invariant, free nodes only.
#[derive(Default)]
struct Hessian {
    isotropic: Vec<(u32, f64)>,
    skew: Vec<(u32, f64, [f64; 3])>,
}

/// The planned matrix.
pub struct Kkt {
    pub solver: Solver,
    dim: usize,
    fields: usize,
    free: usize,
    /// Slots of each row.
    pub row_slots: Vec<Range<usize>>,
    /// Node of each slot.
    pub slot_nodes: Vec<u32>,
    pair_mass: Vec<f64>,
    pair_sum: Vec<f64>,
    own_pair: Vec<u32>,
    diagonal: Vec<u32>,
    full_index: Vec<u32>,
    full: Vec<u32>,
    row_hessian: Vec<Hessian>,
    law_hessian: Vec<Vec<Hessian>>,
    law_outer: Vec<Vec<OuterTerm>>,
    load_pairs: Vec<Vec<u32>>,
    custom_pairs: Vec<Vec<u32>>,
    row_positions: Vec<u32>,
    row_first: Vec<u32>,
    row_diagonal: Vec<u32>,
}

/// Pairs of free nodes that share a block of the matrix.
#[derive(Default)]
struct Pairs {
    found: std::collections::BTreeMap<(u32, u32), (u32, bool)>,
}

impl Pairs {
    fn add(&mut self, a: u32, b: u32, full: bool) {
        for key in [(a, b), (b, a)] {
            let entry = self.found.entry(key).or_default();
            entry.1 |= full;
        }
    }

    fn number(&mut self) {
        for (k, entry) in self.found.values_mut().enumerate() {
            entry.0 = k as u32;
        }
    }

    fn at(&self, a: u32, b: u32) -> u32 {
        self.found[&(a, b)].0
    }
}

impl Kkt {
    /// Plans the matrix of a system with one or two fields a node.
    pub fn new(system: &System, fields: usize) -> Self {
        let (dim, free) = (system.dim, system.free);
        let slot_nodes: Vec<u32> = system.slot_nodes().map(|node| node as u32).collect();
        let row_slots = system.row_slots();
        let is_free = |node: u32| (node as usize) < free;
        let mut pairs = Pairs::default();
        for a in 0..free as u32 {
            pairs.add(a, a, false);
            system.mass.row(a as usize).filter(|&(b, _)| b < free).for_each(|(b, _)| pairs.add(a, b as u32, false));
        }
        let of_rows = system.rows.iter().map(|row| row.invariant);
        let of_laws = system.laws.iter().flat_map(|law| law.invariants.iter().copied());
        for id in of_rows.chain(of_laws) {
            for (a, b, block) in system.invariants.hessian(id) {
                if is_free(a) && is_free(b) {
                    pairs.add(a, b, matches!(block, HessianBlock::Skew(..)));
                }
            }
        }
        let law_slots = |ids: &[InvariantId]| -> Vec<(u32, u8)> {
            let slots = ids.iter().enumerate().flat_map(|(k, &id)| system.invariants.slots_of(id).map(move |s| (s as u32, k as u8)));
            slots.filter(|&(s, _)| is_free(slot_nodes[s as usize])).collect()
        };
        for law in &system.laws {
            let slots = law_slots(&law.invariants);
            for &(s, _) in &slots {
                slots.iter().for_each(|&(t, _)| pairs.add(slot_nodes[s as usize], slot_nodes[t as usize], true));
            }
        }
        let groups = system.loads.iter().map(|load| &load.nodes).chain(system.custom.iter().map(|custom| &custom.nodes));
        for nodes in groups {
            for a in nodes.iter().filter(|a| is_free(a.0)) {
                nodes.iter().filter(|b| is_free(b.0)).for_each(|b| pairs.add(a.0, b.0, true));
            }
        }
        pairs.number();

        let hessian = |id: InvariantId| {
            let mut hessian = Hessian::default();
            for (a, b, block) in system.invariants.hessian(id).into_iter().filter(|&(a, b, _)| is_free(a) && is_free(b)) {
                match block {
                    HessianBlock::Isotropic(c) => hessian.isotropic.push((pairs.at(a, b), c)),
                    HessianBlock::Skew(c, e) => hessian.skew.push((pairs.at(a, b), c, e)),
                }
            }
            hessian
        };
        let row_hessian = system.rows.iter().map(|row| hessian(row.invariant)).collect();
        let law_hessian = system.laws.iter().map(|law| law.invariants.iter().map(|&id| hessian(id)).collect()).collect();
        let law_outer = system.laws.iter().map(|law| {
            let slots = law_slots(&law.invariants);
            let terms = slots.iter().flat_map(|&(s, i)| slots.iter().map(move |&(t, j)| (s, i, t, j)));
            let term = |(s, i, t, j)| OuterTerm {
                slot: [s, t],
                argument: [i, j],
                pair: pairs.at(slot_nodes[s as usize], slot_nodes[t as usize]),
            };
            terms.map(term).collect()
        });
        let law_outer = law_outer.collect();
        let group_pairs = |nodes: &[crate::system::NodeId]| -> Vec<u32> {
            let all = nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a.0, b.0)));
            all.map(|(a, b)| if is_free(a) && is_free(b) { pairs.at(a, b) } else { NONE }).collect()
        };
        let load_pairs = system.loads.iter().map(|load| group_pairs(&load.nodes)).collect();
        let custom_pairs = system.custom.iter().map(|custom| group_pairs(&custom.nodes)).collect();
        let pair_mass = pairs.found.keys().map(|&(a, b)| {
            system.mass.row(a as usize).find(|&(c, _)| c == b as usize).map_or(0.0, |(_, m)| m)
        });
        let pair_mass: Vec<f64> = pair_mass.collect();

        let mut kkt = Self {
            solver: Solver::new(0, &[], &[]),
            dim,
            fields,
            free,
            row_first: Vec::new(),
            pair_sum: vec![0.0; pair_mass.len()],
            pair_mass,
            own_pair: (0..free as u32).map(|a| pairs.at(a, a)).collect(),
            diagonal: Vec::new(),
            full_index: Vec::new(),
            full: Vec::new(),
            row_hessian,
            law_hessian,
            law_outer,
            load_pairs,
            custom_pairs,
            row_positions: Vec::new(),
            row_diagonal: Vec::new(),
            row_slots,
            slot_nodes,
        };
        kkt.plan(&pairs);
        kkt
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.fields * (self.free * self.dim + self.row_slots.len())
    }

    /// Place of a coordinate among the unknowns.
    pub fn coordinate(&self, node: usize, field: usize, component: usize) -> usize {
        (node * self.fields + field) * self.dim + component
    }

    /// Place of a multiplier among the unknowns.
    pub fn multiplier(&self, row: usize, field: usize) -> usize {
        self.fields * self.free * self.dim + row * self.fields + field
    }

    fn is_free(&self, slot: usize) -> bool {
        (self.slot_nodes[slot] as usize) < self.free
    }

    /// Position rows do not react on velocities, so this block of rows and coordinates is empty (both ways).
    fn is_empty_block(node_field: usize, row_field: usize) -> bool {
        node_field == 1 && row_field == 0
    }

    fn plan(&mut self, pairs: &Pairs) {
        let (dim, fields, rows) = (self.dim, self.fields, self.row_slots.len());
        let combinations: Vec<(usize, usize)> = (0..fields).flat_map(|i| (0..fields).map(move |j| (i, j))).collect();
        let mut entries = Vec::new();
        for (&(a, b), &(_, full)) in &pairs.found {
            for &(i, j) in &combinations {
                for c in 0..dim {
                    for d in (0..dim).filter(|&d| full || d == c) {
                        entries.push((self.coordinate(a as usize, i, c) as u32, self.coordinate(b as usize, j, d) as u32));
                    }
                }
            }
        }
        for row in 0..rows {
            for &(i, j) in &combinations {
                let r = self.multiplier(row, i) as u32;
                entries.push((r, self.multiplier(row, j) as u32));
                for s in self.row_slots[row].clone().filter(|&s| self.is_free(s) && !Self::is_empty_block(j, i)) {
                    for c in 0..dim {
                        let q = self.coordinate(self.slot_nodes[s] as usize, j, c) as u32;
                        entries.extend([(r, q), (q, r)]);
                    }
                }
            }
        }
        self.solver = Solver::new(self.size(), &entries, &self.elimination_order(pairs));
        for (&(a, b), &(_, full)) in &pairs.found {
            self.full_index.push(if full { (self.full.len() / (fields * fields * dim * dim)) as u32 } else { NONE });
            for &(i, j) in &combinations {
                for c in 0..dim {
                    let row = self.coordinate(a as usize, i, c);
                    self.diagonal.push(self.solver.position(row, self.coordinate(b as usize, j, c)));
                    for d in (0..dim).filter(|_| full) {
                        self.full.push(self.solver.position(row, self.coordinate(b as usize, j, d)));
                    }
                }
            }
        }
        for row in 0..rows {
            self.row_first.push((self.row_positions.len() / (2 * fields * fields * dim)) as u32);
            for s in self.row_slots[row].clone() {
                for &(i, j) in &combinations {
                    for c in 0..dim {
                        let there = self.is_free(s) && !Self::is_empty_block(i, j);
                        let (q, r) = (self.coordinate(self.slot_nodes[s] as usize, i, c), self.multiplier(row, j));
                        let position = |a, b| if there { self.solver.position(a, b) } else { NONE };
                        self.row_positions.extend([position(q, r), position(r, q)]);
                    }
                }
            }
            for i in 0..fields {
                let r = self.multiplier(row, i);
                self.row_diagonal.push(self.solver.position(r, r));
            }
        }
    }

    /// Nodes by least fill-in, each row right after the last of its nodes: its pivot is then minus what the row's
    /// gradient adds to those before it, and never the bare regularisation unless the row is redundant.
    fn elimination_order(&self, pairs: &Pairs) -> Vec<u32> {
        let mut edges: Vec<(u32, u32)> = pairs.found.keys().copied().filter(|&(a, b)| a < b).collect();
        let free_nodes = |slots: &Range<usize>| -> Vec<u32> {
            slots.clone().filter(|&s| self.is_free(s)).map(|s| self.slot_nodes[s]).collect()
        };
        for slots in &self.row_slots {
            let nodes = free_nodes(slots);
            for &a in &nodes {
                edges.extend(nodes.iter().filter(|&&b| a < b).map(|&b| (a, b)));
            }
        }
        let nodes = fill_reducing_order(self.free, &edges);
        let mut place = vec![0; self.free];
        nodes.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k);
        let mut rows_after: Vec<Vec<usize>> = vec![Vec::new(); self.free];
        let mut first = Vec::new();
        for (row, slots) in self.row_slots.iter().enumerate() {
            match free_nodes(slots).iter().map(|&node| place[node as usize]).max() {
                Some(last) => rows_after[last].push(row),
                None => first.push(row),
            }
        }
        let mut order = Vec::with_capacity(self.size());
        let push_row = |order: &mut Vec<u32>, row| (0..self.fields).for_each(|f| order.push(self.multiplier(row, f) as u32));
        first.into_iter().for_each(|row| push_row(&mut order, row));
        for (k, &node) in nodes.iter().enumerate() {
            for field in 0..self.fields {
                (0..self.dim).for_each(|c| order.push(self.coordinate(node as usize, field, c) as u32));
            }
            rows_after[k].iter().for_each(|&row| push_row(&mut order, row));
        }
        order
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
    }

    /// Starts the sum over pairs of nodes with a weight for each free node.
    pub fn start_with_weights<'a>(&mut self, weights: impl IntoIterator<Item = &'a f64>) {
        self.pair_sum.fill(0.0);
        for (&pair, &weight) in self.own_pair.iter().zip(weights) {
            self.pair_sum[pair as usize] = weight;
        }
    }

    /// Adds `factor` Σ λ_k H_k of the invariant rows to a block; parts that are multiples of the unit matrix go to the
    /// sum over pairs, which [`Kkt::write_sum`] has yet to write.
    pub fn add_row_hessians(&mut self, block: Block, lambda: &[f64], factor: f64) {
        for (row, &lambda) in (0..self.row_hessian.len()).zip(lambda) {
            let weight = factor * lambda;
            for &(pair, c) in &self.row_hessian[row].isotropic {
                self.pair_sum[pair as usize] += weight * c;
            }
            for k in 0..self.row_hessian[row].skew.len() {
                let (pair, c, e) = self.row_hessian[row].skew[k];
                self.add_skew(block, pair, weight * c, &e);
            }
        }
    }

    fn add_skew(&mut self, block: Block, pair: u32, weight: f64, e: &[f64; 3]) {
        let matrix = skew(e);
        let dim = self.dim;
        self.add_full(block, pair, |c, d| weight * matrix[c][d], dim);
    }

    #[inline]
    fn add_full(&mut self, Block(i, j): Block, pair: u32, value: impl Fn(usize, usize) -> f64, dim: usize) {
        let combination = i * self.fields + j;
        let first = (self.full_index[pair as usize] as usize * self.fields * self.fields + combination) * dim * dim;
        let values = self.solver.values_mut();
        for c in 0..dim {
            for d in 0..dim {
                values[self.full[first + c * dim + d] as usize] += value(c, d);
            }
        }
    }

    /// Adds the tangent of a law: `geometric` f_i H_i, and ∇π_i (c_v ∂f_i/∂π_j + c_r ∂f_i/∂π̇_j) ∇π_jᵀ with the left
    /// gradients `left`, the right ones `right` and the factors `[c_v, c_r]`. `motion` are the slots of H v, for the
    /// dependence of π̇ on positions, with its factor.
    pub fn add_law(&mut self, law: usize, response: &Response, geometric: f64, left: &[f64], right: &[f64], by: [f64; 2], motion: (&[f64], f64)) {
        let dim = self.dim;
        for argument in 0..self.law_hessian[law].len() {
            let weight = geometric * response.force[argument];
            for &(pair, c) in &self.law_hessian[law][argument].isotropic {
                self.pair_sum[pair as usize] += weight * c;
            }
            for k in 0..self.law_hessian[law][argument].skew.len() {
                let (pair, c, e) = self.law_hessian[law][argument].skew[k];
                self.add_skew(Block(0, 0), pair, weight * c, &e);
            }
        }
        for k in 0..self.law_outer[law].len() {
            let OuterTerm { slot: [s, t], argument: [i, j], pair } = self.law_outer[law][k];
            let (i, j, s, t) = (i as usize, j as usize, s as usize * dim, t as usize * dim);
            let stiffness = by[0] * response.by_value[i][j] + by[1] * response.by_rate[i][j];
            let turning = motion.1 * response.by_rate[i][j];
            let along = |d: usize| stiffness * right[t + d] + if turning == 0.0 { 0.0 } else { turning * motion.0[t + d] };
            self.add_full(Block(0, 0), pair, |c, d| left[s + c] * along(d), dim);
        }
    }

    /// Adds a dense tangent (k × k over the load's nodes, row-major) times `factor`.
    pub fn add_load(&mut self, load: usize, tangent: &[f64], factor: f64) {
        let pairs = std::mem::take(&mut self.load_pairs);
        self.add_group(Block(0, 0), &pairs[load], tangent, factor);
        self.load_pairs = pairs;
    }

    /// Adds the second derivatives (k × k over the nodes of a custom entry, row-major) times `factor`.
    pub fn add_custom(&mut self, entry: usize, hessian: &[f64], factor: f64) {
        let pairs = std::mem::take(&mut self.custom_pairs);
        self.add_group(Block(0, 0), &pairs[entry], hessian, factor);
        self.custom_pairs = pairs;
    }

    fn add_group(&mut self, block: Block, pairs: &[u32], matrix: &[f64], factor: f64) {
        let (dim, nodes) = (self.dim, pairs.len().isqrt());
        for (k, &pair) in pairs.iter().enumerate().filter(|&(_, &pair)| pair != NONE) {
            let (a, b) = (k / nodes, k % nodes);
            let width = nodes * dim;
            self.add_full(block, pair, |c, d| factor * matrix[(a * dim + c) * width + b * dim + d], dim);
        }
    }

    /// Adds the sum over pairs to the diagonals of a block.
    pub fn write_sum(&mut self, Block(i, j): Block) {
        let (dim, squared) = (self.dim, self.fields * self.fields);
        let combination = i * self.fields + j;
        let values = self.solver.values_mut();
        for (pair, &sum) in self.pair_sum.iter().enumerate() {
            let first = (pair * squared + combination) * dim;
            for &position in &self.diagonal[first..first + dim] {
                values[position as usize] += sum;
            }
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
        let (dim, squared) = (self.dim, self.fields * self.fields);
        let combination = i * self.fields + j;
        let values = self.solver.values_mut();
        for (row, slots) in self.row_slots.iter().enumerate() {
            for (k, s) in slots.clone().enumerate() {
                if self.slot_nodes[s] as usize >= self.free {
                    continue;
                }
                let first = ((self.row_first[row] as usize + k) * squared + combination) * dim;
                for c in 0..dim {
                    let position = self.row_positions[2 * (first + c) + side];
                    values[position as usize] += factor * gradient[s * dim + c];
                }
            }
        }
    }

    /// Subtracts δ (r) from the diagonal of the rows of a field.
    pub fn regularise(&mut self, field: usize, delta: &[f64]) {
        let values = self.solver.values_mut();
        for (row, &delta) in delta.iter().enumerate() {
            values[self.row_diagonal[row * self.fields + field] as usize] -= delta;
        }
    }

    /// Factors the matrix.
    pub fn factor(&mut self) -> Result<(), Singular> {
        self.solver.factor()
    }
}

// Six arguments fit the byte that numbers them.
const _: () = assert!(MAX_ARGUMENTS < 256);
