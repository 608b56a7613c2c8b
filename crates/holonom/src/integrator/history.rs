//! What steps leave, extrapolated to the next: by the polynomial through some of the last ones, of whose highest differences a
//! share comes again, that would have come nearest to the last.

/// Most points before the last that a polynomial goes through.
const ORDERS: usize = 8;

/// Backward differences of a number, of order 1 first.
pub type Differences = [f64; ORDERS];

/// Takes in by how much some numbers changed in a step, and predicts their change in the next. Where the step does not follow
/// others of its length nothing is predicted.
pub fn extrapolate(differences: &mut [Differences], change: &mut [f64], follows: bool, latest: impl Fn(usize) -> f64) {
    if !follows {
        differences.fill([0.0; ORDERS]);
        change.fill(0.0);
        return;
    }
    // Of each order: squares of the new differences, their products with those before, and squares of those.
    let mut sums = [[0.0; 3]; ORDERS];
    for (k, differences) in differences.iter_mut().enumerate() {
        let mut difference = latest(k);
        for (sums, kept) in sums.iter_mut().zip(differences) {
            let last = std::mem::replace(kept, difference);
            sums[0] += difference * difference;
            sums[1] += difference * last;
            sums[2] += last * last;
            difference -= last;
        }
    }
    let fits = sums.map(fit);
    let order = (0..ORDERS).min_by(|&i, &j| fits[i].1.total_cmp(&fits[j].1)).unwrap_or(0);
    for (change, differences) in change.iter_mut().zip(differences) {
        *change = differences[..order].iter().sum::<f64>() + fits[order].0 * differences[order];
    }
}

/// The share with which differences come again, and the squares of what it leaves of them: 1 goes on as a polynomial does, -1
/// alternates. Beyond these, errors would grow.
fn fit([new, product, last]: [f64; 3]) -> (f64, f64) {
    let share = if last > 0.0 { (product / last).clamp(-1.0, 1.0) } else { 0.0 };
    (share, new - share * (2.0 * product - share * last))
}

/// Takes over new numbers, and by how much they changed in a step that follows others of its length.
pub(super) fn take_over(last: &mut [f64], change: &mut [f64], follows: bool, new: &[f64]) {
    for ((last, change), new) in last.iter_mut().zip(change).zip(new) {
        *change = if follows { new - *last } else { 0.0 };
        *last = *new;
    }
}

/// Numbers that an integrator predicts for itself, as it keeps them from step to step.
pub(super) struct History<'a> {
    /// Those of the last step.
    pub value: &'a mut [f64],
    /// Predicted change in the next.
    pub change: &'a mut [f64],
    differences: &'a mut [Differences],
}

impl<'a> History<'a> {
    /// Numbers that the history of one number takes.
    pub const SIZE: usize = 2 + ORDERS;

    /// The history in the memory of an integrator.
    pub fn of(memory: &'a mut [f64]) -> Self {
        let (value, rest) = memory.split_at_mut(memory.len() / Self::SIZE);
        let (change, differences) = rest.split_at_mut(value.len());
        Self { value, change, differences: differences.as_chunks_mut().0 }
    }

    /// Takes in the numbers of another step.
    pub fn remember(&mut self, follows: bool, new: impl Fn(usize) -> f64) {
        let value = &*self.value;
        extrapolate(self.differences, self.change, follows, |k| new(k) - value[k]);
        self.value.iter_mut().enumerate().for_each(|(k, value)| *value = new(k));
    }
}

/// Whether two steps are of the same length; round-off of the times is no other length.
pub fn is_same_length(step: f64, other: f64) -> bool {
    (step - other).abs() <= 1e-9 * step.abs()
}
