//! Short motions that are written as formulas of time, such as a bump `exp(-((t - 5)/0.1)^2)`: steps by accuracy end where they are largest, so that they do not
//! pass them unseen.

use super::expression::Program;
use crate::system::{Bend, Signal, zeros};

/// Times of a run at which it is seen how far a logarithm goes.
const LOOKS: usize = 10_000;

/// How far the logarithm of what has a peak rises and falls in the run where that is short: to a thousandth.
const SHORT: f64 = 7.0;

/// Times by whose logarithms a slope is known are so far from its own, over the length of the run.
const APART: f64 = 1e-8;

/// Whether a formula of t has what may have peaks.
pub(super) fn may_have(program: &Program) -> bool {
    !logarithms(program, 0.0).is_empty()
}

/// The times before `end` (s) at which a formula of t has short peaks.
pub(super) fn times(program: &Program, end: f64) -> Vec<f64> {
    let looks: Vec<Vec<f64>> = (0..=LOOKS).map(|k| logarithms(program, end * k as f64 / LOOKS as f64)).collect();
    let is_short = |peak: &usize| {
        let finite = looks.iter().map(|look| look[*peak]).filter(|logarithm| logarithm.is_finite());
        let (least, most) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)));
        most - least > SHORT
    };
    let tops = |peak: usize| {
        let slope = Slope { program: program.clone(), peak, apart: APART * end };
        // It also turns where it is least.
        zeros(&slope, end).into_iter().filter(move |t| slope.at(t - slope.apart)[0] > 0.0)
    };
    (0..looks[0].len()).filter(is_short).flat_map(tops).collect()
}

/// The sign of the slope of a logarithm that is largest at a peak.
struct Slope {
    program: Program,
    peak: usize,
    /// s
    apart: f64,
}

impl Signal for Slope {
    fn at(&self, t: f64) -> [f64; 3] {
        let [before, after] = [-self.apart, self.apart].map(|apart| logarithms(&self.program, t + apart)[self.peak]);
        [after - before, 0.0, 0.0]
    }
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
