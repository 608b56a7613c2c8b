//! The rank of the rows: the engine's word against the singular values of the dense matrix.

use faer::Mat;
use holonom::analysis;
use holonom::model::Model;

use crate::natural;

/// What became of the comparison.
#[derive(Clone, Debug, PartialEq)]
pub enum Agreement {
    Agree,
    /// No gap in the singular values says what the rank is.
    Unclear,
    /// Of which sort, and in words.
    Differ(&'static str, String),
}

/// Singular value, over the largest, between those of independent rows and round-off.
const THRESHOLD: f64 = 1e-9;

/// Ratio of the singular values beside the threshold that is a clear gap.
const GAP: f64 = 1e3;

/// Gradient of a row over its natural size that may be round-off.
const VANISHING: f64 = 1e-9;

/// Singular value below which the engine may leave a row out: one counts when it adds more than 1e-9 of itself, squared, to those before
/// it, which is at least the square of what its singular value is to the others.
const COUNTED: f64 = 3.2e-5;

/// Singular value from which on its square is clear, too: what rows leave undetermined is found from their products.
const SQUARED: f64 = 1e-6;

/// The rank of a dense matrix.
#[derive(Debug, PartialEq)]
struct Dense {
    rank: usize,
    /// The last singular value that counts and the first that does not.
    gap: [f64; 2],
    /// How many are above [`COUNTED`]: so many rows the engine has to count.
    certain: usize,
}

/// Compares the rank at the start.
pub fn compare(model: &Model, size: f64) -> Agreement {
    let system = &model.system;
    let x = system.start_position();
    let (rows, natural) = (analysis::constraint_jacobian(system, x, 0.0), natural::gradients(system, size));
    let Some(dense) = dense_rank(rows, &natural, system.coordinates()) else {
        return Agreement::Unclear;
    };
    let (rank, [weakest, below]) = (dense.rank, dense.gap);
    let (rows, found) = (system.constraints(), analysis::rank(system, x, 0.0));
    let redundant = rows - rank;
    if (dense.certain..rank).contains(&found.rank) {
        return Agreement::Unclear;
    }
    if found.rank != rank || found.redundant.len() != redundant {
        let names = found.redundant.join(", ");
        let values = format!("{rank} by the gap of singular values from {weakest:.0e} to {below:.0e}");
        let sort = if found.rank < rank { "too low" } else { "too high" };
        return Agreement::Differ(sort, format!("rank {} of {rows} rows, and {values}; redundant: {names}", found.rank));
    }
    match analysis::undetermined(system, x, 0.0) {
        Some(spaces) if spaces.count() != redundant && weakest > SQUARED => {
            let how = format!("{} undetermined combinations of rows, and {redundant} redundant ones", spaces.count());
            Agreement::Differ("forces that are undetermined", how)
        }
        _ => Agreement::Agree,
    }
}

/// The rank of rows scaled to unit gradients, if it is clear. Rows that hold nothing are none. Columns are all lengths: directions are nodes of the length of
/// the mechanism.
fn dense_rank(mut rows: Vec<Vec<f64>>, natural: &[f64], columns: usize) -> Option<Dense> {
    for (row, natural) in rows.iter_mut().zip(natural) {
        if natural.is_infinite() {
            row.fill(0.0);
            continue;
        }
        let length = natural::length(row);
        if length.is_nan() || length <= VANISHING * natural {
            return None;
        }
        row.iter_mut().for_each(|g| *g /= length);
    }
    if rows.is_empty() || columns == 0 {
        return Some(Dense { rank: 0, gap: [1.0, 0.0], certain: 0 });
    }
    let values = Mat::from_fn(rows.len(), columns, |i, j| rows[i][j]).singular_values().ok()?;
    let rank = values.iter().filter(|&&value| value > THRESHOLD * values[0]).count();
    let below = values.get(rank).copied().unwrap_or(0.0);
    if rank == 0 {
        return Some(Dense { rank, gap: [1.0, 0.0], certain: 0 });
    }
    let gap = [values[rank - 1], below];
    let certain = values.iter().filter(|&&value| value > COUNTED).count();
    (gap[1] * GAP <= gap[0]).then_some(Dense { rank, gap, certain })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rank_is_said_where_it_is_clear() {
        let rows = |last: f64| vec![vec![1.0, 0.0, 0.0], vec![0.0, 2.0, 0.0], vec![3.0, 4.0, last]];
        let rank = |rows| dense_rank(rows, &[1.0; 3], 3).map(|dense| dense.rank);
        assert_eq!((rank(rows(0.0)), rank(rows(1.0)), rank(rows(1e-6))), (Some(2), Some(3), Some(3)));
        assert_eq!((rank(vec![vec![0.0; 3]]), rank(rows(1e-12))), (None, Some(2)));
        let certain = |rows| dense_rank(rows, &[1.0; 3], 3).map(|dense| dense.certain);
        assert_eq!((certain(rows(0.0)), certain(rows(1.0)), certain(rows(1e-6))), (Some(2), Some(3), Some(2)));
    }
}
