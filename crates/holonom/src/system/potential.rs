//! Potentials of several quantities, written once over any number type.

use super::derive::difference;
use super::{Differentiated, Law, Reach, Response, Smooth, SmoothFunction};

/// A smooth function as a potential V(π), J. Its discrete gradient keeps energy and, as its arguments are invariants,
/// momenta (methods §5, the G-equivariant one).
impl<F: SmoothFunction> Law for Differentiated<F> {
    fn energy(&self, value: &[f64]) -> f64 {
        self.0.evaluate(value)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        let derivatives = self.derivatives(value);
        (out.force, out.by_value) = (derivatives.gradient, derivatives.hessian);
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let derivatives = difference(self, reach.from, reach.to);
        (out.force, out.by_value) = (derivatives.gradient, derivatives.hessian);
    }
}
