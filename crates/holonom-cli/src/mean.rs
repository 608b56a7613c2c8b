//! Means over time, of a value that goes straight from row to row, as running values of measures have it.

/// A mean over time, or a root of the mean of the squares.
#[derive(Clone, Debug, Default)]
pub struct Mean {
    is_of_squares: bool,
    before: Option<(f64, f64)>,
    integral: f64,
    /// s
    span: f64,
}

impl Mean {
    /// The root of the mean of the squares.
    pub fn of_squares() -> Self {
        Self { is_of_squares: true, ..Self::default() }
    }

    /// Sees the next value.
    pub fn see(&mut self, t: f64, value: f64) {
        if let Some((since, before)) = self.before {
            let step = t - since;
            self.span += step;
            self.integral += match self.is_of_squares {
                true => step / 3.0 * (before * before + before * value + value * value),
                false => 0.5 * step * (before + value),
            };
        }
        self.before = Some((t, value));
    }

    /// The mean; of a single value that.
    pub fn value(&self) -> Option<f64> {
        let mean = self.integral / self.span;
        match (self.span > 0.0, self.is_of_squares) {
            (true, true) => Some(mean.sqrt()),
            (true, false) => Some(mean),
            (false, true) => self.before.map(|(_, value)| value.abs()),
            (false, false) => self.before.map(|(_, value)| value),
        }
    }
}
