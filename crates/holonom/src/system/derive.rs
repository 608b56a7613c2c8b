//! Functions of a few numbers with their derivatives, at a point and between two.

use num_dual::{Dual64, HyperDual64};

use super::{Differentiated, MAX_ARGUMENTS, Number, Signal};

/// A smooth function of some invariants, written once over any number type; [`Differentiated`] takes its derivatives.
pub trait SmoothFunction: Send + Sync {
    /// Its value.
    fn evaluate<N: Number>(&self, value: &[N]) -> N;

    /// What happens, in words, where a step from the first invariants to the second goes across a corner of the function, where it is
    /// not smooth. No such step is taken.
    fn corner(&self, _from: &[f64], _to: &[f64]) -> Option<&'static str> {
        None
    }
}

/// Value, gradient and Hessian of a function of m numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Derivatives {
    /// g; zero for a condition on velocities, which has none.
    pub value: f64,
    /// ∂g/∂π_i; between two positions its discrete derivative D_i.
    pub gradient: [f64; MAX_ARGUMENTS],
    /// ∂²g/∂π_i∂π_j; between two positions ∂D_i/∂π_j with π_j at the second.
    pub hessian: [[f64; MAX_ARGUMENTS]; MAX_ARGUMENTS],
}

impl Derivatives {
    /// Of a function of this one number: `value` is its value, `slope` its derivative by the number, and `turn` how that changes with each argument.
    pub(super) fn chained(&self, value: f64, slope: f64, turn: impl Fn(usize) -> f64) -> Self {
        let mut out = Self { value, gradient: self.gradient.map(|g| slope * g), hessian: self.hessian.map(|line| line.map(|h| slope * h)) };
        for (line, g) in out.hessian.iter_mut().zip(self.gradient) {
            line.iter_mut().enumerate().for_each(|(k, h)| *h += g * turn(k));
        }
        out
    }

    /// Σ_j ∂g_j/∂π_i r_j with the gradient g_j: how a rate changes with an argument.
    #[inline]
    pub(crate) fn bend(&self, i: usize, rates: &[f64; MAX_ARGUMENTS]) -> f64 {
        self.hessian.iter().zip(rates).map(|(line, rate)| line[i] * rate).sum()
    }
}

/// A smooth function of some invariants that has several values, of which one is followed: that with a number, such as
/// the parameter of a curve, near the one it had.
pub trait FollowedFunction: Send + Sync {
    /// The number at these invariants, from one nearby.
    fn locate(&self, value: &[f64], near: f64) -> f64;

    /// Its value, where the number is `at`.
    fn evaluate<N: Number>(&self, value: &[N], at: f64) -> N;

    /// Change of the invariants up to which the mean of its derivative, by Simpson's rule, is as exact as its own change, in which all that the
    /// function comes of is rounded.
    fn least_change(&self) -> f64 {
        0.0
    }
}

/// A followed function as an engine sees it.
pub trait Followed: Send + Sync {
    /// The number at these invariants, from one nearby.
    fn locate(&self, value: &[f64], near: f64) -> f64;

    /// Value and derivatives, where the number is `at`.
    fn derivatives(&self, value: &[f64], at: f64) -> Derivatives;

    /// [`FollowedFunction::least_change`]
    fn least_change(&self) -> f64;
}

impl<F: FollowedFunction> Followed for Differentiated<F> {
    fn locate(&self, value: &[f64], near: f64) -> f64 {
        self.0.locate(value, near)
    }

    fn derivatives(&self, value: &[f64], at: f64) -> Derivatives {
        derive(value, self.0.evaluate(value, at), |point| self.0.evaluate(point, at))
    }

    fn least_change(&self) -> f64 {
        self.0.least_change()
    }
}

/// Coefficients f_i of a condition on velocities Σ f_i(π) π̇_i = 0 that comes of no function of positions, written once
/// over any number type; [`Differentiated`] takes their derivatives.
pub trait PfaffianForm: Send + Sync {
    /// Writes f_i at the values of its invariants.
    fn evaluate<N: Number>(&self, value: &[N], out: &mut [N]);
}

/// Such coefficients as an engine sees them.
pub trait Pfaffian: Send + Sync {
    /// f_i as the gradient and ∂f_i/∂π_j as the Hessian, which is not symmetric; the value is zero.
    fn derivatives(&self, value: &[f64]) -> Derivatives;
}

impl<F: PfaffianForm> Pfaffian for Differentiated<F> {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        let m = value.len();
        let mut out = Derivatives::default();
        for j in 0..m {
            let (mut point, mut result) = ([Dual64::from(0.0); MAX_ARGUMENTS], [Dual64::from(0.0); MAX_ARGUMENTS]);
            point.iter_mut().zip(value).for_each(|(point, &value)| *point = Dual64::from(value));
            point[j].eps = 1.0;
            self.0.evaluate(&point[..m], &mut result[..m]);
            for i in 0..m {
                out.gradient[i] = result[i].re;
                out.hessian[i][j] = result[i].eps;
            }
        }
        out
    }
}

