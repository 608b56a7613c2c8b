//! Curves through given points as functions of one number: `[table.NAME]`.

use std::f64::consts::PI;

use super::Op;
use super::functions::Function;
use crate::model::bodies::short;
use crate::model::spline::Spline;
use crate::system::{Bend, Number};

/// What a curve is beyond its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// The value at the end.
    Hold,
    /// Straight on.
    Line,
    /// No number, so that a run that comes there stops.
    Refuse,
    /// The same again: the last value is the first.
    Periodic,
}

/// A curve through points with rising abscissae.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Slopes at the knots of a cubic that keeps monotone parts monotone; none of a polygon and of a spline.
    slopes: Option<Vec<f64>>,
    spline: Option<Spline>,
    beyond: Beyond,
    /// Knots at which it is highest or lowest, and how far the nearer of those next to them is.
    tops: Vec<[f64; 2]>,
}

/// Most corners that are told one by one.
const FEW: usize = 64;

/// Knots that are higher or lower than those on both sides, as are both ends of a part that is level, with the way to the nearer knot.
fn tops(knots: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let mut tops = Vec::new();
    let mut from = 1;
    while from + 1 < knots.len() {
        let level = values[from..].iter().take_while(|value| **value == values[from]).count();
        let to = from + level - 1;
        if to + 1 < knots.len() && (values[from] - values[from - 1]) * (values[to] - values[to + 1]) > 0.0 {
            let width = |k: usize| (knots[k] - knots[k - 1]).min(knots[k + 1] - knots[k]);
            tops.push([knots[from], width(from)]);
            tops.extend((to > from).then(|| [knots[to], width(to)]));
        }
        from = to + 1;
    }
    tops
}

/// What is wrong where a table refuses to have a value for an argument, and its cure.
pub fn refusal(name: &str, curve: &Curve, argument: f64) -> [String; 2] {
    let [first, end] = curve.range().map(short);
    let asked = short(argument);
    // Beside an end it is told with all digits.
    let asked = if [&first, &end].contains(&&asked) { argument.to_string() } else { asked };
    [
        format!("the table `{name}` is asked at {asked}, and has values from {first} to {end}"),
        "add points to it, or have it go on beyond them with another `outside`".into(),
    ]
}

impl Curve {
    /// Straight lines from point to point.
    pub fn linear(knots: Vec<f64>, values: Vec<f64>, beyond: Beyond) -> Self {
        Self { tops: tops(&knots, &values), knots, values, slopes: None, spline: None, beyond }
    }

    /// A cubic spline with two continuous derivatives: natural or periodic.
    pub fn cubic(knots: Vec<f64>, values: Vec<f64>, beyond: Beyond) -> Self {
        let spline = match beyond {
            Beyond::Periodic => Spline::periodic(knots.clone(), values.clone()),
            _ => Spline::natural(knots.clone(), values.clone()),
        };
        Self { tops: tops(&knots, &values), knots, values, slopes: None, spline: Some(spline), beyond }
    }

    /// [`Spline::swings`]
    pub fn swings(&self) -> Option<String> {
        self.spline.as_ref()?.swings()
    }

    /// Cubics with one continuous derivative that rise where the points rise and fall where they fall: slopes by Fritsch and Butland
    /// (SIAM J. Sci. Stat. Comput. 5, 1984), the weighted harmonic mean of those of both sides, and zero where these differ in sign.
    pub fn monotone(knots: Vec<f64>, values: Vec<f64>, beyond: Beyond) -> Self {
        let last = knots.len() - 1;
        let h = |k: usize| knots[k + 1] - knots[k];
        let secant = |k: usize| (values[k + 1] - values[k]) / h(k);
        let mean = |left: usize, right: usize| {
            let (a, b) = (secant(left), secant(right));
            if a * b <= 0.0 {
                return 0.0;
            }
            let (p, q) = (2.0 * h(right) + h(left), h(right) + 2.0 * h(left));
            (p + q) / (p / a + q / b)
        };
        let inner = (1..last).map(|k| mean(k - 1, k));
        let [first, end] = match beyond {
            Beyond::Periodic => [mean(last - 1, 0); 2],
            _ => [secant(0), secant(last - 1)],
        };
        let slopes = [first].into_iter().chain(inner).chain([end]).collect();
        Self { tops: tops(&knots, &values), knots, values, slopes: Some(slopes), spline: None, beyond }
    }

