//! L U by fronts: dense squares that hand what they add to the rows below to their parents (Duff and Reid 1983), in place.
//!
//! Everything but the arithmetic is worked out beforehand, and the arithmetic is products of tiles. Pivots are taken in the
//! given order; within a front rows change places where a pivot is far below what stands under it.

use std::cmp::Ordering;

use pulp::{Arch, Simd, WithSimd};

use super::Singular;
use super::fronts::{Front, Fronts, LANES, ONE_FRONT, TILE};

/// A square of numbers, by columns.
type Tile = [f64; TILE];
/// A block of a vector.
type Block = [f64; LANES];

pub(super) struct Multifrontal {
    pub(super) plan: Fronts,
    /// The tiles of all fronts; after the factorisation L (below the diagonal, which is 1) and U, on the diagonal their inverses.
    tiles: Vec<Tile>,
    /// The entries of the matrix where there is more than one front: each is put together right before it is factored. A single
    /// front has its entries in its tiles.
    values: Vec<f64>,
    numbers: Numbers,
    arch: Arch,
}

struct Numbers {
    /// Whether a front is to be factored.
    stale: Vec<bool>,
    /// Row of its front that came to each pivot, and whether any of a front did.
    exchange: Vec<u32>,
    exchanged: Vec<bool>,
    /// A right side in the blocks of all fronts, and in the rows below one front.
    y: Vec<Block>,
    local: Vec<Block>,
    /// Rows of a block of pivots and of the pivots below them.
    rows: Vec<Block>,
}

impl Multifrontal {
    pub(super) fn new(size: usize, entries: &[(u32, u32)], order: &[u32]) -> Self {
        let plan = Fronts::new(size, entries, order);
        let most = plan.fronts.iter().map(|front| front.size - front.head).max().unwrap_or(0);
        let pivots = plan.fronts.iter().map(|front| front.pivots).max().unwrap_or(0);
        let blocks = plan.blocks();
        let numbers = Numbers {
            stale: vec![true; plan.fronts.len()],
            exchange: vec![0; blocks * LANES],
            exchanged: vec![false; plan.fronts.len()],
            y: vec![[0.0; LANES]; blocks],
            local: vec![[0.0; LANES]; most],
            rows: vec![[0.0; LANES]; pivots],
        };
        let values = if plan.one_front().is_some() { Vec::new() } else { vec![0.0; plan.entries.len()] };
        Self { tiles: vec![[0.0; TILE]; plan.tiles], values, plan, numbers, arch: Arch::new() }
    }

    /// Where an entry of the matrix is among the values; none outside the pattern.
    pub(super) fn position(&self, row: usize, column: usize) -> Option<usize> {
        let place = self.plan.find(row, column)?;
        if self.plan.one_front().is_some() { Some(place) } else { self.plan.entries.binary_search(&(place as u32)).ok() }
    }

    pub(super) fn values(&self) -> &[f64] {
        if self.plan.one_front().is_some() { self.tiles.as_flattened() } else { &self.values }
    }

    pub(super) fn values_mut(&mut self) -> &mut [f64] {
        if self.plan.one_front().is_some() { self.tiles.as_flattened_mut() } else { &mut self.values }
    }

    pub(super) fn factor(&mut self) -> Result<(), Singular> {
        self.numbers.stale.fill(true);
        self.factor_stale()
    }

    /// Factors the fronts of some unknowns and those above them anew.
    pub(super) fn factor_with(&mut self, unknowns: impl Iterator<Item = usize>) -> Result<(), Singular> {
        for unknown in unknowns {
            self.numbers.stale[self.plan.front_of(unknown)] = true;
        }
        self.factor_stale()
    }

    fn factor_stale(&mut self) -> Result<(), Singular> {
        let Self { plan, tiles, values, numbers, arch } = self;
        arch.dispatch(Factor { plan, tiles, values, numbers })
    }

    pub(super) fn solve(&mut self, b: &mut [f64]) {
        self.arch.dispatch(Solve { plan: &self.plan, tiles: &self.tiles, numbers: &mut self.numbers, b });
    }

    /// Size of the pivot met at a row of the matrix.
    pub(super) fn pivot(&self, row: usize) -> f64 {
        let place = self.plan.place[row] as usize;
        1.0 / self.tiles[self.plan.diagonal(place / LANES)][place % LANES * (LANES + 1)].abs()
    }
}

/// What goes faster with a single front of a size that is known.
trait OneFront: WithSimd {
    /// The same with a single front of `B` blocks.
    fn one<S: Simd, const B: usize>(self, simd: S) -> Self::Output;
}

