//! How far one curve is from another.

use holonom::record::{Recording, Running, RunningValue};

use crate::interpolation::between;

/// The difference of a column in two recordings over the time that both have.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The largest size.
    pub largest: f64,
    /// When it is that large, s.
    pub at: f64,
    /// Root of the mean of its square over time.
    pub rms: f64,
}

/// The difference of a column in two recordings; `None` where either lacks it, or they have no time in common. It is taken at the times of
/// the one with fewer rows there, and the other interpolated: so the fewer rows decide what is seen, and the more rows how well. Where the other
/// has a gap, nothing is known of it.
pub fn difference(reference: &Recording, other: &Recording, column: &str) -> Option<Difference> {
    let (reference, other) = (rows(reference, column)?, rows(other, column)?);
    let ends = |rows: &[(f64, f64)]| Some((rows.first()?.0, rows.last()?.0));
    let (mine, theirs) = (ends(&reference)?, ends(&other)?);
    let common = mine.0.max(theirs.0)..=mine.1.min(theirs.1);
    let within = |rows: &[(f64, f64)]| rows.iter().filter(|(t, _)| common.contains(t)).count();
    let (few, many) = if within(&other) <= within(&reference) { (&other, &reference) } else { (&reference, &other) };
    let (mut found, mut mean): (Option<Difference>, _) = (None, RunningValue::default());
    let few: Vec<(f64, f64)> = few.iter().copied().filter(|(t, _)| common.contains(t)).collect();
    for (t, distance) in distances(&few, many) {
        let size = distance.abs();
        let rms = mean.add(Running::Rms, t, distance);
        found = match found {
            Some(found) if size <= found.largest => Some(Difference { rms, ..found }),
            _ => Some(Difference { largest: size, at: t, rms }),
        };
    }
    found
}

/// Two rows between which the other curve has more rows than these are a gap.
const MOST_WITHIN: usize = 2;

/// Times within both curves, s, and how far `few` is there from `many`: at the rows of `few`, and where these are in a gap of `many`, at the ends
/// of the gap.
fn distances(few: &[(f64, f64)], many: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    let mut rest = few;
    while let Some(&(t, _)) = rest.first() {
        let after = many.partition_point(|(at, _)| *at <= t);
        let end = many.get(after).map_or(f64::INFINITY, |(at, _)| *at);
        let (within, others) = rest.split_at(rest.partition_point(|(at, _)| *at < end));
        match within.len() > MOST_WITHIN {
            true => {
                let ends = many[after - 1..].iter().take(2).filter(|(at, _)| (few[0].0..=few[few.len() - 1].0).contains(at));
                found.extend(ends.map(|&(at, value)| (at, between(few, at) - value)));
            }
            false => found.extend(within.iter().map(|&(t, value)| (t, value - between(many, t)))),
        }
        rest = others;
    }
    found.dedup_by_key(|(t, _)| *t);
    found
}

/// Times and values of a column, where it has a number.
fn rows(recording: &Recording, column: &str) -> Option<Vec<(f64, f64)>> {
    let (times, values) = (recording.column("t")?, recording.column(column)?);
    Some(times.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x over times.
    fn recording(times: impl Iterator<Item = f64>, x: impl Fn(f64) -> f64) -> Recording {
        let mut recording = Recording::new(["t", "x"].map(String::from));
        times.for_each(|t| recording.push(&[t, x(t)]));
        recording
    }

    fn even(count: u32) -> impl Iterator<Item = f64> {
        (0..=count).map(move |k| f64::from(k) / f64::from(count))
    }

    #[test]
    fn differences_are_those_by_hand_whatever_the_rows_are() {
        // t² and t³: the difference is largest at 2/3, and ∫(t² − t³)² = 1/5 − 2/6 + 1/7.
        for (mine, theirs) in [(600, 600), (600, 30_000), (30_000, 600), (600, 1009)] {
            let (a, b) = (recording(even(mine), |t| t * t), recording(even(theirs), |t| t * t * t));
            let found = difference(&a, &b, "x").unwrap();
            assert!((found.largest - 4.0 / 27.0).abs() < 1e-12 && (found.at - 2.0 / 3.0).abs() < 1e-12, "{found:?}");
            assert!((found.rms - (1.0 / 105.0_f64).sqrt()).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn nothing_is_told_of_a_gap() {
        let x = |t: f64| (20.0 * t).cos();
        let steps = recording(even(20), x);
        let gap = recording(even(100), |t| if (0.255..0.745).contains(&t) { f64::NAN } else { x(t) });
        for (a, b) in [(&steps, &gap), (&gap, &steps)] {
            let found = difference(a, b, "x").unwrap();
            assert!(found.largest < 0.02 && found.rms < 0.01, "{found:?}");
        }
        // An offset shows beside the gap.
        let off = recording(even(100), |t| {
            if t < 0.255 {
                x(t)
            } else if t > 0.745 {
                x(t) + 0.5
            } else {
                f64::NAN
            }
        });
        let found = difference(&steps, &off, "x").unwrap();
        assert!((found.largest - 0.5).abs() < 0.02 && found.at > 0.74, "{found:?}");
        // Values at every tenth row are no gaps.
        let seldom = recording(even(1000), |t| if (t * 100.0 - (t * 100.0).round()).abs() < 1e-9 { x(t) } else { f64::NAN });
        let found = difference(&recording(even(40), |t| x(t) + 1.0), &seldom, "x").unwrap();
        assert!((found.rms - 1.0).abs() < 1e-3 && found.largest < 1.001, "{found:?}");
    }

    #[test]
    fn only_common_times_and_numbers_count() {
        let a = recording(even(10), |t| t);
        let b = recording([0.55, 0.75, 3.0].into_iter(), |t| if t < 1.0 { t + 0.5 } else { 1e9 });
        let found = difference(&a, &b, "x").unwrap();
        assert!((found.largest - 0.5).abs() < 1e-12 && (found.rms - 0.5).abs() < 1e-12, "{found:?}");
        let c = recording(even(10), |t| if t < 0.45 { f64::NAN } else { t });
        assert_eq!(difference(&a, &c, "x").map(|found| found.largest), Some(0.0));
        assert_eq!(difference(&a, &recording([5.0, 6.0].into_iter(), |t| t), "x"), None);
        assert_eq!((difference(&a, &a, "y"), difference(&a, &recording(even(3), |_| f64::NAN), "x")), (None, None));
    }
}
