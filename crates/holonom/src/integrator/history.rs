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

/// Squares of the differences of each order, each times the weight of its number, summed over some numbers: at the last step and at the
/// one before it.
pub type Squares<const N: usize> = [[f64; N]; 2];

/// Takes in by how much some numbers changed in a step, and predicts their change in the next. Where the step does not follow
/// others of its length nothing is predicted.
///
/// Differences d of one order, all but the highest, are taken to go on as d_{n+1} = 2c d_n − d_{n−1}, with one c for all numbers: a
/// vibration by the angle acos c a step, and with c = 1 a polynomial. The order and its c are those that would have served best
/// in the last step, by the squares over all numbers, each times its `weight`. Where none serves, a share of the last change comes again.
pub fn extrapolate<const N: usize>(
    differences: &mut [Differences<N>],
    squares: &mut Squares<N>,
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
        *squares = [[0.0; N]; 2];
        change.fill(0.0);
        return;
    }
    let [before, earlier] = *squares;
    let (mut now, mut beyond) = ([0.0; N], 0.0);
    for (k, differences) in differences.iter_mut().enumerate() {
        let (mut difference, weight) = (latest(k), weight(k));
        for (last, square) in differences.iter_mut().zip(&mut now) {
            *square += weight * difference * difference;
            difference -= std::mem::replace(last, difference);
        }
        beyond += weight * difference * difference;
    }
    *squares = [now, before];
    // A difference of the order above is d_n − d_{n−1}, so its square and those of both give the product d_n d_{n−1}, and no sum of products is needed.
    let mut shares = [0.0; N];
    let (lack, missed) = fit(now[1], 0.5 * (now[0] - before[0] - now[1]), before[0], 1.0);
    shares[0] = 1.0 - lack;
    let mut best = missed.min(TRUSTED * now[0]);
    for order in 0..N - 1 {
        let above = now.get(order + 2).copied().unwrap_or(beyond);
        let product = 0.5 * (now[order] - 2.0 * before[order] + earlier[order] - now[order + 1] - before[order + 1]);
        let (lack, missed) = fit(above, product, before[order], 2.0);
        if missed < best {
            best = missed;
            shares = [0.0; N];
            shares[..order].fill(1.0);
            (shares[order], shares[order + 1]) = (1.0 - lack, 1.0);
        }
    }
    for (change, differences) in change.iter_mut().zip(differences) {
        *change = shares.iter().zip(differences).map(|(share, difference)| share * *difference).sum();
    }
}

/// Continues numbers as f times those before, f from −`most` to `most`, as errors would grow beyond that, so that least is missed. Returns `most` − f and
/// the square of what is missed. Takes, for f = `most`, that square and the product of what is missed with the numbers before, and their square.
fn fit(missed: f64, product: f64, square: f64, most: f64) -> (f64, f64) {
    let lack = if square > 0.0 { (-product / square).clamp(0.0, 2.0 * most) } else { most };
    (lack, missed + lack * (2.0 * product + lack * square))
}

/// Numbers that an integrator predicts for itself, as it keeps them from step to step.
pub(super) struct History<'a, const N: usize> {
    /// Those of the last step.
    pub value: &'a mut [f64],
    /// Predicted change in the next.
    pub change: &'a mut [f64],
    differences: &'a mut [Differences<N>],
    squares: &'a mut Squares<N>,
}

impl<'a, const N: usize> History<'a, N> {
    /// Numbers that the history of so many numbers takes.
    pub const fn size(numbers: usize) -> usize {
        2 * N + (2 + N) * numbers
    }

    /// The history in the memory of an integrator.
    pub fn of(memory: &'a mut [f64]) -> Self {
        let (squares, rest) = memory.split_at_mut(2 * N);
        let (value, rest) = rest.split_at_mut(rest.len() / (2 + N));
        let (change, differences) = rest.split_at_mut(value.len());
        let squares = squares.as_chunks_mut().0.first_chunk_mut().expect("there is room for two steps");
        Self { value, change, differences: differences.as_chunks_mut().0, squares }
    }

    /// Takes in the numbers of another step.
    pub fn remember(&mut self, follows: bool, new: impl Fn(usize) -> f64, weight: impl Fn(usize) -> f64) {
        let value = &*self.value;
        extrapolate(self.differences, self.squares, self.change, follows, |k| new(k) - value[k], weight);
        self.value.iter_mut().enumerate().for_each(|(k, value)| *value = new(k));
    }
}

/// Whether two steps are of the same length; round-off of the times is no other length.
pub fn is_same_length(step: f64, other: f64) -> bool {
    (step - other).abs() <= 1e-9 * step.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of the last prediction of numbers at the steps 0, 1, …, over the largest change of one in a step.
    fn error(number: impl Fn(usize, f64) -> f64) -> f64 {
        const NUMBERS: usize = 5;
        let mut differences = [Differences::<MOTION>::default(); NUMBERS];
        let (mut squares, mut change) = (Squares::default(), [0.0; NUMBERS]);
        let rise = |k: usize, step: usize| number(k, step as f64) - number(k, step as f64 - 1.0);
        let steps = 20;
        for step in 1..steps {
            extrapolate(&mut differences, &mut squares, &mut change, step > 1, |k| rise(k, step), |k| [1.0, 1e3][k % 2]);
        }
        let missed = change.iter().enumerate().map(|(k, change)| (change - rise(k, steps)).abs()).fold(0.0, f64::max);
        missed / (0..NUMBERS).map(|k| rise(k, steps).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn polynomials_and_vibrations_go_on() {
        let phase = |k: usize| k as f64;
        let quartic = |k: usize, t: f64| (phase(k) + 0.1 * t).powi(4);
        assert!(error(quartic) < 1e-12, "{}", error(quartic));
        // What trembles from step to step does so about a line.
        for turn in [0.3, 1.5, 3.0] {
            let vibration = |k: usize, t: f64| (phase(k) + turn * t).cos() + 0.2 * t;
            assert!(error(vibration) < 1e-12, "{turn}: {}", error(vibration));
        }
    }

    #[test]
    fn noise_is_not_continued() {
        // The fractional parts of multiples of a large number follow from none before.
        let noise = |k: usize, t: f64| ((t + 31.0 * k as f64) * (t + 7.0) * 1234.567).fract();
        assert!(error(noise) < 1.2, "{}", error(noise));
    }
}
