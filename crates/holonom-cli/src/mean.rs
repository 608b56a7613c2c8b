//! Means over time.

/// A mean over time by the trapezoidal rule.
#[derive(Clone, Debug, Default)]
pub struct Mean {
    before: Option<(f64, f64)>,
    integral: f64,
    /// s
    span: f64,
}

impl Mean {
    /// Sees the next value.
    pub fn see(&mut self, t: f64, value: f64) {
        if let Some((since, before)) = self.before.filter(|_| !value.is_nan()) {
            self.integral += 0.5 * (t - since) * (before + value);
            self.span += t - since;
        }
        self.before = (!value.is_nan()).then_some((t, value));
    }

    /// The mean; of a single value that.
    pub fn value(&self) -> Option<f64> {
        if self.span > 0.0 { Some(self.integral / self.span) } else { self.before.map(|(_, value)| value) }
    }
}
