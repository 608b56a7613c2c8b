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
/// the one with fewer rows there, and the other interpolated: so the fewer rows decide what is seen, and the more rows how well.
pub fn difference(reference: &Recording, other: &Recording, column: &str) -> Option<Difference> {
    let (reference, other) = (rows(reference, column)?, rows(other, column)?);
    let ends = |rows: &[(f64, f64)]| Some((rows.first()?.0, rows.last()?.0));
    let (mine, theirs) = (ends(&reference)?, ends(&other)?);
    let common = mine.0.max(theirs.0)..=mine.1.min(theirs.1);
    let within = |rows: &[(f64, f64)]| rows.iter().filter(|(t, _)| common.contains(t)).count();
    let (few, many) = if within(&other) <= within(&reference) { (&other, &reference) } else { (&reference, &other) };
    let (mut found, mut mean): (Option<Difference>, _) = (None, RunningValue::default());
    for &(t, value) in few.iter().filter(|(t, _)| common.contains(t)) {
        let distance = value - between(many, t);
        let size = distance.abs();
        let rms = mean.add(Running::Rms, t, distance);
        found = match found {
            Some(found) if size <= found.largest => Some(Difference { rms, ..found }),
            _ => Some(Difference { largest: size, at: t, rms }),
        };
    }
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
