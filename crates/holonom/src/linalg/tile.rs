//! Arithmetic of tiles, the squares that fronts are made of.

use std::cmp::Ordering;

use pulp::Simd;

/// Side of a tile.
pub(super) const LANES: usize = 4;

/// Numbers of a tile.
pub(super) const TILE: usize = LANES * LANES;

/// A square of numbers, by columns.
pub(super) type Tile = [f64; TILE];

/// A block of a vector.
pub(super) type Block = [f64; LANES];

/// What a pivot is multiplied by when it is dropped: beside it all others are nothing then, and it takes nothing from them. Its
/// square and its inverse are numbers still.
pub(super) const DROPPED: f64 = 1e150;

/// Size that a pivot is dropped with where it is less.
const NOTHING: f64 = 1e-30;

/// L and U of a tile without exchanges, on their way to their inverses.
pub(super) struct Factors {
    /// Columns of what is left of the tile, in the end U.
    upper: [Block; LANES],
    /// Columns of the inverse of L.
    lower: [Block; LANES],
    /// 1 over the pivots.
    reciprocal: Block,
    /// Largest number of L in each row, over the units of the pivots' rows.
    largest: Block,
}

impl Factors {
    #[inline(always)]
    pub(super) fn of<S: Simd, const DROPS: bool>(simd: S, tile: &Tile, units: &Block, least: f64) -> Self {
        let mut factors = Self {
            upper: std::array::from_fn(|k| *column(tile, k)),
            lower: std::array::from_fn(unit),
            reciprocal: [0.0; LANES],
            largest: [0.0; LANES],
        };
        factors.eliminate::<S, DROPS, 0>(simd, units, least);
        factors.eliminate::<S, DROPS, 1>(simd, units, least);
        factors.eliminate::<S, DROPS, 2>(simd, units, least);
        factors.eliminate::<S, DROPS, 3>(simd, units, least);
        factors
    }

    /// Takes pivot K out of the columns after it, and out of those of the inverse of L. One that is smaller than `least` may be dropped.
    #[inline(always)]
    fn eliminate<S: Simd, const DROPS: bool, const K: usize>(&mut self, simd: S, units: &Block, least: f64) {
        if DROPS && self.upper[K][K].abs() < least {
            self.upper[K][K] = self.upper[K][K].abs().max(NOTHING) * DROPPED;
        }
        self.reciprocal[K] = 1.0 / self.upper[K][K];
        let l = std::array::from_fn(|row| if row > K { self.upper[K][row] * self.reciprocal[K] } else { 0.0 });
        raise(&mut self.largest, &l, units[K]);
        for upper in &mut self.upper[K + 1..] {
            *upper = plus(simd, upper, -upper[K], &l);
        }
        for lower in &mut self.lower[..=K] {
            *lower = plus(simd, lower, -lower[K], &l);
        }
    }

    /// Whether all pivots are numbers to divide by; the largest number of L in each row.
    #[inline(always)]
    pub(super) fn largest(&self) -> Option<Block> {
        (0..LANES).all(|k| self.upper[k][k].is_normal()).then_some(self.largest)
    }

    /// The inverse of L.
    #[inline(always)]
    pub(super) fn lower_inverse(&self) -> Tile {
        of_columns(&self.lower)
    }

    /// The inverse of U.
    #[inline(always)]
    pub(super) fn upper_inverse<S: Simd>(&self, simd: S) -> Tile {
        of_columns(&self.over_upper(simd, &of_columns(&std::array::from_fn(unit))))
    }

    /// The tile times the inverse of U: L where the tile is below the diagonal.
    #[inline(always)]
    pub(super) fn over_upper<S: Simd>(&self, simd: S, tile: &Tile) -> [Block; LANES] {
        let mut l: [Block; LANES] = std::array::from_fn(|k| *column(tile, k));
        self.divide::<S, 0>(simd, &mut l);
        self.divide::<S, 1>(simd, &mut l);
        self.divide::<S, 2>(simd, &mut l);
        self.divide::<S, 3>(simd, &mut l);
        l
    }

    /// Column K of what U goes into, where those before are done.
    #[inline(always)]
    fn divide<S: Simd, const K: usize>(&self, simd: S, l: &mut [Block; LANES]) {
        for j in 0..K {
            l[K] = plus(simd, &l[K], -self.upper[K][j], &l[j]);
        }
        l[K] = l[K].map(|l| l * self.reciprocal[K]);
    }
}

