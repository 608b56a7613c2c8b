//! The numbers of a factorisation: fronts in their order, each put together, eliminated and left to its parent.

use pulp::{Simd, WithSimd};

use super::Singular;
use super::fronts::{Front, Fronts, Sources};
use super::multifrontal::{Numbers, OneFront, with_blocks};
use super::tile::{Block, Factors, LANES, TILE, Tile, above_tiny, add_product, lower, of_columns, packed, product, raise};

pub(super) struct Factor<'a> {
    pub(super) plan: &'a Fronts,
    pub(super) tiles: &'a mut [Tile],
    pub(super) values: &'a [f64],
    pub(super) numbers: &'a mut Numbers,
}

impl WithSimd for Factor<'_> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        if let Some(blocks) = self.plan.one_front() {
            return with_blocks(self, simd, blocks);
        }
        let (plan, Numbers { stale, exchange, exchanged, rows, units, own_units, spread, .. }) = (self.plan, self.numbers);
        for (k, (front, exchanged)) in plan.fronts.iter().zip(exchanged).enumerate() {
            if !std::mem::take(&mut stale[k]) {
                continue;
            }
            let Sources { entries: [first, last], children: [eldest, end], parent } = plan.sources[k];
            if let Some(parent) = parent {
                stale[parent] = true;
            }
            let (done, own) = self.tiles.split_at_mut(front.tile);
            let own = &mut own[..front.size * front.size];
            own.fill([0.0; TILE]);
            for (&place, value) in plan.entries[first..last].iter().zip(&self.values[first..last]) {
                own.as_flattened_mut()[place as usize - front.tile * TILE] = *value;
            }
            for &child in &plan.children[eldest..end] {
                let child = &plan.fronts[child as usize];
                take_over(child, &done[child.tile..], &plan.in_parent[child.range()], front.size, own.as_flattened_mut());
            }
            let exchange = &mut exchange[front.block * LANES..front.block * LANES + front.pivots];
            let own_units = &mut own_units[..front.head];
            own_units.copy_from_slice(&units[front.block..front.block + front.head]);
            *exchanged = eliminate(simd, front, own, exchange, rows, own_units, spread[k])
                .map_err(|pivot| Singular { pivot: plan.row[front.block * LANES + pivot] as usize })?;
        }
        Ok(())
    }
}

