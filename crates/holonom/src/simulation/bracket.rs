//! Narrows the interval of time in which a number goes through zero.

/// An interval at whose beginning a number is on one side of zero and at whose end it is on the other.
pub(super) struct Bracket {
    /// Its beginning and its end, s, and the number there.
    pub low: f64,
    pub high: f64,
    pub at_low: f64,
    pub at_high: f64,
    bisects: bool,
}

impl Bracket {
    pub(super) fn new([low, high]: [f64; 2], [at_low, at_high]: [f64; 2]) -> Self {
        Self { low, high, at_low, at_high, bisects: false }
    }

    /// Where the secant is zero.
    pub(super) fn secant(&self) -> f64 {
        self.high - self.at_high * (self.high - self.low) / (self.at_high - self.at_low)
    }

    /// Where to look next to come as close as `width`: beside the secant, towards the farther end, so that both ends come close; half way where
    /// the last look did not halve the interval.
    pub(super) fn next(&self, width: f64) -> f64 {
        let secant = self.secant();
        let aim = if secant - self.low < self.high - secant { secant + 0.25 * width } else { secant - 0.25 * width };
        if self.bisects || !(aim > self.low && aim < self.high) { 0.5 * (self.low + self.high) } else { aim }
    }

    /// The part of it that is left with the number at the time looked at for one of the ends.
    pub(super) fn narrowed(mut self, t: f64, value: f64, is_beyond: bool) -> Self {
        let whole = self.high - self.low;
        if is_beyond {
            (self.high, self.at_high) = (t, value);
        } else {
            (self.low, self.at_low) = (t, value);
        }
        self.bisects = self.high - self.low > 0.5 * whole;
        self
    }
}