#[inline(always)]
pub(super) fn of_columns(columns: &[Block; LANES]) -> Tile {
    std::array::from_fn(|k| columns[k / LANES][k % LANES])
}

#[inline(always)]
fn unit(k: usize) -> Block {
    std::array::from_fn(|row| if row == k { 1.0 } else { 0.0 })
}

/// Raises each of some numbers to the size of another times `unit`, and to what is no number.
#[inline(always)]
pub(super) fn raise(largest: &mut Block, x: &Block, unit: f64) {
    *largest = std::array::from_fn(|k| {
        let size = (unit * x[k]).abs();
        if size <= largest[k] { largest[k] } else { size }
    });
}

/// target + factor x
#[inline(always)]
fn plus<S: Simd>(simd: S, target: &Block, factor: f64, x: &Block) -> Block {
    let mut out = *target;
    for (sum, &x) in S::as_mut_simd_f64s(&mut out).0.iter_mut().zip(S::as_simd_f64s(x).0) {
        *sum = simd.mul_add_f64s(simd.splat_f64s(factor), x, *sum);
    }
    out
}

/// Both inverses in one tile: what is below the diagonal of the first, and the second.
#[inline(always)]
pub(super) fn packed(lower: &Tile, upper: &Tile) -> Tile {
    std::array::from_fn(|k| if k % LANES > k / LANES { lower[k] } else { upper[k] })
}

/// The first of two packed inverses.
#[inline(always)]
pub(super) fn lower(tile: &Tile) -> Tile {
    std::array::from_fn(|k| match (k % LANES).cmp(&(k / LANES)) {
        Ordering::Greater => tile[k],
        Ordering::Equal => 1.0,
        Ordering::Less => 0.0,
    })
}

/// The second of two packed inverses.
#[inline(always)]
pub(super) fn upper(tile: &Tile) -> Tile {
    std::array::from_fn(|k| if k % LANES > k / LANES { 0.0 } else { tile[k] })
}

#[inline(always)]
pub(super) fn diagonal(tile: &Tile) -> Block {
    std::array::from_fn(|k| tile[k * (LANES + 1)])
}

/// Column `k` of a tile.
#[inline(always)]
fn column(tile: &Tile, k: usize) -> &Block {
    &tile.as_chunks().0[k]
}

/// target + sign · tile x
#[inline(always)]
pub(super) fn add_times<S: Simd>(simd: S, target: &Block, tile: &Tile, x: &Block, sign: f64) -> Block {
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
pub(super) fn shortly_times<S: Simd>(simd: S, target: &Block, tile: &Tile, x: &Block) -> Block {
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
pub(super) fn times<S: Simd>(simd: S, tile: &Tile, x: &Block) -> Block {
    add_times(simd, &[0.0; LANES], tile, x, 1.0)
}

/// target −= tile x
#[inline(always)]
pub(super) fn subtract_times<S: Simd>(simd: S, target: &mut Block, tile: &Tile, x: &Block) {
    *target = shortly_times(simd, target, tile, &x.map(|x| -x));
}

/// Zero in place of numbers below 1e-146, and others but for so much as they are. What a long chain hands on falls off
/// exponentially, and numbers near the least there is take a hundred times as long: the product of two such is not among them.
#[inline(always)]
pub(super) fn above_tiny<const N: usize>(x: [f64; N]) -> [f64; N] {
    const TINY: f64 = 1e-130;
    x.map(|x| (x + TINY) - TINY)
}

#[inline(always)]
pub(super) fn product<S: Simd>(simd: S, a: &Tile, b: &Tile) -> Tile {
    let mut out = [0.0; TILE];
    for (out, b) in out.as_chunks_mut().0.iter_mut().zip(b.as_chunks().0) {
        *out = times(simd, a, b);
    }
    out
}

/// target + sign · a b
#[inline(always)]
pub(super) fn add_product<S: Simd>(simd: S, target: &mut Tile, a: &Tile, b: &Tile, sign: f64) {
    for (target, b) in target.as_chunks_mut().0.iter_mut().zip(b.as_chunks().0) {
        *target = add_times(simd, target, a, b, sign);
    }
}