impl OneFront for Factor<'_> {
    /// Leaves the inverse of L in its place.
    #[inline(always)]
    fn one<S: Simd, const B: usize>(self, simd: S) -> Self::Output {
        let front = Front { head: B, size: B, ..self.plan.fronts[0] };
        let (Numbers { exchange, exchanged, rows, units, spread, .. }, tiles) = (self.numbers, &mut self.tiles[..B * B]);
        let mut own_units: [Block; B] = std::array::from_fn(|k| units[k]);
        exchanged[0] = eliminate(simd, &front, tiles, &mut exchange[..front.pivots], rows, &mut own_units, spread[0])
            .map_err(|pivot| Singular { pivot: self.plan.row[pivot] as usize })?;
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

/// A pivot this far below the largest number under it, each in the unit of its row, is exchanged.
const SMALL: f64 = 1e-3;

/// Eliminates the pivots of a front, a block at a time; whether rows changed places, or the pivot that cannot be one.
#[inline(always)]
fn eliminate<S: Simd>(
    simd: S,
    front: &Front,
    tiles: &mut [Tile],
    exchange: &mut [u32],
    rows: &mut [Block],
    units: &mut [Block],
    spread: f64,
) -> Result<bool, usize> {
    let size = front.size;
    for k in front.pivots..front.head * LANES {
        tiles[k / LANES * (size + 1)][k % LANES * (LANES + 1)] = 1.0;
    }
    let mut exchanged = false;
    for block in 0..front.head {
        let pivots = block * (size + 1)..block * size + front.head;
        let factors = match in_order(simd, &tiles[pivots.clone()], &units[block..], spread, 1.0 / SMALL) {
            Some(factors) => factors,
            None => {
                if !exchanged {
                    exchange.iter_mut().enumerate().for_each(|(k, row)| *row = k as u32);
                }
                exchanged = true;
                exchange_rows(block, front, tiles, exchange, rows, units)?;
                // Round-off may put what was exchanged a little above.
                in_order(simd, &tiles[pivots], &units[block..], spread, 2.0 / SMALL).ok_or(block * LANES)?
            }
        };
        let inverse = factors.lower_inverse();
        tiles[block * (size + 1)] = packed(&inverse, &factors.upper_inverse(simd));
        let (done, rest) = tiles.split_at_mut((block + 1) * size);
        let panel = &mut done[block * (size + 1) + 1..];
        for l in panel.iter_mut() {
            *l = above_tiny(of_columns(&factors.over_upper(simd, l)));
        }
        for column in rest.chunks_exact_mut(size) {
            let (head, tail) = column[block..].split_first_mut().expect("a column has all rows");
            *head = above_tiny(product(simd, &inverse, head));
            for (l, target) in panel.iter().zip(tail) {
                add_product(simd, target, l, head, -1.0);
            }
        }
    }
    Ok(exchanged)
}

/// The factors of the first of a column of tiles, where in the order as it is all pivots are fit: nothing in L is larger than
/// `most`, where each row has its unit.
#[inline(always)]
fn in_order<S: Simd>(simd: S, panel: &[Tile], units: &[Block], spread: f64, most: f64) -> Option<Factors> {
    let (diagonal, below) = panel.split_first()?;
    let factors = Factors::of(simd, diagonal, &[1.0; LANES]);
    let mut largest = factors.largest()?;
    for tile in below {
        factors.over_upper(simd, tile).iter().for_each(|column| raise(&mut largest, column, 1.0));
    }
    // Where all are fit whatever their units the units need not be looked at. Neither infinite numbers nor what is no number pass.
    match largest.iter().all(|l| l * spread <= most) {
        true => Some(factors),
        false => in_units(simd, panel, units, most).then_some(factors),
    }
}

/// Whether nothing in L is larger than `most` where each row has its unit.
#[inline(never)]
fn in_units<S: Simd>(simd: S, panel: &[Tile], units: &[Block], most: f64) -> bool {
    let per_unit = units[0].map(|unit| 1.0 / unit);
    let factors = Factors::of(simd, &panel[0], &per_unit);
    let fits = |largest: &Block, units: &Block| largest.iter().zip(units).all(|(l, unit)| l * unit <= most);
    let of_tile = |(tile, units): (&Tile, &Block)| {
        let mut largest = [0.0; LANES];
        factors.over_upper(simd, tile).iter().zip(per_unit).for_each(|(column, unit)| raise(&mut largest, column, unit));
        fits(&largest, units)
    };
    factors.largest().is_some_and(|largest| fits(&largest, &units[0])) && panel[1..].iter().zip(&units[1..]).all(of_tile)
}

/// Exchanges the row of each pivot of a block that is far smaller than the largest number below it among the pivots for the
/// row of that; the pivot that cannot be one.
#[inline(never)]
fn exchange_rows(
    block: usize,
    front: &Front,
    tiles: &mut [Tile],
    exchange: &mut [u32],
    rows: &mut [Block],
    units: &mut [Block],
) -> Result<(), usize> {
    let first = block * LANES;
    let place = |row: usize, column: usize| (column / LANES * front.size + row / LANES, column % LANES * LANES + row % LANES);
    let (rows, units) = (&mut rows[..front.pivots - first], &mut units.as_flattened_mut()[first..]);
    for (row, numbers) in rows.iter_mut().enumerate() {
        *numbers = std::array::from_fn(|k| {
            let (tile, at) = place(first + row, first + k);
            tiles[tile][at]
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
            for column in 0..front.size * LANES {
                let (from, to) = (place(first + k, column), place(first + largest, column));
                let kept = tiles[from.0][from.1];
                tiles[from.0][from.1] = tiles[to.0][to.1];
                tiles[to.0][to.1] = kept;
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

/// Adds what a front left to the rows below its pivots to the front of its parent, whose columns have `size` tiles.
#[inline(always)]
fn take_over(front: &Front, tiles: &[Tile], in_parent: &[u32], size: usize, square: &mut [f64]) {
    for (k, &to) in in_parent.iter().enumerate() {
        let (to, lane) = (to as usize, k % LANES);
        let target = &mut square[to / TILE * size * TILE + to % LANES * LANES..];
        let column = &tiles[(front.head + k / LANES) * front.size + front.head..];
        for (rows, tile) in in_parent.chunks(LANES).zip(column) {
            let values = &tile[lane * LANES..(lane + 1) * LANES];
            rows.iter().zip(values).for_each(|(&row, value)| target[row as usize] += value);
        }
    }
}
