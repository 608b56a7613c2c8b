//! The numbers of a factorisation: fronts in their order, each put together, eliminated and left to its parent.

use pulp::{Simd, WithSimd};

use super::Singular;
use super::fronts::{Front, Fronts};
use super::multifrontal::{Numbers, OneFront, Parts, with_blocks};
use super::tile::{Block, Factors, LANES, TILE, Tile, above_tiny, add_product, diagonal, lower, of_columns, packed, product, raise};

pub(super) struct Factor<'a, const DROPS: bool> {
    pub(super) plan: &'a Fronts,
    pub(super) parts: &'a mut Parts,
    pub(super) values: &'a [f64],
    pub(super) numbers: &'a mut Numbers,
    pub(super) pivoting: Pivoting,
}

/// What becomes of pivots that are small.
#[derive(Clone, Copy)]
pub(super) struct Pivoting {
    /// Size below which they are dropped.
    least: f64,
    /// Largest number in L, each row in its unit, without an exchange of rows.
    most: f64,
}

impl Pivoting {
    pub(super) const EXCHANGE: Self = Self { least: 0.0, most: 1.0 / SMALL };

    /// Drops those smaller than `least`, and takes all others as they come.
    pub(super) fn drop_below(least: f64) -> Self {
        Self { least, most: f64::INFINITY }
    }
}

impl<const DROPS: bool> WithSimd for Factor<'_, DROPS> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        if let Some(blocks) = self.plan.one_front() {
            return with_blocks(self, simd, blocks);
        }
        let Numbers { stale, exchange, exchanged, reciprocal, rows, units, own_units, .. } = self.numbers;
        let (plan, Parts { lower, upper, rest }, pivoting) = (self.plan, self.parts, self.pivoting);
        for (k, (front, exchanged)) in plan.fronts.iter().zip(exchanged).enumerate() {
            if !std::mem::take(&mut stale[k]) {
                continue;
            }
            let sources = &plan.sources[k];
            if let Some(parent) = sources.parent {
                stale[parent] = true;
            }
            let (done, rest) = rest.split_at_mut(sources.rest);
            let mut square = Square {
                columns: &mut lower[front.columns()],
                beside: &mut upper[front.upper..][..front.head * front.tail()],
                rest: &mut rest[..front.tail() * front.tail()],
            };
            square.rest.fill([0.0; TILE]);
            fill(square.columns, plan, sources.lower, front.lower, self.values);
            fill(square.beside, plan, sources.upper, plan.tiles.lower + front.upper, self.values);
            for &child in &plan.children[sources.children[0]..sources.children[1]] {
                let left = &done[plan.sources[child as usize].rest..];
                let child = &plan.fronts[child as usize];
                take_over(child, left, &plan.in_parent[child.range()], front, &mut square);
            }
            let exchange = &mut exchange[front.block * LANES..front.block * LANES + front.pivots];
            let own_units = &mut own_units[..front.head];
            own_units.copy_from_slice(&units[front.blocks()]);
            *exchanged = eliminate::<S, DROPS>(simd, front, &mut square, exchange, rows, own_units, pivoting)
                .map_err(|pivot| Singular { pivot: plan.row[front.block * LANES + pivot] as usize })?;
            let diagonals = square.columns.iter().step_by(front.size + 1);
            reciprocal[front.blocks()].iter_mut().zip(diagonals).for_each(|(out, tile)| *out = diagonal(tile));
        }
        Ok(())
    }
}

impl<const DROPS: bool> OneFront for Factor<'_, DROPS> {
    /// Leaves the inverse of L in its place.
    #[inline(always)]
    fn one<S: Simd, const B: usize>(self, simd: S) -> Self::Output {
        let front = Front { head: B, size: B, ..self.plan.fronts[0] };
        let Numbers { exchange, exchanged, reciprocal, rows, units, .. } = self.numbers;
        let tiles = &mut self.parts.lower[..B * B];
        let mut own_units: [Block; B] = std::array::from_fn(|k| units[k]);
        let mut square = Square { columns: &mut *tiles, beside: &mut [], rest: &mut [] };
        exchanged[0] = eliminate::<S, DROPS>(simd, &front, &mut square, &mut exchange[..front.pivots], rows, &mut own_units, self.pivoting)
            .map_err(|pivot| Singular { pivot: self.plan.row[pivot] as usize })?;
        (0..B).for_each(|k| reciprocal[k] = diagonal(&tiles[k * (B + 1)]));
        let inverse: [Tile; B] = std::array::from_fn(|k| lower(&tiles[k * (B + 1)]));
        for k in 0..B {
            for i in k + 1..B {
                let mut sum = product(simd, &tiles[k * B + i], &inverse[k]);
                for j in k + 1..i {
                    add_product(simd, &mut sum, &tiles[j * B + i], &tiles[k * B + j], 1.0);
                }
                tiles[k * B + i] = product(simd, &inverse[i], &sum).map(|x| -x);
            }
        }
        Ok(())
    }
}

