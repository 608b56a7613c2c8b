//! A solution with the factors: down the fronts with L, up again with U.

use pulp::{Simd, WithSimd};

use super::fronts::{Front, Fronts};
use super::multifrontal::{Numbers, OneFront, Parts, with_blocks};
use super::tile::{Block, LANES, Tile, above_tiny, lower, shortly_times, subtract_times, upper};

pub(super) struct Solve<'a> {
    pub(super) plan: &'a Fronts,
    pub(super) parts: &'a Parts,
    pub(super) numbers: &'a mut Numbers,
    pub(super) b: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if let Some(blocks) = self.plan.one_front() {
            return with_blocks(self, simd, blocks);
        }
        let (Numbers { exchange, exchanged, y, local, .. }, Parts { lower, upper, .. }) = (self.numbers, self.parts);
        for front in self.plan.fronts.iter().filter(|front| front.pivots < front.head * LANES) {
            y[front.block + front.head - 1] = [0.0; LANES];
        }
        for (&place, &b) in self.plan.place.iter().zip(&*self.b) {
            y.as_flattened_mut()[place as usize] = b;
        }
        for (front, &exchanged) in self.plan.fronts.iter().zip(&*exchanged) {
            let (columns, local) = (&lower[front.columns()], &mut local[..front.tail()]);
            let own = &mut y[front.blocks()];
            if exchanged {
                let rows = &exchange[front.block * LANES..front.block * LANES + front.pivots];
                rows.iter().enumerate().for_each(|(k, &row)| own.as_flattened_mut().swap(k, row as usize));
            }
            local.fill([0.0; LANES]);
            solve_lower(simd, front, columns, own, local);
            for (&place, value) in self.plan.below[front.range()].iter().zip(local.as_flattened()) {
                y.as_flattened_mut()[place as usize] += value;
            }
        }
        for front in self.plan.fronts.iter().rev() {
            let local = &mut local[..front.tail()];
            local.fill([0.0; LANES]);
            for (&place, value) in self.plan.below[front.range()].iter().zip(local.as_flattened_mut()) {
                *value = y.as_flattened()[place as usize];
            }
            solve_upper(simd, front, &lower[front.columns()], &upper[front.upper..], &mut y[front.blocks()], local);
        }
        for (&place, b) in self.plan.place.iter().zip(self.b) {
            *b = y.as_flattened()[place as usize];
        }
    }
}

impl OneFront for Solve<'_> {
    #[inline(always)]
    fn one<S: Simd, const B: usize>(self, simd: S) {
        let (Numbers { exchange, exchanged, .. }, tiles) = (self.numbers, &self.parts.lower[..B * B]);
        let mut b = [[0.0; LANES]; B];
        for (&place, &value) in self.plan.place.iter().zip(&*self.b) {
            b.as_flattened_mut()[place as usize] = value;
        }
        if exchanged[0] {
            let rows = &exchange[..self.plan.fronts[0].pivots];
            rows.iter().enumerate().for_each(|(k, &row)| b.as_flattened_mut().swap(k, row as usize));
        }
        let mut y = [[0.0; LANES]; B];
        for i in 0..B {
            y[i] = shortly_times(simd, &[0.0; LANES], &lower(&tiles[i * (B + 1)]), &b[i]);
            for j in 0..i {
                y[i] = shortly_times(simd, &y[i], &tiles[j * B + i], &b[j]);
            }
        }
        for k in (0..B).rev() {
            y[k] = shortly_times(simd, &[0.0; LANES], &upper(&tiles[k * (B + 1)]), &y[k]);
            let x = y[k].map(|x| -x);
            for i in 0..k {
                y[i] = shortly_times(simd, &y[i], &tiles[k * B + i], &x);
            }
        }
        for (&place, b) in self.plan.place.iter().zip(self.b) {
            *b = y.as_flattened()[place as usize];
        }
    }
}

/// Solves with the pivots' columns of L; leaves in `below` what they take off the rows below.
#[inline(always)]
fn solve_lower<S: Simd>(simd: S, front: &Front, columns: &[Tile], own: &mut [Block], below: &mut [Block]) {
    for (block, column) in columns.chunks_exact(front.size).enumerate() {
        let (head, tail) = own[block..].split_first_mut().expect("a block for each tile on the diagonal");
        let (pivots, rows) = column.split_at(front.head);
        *head = above_tiny(shortly_times(simd, &[0.0; LANES], &lower(&pivots[block]), head));
        for (target, tile) in tail.iter_mut().zip(&pivots[block + 1..]) {
            subtract_times(simd, target, tile, head);
        }
        for (target, tile) in below.iter_mut().zip(rows) {
            subtract_times(simd, target, tile, head);
        }
    }
}

/// Solves with the pivots' rows of U, where the rows below are known.
#[inline(always)]
fn solve_upper<S: Simd>(simd: S, front: &Front, pivots: &[Tile], rows: &[Tile], own: &mut [Block], below: &[Block]) {
    for (column, x) in rows.chunks_exact(front.head).zip(below) {
        for (target, tile) in own.iter_mut().zip(column) {
            subtract_times(simd, target, tile, x);
        }
    }
    for block in (0..front.head).rev() {
        let (column, diagonal) = pivots[block * front.size..][..=block].split_at(block);
        let (above, last) = own[..=block].split_at_mut(block);
        last[0] = above_tiny(shortly_times(simd, &[0.0; LANES], &upper(&diagonal[0]), &last[0]));
        for (target, tile) in above.iter_mut().zip(column) {
            subtract_times(simd, target, tile, &last[0]);
        }
    }
}
