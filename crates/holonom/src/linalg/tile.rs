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

/// The inverses of the lower (with ones on its diagonal) and of the upper triangle of a tile.
#[inline(always)]
pub(super) fn inverses(tile: &Tile) -> [Tile; 2] {
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
pub(super) fn packed([lower, upper]: &[Tile; 2]) -> Tile {
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
