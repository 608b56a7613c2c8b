//! How many digits of an answer are shown, and what is no part of it.

/// Digits of an answer.
pub const DIGITS: usize = 5;

/// Share of the largest of some answers below which one is round-off.
pub(crate) const ROUND_OFF: f64 = 1e-12;

/// An answer, zero where it is round-off beside the `largest` of its like.
pub fn without_round_off(value: f64, largest: f64) -> f64 {
    if value.abs() < ROUND_OFF * largest { 0.0 } else { value }
}

/// A number with so many digits, and zeros after them: the terminal and the report show the same.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// An answer between two others without its round-off, and its digits: of what changes by a small share of itself so many that this shows.
pub fn between(value: f64, [low, high]: [f64; 2]) -> (f64, usize) {
    let (largest, span) = (low.abs().max(high.abs()), high - low);
    let shares = if span > ROUND_OFF * largest { (largest / span).log10().floor() } else { 0.0 };
    (without_round_off(value, largest), DIGITS + (shares - 1.0).max(0.0) as usize)
}