/// The parts of a front where they are kept: the columns of its pivots, their rows beside these, and what is left to its parent.
struct Square<'a> {
    columns: &'a mut [Tile],
    beside: &'a mut [Tile],
    rest: &'a mut [Tile],
}

/// Puts the entries of a part of a front, whose first tile is `first`, into it.
#[inline(always)]
fn fill(tiles: &mut [Tile], plan: &Fronts, [from, to]: [usize; 2], first: usize, values: &[f64]) {
    tiles.fill([0.0; TILE]);
    for (&place, value) in plan.entries[from..to].iter().zip(&values[from..to]) {
        tiles.as_flattened_mut()[place as usize - first * TILE] = *value;
    }
}

/// A pivot this far below the largest number under it, each in the unit of its row, is exchanged.
const SMALL: f64 = 1e-3;

/// Eliminates the pivots of a front, a block at a time; whether rows changed places, or the pivot that cannot be one.
#[inline(always)]
fn eliminate<S: Simd, const DROPS: bool>(
    simd: S,
    front: &Front,
    square: &mut Square,
    exchange: &mut [u32],
    rows: &mut [Block],
    units: &mut [Block],
    pivoting: Pivoting,
) -> Result<bool, usize> {
    let Square { columns, beside, rest } = square;
    let (head, size, tail) = (front.head, front.size, front.tail());
    for k in front.pivots..head * LANES {
        columns[k / LANES * (size + 1)][k % LANES * (LANES + 1)] = 1.0;
    }
    let mut exchanged = false;
    for block in 0..head {
        let pivots = block * (size + 1)..block * size + head;
        let factors = match in_order::<S, DROPS>(simd, &columns[pivots.clone()], &units[block..], pivoting) {
            Some(factors) => factors,
            None => {
                if !exchanged {
                    exchange.iter_mut().enumerate().for_each(|(k, row)| *row = k as u32);
                }
                exchanged = true;
                exchange_rows(block, front, [columns, beside], exchange, rows, units)?;
                // Round-off may put what was exchanged a little above.
                in_order::<S, DROPS>(simd, &columns[pivots], &units[block..], Pivoting { most: 2.0 * pivoting.most, ..pivoting })
                    .ok_or(block * LANES)?
            }
        };
        let inverse = factors.lower_inverse();
        columns[block * (size + 1)] = packed(&inverse, &factors.upper_inverse(simd));
        let (done, after) = columns.split_at_mut((block + 1) * size);
        let panel = &mut done[block * (size + 1) + 1..];
        for l in panel.iter_mut() {
            *l = above_tiny(of_columns(&factors.over_upper(simd, l)));
        }
        let (pivots, below) = panel.split_at(head - block - 1);
        let columns = after.chunks_exact_mut(size).map(|column| column[block..].split_at_mut(head - block));
        let others = beside.chunks_exact_mut(head).map(|column| &mut column[block..]).zip(rest.chunks_exact_mut(tail.max(1)));
        for (column, rest) in columns.chain(others) {
            let (row, column) = column.split_first_mut().expect("a column has all rows");
            *row = above_tiny(product(simd, &inverse, row));
            for (l, target) in pivots.iter().zip(column) {
                add_product(simd, target, l, row, -1.0);
            }
            for (l, target) in below.iter().zip(rest) {
                add_product(simd, target, l, row, -1.0);
            }
        }
    }
    Ok(exchanged)
}