    /// What to do to an argument, for each place where derivatives jump, to have a number that passes zero there: in every period of a
    /// curve that has some.
    pub(super) fn kinks(&self) -> Vec<Vec<Op>> {
        self.passes(&self.knots)
    }

    /// The same where the value or the slope may jump: at the corners of a polygon, and at the ends of what is smooth between.
    pub(super) fn corners(&self) -> Vec<Vec<Op>> {
        match (&self.knots[..], self.is_polygon()) {
            ([first, .., last], false) => self.passes(&[*first, *last]),
            (knots, _) => self.passes(knots),
        }
    }

    /// What passes zero at these knots.
    fn passes(&self, knots: &[f64]) -> Vec<Vec<Op>> {
        let period = (self.beyond == Beyond::Periodic).then(|| self.knots[self.knots.len() - 1] - self.knots[0]);
        let turns = period.map(|period| [Op::Constant(PI / period), Op::Mul, Op::OfOne(Function::Sin)]);
        let pass = |&knot: &f64| [Op::Constant(knot), Op::Sub].into_iter().chain(turns.clone().into_iter().flatten()).collect();
        knots.iter().map(pass).collect()
    }

    /// Tells where the curve bends at `s`: at the corners of a polygon, one by one where they are few, and where it is highest or lowest within
    /// a width that steps may be longer than.
    pub(super) fn bends(&self, s: f64, note: &mut impl FnMut(Bend)) {
        if self.is_polygon() && self.knots.len() <= FEW {
            let period = (self.beyond == Beyond::Periodic).then(|| self.knots[self.knots.len() - 1] - self.knots[0]);
            let off = |knot: &f64| period.map_or(s - knot, |period| (PI * (s - knot) / period).sin());
            return self.knots.iter().for_each(|knot| note(Bend::Corner(off(knot))));
        }
        note(Bend::Corner(self.bend(s)));
        if !self.tops.is_empty() {
            let s = self.in_period(s);
            let next = self.tops.partition_point(|[knot, _]| *knot <= s);
            let near = self.tops[next.saturating_sub(1)..(next + 1).min(self.tops.len())].iter();
            let seen = near.map(|[knot, width]| -(1.0 + ((s - knot) / width).powi(2)).ln());
            note(Bend::Peak(seen.fold(f64::NEG_INFINITY, f64::max)));
        }
    }

    /// Whether it goes straight from knot to knot.
    fn is_polygon(&self) -> bool {
        self.slopes.is_none() && self.spline.is_none()
    }

    /// Where `s` is in the period that the knots are of.
    fn in_period(&self, s: f64) -> f64 {
        let (first, end) = (self.knots[0], self.knots[self.knots.len() - 1]);
        if self.beyond == Beyond::Periodic { s - ((s - first) / (end - first)).floor() * (end - first) } else { s }
    }

    /// A number that passes zero with slope ±1 where the slope jumps: the distance of `s` from the nearest of these places, of one sign and
    /// the other in turn.
    pub(super) fn bend(&self, s: f64) -> f64 {
        let last = self.knots.len() - 1;
        let (first, end) = (self.knots[0], self.knots[last]);
        let (s, turns) = match self.beyond {
            Beyond::Periodic => {
                let turns = ((s - first) / (end - first)).floor();
                (s - turns * (end - first), turns * last as f64)
            }
            _ => (s, 0.0),
        };
        let (before, near): (usize, [f64; 2]) = match self.is_polygon() {
            true => {
                let k = self.knots.partition_point(|&knot| knot <= s);
                (k, [self.knots[k.saturating_sub(1)], self.knots[k.min(last)]])
            }
            // Smooth but for its ends.
            false if self.beyond == Beyond::Periodic => return 1.0,
            false => (usize::from(s >= first) + usize::from(s >= end), [first, end]),
        };
        let distance = near.map(|knot| (s - knot).abs()).into_iter().fold(f64::INFINITY, f64::min);
        if (before as f64 + turns).rem_euclid(2.0) == 0.0 { distance } else { -distance }
    }

