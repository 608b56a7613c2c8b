//! Dense L U with partial pivoting, in place, row-major.

use super::Singular;

pub(super) struct DenseLu {
    size: usize,
    pub(super) values: Vec<f64>,
    /// Row exchanged with row k at step k.
    exchange: Vec<u32>,
}

impl DenseLu {
    pub(super) fn new(size: usize) -> Self {
        Self { size, values: vec![0.0; size * size], exchange: vec![0; size] }
    }

    pub(super) fn position(&self, row: usize, column: usize) -> u32 {
        (row * self.size + column) as u32
    }

    pub(super) fn factor(&mut self) -> Result<(), Singular> {
        let n = self.size;
        for k in 0..n {
            let pivot_row = (k..n).fold(k, |best, i| if self.values[i * n + k].abs() > self.values[best * n + k].abs() { i } else { best });
            self.exchange[k] = pivot_row as u32;
            if pivot_row != k {
                let (upper, lower) = self.values.split_at_mut(pivot_row * n);
                upper[k * n..k * n + n].swap_with_slice(&mut lower[..n]);
            }
            let (upper, lower) = self.values.split_at_mut((k + 1) * n);
            let pivot_row = &upper[k * n..];
            let pivot = pivot_row[k];
            if !pivot.is_finite() || pivot == 0.0 {
                return Err(Singular { pivot: k });
            }
            for row in lower.chunks_exact_mut(n) {
                let factor = row[k] / pivot;
                row[k] = factor;
                if factor != 0.0 {
                    for (target, source) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                        *target -= factor * source;
                    }
                }
            }
        }
        Ok(())
    }

    pub(super) fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        for k in 0..n {
            b.swap(k, self.exchange[k] as usize);
        }
        for i in 0..n {
            let sum: f64 = self.values[i * n..i * n + i].iter().zip(&b[..i]).map(|(l, b)| l * b).sum();
            b[i] -= sum;
        }
        for i in (0..n).rev() {
            let sum: f64 = self.values[i * n + i + 1..(i + 1) * n].iter().zip(&b[i + 1..]).map(|(u, b)| u * b).sum();
            b[i] = (b[i] - sum) / self.values[i * n + i];
        }
    }

    pub(super) fn pivots(&self, out: &mut [f64]) {
        for k in 0..self.size {
            out[k] = self.values[k * self.size + k].abs();
        }
    }
}
