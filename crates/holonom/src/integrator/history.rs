//! What steps leave, extrapolated to the next: by the polynomial through some of the last ones, or by the vibration about it, whichever
//! would have come nearest to the last.

/// Backward differences of a number up to order N, of order 1 first.
pub type Differences<const N: usize> = [f64; N];

/// Orders that are kept of accelerations, whose prediction begins the iteration.
pub const MOTION: usize = 6;

/// Orders that are kept of multipliers, whose prediction is for the first tangent only.
pub const MULTIPLIERS: usize = 4;

/// A vibration must have left less than this share of the last change, squared: others foretell nothing, and large steps would begin so far
/// off that Newton's iteration finds another solution.
const TRUSTED: f64 = 0.02;

/// Takes in by how much some numbers changed in a step, and predicts their change in the next. Where the step does not follow
/// others of its length nothing is predicted.
///
/// Differences d of one order, all but the highest, are taken to go on as d_{n+1} = 2c d_n − d_{n−1}, with one c for all numbers: a
/// vibration by the angle acos c a step does, and with c = 1 a polynomial. The order and its c are those that would have served best
/// in the last step, by the squares over all numbers, each times its `weight`. Where none serves, a share of the last change comes again.
pub fn extrapolate<const N: usize>(
    differences: &mut [Differences<N>],
    change: &mut [f64],
    follows: bool,
    latest: impl Fn(usize) -> f64,
    weight: impl Fn(usize) -> f64,
) {
    if change.is_empty() {
        return;
    }
    if !follows {
        differences.fill([0.0; N]);
        change.fill(0.0);
        return;
    }
    // Squares of the last change and its products with that before, and of each order squares of d_n + d_{n−2}, their products with
    // d_{n−1}, and squares of that.
    let (mut whole, mut again) = (0.0, 0.0);
    let (mut sums, mut products, mut squares) = ([0.0; N], [0.0; N], [0.0; N]);
    for (k, differences) in differences.iter_mut().enumerate() {
        let (last, weight) = (*differences, weight(k));
        differences[0] = latest(k);
        for order in 1..N {
            differences[order] = differences[order - 1] - last[order - 1];
        }
        whole += weight * differences[0] * differences[0];
        again += weight * differences[0] * last[0];
        for order in 0..N - 1 {
            let sum = differences[order] + last[order] - last[order + 1];
            sums[order] += weight * sum * sum;
            products[order] += weight * sum * last[order];
            squares[order] += weight * last[order] * last[order];
        }
    }
    let mut shares = [0.0; N];
    let (share, missed) = fit(whole, again, squares[0], 1.0);
    shares[0] = share;
    let mut best = missed.min(TRUSTED * whole);
    for order in 0..N - 1 {
        let (factor, missed) = fit(sums[order], products[order], squares[order], 2.0);
        if missed < best {
            best = missed;
            shares = [0.0; N];
            shares[..order].fill(1.0);
            (shares[order], shares[order + 1]) = (factor - 1.0, 1.0);
        }
    }
    for (change, differences) in change.iter_mut().zip(differences) {
        *change = shares.iter().zip(differences).map(|(share, difference)| share * *difference).sum();
    }
}

/// The factor, within bounds beyond which errors would grow, that leaves least of some numbers when times others are taken from them, from
/// squares of the numbers, products and squares of the others; and the squares of what it leaves.
fn fit(sum: f64, product: f64, square: f64, most: f64) -> (f64, f64) {
    let factor = if square > 0.0 { (product / square).clamp(-most, most) } else { 0.0 };
    (factor, sum - factor * (2.0 * product - factor * square))
}

/// Numbers that an integrator predicts for itself, as it keeps them from step to step.
pub(super) struct History<'a, const N: usize> {
    /// Those of the last step.
    pub value: &'a mut [f64],
    /// Predicted change in the next.
    pub change: &'a mut [f64],
    differences: &'a mut [Differences<N>],
}

impl<'a, const N: usize> History<'a, N> {
    /// Numbers that the history of one number takes.
    pub const SIZE: usize = 2 + N;

    /// The history in the memory of an integrator.
    pub fn of(memory: &'a mut [f64]) -> Self {
        let (value, rest) = memory.split_at_mut(memory.len() / Self::SIZE);
        let (change, differences) = rest.split_at_mut(value.len());
        Self { value, change, differences: differences.as_chunks_mut().0 }
    }

    /// Takes in the numbers of another step.
    pub fn remember(&mut self, follows: bool, new: impl Fn(usize) -> f64, weight: impl Fn(usize) -> f64) {
        let value = &*self.value;
        extrapolate(self.differences, self.change, follows, |k| new(k) - value[k], weight);
        self.value.iter_mut().enumerate().for_each(|(k, value)| *value = new(k));
    }
}

/// Whether two steps are of the same length; round-off of the times is no other length.
pub fn is_same_length(step: f64, other: f64) -> bool {
    (step - other).abs() <= 1e-9 * step.abs()
}
