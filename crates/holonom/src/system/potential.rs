//! Potentials of several invariants, written once over any number type.

use super::{Differentiated, Law, MAX_ARGUMENTS, Number, Reach, Response};
use num_dual::HyperDual64;

/// A potential V(π) of some invariants; [`Differentiated`] makes a [`Law`] of it, whose discrete gradient keeps energy
/// and, as its arguments are invariants, momenta (methods §2.2, the G-equivariant one).
pub trait PotentialFunction: Send + Sync {
    /// V at the values of its invariants, J.
    fn evaluate<N: Number>(&self, value: &[N]) -> N;
}

/// Change of the invariants, over their size, below which the quotient of the discrete gradient would be round-off; the
/// gradient at the middle is then as exact.
const NO_CHANGE: f64 = 1e-6;

/// Gradient and Hessian of a potential of `m` invariants.
type Derivatives = ([f64; MAX_ARGUMENTS], [[f64; MAX_ARGUMENTS]; MAX_ARGUMENTS]);

fn derivatives<F: PotentialFunction>(potential: &F, value: &[f64]) -> Derivatives {
    let m = value.len();
    let (mut gradient, mut hessian) = ([0.0; MAX_ARGUMENTS], [[0.0; MAX_ARGUMENTS]; MAX_ARGUMENTS]);
    for i in 0..m {
        for j in 0..=i {
            let mut point = [HyperDual64::from(0.0); MAX_ARGUMENTS];
            point.iter_mut().zip(value).for_each(|(point, &value)| *point = HyperDual64::from(value));
            point[i].eps1 = 1.0;
            point[j].eps2 = 1.0;
            let result = potential.evaluate(&point[..m]);
            gradient[i] = result.eps1;
            hessian[i][j] = result.eps1eps2;
            hessian[j][i] = result.eps1eps2;
        }
    }
    (gradient, hessian)
}

impl<F: PotentialFunction> Law for Differentiated<F> {
    fn energy(&self, value: &[f64]) -> f64 {
        self.0.evaluate(value)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        (out.force, out.by_value) = derivatives(&self.0, value);
    }

    /// D V = V'(π̄) + (ΔV − V'(π̄)·Δπ)/‖Δπ‖² Δπ.
    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let m = reach.from.len();
        let (mut middle, mut change) = ([0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS]);
        for i in 0..m {
            middle[i] = 0.5 * (reach.from[i] + reach.to[i]);
            change[i] = reach.to[i] - reach.from[i];
        }
        let (gradient, hessian) = derivatives(&self.0, &middle[..m]);
        let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
        let size = square(&change);
        for i in 0..m {
            out.force[i] = gradient[i];
            (0..m).for_each(|j| out.by_value[i][j] = 0.5 * hessian[i][j]);
        }
        if size <= NO_CHANGE * NO_CHANGE * square(&middle) {
            return;
        }
        let along: f64 = (0..m).map(|i| gradient[i] * change[i]).sum();
        let quotient = (self.energy(reach.to) - self.energy(reach.from) - along) / size;
        let (end, _) = derivatives(&self.0, reach.to);
        for j in 0..m {
            let bent: f64 = (0..m).map(|k| hessian[k][j] * change[k]).sum();
            let slope = (end[j] - gradient[j] - 0.5 * bent - 2.0 * quotient * change[j]) / size;
            (0..m).for_each(|i| out.by_value[i][j] += slope * change[i]);
        }
        for i in 0..m {
            out.force[i] += quotient * change[i];
            out.by_value[i][i] += quotient;
        }
    }
}
