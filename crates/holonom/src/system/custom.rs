//! Constraints and forces that no invariant expresses: functions of coordinates and time, differentiated by dual numbers.

use num_dual::{Dual, Dual2_64, Dual64, DualNum, HyperDual64};

use super::{Bend, Load};

/// A number that carries derivatives along, or a plain one.
pub trait Number: DualNum<Primitive = f64> + Copy {
    /// Whether all derivatives are zero.
    fn is_constant(&self) -> bool;

    /// Whether it is less than another number of the same value right after this moment. Known of numbers that follow time only: partial derivatives
    /// by one coordinate must all belong to the same side of a corner.
    fn is_less_ahead(&self, _other: &Self) -> bool {
        false
    }
}

impl Number for f64 {
    fn is_constant(&self) -> bool {
        true
    }
}

impl<N: Number> Number for Dual<N>
where
    Self: DualNum<Primitive = f64>,
{
    fn is_constant(&self) -> bool {
        self.re.is_constant() && self.eps.re() == 0.0 && self.eps.is_constant()
    }
}

impl Number for Dual2_64 {
    fn is_constant(&self) -> bool {
        self.v1 == 0.0 && self.v2 == 0.0
    }

    fn is_less_ahead(&self, other: &Self) -> bool {
        (self.v1, self.v2) < (other.v1, other.v2)
    }
}

impl Number for HyperDual64 {
    fn is_constant(&self) -> bool {
        self.eps1 == 0.0 && self.eps2 == 0.0 && self.eps1eps2 == 0.0
    }
}

/// Constraint rows Φ(q, t) as an engine sees them: values and derivatives. Made from a [`ConstraintFunction`] by
/// [`Differentiated`], or written by hand. What is to be written arrives zeroed.
pub trait CustomRows: Send + Sync {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Φ (rows) at the coordinates `x` (k numbers) of its nodes.
    fn value(&self, x: &[f64], t: f64, phi: &mut [f64]);

    /// ∂Φ/∂x (rows × k, row-major) and ∂Φ/∂t (rows).
    fn gradient(&self, x: &[f64], t: f64, by_position: &mut [f64], by_time: &mut [f64]);

    /// Σ λ_k ∂²Φ_k/∂x² (k × k, row-major).
    fn hessian(&self, x: &[f64], t: f64, lambda: &[f64], out: &mut [f64]);

    /// ∂²Φ/∂x∂t (rows × k, row-major): how gradients change with time alone.
    fn mixed(&self, x: &[f64], t: f64, out: &mut [f64]);

    /// d²Φ/ds² along (x + s v, t + s): all of Φ̈ but G a (rows).
    fn curvature(&self, x: &[f64], v: &[f64], t: f64, out: &mut [f64]);
}

/// A constraint written once over any number type; [`Differentiated`] takes its derivatives.
pub trait ConstraintFunction: Send + Sync {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Φ at coordinates `x` of the nodes, D numbers a node, and time `t`. It arrives zeroed.
    fn evaluate<N: Number>(&self, x: &[N], t: N, phi: &mut [N]);
}

/// A force written once over any number type; [`Differentiated`] takes its derivatives.
pub trait ForceFunction: Send + Sync {
    /// Force at coordinates `x` and velocities `v` of the nodes, D numbers a node, and time `t`, N. It arrives zeroed.
    fn evaluate<N: Number>(&self, x: &[N], v: &[N], t: N, force: &mut [N]);

    /// Hands over where the force bends, as [`Law::bends`](super::Law::bends) does.
    fn bends(&self, _x: &[f64], _v: &[f64], _t: f64, _note: &mut dyn FnMut(Bend)) {}
}

impl<F: ForceFunction> ForceFunction for std::sync::Arc<F> {
    fn evaluate<N: Number>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        (**self).evaluate(x, v, t, force);
    }

    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        (**self).bends(x, v, t, note);
    }
}

/// A load as a closure of coordinates `x` and velocities `v` of its nodes, D numbers a node, and the time; its derivatives, which only steer
/// the iteration, are central differences.
pub struct Differences<F>(pub F);

impl<F: Fn(&[f64], &[f64], f64, &mut [f64]) + Send + Sync> Load for Differences<F> {
    fn force(&self, x: &[f64], v: &[f64], t: f64, force: &mut [f64]) {
        (self.0)(x, v, t, force);
    }

    fn tangent(&self, x: &[f64], v: &[f64], t: f64, by_position: &mut [f64], by_velocity: &mut [f64]) {
        let k = x.len();
        let (mut x, mut v) = (x.to_vec(), v.to_vec());
        let (mut ahead, mut behind) = (vec![0.0; k], vec![0.0; k]);
        let step =
            |numbers: &[f64]| f64::EPSILON.cbrt() * numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs())).max(f64::EPSILON);
        let steps = [step(&x), step(&v)];
        for direction in 0..2 * k {
            let (i, is_position) = (direction % k, direction < k);
            let h = steps[usize::from(!is_position)];
            let here = if is_position { x[i] } else { v[i] };
            for (sign, out) in [(1.0, &mut ahead), (-1.0, &mut behind)] {
                *if is_position { &mut x[i] } else { &mut v[i] } = here + sign * h;
                out.fill(0.0);
                (self.0)(&x, &v, t, out);
            }
            *if is_position { &mut x[i] } else { &mut v[i] } = here;
            let out = if is_position { &mut *by_position } else { &mut *by_velocity };
            (0..k).for_each(|row| out[row * k + i] = (ahead[row] - behind[row]) / (2.0 * h));
        }
    }
}

/// Derivatives of a function by dual numbers. Nothing is allocated in a step for up to [`SIZE`] coordinates and rows.
pub struct Differentiated<F>(pub F);