#[inline(always)]
fn with_blocks<S: Simd, T: OneFront>(task: T, simd: S, blocks: usize) -> T::Output {
    match blocks {
        1 => task.one::<S, 1>(simd),
        2 => task.one::<S, 2>(simd),
        3 => task.one::<S, 3>(simd),
        _ => task.one::<S, ONE_FRONT>(simd),
    }
}

struct Factor<'a> {
    plan: &'a Fronts,
    tiles: &'a mut [Tile],
    values: &'a [f64],
    numbers: &'a mut Numbers,
}

impl WithSimd for Factor<'_> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        if let Some(blocks) = self.plan.one_front() {
            return with_blocks(self, simd, blocks);
        }
        let (plan, Numbers { stale, exchange, exchanged, rows, .. }) = (self.plan, self.numbers);
        for (k, (front, exchanged)) in plan.fronts.iter().zip(exchanged).enumerate() {
            if !std::mem::take(&mut stale[k]) {
                continue;
            }
            if let Some(parent) = front.parent {
                stale[parent] = true;
            }
            let (done, own) = self.tiles.split_at_mut(front.tile);
            let own = &mut own[..front.size * front.size];
            own.fill([0.0; TILE]);
            let [first, last] = front.entries;
            for (&place, value) in plan.entries[first..last].iter().zip(&self.values[first..last]) {
                own.as_flattened_mut()[place as usize - front.tile * TILE] = *value;
            }
            let [first, last] = front.children;
            for &child in &plan.children[first..last] {
                let child = &plan.fronts[child as usize];
                take_over(child, &done[child.tile..], &plan.in_parent[child.range()], front.size, own.as_flattened_mut());
            }
            let exchange = &mut exchange[front.block * LANES..front.block * LANES + front.pivots];
            *exchanged = eliminate(simd, front, own, exchange, rows)
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
        let (Numbers { exchange, exchanged, rows, .. }, tiles) = (self.numbers, &mut self.tiles[..B * B]);
        exchanged[0] = eliminate(simd, &front, tiles, &mut exchange[..front.pivots], rows)
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

/// A pivot this far below the largest number under it is exchanged.
const SMALL: f64 = 1e-3;

/// Eliminates the pivots of a front, a block at a time; whether rows changed places, or the pivot that cannot be one.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, front: &Front, tiles: &mut [Tile], exchange: &mut [u32], rows: &mut [Block]) -> Result<bool, usize> {
    let size = front.size;
    for k in front.pivots..front.head * LANES {
        tiles[k / LANES * (size + 1)][k % LANES * (LANES + 1)] = 1.0;
    }
    let mut exchanged = false;
    for block in 0..front.head {
        let pivots = block * (size + 1)..block * size + front.head;
        let inverse = match in_order(simd, &tiles[pivots.clone()]) {
            Some(inverse) => inverse,
            None => {
                if !exchanged {
                    exchange.iter_mut().enumerate().for_each(|(k, row)| *row = k as u32);
                }
                exchanged = true;
                exchange_rows(block, front, tiles, exchange, rows)?;
                in_order(simd, &tiles[pivots]).ok_or(block * LANES)?
            }
        };
        tiles[block * (size + 1)] = packed(&inverse);
        let (done, rest) = tiles.split_at_mut((block + 1) * size);
        let panel = &mut done[block * (size + 1) + 1..];
        for l in panel.iter_mut() {
            *l = above_tiny(product(simd, l, &inverse[1]));
        }
        for column in rest.chunks_exact_mut(size) {
            let (head, tail) = column[block..].split_first_mut().expect("a column has all rows");
            *head = above_tiny(product(simd, &inverse[0], head));
            for (l, target) in panel.iter().zip(tail) {
                add_product(simd, target, l, head, -1.0);
            }
        }
    }
    Ok(exchanged)
}

/// The inverses of the factors of the first of a column of tiles, where all pivots are fit in the order as it is.
#[inline(always)]
fn in_order<S: Simd>(simd: S, panel: &[Tile]) -> Option<[Tile; 2]> {
    let (diagonal, below) = panel.split_first()?;
    let mut factors = *diagonal;
    let mut largest = [0.0; LANES];
    for k in 0..LANES {
        let scale = 1.0 / factors[k * LANES + k];
        for row in k + 1..LANES {
            factors[k * LANES + row] *= scale;
            larger(&mut largest[row], factors[k * LANES + row]);
            for j in k + 1..LANES {
                factors[j * LANES + row] -= factors[j * LANES + k] * factors[k * LANES + row];
            }
        }
    }
    let inverse = inverses(&factors);
    for tile in below {
        let l = product(simd, tile, &inverse[1]);
        for k in 0..TILE {
            larger(&mut largest[k % LANES], l[k]);
        }
    }
    // Neither infinite numbers nor what is no number pass.
    let ends = (0..LANES).all(|k| factors[k * (LANES + 1)].is_normal());
    (ends && largest.iter().all(|&l| l <= 1.0 / SMALL)).then_some(inverse)
}

