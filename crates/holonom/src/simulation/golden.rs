//! The golden section.

/// Share of a way at which its golden section is. Fractional parts of its multiples fall everywhere between whole numbers.
pub(crate) const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Where a number is highest that rises and then falls between two places, and how high. The search ends where `ends` says so of the way that is
/// left and of the highest number so far, or where places are no longer told apart.
pub(super) fn highest(mut at: impl FnMut(f64) -> f64, [mut low, mut high]: [f64; 2], ends: impl Fn(f64, f64) -> bool) -> (f64, f64) {
    let mut known = |place: f64| (place, at(place));
    let (mut left, mut right) = (known(high - GOLDEN * (high - low)), known(low + GOLDEN * (high - low)));
    while !ends(high - low, left.1.max(right.1)) {
        if left.1 >= right.1 {
            (high, right) = (right.0, left);
            left = known(high - GOLDEN * (high - low));
        } else {
            (low, left) = (left.0, right);
            right = known(low + GOLDEN * (high - low));
        }
        if !(low < left.0 && left.0 < right.0 && right.0 < high) {
            break;
        }
    }
    if left.1 >= right.1 { left } else { right }
}
