//! Which entries a stage's matrix has and where they are, for nodes with one or more fields of coordinates and rows with as many multipliers.

use std::ops::Range;
use std::sync::Arc;

use super::law_groups::LawGroup;
use crate::linalg::Plan;
use crate::system::Slots;

/// The number of no pair.
pub(super) const NONE: u32 = u32::MAX;

/// A block of the matrix: the field of its rows and the field of its columns.
#[derive(Clone, Copy, Debug)]
pub struct Block(pub usize, pub usize);

/// A skew block of second derivatives, w ↦ w × e: which of the pairs with full blocks, and e (in the plane its normal's part).
#[derive(Clone, Copy)]
pub(super) struct Turn {
    pub full: u32,
    pub axis: [f64; 3],
}

impl Turn {
    pub(super) fn add(&self, factor: f64, sums: &mut [[f64; 3]]) {
        let sum = &mut sums[self.full as usize];
        (0..3).for_each(|c| sum[c] += factor * self.axis[c]);
    }
}

/// Constant second derivatives of an invariant, free nodes only.
#[derive(Default)]
pub(super) struct Hessian {
    pub isotropic: Vec<(u32, f64)>,
    pub skew: Vec<Turn>,
}

/// Which fields of coordinates (second argument) and of rows (third) share a block of the matrix; first comes the number
/// of fields.
pub type Coupling = fn(usize, usize, usize) -> bool;

/// One stage without velocities, or several stages each with all rows.
pub const ALL: Coupling = |_, _, _| true;

/// Rows of a stage and coordinates of the same stage.
pub(super) const OWN_STAGE: Coupling = |_, node, row| node == row;

/// The first half of the fields are positions of the stages, the second half velocities. Position rows do not react on
/// velocities.
pub(super) const TWO_LEVELS: Coupling =
    |fields, node, row| node % (fields / 2) == row % (fields / 2) && (node < fields / 2 || row >= fields / 2);

/// Which nodes and rows share a block of the matrix, and where its entries are: the same for all matrices of a kind.
pub struct Pattern {
    pub(super) plan: Plan,
    pub(super) dim: usize,
    pub(super) fields: usize,
    pub(super) free: usize,
    pub(super) coupling: Coupling,
    /// The system's slots.
    pub(super) slots: Arc<Slots>,
    /// The nodes of each pair.
    pub(super) pair_nodes: Vec<[u32; 2]>,
    /// The pairs with full blocks.
    pub(super) full_pairs: Vec<u32>,
    pub(super) own_pair: Vec<u32>,
    pub(super) diagonal: Vec<u32>,
    pub(super) full_index: Vec<u32>,
    pub(super) full: Vec<u32>,
    /// Second derivatives of all rows: row, pair and factor, and row and skew block.
    pub(super) row_isotropic: Vec<(u32, u32, f64)>,
    pub(super) row_skew: Vec<(u32, Turn)>,
    pub(super) law_hessian: Vec<Vec<Hessian>>,
    pub(super) law_groups: Vec<LawGroup>,
    pub(super) load_pairs: Vec<Vec<u32>>,
    pub(super) custom_pairs: Vec<Vec<u32>>,
    /// For columns and for rows, for each block: number of a slot's component and its place in the matrix.
    pub(super) row_entries: Vec<Vec<[u32; 2]>>,
    pub(super) row_diagonal: Vec<u32>,
    /// For each row, and at the end, the first of its second derivatives that are multiples of the unit matrix, and the first
    /// of its entries with one field.
    pub(super) row_first: Vec<[u32; 2]>,
}

impl Pattern {
    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.fields * (self.free * self.dim + self.slots.rows.len())
    }

    /// Place of a coordinate among the unknowns.
    pub fn coordinate(&self, node: usize, field: usize, component: usize) -> usize {
        (node * self.fields + field) * self.dim + component
    }

    /// Place of a multiplier among the unknowns.
    pub fn multiplier(&self, row: usize, field: usize) -> usize {
        self.fields * self.free * self.dim + row * self.fields + field
    }

    /// Where the gradient of a row is among those of all slots.
    pub(super) fn gradient_of(&self, row: usize) -> Range<usize> {
        let Range { start, end } = self.slots.rows[row];
        start * self.dim..end * self.dim
    }

    pub(super) fn is_free(&self, slot: usize) -> bool {
        (self.slots.nodes[slot] as usize) < self.free
    }

    /// Whether the rows of one field and the coordinates of another have entries in common.
    pub(super) fn are_coupled(&self, node_field: usize, row_field: usize) -> bool {
        (self.coupling)(self.fields, node_field, row_field)
    }

    /// The places of the lines of a full block of a pair of nodes, those of one line after the other.
    #[inline]
    pub(super) fn full_block<const D: usize>(&self, Block(i, j): Block, pair: u32) -> &[[u32; D]] {
        let first = (self.full_index[pair as usize] as usize * self.fields * self.fields + i * self.fields + j) * D;
        &self.full.as_chunks().0[first..first + D]
    }
}