/// Coordinates, and rows, of one function that fit on the stack; more are put on the heap.
pub const SIZE: usize = 24;

/// Calls `f` with room for so many numbers, on the stack where they are those of a function of [`SIZE`] coordinates.
fn with_room<N: Copy, T>(zero: N, count: usize, f: impl FnOnce(&mut [N]) -> T) -> T {
    if count <= 3 * SIZE { f(&mut [zero; 3 * SIZE][..count]) } else { f(&mut vec![zero; count]) }
}

impl<F> Differentiated<F> {
    fn rows_at<N: Number>(&self, x: &[N], t: N, phi: &mut [N])
    where
        F: ConstraintFunction,
    {
        phi.fill(N::from(0.0));
        self.0.evaluate(x, t, phi);
    }

    fn force_at<N: Number>(&self, x: &[N], v: &[N], t: N, force: &mut [N])
    where
        F: ForceFunction,
    {
        force.fill(N::from(0.0));
        self.0.evaluate(x, v, t, force);
    }
}

impl<F: ConstraintFunction> CustomRows for Differentiated<F> {
    fn rows(&self) -> usize {
        self.0.rows()
    }

    fn value(&self, x: &[f64], t: f64, phi: &mut [f64]) {
        self.0.evaluate(x, t, phi);
    }

    fn gradient(&self, x: &[f64], t: f64, by_position: &mut [f64], by_time: &mut [f64]) {
        let (k, rows) = (x.len(), self.0.rows());
        with_room(Dual64::from(0.0), k + rows, |room| {
            let (point, phi) = room.split_at_mut(k);
            for direction in 0..k {
                point.iter_mut().zip(x).for_each(|(point, &x)| *point = Dual64::from(x));
                point[direction].eps = 1.0;
                self.rows_at(point, Dual64::from(t), phi);
                (0..rows).for_each(|row| by_position[row * k + direction] = phi[row].eps);
            }
        });
        // Numbers that follow time have the slope right after a corner.
        with_room(Dual2_64::from(0.0), k + rows, |room| {
            let (point, phi) = room.split_at_mut(k);
            point.iter_mut().zip(x).for_each(|(point, &x)| *point = Dual2_64::from(x));
            self.rows_at(point, Dual2_64::new(t, 1.0, 0.0), phi);
            by_time.iter_mut().zip(phi).for_each(|(by_time, phi)| *by_time = phi.v1);
        });
    }

    fn hessian(&self, x: &[f64], t: f64, lambda: &[f64], out: &mut [f64]) {
        let k = x.len();
        with_room(HyperDual64::from(0.0), k + lambda.len(), |room| {
            let (point, phi) = room.split_at_mut(k);
            for i in 0..k {
                for j in 0..=i {
                    point.iter_mut().zip(x).for_each(|(point, &x)| *point = HyperDual64::from(x));
                    point[i].eps1 = 1.0;
                    point[j].eps2 = 1.0;
                    self.rows_at(point, HyperDual64::from(t), phi);
                    let sum: f64 = phi.iter().zip(lambda).map(|(phi, lambda)| lambda * phi.eps1eps2).sum();
                    out[i * k + j] = sum;
                    out[j * k + i] = sum;
                }
            }
        });
    }

    fn mixed(&self, x: &[f64], t: f64, out: &mut [f64]) {
        let (k, rows) = (x.len(), self.0.rows());
        with_room(HyperDual64::from(0.0), k + rows, |room| {
            let (point, phi) = room.split_at_mut(k);
            for i in 0..k {
                point.iter_mut().zip(x).for_each(|(point, &x)| *point = HyperDual64::from(x));
                point[i].eps1 = 1.0;
                self.rows_at(point, HyperDual64::new(t, 0.0, 1.0, 0.0), phi);
                (0..rows).for_each(|row| out[row * k + i] = phi[row].eps1eps2);
            }
        });
    }

    fn curvature(&self, x: &[f64], v: &[f64], t: f64, out: &mut [f64]) {
        with_room(Dual2_64::from(0.0), x.len() + out.len(), |room| {
            let (point, phi) = room.split_at_mut(x.len());
            point.iter_mut().zip(x.iter().zip(v)).for_each(|(point, (&x, &v))| *point = Dual2_64::new(x, v, 0.0));
            self.rows_at(point, Dual2_64::new(t, 1.0, 0.0), phi);
            out.iter_mut().zip(phi).for_each(|(out, phi)| *out = phi.v2);
        });
    }
}

impl<F: ForceFunction> Load for Differentiated<F> {
    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        self.0.bends(x, v, t, note);
    }

    fn force(&self, x: &[f64], v: &[f64], t: f64, force: &mut [f64]) {
        self.0.evaluate(x, v, t, force);
    }

    fn tangent(&self, x: &[f64], v: &[f64], t: f64, by_position: &mut [f64], by_velocity: &mut [f64]) {
        let k = x.len();
        with_room(Dual64::from(0.0), 3 * k, |room| {
            let (point, rest) = room.split_at_mut(k);
            let (rate, force) = rest.split_at_mut(k);
            for direction in 0..2 * k {
                for i in 0..k {
                    point[i] = Dual64::from(x[i]);
                    rate[i] = Dual64::from(v[i]);
                }
                let (varied, out) = match direction < k {
                    true => (&mut point[direction], &mut *by_position),
                    false => (&mut rate[direction - k], &mut *by_velocity),
                };
                varied.eps = 1.0;
                self.force_at(point, rate, Dual64::from(t), force);
                for i in 0..k {
                    out[i * k + direction % k] = force[i].eps;
                }
            }
        });
    }
}
