//! The largest step with which a run completes (§7.3 of the paper), by doubling and bisection.

/// The outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestStep {
    /// Largest step found to complete, s; zero when not even the first did.
    pub completes: f64,
    /// Smallest step found to fail, s; none when every step up to the limit completed.
    pub fails: Option<f64>,
    /// How many runs that took.
    pub runs: usize,
}

/// Searches from `first` upwards to `limit` (s) with runs that say whether they completed, until the largest step that
/// completes and the smallest that fails are within `ratio` of each other.
pub fn largest_step(first: f64, limit: f64, ratio: f64, mut completes: impl FnMut(f64) -> bool) -> LargestStep {
    let mut found = LargestStep { completes: 0.0, fails: None, runs: 0 };
    let mut step = first;
    loop {
        found.runs += 1;
        if completes(step) {
            found.completes = step;
        } else {
            found.fails = Some(step);
        }
        step = match found.fails {
            None if found.completes >= limit => break,
            None => (2.0 * step).min(limit),
            Some(fails) if found.completes == 0.0 && fails < first / 1024.0 => break,
            Some(fails) if found.completes == 0.0 => 0.5 * fails,
            Some(fails) if fails <= ratio * found.completes => break,
            Some(fails) => 0.5 * (found.completes + fails),
        };
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_border_from_both_sides() {
        for border in [0.003, 0.25, 0.777] {
            let found = largest_step(0.025, 2.0, 1.01, |step| step <= border);
            assert!(found.completes <= border && found.fails.unwrap() > border);
            assert!(found.fails.unwrap() <= 1.01 * found.completes, "{found:?}");
        }
        assert_eq!(largest_step(0.025, 2.0, 1.01, |_| true).completes, 2.0);
        assert_eq!(largest_step(0.025, 2.0, 1.01, |_| false).completes, 0.0);
    }
}