/// Raises `largest` to |x|, and to what is no number.
#[inline(always)]
fn larger(largest: &mut f64, x: f64) {
    *largest = if x.abs() <= *largest { *largest } else { x.abs() };
}

/// Exchanges the row of each pivot of a block that is far smaller than the largest number below it among the pivots for the
/// row of that; the pivot that cannot be one.
#[inline(never)]
fn exchange_rows(block: usize, front: &Front, tiles: &mut [Tile], exchange: &mut [u32], rows: &mut [Block]) -> Result<(), usize> {
    let first = block * LANES;
    let place = |row: usize, column: usize| (column / LANES * front.size + row / LANES, column % LANES * LANES + row % LANES);
    let rows = &mut rows[..front.pivots - first];
    for (row, numbers) in rows.iter_mut().enumerate() {
        *numbers = std::array::from_fn(|k| {
            let (tile, at) = place(first + row, first + k);
            tiles[tile][at]
        });
    }
    for k in 0..rows.len().min(LANES) {
        let (largest, size) = (k..rows.len()).fold((k, 0.0), |(m, size), row| {
            let other = rows[row][k].abs();
            if other > size { (row, other) } else { (m, size) }
        });
        if !size.is_normal() {
            return Err(first + k);
        }
        if rows[k][k].abs() < SMALL * size {
            rows.swap(k, largest);
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

/// The inverses of the lower (with ones on its diagonal) and of the upper triangle of a tile.
#[inline(always)]
fn inverses(tile: &Tile) -> [Tile; 2] {
    let [mut lower, mut upper] = [[0.0; TILE]; 2];
    for k in 0..LANES {
        lower[k * LANES + k] = 1.0;
        for row in k + 1..LANES {
            lower[k * LANES + row] = -(k..row).map(|j| tile[j * LANES + row] * lower[k * LANES + j]).sum::<f64>();
        }
        let scale = 1.0 / tile[k * LANES + k];
        upper[k * LANES + k] = scale;
        for row in 0..k {
            upper[k * LANES + row] = -scale * (row..k).map(|j| upper[j * LANES + row] * tile[k * LANES + j]).sum::<f64>();
        }
    }
    [lower, upper]
}

/// Both inverses in one tile: what is below the diagonal of the first, and the second.
#[inline(always)]
fn packed([lower, upper]: &[Tile; 2]) -> Tile {
    std::array::from_fn(|k| if k % LANES > k / LANES { lower[k] } else { upper[k] })
}

/// The first of two packed inverses.
#[inline(always)]
fn lower(tile: &Tile) -> Tile {
    std::array::from_fn(|k| match (k % LANES).cmp(&(k / LANES)) {
        Ordering::Greater => tile[k],
        Ordering::Equal => 1.0,
        Ordering::Less => 0.0,
    })
}

/// The second of two packed inverses.
#[inline(always)]
fn upper(tile: &Tile) -> Tile {
    std::array::from_fn(|k| if k % LANES > k / LANES { 0.0 } else { tile[k] })
}

/// Column `k` of a tile.
#[inline(always)]
fn column(tile: &Tile, k: usize) -> &Block {
    &tile.as_chunks().0[k]
}

/// target + sign · tile x
#[inline(always)]
fn add_times<S: Simd>(simd: S, target: &Block, tile: &Tile, x: &Block, sign: f64) -> Block {
    let mut out = *target;
    let sum = S::as_mut_simd_f64s(&mut out).0;
    for k in 0..LANES {
        let (column, x) = (S::as_simd_f64s(column(tile, k)).0, simd.splat_f64s(sign * x[k]));
        for (sum, &entry) in sum.iter_mut().zip(column) {
            *sum = simd.mul_add_f64s(entry, x, *sum);
        }
    }
    out
}

/// target + tile x in two sums, for where the next operation waits for it.
#[inline(always)]
fn shortly_times<S: Simd>(simd: S, target: &Block, tile: &Tile, x: &Block) -> Block {
    let [mut out, mut other] = [*target, [0.0; LANES]];
    let sums = [S::as_mut_simd_f64s(&mut out).0, S::as_mut_simd_f64s(&mut other).0];
    for (half, sum) in sums.into_iter().enumerate() {
        for k in 2 * half..2 * half + 2 {
            let (column, x) = (S::as_simd_f64s(column(tile, k)).0, simd.splat_f64s(x[k]));
            for (sum, &entry) in sum.iter_mut().zip(column) {
                *sum = simd.mul_add_f64s(entry, x, *sum);
            }
        }
    }
    std::array::from_fn(|k| out[k] + other[k])
}

/// tile x
#[inline(always)]
fn times<S: Simd>(simd: S, tile: &Tile, x: &Block) -> Block {
    add_times(simd, &[0.0; LANES], tile, x, 1.0)
}

/// target −= tile x
#[inline(always)]
fn subtract_times<S: Simd>(simd: S, target: &mut Block, tile: &Tile, x: &Block) {
    *target = shortly_times(simd, target, tile, &x.map(|x| -x));
}

/// Zero in place of numbers below 1e-146, and others but for so much as they are. What a long chain hands on falls off
/// exponentially, and numbers near the least there is take a hundred times as long: the product of two such is not among them.
#[inline(always)]
fn above_tiny<const N: usize>(x: [f64; N]) -> [f64; N] {
    const TINY: f64 = 1e-130;
    x.map(|x| (x + TINY) - TINY)
}

#[inline(always)]
fn product<S: Simd>(simd: S, a: &Tile, b: &Tile) -> Tile {
    let mut out = [0.0; TILE];
    for (out, b) in out.as_chunks_mut().0.iter_mut().zip(b.as_chunks().0) {
        *out = times(simd, a, b);
    }
    out
}

/// target + sign · a b
#[inline(always)]
fn add_product<S: Simd>(simd: S, target: &mut Tile, a: &Tile, b: &Tile, sign: f64) {
    for (target, b) in target.as_chunks_mut().0.iter_mut().zip(b.as_chunks().0) {
        *target = add_times(simd, target, a, b, sign);
    }
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

struct Solve<'a> {
    plan: &'a Fronts,
    tiles: &'a [Tile],
    numbers: &'a mut Numbers,
    b: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if let Some(blocks) = self.plan.one_front() {
            return with_blocks(self, simd, blocks);
        }
        let Numbers { exchange, exchanged, y, local, .. } = self.numbers;
        for front in self.plan.fronts.iter().filter(|front| front.pivots < front.head * LANES) {
            y[front.block + front.head - 1] = [0.0; LANES];
        }
        for (&place, &b) in self.plan.place.iter().zip(&*self.b) {
            y.as_flattened_mut()[place as usize] = b;
        }
        for (front, &exchanged) in self.plan.fronts.iter().zip(&*exchanged) {
            let (tiles, local) = (&self.tiles[front.tile..], &mut local[..front.size - front.head]);
            let blocks = front.block..front.block + front.head;
            let own = &mut y[blocks];
            if exchanged {
                let rows = &exchange[front.block * LANES..front.block * LANES + front.pivots];
                rows.iter().enumerate().for_each(|(k, &row)| own.as_flattened_mut().swap(k, row as usize));
            }
            local.fill([0.0; LANES]);
            solve_lower(simd, front, tiles, own, local);
            for (&place, value) in self.plan.below[front.range()].iter().zip(local.as_flattened()) {
                y.as_flattened_mut()[place as usize] += value;
            }
        }
        for front in self.plan.fronts.iter().rev() {
            let (tiles, local) = (&self.tiles[front.tile..], &mut local[..front.size - front.head]);
            let blocks = front.block..front.block + front.head;
            local.fill([0.0; LANES]);
            for (&place, value) in self.plan.below[front.range()].iter().zip(local.as_flattened_mut()) {
                *value = y.as_flattened()[place as usize];
            }
            solve_upper(simd, front, tiles, &mut y[blocks], local);
        }
        for (&place, b) in self.plan.place.iter().zip(self.b) {
            *b = y.as_flattened()[place as usize];
        }
    }
}

impl OneFront for Solve<'_> {
    #[inline(always)]
    fn one<S: Simd, const B: usize>(self, simd: S) {
        let (Numbers { exchange, exchanged, .. }, tiles) = (self.numbers, &self.tiles[..B * B]);
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
fn solve_lower<S: Simd>(simd: S, front: &Front, tiles: &[Tile], own: &mut [Block], below: &mut [Block]) {
    for (block, column) in tiles.chunks_exact(front.size).take(front.head).enumerate() {
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
fn solve_upper<S: Simd>(simd: S, front: &Front, tiles: &[Tile], own: &mut [Block], below: &[Block]) {
    let (pivots, rows) = tiles.split_at(front.head * front.size);
    for (column, x) in rows.chunks_exact(front.size).zip(below) {
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
