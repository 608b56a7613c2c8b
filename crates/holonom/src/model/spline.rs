//! Cubic splines through given points: profiles of drives and curves.

use super::bodies::short;
use crate::system::{Number, Signal};

/// Places between two points that are looked at, and share of the range of their values beyond which a spline swings.
const LOOKS: u32 = 16;
const SWINGS: f64 = 0.1;

/// A cubic spline with two continuous derivatives: natural, at rest at its ends, or periodic. Beyond an end that is not
/// periodic it goes on straight, with a jump of the second derivative unless it is natural.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Where the points are, rising (k).
    knots: Vec<f64>,
    /// Values there (k).
    values: Vec<f64>,
    /// Second derivatives there (k).
    bends: Vec<f64>,
    periodic: bool,
}

impl Spline {
    /// The natural spline through at least two points with rising knots.
    pub fn natural(knots: Vec<f64>, values: Vec<f64>) -> Self {
        let last = knots.len() - 1;
        let mut bends = vec![0.0; knots.len()];
        if last > 1 {
            let (diagonal, side, right) = equations(&knots, &values, 1..last);
            bends[1..last].copy_from_slice(&tridiagonal(&diagonal, &side, right));
        }
        Self { knots, values, bends, periodic: false }
    }

    /// The spline through at least two points that is at rest at both ends, and stays there beyond them.
    pub fn resting(knots: Vec<f64>, values: Vec<f64>) -> Self {
        let last = knots.len() - 1;
        let h = |k: usize| knots[k + 1] - knots[k];
        let slope = |k: usize| (values[k + 1] - values[k]) / h(k);
        let (inner, _, inner_right) = equations(&knots, &values, 1..last);
        let diagonal: Vec<f64> = [2.0 * h(0)].into_iter().chain(inner).chain([2.0 * h(last - 1)]).collect();
        let side: Vec<f64> = (0..last).map(h).collect();
        let right = [6.0 * slope(0)].into_iter().chain(inner_right).chain([-6.0 * slope(last - 1)]).collect();
        let bends = tridiagonal(&diagonal, &side, right);
        Self { knots, values, bends, periodic: false }
    }

    /// The periodic spline through at least three different points, of which the last is the first again.
    pub fn periodic(knots: Vec<f64>, values: Vec<f64>) -> Self {
        let last = knots.len() - 1;
        // The unknowns are the bends at 1 … last; the first is the last. Sherman and Morrison take the corners away.
        let h = |k: usize| knots[k + 1] - knots[k];
        let slope = |k: usize| (values[k + 1] - values[k]) / h(k);
        let (mut diagonal, mut side, mut right) = equations(&knots, &values, 1..last);
        let corner = h(0);
        side.push(h(last - 1));
        diagonal.push(2.0 * (h(last - 1) + corner));
        right.push(6.0 * (slope(0) - slope(last - 1)));
        let n = diagonal.len();
        let gamma = -diagonal[0];
        diagonal[0] -= gamma;
        diagonal[n - 1] -= corner * corner / gamma;
        let mut ends = vec![0.0; n];
        (ends[0], ends[n - 1]) = (gamma, corner);
        let (x, z) = (tridiagonal(&diagonal, &side, right), tridiagonal(&diagonal, &side, ends));
        let factor = (x[0] + corner * x[n - 1] / gamma) / (1.0 + z[0] + corner * z[n - 1] / gamma);
        let mut bends = vec![0.0; knots.len()];
        for k in 0..n {
            bends[k + 1] = x[k] - factor * z[k];
        }
        bends[0] = bends[last];
        Self { knots, values, bends, periodic: true }
    }

    /// From where to where it goes, in words, if that is far beyond the values of its points.
    pub fn swings(&self) -> Option<String> {
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::MAX, f64::MIN], |[least, most], value| [least.min(value), most.max(value)])
        };
        let inside = |pair: &[f64]| {
            let [low, high] = [pair[0], pair[1]];
            (1..LOOKS).map(move |k| self.evaluate(low + (high - low) * f64::from(k) / f64::from(LOOKS)))
        };
        let [least, most] = range(&mut self.values.iter().copied());
        let [lowest, highest] = range(&mut self.knots.windows(2).flat_map(inside));
        let swings = (least - lowest).max(highest - most) > SWINGS * (most - least);
        swings.then(|| {
            let [lowest, highest] = [lowest.min(least), highest.max(most)].map(short);
            format!(
                "between its points this goes from {lowest} to {highest}, beyond what is written, as a spline swings where steps differ"
            )
        })
    }

    /// Where its points are.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The value at `s`, with whatever derivatives the number carries.
    pub fn evaluate<N: Number>(&self, s: N) -> N {
        let (k, s) = self.interval(s);
        let Some(k) = k else {
            let last = self.knots.len() - 1;
            return if s.re() < self.knots[0] { self.straight(s, 0, 0) } else { self.straight(s, last - 1, last) };
        };
        let h = self.knots[k + 1] - self.knots[k];
        let (b, a) = ((s - self.knots[k]) / h, (-s + self.knots[k + 1]) / h);
        let cubic = |share: N, bend: f64| (share * share * share - share) * (bend * h * h / 6.0);
        a * self.values[k] + b * self.values[k + 1] + cubic(a, self.bends[k]) + cubic(b, self.bends[k + 1])
    }

    /// The derivative at `s`.
    pub fn slope(&self, s: f64) -> f64 {
        self.derivatives(s)[1]
    }

    /// The value at `s` and its three derivatives.
    pub fn derivatives(&self, s: f64) -> [f64; 4] {
        let (k, s) = self.interval(s);
        let Some(k) = k else {
            let outside = self.evaluate(num_dual::Dual64::new(s, 1.0));
            return [outside.re, outside.eps, 0.0, 0.0];
        };
        let h = self.knots[k + 1] - self.knots[k];
        let (b, a) = ((s - self.knots[k]) / h, (self.knots[k + 1] - s) / h);
        let ([left, right], [low, high]) = ([self.values[k], self.values[k + 1]], [self.bends[k], self.bends[k + 1]]);
        let cubic = |share: f64, bend: f64| (share * share * share - share) * (bend * h * h / 6.0);
        let square = |share: f64, bend: f64| (3.0 * share * share - 1.0) * (bend * h / 6.0);
        [
            a * left + b * right + cubic(a, low) + cubic(b, high),
            (right - left) / h + square(b, high) - square(a, low),
            a * low + b * high,
            (high - low) / h,
        ]
    }

    /// The interval of `s`, none beyond a natural end, and `s` brought into the first period.
    fn interval<N: Number>(&self, s: N) -> (Option<usize>, N) {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let mut s = s;
        if self.periodic {
            s -= ((s.re() - first) / (last - first)).floor() * (last - first);
        } else if s.re() < first || s.re() > last {
            return (None, s);
        }
        (Some(self.knots.partition_point(|&knot| knot <= s.re()).clamp(1, self.knots.len() - 1) - 1), s)
    }

    /// The tangent at an end: of interval `k` at knot `at`.
    fn straight<N: Number>(&self, s: N, k: usize, at: usize) -> N {
        let h = self.knots[k + 1] - self.knots[k];
        let bend = if at == k { -2.0 * self.bends[k] - self.bends[k + 1] } else { self.bends[k] + 2.0 * self.bends[k + 1] };
        let slope = (self.values[k + 1] - self.values[k]) / h + h / 6.0 * bend;
        (s - self.knots[at]) * slope + self.values[at]
    }
}

