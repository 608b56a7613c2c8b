//! The pattern of a stage's matrix: which nodes and rows share a block, and in what order they are eliminated.

use std::ops::Range;

use super::augmented::Augmented;
use super::hubs::early_rows;
use super::law_groups::group_laws;
use super::pattern::{Coupling, Hessian, NONE, Pattern, Turn};
use crate::linalg::{Places, Plan, Plans, fill_reducing_order};
use crate::system::{HessianBlock, InvariantId, NodeId, Quantity, Row, System};

/// Pairs of free nodes that share a block of the matrix, ascending, and whether the block is a full one.
#[derive(Default)]
pub(super) struct Pairs {
    found: Vec<(u32, u32, bool)>,
    /// Of each pair, its number among those with full blocks.
    full: Vec<Option<u32>>,
    /// Where those of each first node begin, and the end.
    begins: Vec<u32>,
}

impl Pairs {
    /// Adds a pair; the same the other way round is added, too.
    fn add(&mut self, a: u32, b: u32, full: bool) {
        self.found.push((a, b, full));
    }

    /// Puts them in order, each once, for `nodes` free nodes.
    fn number(&mut self, nodes: usize) {
        // A full block comes before one that is not.
        self.found.sort_unstable_by_key(|&(a, b, full)| (a, b, !full));
        self.found.dedup_by_key(|&mut (a, b, _)| (a, b));
        self.begins = (0..=nodes as u32).map(|node| self.found.partition_point(|&(a, ..)| a < node) as u32).collect();
        let mut count = 0..;
        self.full = self.found.iter().map(|&(.., full)| full.then(|| count.next().expect("it has no end"))).collect();
    }

    fn at(&self, a: u32, b: u32) -> u32 {
        let first = self.begins[a as usize];
        let of_node = &self.found[first as usize..self.begins[a as usize + 1] as usize];
        first + of_node.binary_search_by_key(&b, |&(_, b, _)| b).expect("the pair was added") as u32
    }

    fn full_at(&self, a: u32, b: u32) -> u32 {
        self.full[self.at(a, b) as usize].expect("the pair was added with a full block")
    }

    /// The two nodes, and the number among the pairs with full blocks.
    fn iter(&self) -> impl Iterator<Item = (u32, u32, Option<u32>)> {
        self.found.iter().zip(&self.full).map(|(&(a, b, _), &full)| (a, b, full))
    }
}

