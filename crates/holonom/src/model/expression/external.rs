//! Functions that a program gives by code, which formulas call by their names.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard};

use smallvec::SmallVec;

use crate::system::Number;

/// A function that formulas may call. It depends on its arguments alone: it is called as often as a step needs, in no order of time, and not
/// again where it was called last.
///
/// Derivatives steer the iteration of forces, and may be as rough as differences are. Where a function stands in an equation of
/// constraint, they are the directions of its forces, and should be given.
pub trait ExternalFunction: Send + Sync {
    /// Number of arguments, at least one.
    fn arguments(&self) -> usize;

    /// Number of values: formulas write `NAME[k](…)` for the k-th, counted from 0, where there are several.
    fn values(&self) -> usize {
        1
    }

    /// The values there. What is no number stops the run.
    fn call(&self, arguments: &[f64], values: &mut [f64]);

    /// Derivatives of the values by the arguments (values × arguments, row-major); by default central differences.
    fn gradient(&self, arguments: &[f64], gradient: &mut [f64]) {
        differences(self, arguments, gradient);
    }
}

/// Derivatives of the values of a function by central differences.
pub fn differences<F: ExternalFunction + ?Sized>(function: &F, arguments: &[f64], gradient: &mut [f64]) {
    let at = |arguments: &[f64], out: &mut [f64]| function.call(arguments, out);
    central(arguments, over(f64::EPSILON.cbrt()), function.values(), at, |i, k, slope| gradient[k * arguments.len() + i] = slope);
}

/// A share of an argument, or of one where it is smaller.
fn over(share: f64) -> impl Fn(f64) -> f64 {
    move |here| share * here.abs().max(1.0)
}

/// Central differences of `count` numbers by each argument, over a step for its value: calls `put` with the argument, the number and the slope.
pub(in crate::model) fn central(
    arguments: &[f64],
    step: impl Fn(f64) -> f64,
    count: usize,
    at: impl Fn(&[f64], &mut [f64]),
    mut put: impl FnMut(usize, usize, f64),
) {
    let mut place: Point = arguments.into();
    let (mut ahead, mut behind) = (Point::from_elem(0.0, count), Point::from_elem(0.0, count));
    for (i, &here) in arguments.iter().enumerate() {
        let step = step(here);
        place[i] = here + step;
        at(&place, &mut ahead);
        place[i] = here - step;
        at(&place, &mut behind);
        place[i] = here;
        (0..count).for_each(|k| put(i, k, (ahead[k] - behind[k]) / (2.0 * step)));
    }
}

type Point = SmallVec<[f64; 16]>;

/// Functions by their names.
pub type Functions = HashMap<String, External>;

/// A function that a program gives, with what it was where it was called last.
#[derive(Clone)]
pub struct External(Arc<Inner>);

struct Inner {
    function: Box<dyn ExternalFunction>,
    arguments: usize,
    values: usize,
    last: Mutex<Last>,
}

/// What is known of a function at one place.
#[derive(Clone, Default)]
struct Last {
    at: Point,
    values: Point,
    gradient: Option<Point>,
    /// values × arguments × arguments.
    curvature: Option<Point>,
}

impl External {
    /// Of a function.
    ///
    /// # Panics
    /// When it has no argument or no value.
    pub fn new(function: impl ExternalFunction + 'static) -> Self {
        let (arguments, values) = (function.arguments(), function.values());
        assert!(arguments > 0 && values > 0, "a function has arguments and values");
        Self(Arc::new(Inner { function: Box::new(function), arguments, values, last: Mutex::default() }))
    }

    /// Number of arguments.
    pub fn arguments(&self) -> usize {
        self.0.arguments
    }

    /// Number of values.
    pub fn values(&self) -> usize {
        self.0.values
    }

    /// The k-th value there, with whatever derivatives the numbers carry.
    pub(super) fn evaluate<N: Number>(&self, k: usize, arguments: &[N]) -> N {
        let at: Point = arguments.iter().map(|argument| argument.re()).collect();
        if N::NDERIV == 0 {
            return N::from(self.value(&at, k));
        }
        let last = self.known(&at, N::NDERIV > 1);
        let (n, mut sum) = (at.len(), N::from(last.values[k]));
        // Without their values, numbers that carry derivatives are small of first order.
        let small: SmallVec<[N; 16]> = arguments.iter().zip(&at).map(|(argument, at)| *argument - *at).collect();
        let slopes = &last.gradient.as_ref().expect("it is known")[k * n..(k + 1) * n];
        small.iter().zip(slopes).for_each(|(small, slope)| sum += *small * *slope);
        if let Some(curvature) = last.curvature.as_ref().filter(|_| N::NDERIV > 1) {
            for (i, line) in curvature[k * n * n..(k + 1) * n * n].chunks_exact(n).enumerate() {
                line.iter().zip(&small).for_each(|(bend, other)| sum += small[i] * *other * (0.5 * bend));
            }
        }
        sum
    }

