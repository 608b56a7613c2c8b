//! Short motions that are written as formulas of time, such as a bump `exp(-((t - 5)/0.1)^2)`: steps by accuracy end where they are largest, so that they do not
//! pass them unseen.

use super::expression::Program;
use crate::system::Bend;

/// Times of a run between which no more than one peak of a function is looked for.
const LOOKS: usize = 10_000;

/// How far the logarithm of what has a peak rises and falls in the run where that is short: to a thousandth.
const SHORT: f64 = 7.0;

/// Places at which the slope is seen are so far apart, over the time.
const APART: f64 = 1e-8;

/// Whether a formula of t has what may have peaks.
pub(super) fn may_have(program: &Program) -> bool {
    !logarithms(program, 0.0).is_empty()
}

/// The times before `end` (s) at which a formula of t has short peaks.
pub(super) fn times(program: &Program, end: f64) -> Vec<f64> {
    let at = |k: usize| end * k as f64 / LOOKS as f64;
    let looks: Vec<Vec<f64>> = (0..=LOOKS).map(|k| logarithms(program, at(k))).collect();
    let count = looks[0].len();
    let is_short = |peak: usize| {
        let finite = looks.iter().filter_map(|look| look.get(peak)).filter(|logarithm| logarithm.is_finite());
        let (least, most) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(*x), most.max(*x)));
        most - least > SHORT
    };
    let mut times = Vec::new();
    for peak in (0..count).filter(|&peak| is_short(peak)) {
        let rises = |t: f64| {
            let [before, after] = [-APART, APART].map(|apart| logarithms(program, t + apart * end).get(peak).copied().unwrap_or(f64::NAN));
            after > before
        };
        let mut rose = rises(at(0));
        for k in 1..=LOOKS {
            let does = rises(at(k));
            if rose && !does {
                let (mut low, mut high) = (at(k - 1), at(k));
                while high - low > APART * end {
                    let middle = 0.5 * (low + high);
                    *(if rises(middle) { &mut low } else { &mut high }) = middle;
                }
                times.push(0.5 * (low + high));
            }
            rose = does;
        }
    }
    times
}

/// Logarithms that are largest at the peaks of parts of a formula.
fn logarithms(program: &Program, t: f64) -> Vec<f64> {
    let mut found = Vec::new();
    program.bends(&[t], &mut |bend| {
        if let Bend::Peak(logarithm) = bend {
            found.push(logarithm);
        }
    });
    found
}