    /// The arguments of its ends.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    /// Whether it has no value at `s`, as that is beyond its ends.
    pub(super) fn refuses(&self, s: f64) -> bool {
        let [first, end] = self.range();
        self.beyond == Beyond::Refuse && (s < first || s > end)
    }

    /// The value at `s`, with whatever derivatives the number carries.
    pub fn evaluate<N: Number>(&self, s: N) -> N {
        let last = self.knots.len() - 1;
        let (first, end) = (self.knots[0], self.knots[last]);
        let mut s = s;
        if self.beyond == Beyond::Periodic {
            s -= ((s.re() - first) / (end - first)).floor() * (end - first);
        }
        let is_inside = (first..=end).contains(&s.re());
        if !is_inside {
            let at = if s.re() < first { 0 } else { last };
            return match self.beyond {
                Beyond::Hold => N::from(self.values[at]),
                Beyond::Line => (s - self.knots[at]) * self.end_slope(at) + self.values[at],
                Beyond::Refuse => N::from(f64::NAN),
                // Rounding has put it an end too far, or it is no number.
                Beyond::Periodic => s * 0.0 + self.values[at],
            };
        }
        if let Some(spline) = &self.spline {
            return spline.evaluate(s);
        }
        let k = self.knots.partition_point(|&knot| knot <= s.re()).clamp(1, last) - 1;
        let h = self.knots[k + 1] - self.knots[k];
        let u = (s - self.knots[k]) / h;
        let rise = self.values[k + 1] - self.values[k];
        let Some(slopes) = &self.slopes else { return u * rise + self.values[k] };
        // Hermite's cubic in powers of u.
        let (a, b) = (slopes[k] * h, slopes[k + 1] * h);
        ((u * (a + b - 2.0 * rise) + (3.0 * rise - 2.0 * a - b)) * u + a) * u + self.values[k]
    }