/// Diagonal, side and right-hand side of the equations for the bends at some inner knots.
fn equations(knots: &[f64], values: &[f64], inner: std::ops::Range<usize>) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let h = |k: usize| knots[k + 1] - knots[k];
    let slope = |k: usize| (values[k + 1] - values[k]) / h(k);
    let diagonal = inner.clone().map(|k| 2.0 * (h(k - 1) + h(k))).collect();
    let side = inner.clone().skip(1).map(|k| h(k - 1)).collect();
    let right = inner.map(|k| 6.0 * (slope(k) - slope(k - 1))).collect();
    (diagonal, side, right)
}

/// Solves a symmetric tridiagonal system.
fn tridiagonal(diagonal: &[f64], side: &[f64], mut right: Vec<f64>) -> Vec<f64> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for k in 1..n {
        let factor = side[k - 1] / pivots[k - 1];
        pivots[k] -= factor * side[k - 1];
        right[k] -= factor * right[k - 1];
    }
    for k in (0..n).rev() {
        if k + 1 < n {
            right[k] -= side[k] * right[k + 1];
        }
        right[k] /= pivots[k];
    }
    right
}

impl Signal for Spline {
    fn at(&self, t: f64) -> [f64; 3] {
        let value = self.evaluate(num_dual::Dual2_64::new(t, 1.0, 0.0));
        [value.re, value.v1, value.v2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_natural_spline_is_smooth_and_meets_its_points() {
        let spline = Spline::natural(vec![0.0, 1.0, 2.5, 3.0, 5.0], vec![1.0, -1.0, 0.5, 2.0, 0.0]);
        for (knot, value) in spline.knots.iter().zip(&spline.values) {
            let [before, at, after] = [-1e-9, 0.0, 1e-9].map(|step| spline.at(knot + step));
            assert!((at[0] - value).abs() < 1e-14);
            for k in 0..3 {
                assert!((before[k] - after[k]).abs() < 1e-7, "derivative {k} at {knot}");
            }
        }
        assert_eq!(spline.at(-1.0)[2], 0.0);
        assert!((spline.at(9.0)[1] - spline.at(5.0)[1]).abs() < 1e-14);
    }

    #[test]
    fn a_resting_spline_rests_at_its_ends() {
        let spline = Spline::resting(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, -1.0]);
        for (s, value) in [(0.0, 0.0), (3.0, -1.0), (5.0, -1.0), (-2.0, 0.0)] {
            let [found, rate, _] = spline.at(s);
            assert!((found - value).abs() < 1e-14 && rate.abs() < 1e-14, "{s}: {found}, {rate}");
        }
        let two = Spline::resting(vec![0.0, 1.0], vec![0.0, 1.0]);
        assert!((two.at(0.5)[0] - 0.5).abs() < 1e-15 && (two.at(0.25)[0] - 0.15625).abs() < 1e-15, "3 s² − 2 s³");
    }

    #[test]
    fn two_points_are_joined_by_a_straight_line() {
        let line = Spline::natural(vec![0.0, 2.0], vec![1.0, 5.0]);
        assert_eq!(line.at(0.5), [2.0, 2.0, 0.0]);
    }

    #[test]
    fn a_periodic_spline_follows_a_sine() {
        let knots: Vec<f64> = (0..=40).map(|k| k as f64 / 40.0 * std::f64::consts::TAU).collect();
        let spline = Spline::periodic(knots.clone(), knots.iter().map(|s| s.sin()).collect());
        for s in [0.0, 0.3, 3.0, 6.2, 7.0, -2.0] {
            let [value, rate, bend] = spline.at(s);
            assert!((value - s.sin()).abs() < 1e-6 && (rate - s.cos()).abs() < 1e-4 && (bend + s.sin()).abs() < 3e-3, "{s}");
        }
    }
}