/// The factors of the first of a column of tiles, where in the order as it is all pivots are fit: nothing in L is larger than
/// the pivoting allows, where each row has its unit.
#[inline(always)]
fn in_order<S: Simd, const DROPS: bool>(simd: S, panel: &[Tile], units: &[Block], pivoting: Pivoting) -> Option<Factors> {
    let ([diagonal, below @ ..], [own, others @ ..]) = (panel, units) else { return None };
    let per_unit = own.map(|unit| 1.0 / unit);
    let factors = Factors::of::<S, DROPS>(simd, diagonal, &per_unit, pivoting.least);
    // Neither infinite numbers nor what is no number pass. Without a branch all rows are looked at together.
    let fits = |largest: &Block, units: &Block| largest.iter().zip(units).fold(true, |fits, (l, unit)| fits & (l * unit <= pivoting.most));
    let mut all = fits(&factors.largest()?, own);
    for (tile, units) in below.iter().zip(others) {
        let mut largest = [0.0; LANES];
        factors.over_upper(simd, tile).iter().zip(per_unit).for_each(|(column, unit)| raise(&mut largest, column, unit));
        all &= fits(&largest, units);
    }
    all.then_some(factors)
}

/// Exchanges the row of each pivot of a block that is far smaller than the largest number below it among the pivots for the
/// row of that; the pivot that cannot be one.
#[inline(never)]
fn exchange_rows(
    block: usize,
    front: &Front,
    [columns, beside]: [&mut [Tile]; 2],
    exchange: &mut [u32],
    rows: &mut [Block],
    units: &mut [Block],
) -> Result<(), usize> {
    let first = block * LANES;
    let place = |row: usize, column: usize| (row / LANES, column % LANES * LANES + row % LANES);
    let own = block * front.size..(block + 1) * front.size;
    let (rows, units) = (&mut rows[..front.pivots - first], &mut units.as_flattened_mut()[first..]);
    for (row, numbers) in rows.iter_mut().enumerate() {
        *numbers = std::array::from_fn(|k| {
            let (tile, at) = place(first + row, first + k);
            columns[own.clone()][tile][at]
        });
    }
    for k in 0..rows.len().min(LANES) {
        let (largest, size) = (k..rows.len()).fold((k, 0.0), |(m, size), row| {
            let other = (units[row] * rows[row][k]).abs();
            if other > size { (row, other) } else { (m, size) }
        });
        if !size.is_normal() {
            return Err(first + k);
        }
        if (units[k] * rows[k][k]).abs() < SMALL * size {
            rows.swap(k, largest);
            units.swap(k, largest);
            exchange[first + k] = (first + largest) as u32;
            for column in columns.chunks_exact_mut(front.size).chain(beside.chunks_exact_mut(front.head)) {
                for lane in 0..LANES {
                    let (from, to) = (place(first + k, lane), place(first + largest, lane));
                    let kept = column[from.0][from.1];
                    column[from.0][from.1] = column[to.0][to.1];
                    column[to.0][to.1] = kept;
                }
            }
        }
        let pivot = rows[k];
        for row in &mut rows[k + 1..] {
            let factor = row[k] / pivot[k];
            (k + 1..LANES).for_each(|j| row[j] -= factor * pivot[j]);
        }
    }
    Ok(())
}

/// Adds what a front left to the rows below its pivots to the front of its parent.
#[inline(always)]
fn take_over(front: &Front, left: &[Tile], in_parent: &[u32], parent: &Front, square: &mut Square) {
    let (head, size, tail) = (parent.head, parent.size, parent.tail());
    for (k, &to) in in_parent.iter().enumerate() {
        let (to, lane, own_lane) = (to as usize / TILE, to as usize % TILE * LANES, k % LANES * LANES);
        let (pivots, below) = match to.checked_sub(head) {
            None => square.columns[to * size..][..size].split_at_mut(head),
            Some(to) => (&mut square.beside[to * head..][..head], &mut square.rest[to * tail..][..tail]),
        };
        let (pivots, below) = (pivots.as_flattened_mut(), below.as_flattened_mut());
        let column = &left[k / LANES * front.tail()..][..front.tail()];
        for (rows, tile) in in_parent.chunks(LANES).zip(column) {
            for (&row, value) in rows.iter().zip(&tile[own_lane..own_lane + LANES]) {
                match (row as usize + lane).checked_sub(head * TILE) {
                    None => pivots[row as usize + lane] += value,
                    Some(row) => below[row] += value,
                }
            }
        }
    }
}
