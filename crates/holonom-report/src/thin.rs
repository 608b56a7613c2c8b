//! Long recordings are shortened for the page: groups of k rows become one, and nothing that a reader looks for gets lost.
//!
//! Row 0 stands for itself. After it, every group is the k rows that end with the row which is kept, so that a peak is shown at
//! most k − 1 rows late and never before it happened. The last row of the recording always ends the last group. Only where both
//! ends of a range are kept two groups share their rows, and a peak may be up to k rows early or 2k − 1 rows late.

/// Rows a page holds per run; a screen has no room for more.
pub const MAX_ROWS: usize = 4000;

/// Numbers a page holds per run for the motion of all points; limits the rows of a mechanism with very many points.
const MAX_COORDINATES: usize = 1_200_000;

/// Fewer rows would make the motion jump.
const MIN_ROWS: usize = 500;

/// What represents a group of rows in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// The row the group ends with: times, states, sums.
    Last,
    /// The largest value: violations, iterations.
    Max,
    /// The value farthest from zero, with its sign: errors and what is exchanged per step.
    Extreme,
    /// The least and the largest value of two groups in the order in which they were reached, where a curve through the last rows
    /// would not come to them: what has peaks to either side of any middle. What rises or falls stays exact.
    Range,
}

/// Which rows of a recording the page shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thinning {
    /// Every `stride`-th row is shown.
    pub stride: usize,
    rows: usize,
}

impl Thinning {
    /// For a recording of `rows` rows and a motion of `coordinates` numbers per row.
    pub fn new(rows: usize, coordinates: usize) -> Self {
        let most = (MAX_COORDINATES / coordinates.max(1)).clamp(MIN_ROWS, MAX_ROWS);
        Self { stride: rows.saturating_sub(1).div_ceil(most - 1).max(1), rows }
    }

    /// Rows that are left.
    pub fn kept(&self) -> usize {
        if self.rows == 0 { 0 } else { 1 + (self.rows - 1).div_ceil(self.stride) }
    }

    /// One column, shortened.
    pub fn apply(&self, values: &[f64], keep: Keep) -> Vec<f64> {
        let Some((first, rest)) = values.split_first() else {
            return Vec::new();
        };
        if keep == Keep::Range {
            return self.ranges(*first, rest);
        }
        let groups = rest.chunks(self.stride).map(|group| represent(group, keep));
        std::iter::once(*first).chain(groups).collect()
    }

    /// Two groups at a time have room for their least and their largest value. A group left over at the end has room for one of them.
    fn ranges(&self, first: f64, rest: &[f64]) -> Vec<f64> {
        let mut kept = vec![first];
        let mut before = first;
        for pair in rest.chunks(2 * self.stride) {
            let ends: Vec<f64> = pair.chunks(self.stride).map(|group| represent(group, Keep::Last)).collect();
            let [least, most] = [f64::lt, f64::gt].map(|is_beyond| farthest(pair, is_beyond));
            let [low, high] = [f64::min, f64::max].map(|bound| ends.iter().copied().fold(before, bound));
            let is_met = |row: usize| (low..=high).contains(&pair[row]);
            if pair.iter().any(|value| value.is_nan()) {
                kept.extend(pair.chunks(self.stride).map(|group| represent(group, Keep::Extreme)));
            } else if is_met(least) && is_met(most) {
                kept.extend(&ends);
            } else if ends.len() == 1 {
                let off = |row: usize| (low - pair[row]).max(pair[row] - high);
                kept.push(pair[if off(least) > off(most) { least } else { most }]);
            } else {
                kept.extend([pair[least.min(most)], pair[least.max(most)]]);
            }
            before = pair[pair.len() - 1];
        }
        kept
    }
}

fn represent(group: &[f64], keep: Keep) -> f64 {
    let last = group[group.len() - 1];
    match keep {
        Keep::Last | Keep::Range => last,
        Keep::Max => largest(group, last, |v| v),
        Keep::Extreme => largest(group, last, f64::abs),
    }
}

/// The first row whose value is beyond all others.
fn farthest(values: &[f64], is_beyond: fn(&f64, &f64) -> bool) -> usize {
    (1..values.len()).fold(0, |best, row| if is_beyond(&values[row], &values[best]) { row } else { best })
}

/// NaN counts as larger than everything: it is what one wants to see.
fn largest(group: &[f64], start: f64, size: impl Fn(f64) -> f64) -> f64 {
    group.iter().copied().fold(start, |best, v| {
        if best.is_nan() || v.is_nan() {
            f64::NAN
        } else if size(v) > size(best) {
            v
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_recordings_stay_whole() {
        for rows in [0, 1, 2, 801, MAX_ROWS] {
            let thinning = Thinning::new(rows, 6);
            assert_eq!((thinning.stride, thinning.kept()), (1, rows));
        }
    }

    #[test]
    fn long_recordings_fit_and_keep_both_ends() {
        for rows in [MAX_ROWS + 1, 10_007, 200_001] {
            let thinning = Thinning::new(rows, 6);
            let t: Vec<f64> = (0..rows).map(|i| i as f64).collect();
            let kept = thinning.apply(&t, Keep::Last);
            assert!(kept.len() <= MAX_ROWS && kept.len() == thinning.kept(), "{rows}: {}", kept.len());
            assert_eq!((kept[0], kept[kept.len() - 1]), (0.0, (rows - 1) as f64));
            assert_eq!(kept[1], thinning.stride as f64);
        }
    }

    #[test]
    fn peaks_survive_wherever_they_are() {
        let thinning = Thinning::new(20_001, 6);
        for peak in [1, 4_999, 5_000, 5_001, 20_000] {
            let mut values = vec![1e-12; 20_001];
            values[peak] = 1e-3;
            assert!(thinning.apply(&values, Keep::Max).contains(&1e-3), "row {peak}");
            values[peak] = -1e-3;
            assert!(thinning.apply(&values, Keep::Extreme).contains(&-1e-3), "row {peak}");
            values[peak] = f64::NAN;
            assert_eq!(thinning.apply(&values, Keep::Max).iter().filter(|v| v.is_nan()).count(), 1);
        }
    }

    #[test]
    fn both_ends_of_a_range_survive_and_what_rises_stays_exact() {
        let thinning = Thinning::new(20_001, 6);
        let ramp: Vec<f64> = (0..20_001).map(f64::from).collect();
        assert!(thinning.apply(&ramp, Keep::Range) == thinning.apply(&ramp, Keep::Last));
        for peak in [1, 4_999, 5_000, 5_001, 10_001, 19_990, 19_999] {
            let mut values = vec![3.0; 20_001];
            (values[peak], values[peak + 1]) = (400.0, 2.0);
            let kept = thinning.apply(&values, Keep::Range);
            assert!(kept.contains(&400.0) && kept.contains(&2.0), "row {peak}");
            assert_eq!(kept.len(), thinning.kept());
        }
    }

    #[test]
    fn many_points_mean_fewer_rows() {
        assert!(Thinning::new(MAX_ROWS, 3 * 1000).kept() <= MIN_ROWS);
    }
}