    fn last(&self) -> MutexGuard<'_, Last> {
        self.0.last.lock().unwrap_or_else(|broken| broken.into_inner())
    }

    fn value(&self, at: &Point, k: usize) -> f64 {
        if let Some(value) = Some(self.last()).filter(|last| last.is_at(at)).map(|last| last.values[k]) {
            return value;
        }
        // Not held while it is called: the call may take long, and other threads have the same model.
        let mut values = Point::from_elem(0.0, self.0.values);
        self.0.function.call(at, &mut values);
        let value = values[k];
        *self.last() = Last { at: at.clone(), values, ..Last::default() };
        value
    }

    /// Everything that is asked for there, to be read before others have the function.
    fn known(&self, at: &Point, with_curvature: bool) -> MutexGuard<'_, Last> {
        let held = self.last();
        let is_there = held.is_at(at);
        if is_there && held.gradient.is_some() && (held.curvature.is_some() || !with_curvature) {
            return held;
        }
        let known = is_there.then(|| held.clone());
        // Not held while it is called, as above.
        drop(held);
        let Inner { function, values: m, .. } = &*self.0;
        let (n, m) = (at.len(), *m);
        let mut last = known.unwrap_or_else(|| {
            let mut values = Point::from_elem(0.0, m);
            function.call(at, &mut values);
            Last { at: at.clone(), values, ..Last::default() }
        });
        if last.gradient.is_none() {
            let mut gradient = Point::from_elem(0.0, m * n);
            function.gradient(at, &mut gradient);
            last.gradient = Some(gradient);
        }
        if with_curvature && last.curvature.is_none() {
            let mut curvature = Point::from_elem(0.0, m * n * n);
            let at_place = |place: &[f64], out: &mut [f64]| function.gradient(place, out);
            // Wider than for first derivatives: these may be differences themselves.
            central(at, over(f64::EPSILON.powf(0.25)), m * n, at_place, |i, kj, slope| {
                let (k, j) = (kj / n, kj % n);
                curvature[(k * n + i) * n + j] += 0.5 * slope;
                curvature[(k * n + j) * n + i] += 0.5 * slope;
            });
            last.curvature = Some(curvature);
        }
        let mut held = self.last();
        *held = last;
        held
    }
}

impl Last {
    /// Whether it is known there. A function that gave no numbers is asked again, as it may have failed for a reason of its own.
    fn is_at(&self, at: &Point) -> bool {
        self.at.len() == at.len()
            && self.at.iter().zip(at).all(|(one, other)| one.to_bits() == other.to_bits())
            && self.values.iter().chain(self.gradient.iter().flatten()).all(|number| number.is_finite())
    }
}

/// The same function, not an equal one.
impl PartialEq for External {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for External {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "External({} arguments, {} values)", self.0.arguments, self.0.values)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use num_dual::{Dual2_64, Dual64, HyperDual64};

    use super::*;

    /// x² y and sin x, with how often it is called.
    struct Two(Arc<AtomicUsize>);

    impl ExternalFunction for Two {
        fn arguments(&self) -> usize {
            2
        }

        fn values(&self) -> usize {
            2
        }

        fn call(&self, arguments: &[f64], values: &mut [f64]) {
            self.0.fetch_add(1, Ordering::Relaxed);
            values.copy_from_slice(&[arguments[0].powi(2) * arguments[1], arguments[0].sin()]);
        }
    }

    #[test]
    fn derivatives_of_every_number_type_are_those_of_the_function() {
        let f = External::new(Two(Arc::default()));
        let (x, y) = (0.7, -3.0);
        assert_eq!(f.evaluate(0, &[x, y]), x * x * y);
        let along: Dual64 = f.evaluate(0, &[Dual64::new(x, 1.0), Dual64::new(y, 2.0)]);
        assert!((along.eps - (2.0 * x * y + 2.0 * x * x)).abs() < 1e-9, "{along:?}");
        let twice: Dual2_64 = f.evaluate(1, &[Dual2_64::new(x, 1.0, 0.5), Dual2_64::from(y)]);
        assert!((twice.v1 - x.cos()).abs() < 1e-9 && (twice.v2 - (0.5 * x.cos() - x.sin())).abs() < 1e-6, "{twice:?}");
        let mixed: HyperDual64 = f.evaluate(0, &[HyperDual64::new(x, 1.0, 0.0, 0.0), HyperDual64::new(y, 0.0, 1.0, 0.0)]);
        assert!((mixed.eps1eps2 - 2.0 * x).abs() < 1e-6, "{mixed:?}");
    }

    #[test]
    fn a_function_is_not_called_again_where_it_was_called_last() {
        let count = Arc::new(AtomicUsize::new(0));
        let f = External::new(Two(count.clone()));
        let both = [0, 1].map(|k| f.evaluate(k, &[0.5, 1.0]));
        assert_eq!((both, count.load(Ordering::Relaxed)), ([0.25, 0.5_f64.sin()], 1));
        let slopes = [0, 1].map(|k| f.evaluate(k, &[Dual64::new(0.5, 1.0), Dual64::from(1.0)]).eps);
        assert_eq!(count.load(Ordering::Relaxed), 1 + 4, "two differences of two arguments, and the value was known");
        assert!((slopes[1] - 0.5_f64.cos()).abs() < 1e-9);
        f.evaluate(0, &[-0.0, 1.0]);
        f.evaluate(0, &[0.0, 1.0]);
        assert_eq!(count.load(Ordering::Relaxed), 7, "0 and −0 are two places");
        assert!([0, 1].into_iter().all(|k| !f.evaluate(k, &[f64::INFINITY, 1.0]).is_finite()));
        assert_eq!(count.load(Ordering::Relaxed), 9, "what is no number is not kept");
    }
}