    /// The slope at an end.
    fn end_slope(&self, at: usize) -> f64 {
        if let Some(slopes) = &self.slopes {
            return slopes[at];
        }
        if let Some(spline) = &self.spline {
            return spline.slope(self.knots[at]);
        }
        let k = at.min(self.knots.len() - 2);
        (self.values[k + 1] - self.values[k]) / (self.knots[k + 1] - self.knots[k])
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;

    const KNOTS: [f64; 5] = [0.0, 1.0, 2.5, 3.0, 5.0];
    const VALUES: [f64; 5] = [1.0, -1.0, 0.5, 2.0, 1.0];

    #[test]
    fn every_curve_meets_its_points_and_has_the_derivative_of_its_differences() {
        for make in [Curve::linear, Curve::cubic, Curve::monotone] {
            for beyond in [Beyond::Hold, Beyond::Line, Beyond::Refuse, Beyond::Periodic] {
                let curve = make(KNOTS.to_vec(), VALUES.to_vec(), beyond);
                for (knot, value) in KNOTS.iter().zip(VALUES) {
                    assert!((curve.evaluate(*knot) - value).abs() < 1e-14, "{beyond:?} at {knot}");
                }
                for s in [0.3, 1.7, 2.7, 4.4, 6.3, -0.7, -11.3] {
                    let dual: Dual64 = curve.evaluate(Dual64::new(s, 1.0));
                    let difference = (curve.evaluate(s + 1e-6) - curve.evaluate(s - 1e-6)) / 2e-6;
                    let is_refused = beyond == Beyond::Refuse && !(0.0..=5.0).contains(&s);
                    assert_eq!(dual.re.is_nan(), is_refused, "{beyond:?} at {s}");
                    assert!(is_refused || (dual.eps - difference).abs() < 1e-8, "{beyond:?} at {s}: {} {difference}", dual.eps);
                }
            }
        }
    }

    #[test]
    fn a_monotone_curve_never_overshoots() {
        let curve = Curve::monotone(vec![0.0, 1.0, 1.1, 3.0, 4.0], vec![0.0, 0.0, 5.0, 5.0, 6.0], Beyond::Hold);
        let values: Vec<f64> = (0..=400).map(|k| curve.evaluate(f64::from(k) * 0.01)).collect();
        assert!(values.windows(2).all(|pair| pair[1] >= pair[0] - 1e-14));
        let spline = Curve::cubic(vec![0.0, 1.0, 1.1, 3.0, 4.0], vec![0.0, 0.0, 5.0, 5.0, 6.0], Beyond::Hold);
        assert!((0..=400).any(|k| spline.evaluate(f64::from(k) * 0.01) > 6.0), "which a spline does");
    }

    #[test]
    fn tops_are_where_a_curve_turns() {
        let at = |values: &[f64]| {
            let knots: Vec<f64> = (0..values.len()).map(|k| (k * k) as f64).collect();
            tops(&knots, values).iter().map(|[knot, width]| [*knot, *width]).collect::<Vec<_>>()
        };
        assert_eq!(at(&[0.0, 0.0, 1.0, 0.0, 0.0]), [[4.0, 3.0]]);
        assert_eq!(at(&[0.0, 1.0, 1.0, 0.5, 2.0]), [[1.0, 1.0], [4.0, 3.0], [9.0, 5.0]]);
        assert_eq!(at(&[0.0, 0.0, 1.0, 1.0, 2.0]), [[0.0; 2]; 0]);
        assert_eq!(at(&[3.0]), [[0.0; 2]; 0]);
    }

    #[test]
    fn bends_change_their_sign_at_the_knots_and_nowhere_else() {
        let signs = |curve: &Curve, from: f64, to: f64| {
            let at = |k: i32| curve.bend(from + (to - from) * (f64::from(k) + 0.5) / 1000.0);
            assert!((0..1000).all(|k| (at(k + 1) - at(k)).abs() < 1.001 * (to - from) / 1000.0), "it is continuous");
            (0..1000).filter(|&k| (at(k) > 0.0) != (at(k + 1) > 0.0)).count()
        };
        for (beyond, knots) in [(Beyond::Hold, 5), (Beyond::Line, 5), (Beyond::Refuse, 5), (Beyond::Periodic, 11)] {
            assert_eq!(signs(&Curve::linear(KNOTS.to_vec(), VALUES.to_vec(), beyond), -4.9, 9.9), knots, "{beyond:?}");
        }
        assert_eq!(signs(&Curve::cubic(KNOTS.to_vec(), VALUES.to_vec(), Beyond::Hold), -4.9, 9.9), 2);
        assert_eq!(signs(&Curve::monotone(KNOTS.to_vec(), VALUES.to_vec(), Beyond::Periodic), -4.9, 9.9), 0);
    }

    #[test]
    fn beyond_its_ends_a_curve_is_what_was_asked_for() {
        let at = |beyond, s: f64| Curve::linear(KNOTS.to_vec(), VALUES.to_vec(), beyond).evaluate(s);
        assert_eq!([at(Beyond::Hold, 9.0), at(Beyond::Hold, -1.0)], [1.0, 1.0]);
        assert_eq!([at(Beyond::Line, 7.0), at(Beyond::Line, -1.0)], [0.0, 3.0]);
        assert!((at(Beyond::Periodic, 5.5) - at(Beyond::Periodic, 0.5)).abs() < 1e-15);
    }
}
