//! Sparse L U on a structurally symmetric pattern with a static order, in place.
//!
//! Every update of the elimination has its place worked out beforehand, so that factoring is one pass over lists
//! without searching or clearing.

use super::Singular;

pub(super) struct SparseLu {
    size: usize,
    /// Diagonal (size), then U by rows, then L by columns on the same pattern.
    pub(super) values: Vec<f64>,
    /// Place of each row of the matrix in the order of elimination.
    place: Vec<u32>,
    /// Row eliminated at each place.
    order: Vec<u32>,
    /// Start of each row of U in `index`, places.
    start: Vec<u32>,
    /// Columns of U, as places.
    index: Vec<u32>,
    /// For each pivot, for each pair (i, j) of its column and row, where A_ij is among the values.
    target: Vec<u32>,
    target_start: Vec<usize>,
    /// Copy of the pivot's row of U, and of the right side in the order of elimination.
    scratch: Vec<f64>,
}

impl SparseLu {
    pub(super) fn new(size: usize, entries: &[(u32, u32)], order: &[u32]) -> Self {
        let mut place = vec![0; size];
        for (k, &row) in order.iter().enumerate() {
            place[row as usize] = k as u32;
        }
        let (start, index) = fill_in(size, entries, &place);
        let mut lu = Self {
            size,
            values: vec![0.0; size + 2 * index.len()],
            place,
            order: order.to_vec(),
            start,
            index,
            target: Vec::new(),
            target_start: vec![0],
            scratch: vec![0.0; size],
        };
        for k in 0..size {
            let row = lu.row(k);
            for i in row.clone() {
                for j in row.clone() {
                    let target = lu.at_places(lu.index[i], lu.index[j]);
                    lu.target.push(target);
                }
            }
            lu.target_start.push(lu.target.len());
        }
        lu
    }

    fn row(&self, k: usize) -> std::ops::Range<usize> {
        self.start[k] as usize..self.start[k + 1] as usize
    }

    fn at_places(&self, i: u32, j: u32) -> u32 {
        self.find_places(i, j).expect("the entry is in the pattern")
    }

    fn find_places(&self, i: u32, j: u32) -> Option<u32> {
        if i == j {
            return Some(i);
        }
        let (pivot, other) = (i.min(j) as usize, i.max(j));
        let range = self.row(pivot);
        let offset = self.index[range.clone()].binary_search(&other).ok()?;
        let lower = if i > j { self.index.len() } else { 0 };
        Some((self.size + lower + range.start + offset) as u32)
    }

    pub(super) fn find(&self, row: usize, column: usize) -> Option<u32> {
        self.find_places(self.place[row], self.place[column])
    }

    pub(super) fn position(&self, row: usize, column: usize) -> u32 {
        self.at_places(self.place[row], self.place[column])
    }

    pub(super) fn factor(&mut self) -> Result<(), Singular> {
        let (n, upper) = (self.size, self.index.len());
        for k in 0..n {
            let pivot = self.values[k];
            if !pivot.is_finite() || pivot == 0.0 {
                return Err(Singular { pivot: self.order[k] as usize });
            }
            let row = self.start[k] as usize..self.start[k + 1] as usize;
            let width = row.len();
            if width == 0 {
                continue;
            }
            let source = &mut self.scratch[..width];
            source.copy_from_slice(&self.values[n + row.start..n + row.end]);
            let targets = &self.target[self.target_start[k]..self.target_start[k + 1]];
            for (i, targets) in targets.chunks_exact(width).enumerate() {
                let factor = self.values[n + upper + row.start + i] / pivot;
                self.values[n + upper + row.start + i] = factor;
                if factor != 0.0 {
                    for (&target, &u) in targets.iter().zip(source.iter()) {
                        self.values[target as usize] -= factor * u;
                    }
                }
            }
        }
        Ok(())
    }

    pub(super) fn solve(&mut self, b: &mut [f64]) {
        let (n, upper) = (self.size, self.index.len());
        let y = &mut self.scratch;
        for (y, &row) in y.iter_mut().zip(&self.order) {
            *y = b[row as usize];
        }
        for k in 0..n {
            let value = y[k];
            for p in self.start[k] as usize..self.start[k + 1] as usize {
                y[self.index[p] as usize] -= self.values[n + upper + p] * value;
            }
        }
        for k in (0..n).rev() {
            let mut value = y[k];
            for p in self.start[k] as usize..self.start[k + 1] as usize {
                value -= self.values[n + p] * y[self.index[p] as usize];
            }
            y[k] = value / self.values[k];
        }
        for (&y, &row) in y.iter().zip(&self.order) {
            b[row as usize] = y;
        }
    }

    pub(super) fn pivots(&self, out: &mut [f64]) {
        for (k, &row) in self.order.iter().enumerate() {
            out[row as usize] = self.values[k].abs();
        }
    }
}

/// Pattern of U by rows (sorted places) after elimination: each pivot's row joins that of its parent in the
/// elimination tree.
fn fill_in(size: usize, entries: &[(u32, u32)], place: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); size];
    for &(i, j) in entries {
        let (i, j) = (place[i as usize], place[j as usize]);
        if i != j {
            rows[i.min(j) as usize].push(i.max(j));
        }
    }
    let (mut start, mut index) = (vec![0], Vec::new());
    for k in 0..size {
        let mut row = std::mem::take(&mut rows[k]);
        row.sort_unstable();
        row.dedup();
        if let Some((&parent, rest)) = row.split_first() {
            rows[parent as usize].extend_from_slice(rest);
        }
        index.extend_from_slice(&row);
        start.push(index.len() as u32);
    }
    (start, index)
}
