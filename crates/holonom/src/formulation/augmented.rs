//! Rows that enter the part of the coordinates as well.

/// A row whose square is added to the part of the coordinates, A + ḠᵀWG: the paper's penalty, which leaves the solution where
/// it is and makes A regular where nodes have hardly any mass (methods §13).
#[derive(Clone)]
pub(super) struct Augmented {
    /// W, kg over the square of the row's unit.
    pub weight: f64,
    /// Place of the row's multiplier, and of its entry on the diagonal.
    pub row: u32,
    pub diagonal: u32,
    /// Coordinates of its nodes, each with the place of its entries in the row's column and in the row.
    pub entries: Vec<[u32; 3]>,
    /// The places of all pairs of these coordinates.
    pub pairs: Vec<u32>,
    /// The entries in the row's column when the matrix was last factored; none where the row is soft.
    pub column: Vec<f64>,
}

/// A row whose δ times W is more than this is not augmented: the solution would be another.
const SOFT: f64 = 1e-6;

impl Augmented {
    /// Adds the square to the part of the coordinates.
    pub(super) fn add(&mut self, values: &mut [f64]) {
        let is_soft = -values[self.diagonal as usize] * self.weight > SOFT;
        for (kept, [_, column, _]) in self.column.iter_mut().zip(&self.entries) {
            *kept = if is_soft { 0.0 } else { values[*column as usize] };
        }
        for (pairs, column) in self.pairs.chunks_exact(self.entries.len()).zip(&self.column) {
            for (&pair, [_, _, row]) in pairs.iter().zip(&self.entries) {
                values[pair as usize] += self.weight * column * values[*row as usize];
            }
        }
    }

    /// Adds to a right side what leaves the solution where it is.
    pub(super) fn pull(&self, b: &mut [f64]) {
        let pull = self.weight * b[self.row as usize];
        self.entries.iter().zip(&self.column).for_each(|([q, ..], column)| b[*q as usize] += pull * column);
    }
}