/// A smooth function as an engine sees it.
pub trait Smooth: Send + Sync {
    /// Value and derivatives.
    fn derivatives(&self, value: &[f64]) -> Derivatives;

    /// [`SmoothFunction::corner`]
    fn corner(&self, from: &[f64], to: &[f64]) -> Option<&'static str>;

    /// [`FollowedFunction::least_change`]
    fn least_change(&self) -> f64 {
        0.0
    }
}

impl<F: SmoothFunction> Smooth for Differentiated<F> {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        derive(value, self.0.evaluate(value), |point| self.0.evaluate(point))
    }

    fn corner(&self, from: &[f64], to: &[f64]) -> Option<&'static str> {
        self.0.corner(from, to)
    }
}

/// Derivatives of a function by dual numbers.
fn derive(value: &[f64], result: f64, evaluate: impl Fn(&[HyperDual64]) -> HyperDual64) -> Derivatives {
    let m = value.len();
    let mut out = Derivatives { value: result, ..Derivatives::default() };
    for i in 0..m {
        for j in 0..=i {
            let mut point = [HyperDual64::from(0.0); MAX_ARGUMENTS];
            point.iter_mut().zip(value).for_each(|(point, &value)| *point = HyperDual64::from(value));
            point[i].eps1 = 1.0;
            point[j].eps2 = 1.0;
            let result = evaluate(&point[..m]);
            out.gradient[i] = result.eps1;
            out.hessian[i][j] = result.eps1eps2;
            out.hessian[j][i] = result.eps1eps2;
        }
    }
    out
}

/// Change of the arguments, over their size, below which the quotient of the discrete derivative would be round-off; the mean of the
/// derivative by Simpson's rule is then as exact, also where the function bends within a thousandth of them.
pub(crate) const NO_CHANGE: f64 = 1e-6;

/// The discrete derivative of a smooth function: D = g'(π̄) + (Δg − g'(π̄)·Δπ)/‖Δπ‖² Δπ, and what it changes by with the
/// second position.
pub(super) fn difference(smooth: &dyn Smooth, from: &[f64], to: &[f64]) -> Derivatives {
    quotient(from, to, smooth.least_change(), |_, value| smooth.derivatives(value))
}

/// The discrete derivative Δf/Δq of a function of one number, and what it changes by with the second place. Where the quotient would be
/// round-off, for changes that are little beside `size` or the number, it is the mean of the derivative by Simpson's rule.
pub(super) fn chord(curve: &dyn Signal, from: f64, to: f64, size: f64) -> (f64, f64) {
    let change = to - from;
    if change.abs() <= NO_CHANGE * from.abs().max(to.abs()).max(size) {
        let [start, middle, end] = [from, 0.5 * (from + to), to].map(|q| curve.at(q));
        return ((start[1] + 4.0 * middle[1] + end[1]) / 6.0, (2.0 * middle[2] + end[2]) / 6.0);
    }
    let ([first, ..], [last, slope, _]) = (curve.at(from), curve.at(to));
    let chord = (last - first) / change;
    (chord, (slope - chord) / change)
}

/// Where between two positions a function is taken.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Start,
    Middle,
    End,
}

/// The discrete derivative between two positions of what has these derivatives; of changes up to `least` in all it is the mean of the derivative.
pub(super) fn quotient(from: &[f64], to: &[f64], least: f64, derivatives: impl Fn(Place, &[f64]) -> Derivatives) -> Derivatives {
    let m = from.len();
    let (mut middle, mut change) = ([0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS]);
    for i in 0..m {
        middle[i] = 0.5 * (from[i] + to[i]);
        change[i] = to[i] - from[i];
    }
    let half = derivatives(Place::Middle, &middle[..m]);
    let mut out = half;
    out.hessian.iter_mut().flatten().for_each(|h| *h *= 0.5);
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    let size = square(&change);
    let is_small = size <= (NO_CHANGE * NO_CHANGE * square(&middle)).max(least * least);
    if size == 0.0 {
        return out;
    }
    let (start, end) = (derivatives(Place::Start, from), derivatives(Place::End, to));
    if is_small {
        for i in 0..m {
            out.gradient[i] = (start.gradient[i] + 4.0 * half.gradient[i] + end.gradient[i]) / 6.0;
            (0..m).for_each(|j| out.hessian[i][j] = (2.0 * half.hessian[i][j] + end.hessian[i][j]) / 6.0);
        }
        return out;
    }
    let along: f64 = (0..m).map(|i| half.gradient[i] * change[i]).sum();
    let quotient = (end.value - start.value - along) / size;
    for j in 0..m {
        let bent: f64 = (0..m).map(|k| half.hessian[k][j] * change[k]).sum();
        let slope = (end.gradient[j] - half.gradient[j] - 0.5 * bent - 2.0 * quotient * change[j]) / size;
        (0..m).for_each(|i| out.hessian[i][j] += slope * change[i]);
    }
    for i in 0..m {
        out.gradient[i] += quotient * change[i];
        out.hessian[i][i] += quotient;
    }
    out
}