impl Pattern {
    /// The pattern of a system's matrices with `fields` fields a node, where the rows `augmented` (r) enter the part of the coordinates.
    pub(super) fn new(system: &System, augmented: &[bool], fields: usize, coupling: Coupling) -> Self {
        let (dim, free) = (system.dim, system.free);
        let (slot_nodes, row_slots) = (&system.slots.nodes, &system.slots.rows);
        let is_free = |node: u32| (node as usize) < free;
        let mut pairs = Pairs::default();
        for a in 0..free as u32 {
            pairs.add(a, a, false);
            system.mass.row(a as usize).filter(|&(b, _)| b < free).for_each(|(b, block)| pairs.add(a, b as u32, block.s != 0.0));
        }
        let row_invariant = |row: &Row| match row.quantity {
            Quantity::Invariant(id) => Some(id),
            Quantity::Function(_) => None,
        };
        // A row that is a function of invariants has the tangent of a law of them.
        let function_base = system.function_rows.iter().map(|&row| match system.rows[row as usize].quantity {
            Quantity::Function(id) => system.functions.base(id),
            Quantity::Invariant(_) => unreachable!("a row of a function"),
        });
        let laws: Vec<&[InvariantId]> = system.laws.iter().map(|law| law.invariants.as_slice()).chain(function_base).collect();
        let of_rows = system.rows.iter().filter_map(row_invariant);
        for id in of_rows.chain(laws.iter().flat_map(|law| law.iter().copied())) {
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
        for law in &laws {
            let slots = law_slots(law);
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
        for (slots, _) in row_slots.iter().zip(augmented).filter(|(_, augmented)| **augmented) {
            let nodes: Vec<u32> = slots.clone().map(|slot| slot_nodes[slot]).filter(|&node| is_free(node)).collect();
            for &a in &nodes {
                nodes.iter().for_each(|&b| pairs.add(a, b, true));
            }
        }
        pairs.number(free);

        let hessian = |id: InvariantId| {
            let mut hessian = Hessian::default();
            for (a, b, block) in system.invariants.hessian(id).into_iter().filter(|&(a, b, _)| is_free(a) && is_free(b)) {
                match block {
                    HessianBlock::Isotropic(c) => hessian.isotropic.push((pairs.at(a, b), c)),
                    HessianBlock::Skew(c, e) => {
                        let axis = e.map(|e| c * e);
                        match hessian.skew.iter_mut().find(|turn| turn.full == pairs.full_at(a, b)) {
                            Some(turn) => (0..3).for_each(|c| turn.axis[c] += axis[c]),
                            None => hessian.skew.push(Turn { full: pairs.full_at(a, b), axis }),
                        }
                    }
                }
            }
            hessian
        };
        let (mut row_isotropic, mut row_skew) = (Vec::new(), Vec::new());
        for (k, id) in (0..).zip(system.rows.iter().map(row_invariant)) {
            let hessian = id.map_or_else(Hessian::default, hessian);
            row_isotropic.extend(hessian.isotropic.iter().map(|&(pair, c)| (k, pair, c)));
            row_skew.extend(hessian.skew.iter().map(|&turn| (k, turn)));
        }
        let law_hessian = laws.iter().map(|law| law.iter().map(|&id| hessian(id)).collect()).collect();
        let of_laws = laws.iter().map(|law| law_slots(law).into_iter().map(|(slot, argument)| (slot_nodes[slot as usize], slot, argument)));
        // Rows are added apart from forces.
        let law_groups = group_laws(of_laws.map(Iterator::collect), system.laws.len(), |a, b| pairs.at(a, b));
        let group_pairs = |nodes: &[NodeId]| -> Vec<u32> {
            let all = nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a.0, b.0)));
            all.map(|(a, b)| if is_free(a) && is_free(b) { pairs.at(a, b) } else { NONE }).collect()
        };
        let load_pairs = system.loads.iter().map(|load| group_pairs(&load.nodes)).collect();
        let custom_pairs = system.custom.iter().map(|custom| group_pairs(&custom.nodes)).collect();
        let full_pairs = (0..).zip(&pairs.full).filter_map(|(pair, full)| full.map(|_| pair)).collect();
        let mut pattern = Self {
            plan: Plan::new(&Plans::default(), 0, &[], &[]),
            dim,
            fields,
            free,
            coupling,
            pair_nodes: pairs.iter().map(|(a, b, _)| [a, b]).collect(),
            full_pairs,
            own_pair: (0..free as u32).map(|a| pairs.at(a, a)).collect(),
            diagonal: Vec::new(),
            full_index: Vec::new(),
            full: Vec::new(),
            row_isotropic,
            row_skew,
            law_hessian,
            law_groups,
            load_pairs,
            custom_pairs,
            row_entries: Vec::new(),
            row_diagonal: Vec::new(),
            row_first: Vec::new(),
            slots: system.slots.clone(),
        };
        pattern.place(system, &pairs);
        pattern
    }

    /// The places that a row whose square weighs `weight` needs.
    pub(super) fn augment(&self, places: &Places<'_>, row: usize, field: usize, weight: f64) -> Augmented {
        let multiplier = self.multiplier(row, field);
        let mut coordinates = Vec::new();
        for slot in self.slots.rows[row].clone().filter(|&slot| self.is_free(slot)) {
            for other in (0..self.fields).filter(|&other| self.are_coupled(other, field)) {
                coordinates.extend((0..self.dim).map(|c| self.coordinate(self.slots.nodes[slot] as usize, other, c)));
            }
        }
        // A function may name a node several times.
        coordinates.sort_unstable();
        coordinates.dedup();
        let at = |row: usize, column: usize| places.position(row, column);
        Augmented {
            weight,
            row: multiplier as u32,
            diagonal: at(multiplier, multiplier),
            pairs: coordinates.iter().flat_map(|&a| coordinates.iter().map(move |&b| (a, b))).map(|(a, b)| at(a, b)).collect(),
            column: vec![0.0; coordinates.len()],
            entries: coordinates.into_iter().map(|q| [q as u32, at(q, multiplier), at(multiplier, q)]).collect(),
        }
    }

    fn place(&mut self, system: &System, pairs: &Pairs) {
        let (dim, fields, rows) = (self.dim, self.fields, self.slots.rows.len());
        let combinations: Vec<(usize, usize)> = (0..fields).flat_map(|i| (0..fields).map(move |j| (i, j))).collect();
        let mut entries = Vec::new();
        for (a, b, full) in pairs.iter() {
            for &(i, j) in &combinations {
                for c in 0..dim {
                    for d in (0..dim).filter(|&d| full.is_some() || d == c) {
                        entries.push((self.coordinate(a as usize, i, c) as u32, self.coordinate(b as usize, j, d) as u32));
                    }
                }
            }
        }
        for row in 0..rows {
            for &(i, j) in &combinations {
                let r = self.multiplier(row, i) as u32;
                entries.push((r, self.multiplier(row, j) as u32));
                for s in self.slots.rows[row].clone().filter(|&s| self.is_free(s) && self.are_coupled(j, i)) {
                    for c in 0..dim {
                        let q = self.coordinate(self.slots.nodes[s] as usize, j, c) as u32;
                        entries.extend([(r, q), (q, r)]);
                    }
                }
            }
        }
        self.plan = Plan::new(&system.plans, self.size(), &entries, &self.elimination_order(system, pairs));
        drop(entries);
        let plan = self.plan.clone();
        let places = plan.places();
        for (a, b, full) in pairs.iter() {
            self.full_index.push(full.unwrap_or(NONE));
            for &(i, j) in &combinations {
                for c in 0..dim {
                    let row = self.coordinate(a as usize, i, c);
                    self.diagonal.push(places.position(row, self.coordinate(b as usize, j, c)));
                    for d in (0..dim).filter(|_| full.is_some()) {
                        self.full.push(places.position(row, self.coordinate(b as usize, j, d)));
                    }
                }
            }
        }
        let mut row_entries = vec![Vec::new(); 2 * fields * fields];
        for row in 0..rows {
            for s in self.slots.rows[row].clone().filter(|&s| self.is_free(s)) {
                for &(i, j) in combinations.iter().filter(|&&(i, j)| self.are_coupled(i, j)) {
                    for c in 0..dim {
                        let (q, r) = (self.coordinate(self.slots.nodes[s] as usize, i, c), self.multiplier(row, j));
                        for (side, position) in [places.position(q, r), places.position(r, q)].into_iter().enumerate() {
                            row_entries[(side * fields + i) * fields + j].push([(s * dim + c) as u32, position]);
                        }
                    }
                }
            }
            for i in 0..fields {
                let r = self.multiplier(row, i);
                self.row_diagonal.push(places.position(r, r));
            }
        }
        self.row_entries = row_entries;
        let mut entries = 0;
        for row in 0..=rows {
            let isotropic = self.row_isotropic.partition_point(|&(other, _, _)| (other as usize) < row);
            self.row_first.push([isotropic as u32, entries as u32]);
            if let Some(slots) = self.slots.rows.get(row) {
                entries += slots.clone().filter(|&s| self.is_free(s)).count() * dim;
            }
        }
    }

    /// Nodes by least fill-in, each row right after the last of its nodes: its pivot is then minus what the row's
    /// gradient adds to those before it, and never the bare regularisation unless the row is redundant. Some rows need not wait
    /// for hubs.
    fn elimination_order(&self, system: &System, pairs: &Pairs) -> Vec<u32> {
        let mut edges: Vec<(u32, u32)> = pairs.iter().filter(|&(a, b, _)| a < b).map(|(a, b, _)| (a, b)).collect();
        let free_nodes =
            |slots: &Range<usize>| -> Vec<u32> { slots.clone().filter(|&s| self.is_free(s)).map(|s| self.slots.nodes[s]).collect() };
        for slots in &self.slots.rows {
            let nodes = free_nodes(slots);
            for &a in &nodes {
                edges.extend(nodes.iter().filter(|&&b| a < b).map(|&b| (a, b)));
            }
        }
        let hubs = early_rows(self, system, &mut edges);
        let waits_for = |row: usize, node: u32| hubs.as_ref().is_none_or(|(is_hub, is_early)| !(is_early[row] && is_hub[node as usize]));
        let nodes = fill_reducing_order(self.free, &edges);
        let mut place = vec![0; self.free];
        nodes.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k);
        let mut rows_after: Vec<Vec<usize>> = vec![Vec::new(); self.free];
        let mut first = Vec::new();
        for (row, slots) in self.slots.rows.iter().enumerate() {
            match free_nodes(slots).into_iter().filter(|&node| waits_for(row, node)).map(|node| place[node as usize]).max() {
                Some(last) => rows_after[last].push(row),
                None => first.push(row),
            }
        }
        let mut order = Vec::with_capacity(self.size());
        let push_row = |order: &mut Vec<u32>, row| (0..self.fields).for_each(|f| order.push(self.multiplier(row, f) as u32));
        first.into_iter().for_each(|row| push_row(&mut order, row));
        for (&node, rows) in nodes.iter().zip(&rows_after) {
            for field in (0..self.fields).rev() {
                (0..self.dim).for_each(|c| order.push(self.coordinate(node as usize, field, c) as u32));
            }
            rows.iter().for_each(|&row| push_row(&mut order, row));
        }
        order
    }
}
