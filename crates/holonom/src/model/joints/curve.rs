//! A curve in space or in the plane: a cubic spline through points, and how far a point is beside it.

use std::sync::Arc;

use num_dual::{Dual2_64, DualNum};

use crate::model::geometry::{Vec3, across, add, carried, cross, dot, norm, scale, subtract};
use crate::model::spline::Spline;
use crate::system::{Derivatives, Followed};

/// A spline through points over the length of its chords, with a direction across it at each, carried along it.
#[derive(Debug)]
pub struct Curve {
    place: Vec<Spline>,
    /// A direction across, by its components; none in the plane, where that is the tangent's quarter turn.
    carried: Vec<Spline>,
    /// Length of all chords.
    length: f64,
}

/// Share of its length in which a curve bends so little that the mean of a derivative by Simpson's rule has no error but round-off, also where a
/// thousand points bend it.
const STRAIGHT: f64 = 1e-5;

/// Parts of each stretch of a curve at whose ends the nearest point is looked for.
const SAMPLES: u32 = 16;

/// Most Newton steps to the nearest point of a curve.
const STEPS: usize = 50;

impl Curve {
    /// The curve through `points`, and back to the first where it is closed.
    pub fn new(dim: usize, points: &[Vec3], closed: bool) -> Self {
        let mut points = points.to_vec();
        if closed {
            points.push(points[0]);
        }
        let mut knots = vec![0.0];
        for pair in points.windows(2) {
            knots.push(knots[knots.len() - 1] + norm(subtract(pair[1], pair[0])));
        }
        let spline =
            |values: Vec<f64>| if closed { Spline::periodic(knots.clone(), values) } else { Spline::natural(knots.clone(), values) };
        let place: Vec<Spline> = (0..dim).map(|c| spline(points.iter().map(|point| point[c]).collect())).collect();
        let carried = if dim == 2 { Vec::new() } else { (0..3).map(|c| spline(carried_across(&place, &knots, closed, c))).collect() };
        Self { place, carried, length: knots[knots.len() - 1] }
    }

    /// The place at `s`.
    pub fn at(&self, s: f64) -> Vec3 {
        vector(&self.place, |spline| spline.evaluate(s))
    }

    /// So many places along it, for the picture.
    pub fn places(&self, count: u32) -> impl Iterator<Item = Vec3> {
        (0..=count).map(move |k| self.at(self.length * f64::from(k) / f64::from(count)))
    }

    /// The place at `s` and its three derivatives.
    fn derivatives(&self, s: f64) -> [Vec3; 4] {
        of_each(&self.place, s)
    }

    /// How far beyond `start` the parameter of the point nearest to `x` is, from `near` on: |x − C(s)|² is least. From what it has found it
    /// finds the same again, to the bit, so that a resumed run goes on with the numbers of one that was not stopped.
    fn nearest(&self, x: Vec3, start: f64, near: f64) -> f64 {
        let mut way = near;
        for _ in 0..STEPS {
            let s = start + way;
            let [place, tangent, bend, _] = self.derivatives(s);
            let arm = subtract(x, place);
            let square = dot(tangent, tangent);
            // Where the curve bends away too strongly for Newton's step, that of Gauss.
            let curvature = square - dot(arm, bend);
            let step = dot(arm, tangent) / if curvature > 0.1 * square { curvature } else { square };
            if step.abs() <= 1e-15 * (self.length + s.abs()) {
                break;
            }
            way += step;
        }
        way
    }

    /// The parameter of the point nearest to `x` of all.
    pub fn nearest_of_all(&self, x: Vec3) -> f64 {
        let distance = |s: f64| norm(subtract(x, self.at(s)));
        let within = |pair: &[f64]| {
            let [low, high] = [pair[0], pair[1]];
            (0..=SAMPLES).map(move |k| low + (high - low) * f64::from(k) / f64::from(SAMPLES))
        };
        let best = self.place[0].knots().windows(2).flat_map(within).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        self.nearest(x, 0.0, best.expect("samples"))
    }

    /// The direction across the curve at `s`, first or second, of unit length, and its two derivatives.
    fn across(&self, s: f64, tangents: [Vec3; 3], which: usize) -> [Vec3; 3] {
        let of =
            |[value, first, second]: [Vec3; 3]| -> [Dual2_64; 3] { std::array::from_fn(|c| Dual2_64::new(value[c], first[c], second[c])) };
        let dot = |u: [Dual2_64; 3], w: [Dual2_64; 3]| u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
        let [value, first, second, _] = of_each(&self.carried, s);
        let (carried, tangent) = (of([value, first, second]), of(tangents));
        let square = dot(tangent, tangent);
        let along = dot(carried, tangent) / square;
        let across: [Dual2_64; 3] = std::array::from_fn(|c| carried[c] - tangent[c] * along);
        let size = dot(across, across).sqrt();
        let direction: [Dual2_64; 3] = std::array::from_fn(|c| {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            match which {
                0 => across[c] / size,
                _ => (tangent[i] * across[j] - tangent[j] * across[i]) / (square.sqrt() * size),
            }
        });
        [direction.map(|e| e.re), direction.map(|e| e.v1), direction.map(|e| e.v2)]
    }
}

/// Values of the splines at `s` and their three derivatives.
fn of_each(splines: &[Spline], s: f64) -> [Vec3; 4] {
    let mut all = [[0.0; 3]; 4];
    for (c, spline) in splines.iter().enumerate() {
        spline.derivatives(s).iter().zip(&mut all).for_each(|(&value, vector)| vector[c] = value);
    }
    all
}

fn vector(splines: &[Spline], of: impl Fn(&Spline) -> f64) -> Vec3 {
    std::array::from_fn(|c| splines.get(c).map_or(0.0, &of))
}

/// Component c of a unit vector across the curve at each knot, carried along it without turning about it; of a closed
/// curve what is missing to the first at the end is spread along it.
fn carried_across(place: &[Spline], knots: &[f64], closed: bool, c: usize) -> Vec<f64> {
    let tangent = |s: f64| {
        let tangent = vector(place, |spline| spline.slope(s));
        scale(tangent, 1.0 / norm(tangent))
    };
    let mut vectors = vec![across(tangent(knots[0]), 3)[0]];
    for pair in knots.windows(2) {
        let mut current = vectors[vectors.len() - 1];
        // In small steps: a carried vector depends on the way.
        for k in 0..20 {
            let at = |k: f64| tangent(pair[0] + (pair[1] - pair[0]) * k / 20.0);
            current = carried(current, at(f64::from(k)), at(f64::from(k) + 1.0));
        }
        vectors.push(current);
    }
    if closed {
        let (first, last, axis) = (vectors[0], vectors[vectors.len() - 1], tangent(knots[0]));
        let twist = dot(cross(last, first), axis).atan2(dot(last, first));
        let length = knots[knots.len() - 1];
        for (v, &s) in vectors.iter_mut().zip(knots) {
            let (sin, cos) = (twist * s / length).sin_cos();
            *v = add(scale(*v, cos), scale(cross(tangent(s), *v), sin));
        }
    }
    vectors.into_iter().map(|v| v[c]).collect()
}

/// What is measured of a point by a curve: its parameter from the start, or how far it is beside the curve.
pub struct Measured {
    pub curve: Arc<Curve>,
    /// Parameter at the start.
    pub start: f64,
    pub what: What,
}

#[derive(Clone, Copy)]
pub enum What {
    Parameter,
    /// Across the curve, first or second direction.
    Beside(usize),
}

impl Followed for Measured {
    fn locate(&self, value: &[f64], near: f64) -> f64 {
        self.curve.nearest(vector_of(value), self.start, near)
    }

    fn least_change(&self) -> f64 {
        STRAIGHT * self.curve.length
    }

    /// With r from the nearest point to the place, r·C'(s) = 0 gives s by its derivatives: κ ds = C'·dx with κ = C'·C' − r·C''.
    fn derivatives(&self, value: &[f64], at: f64) -> Derivatives {
        let s = at + self.start;
        let [place, tangent, bend, twist] = self.curve.derivatives(s);
        let arm = subtract(vector_of(value), place);
        let square = dot(tangent, tangent);
        let curvature = square - dot(arm, bend);
        let slope = scale(tangent, 1.0 / curvature);
        let change = dot(arm, twist) - 3.0 * dot(tangent, bend);
        let turned = |i: usize, j: usize| (bend[i] * slope[j] + slope[i] * bend[j] + change * slope[i] * slope[j]) / curvature;
        let mut out = Derivatives::default();
        let mut write = |value: f64, gradient: Vec3, hessian: &dyn Fn(usize, usize) -> f64| {
            out.value = value;
            for i in 0..self.curve.place.len() {
                out.gradient[i] = gradient[i];
                (0..self.curve.place.len()).for_each(|j| out.hessian[i][j] = hessian(i, j));
            }
        };
        match self.what {
            What::Parameter => write(at + dot(arm, tangent) / curvature, slope, &turned),
            What::Beside(_) if value.len() == 2 => {
                let size = square.sqrt();
                let normal = [-tangent[1] / size, tangent[0] / size, 0.0];
                let share = -dot(normal, bend) / curvature / square;
                write(dot(arm, normal), normal, &|i, j| share * tangent[i] * tangent[j]);
            }
            What::Beside(k) => {
                let [across, first, second] = self.curve.across(s, [tangent, bend, twist], k);
                let (by_first, by_second) = (dot(arm, first), dot(arm, second) - dot(tangent, first));
                let gradient = add(across, scale(slope, by_first));
                write(dot(arm, across), gradient, &|i, j| {
                    first[i] * slope[j] + slope[i] * first[j] + by_second * slope[i] * slope[j] + by_first * turned(i, j)
                });
            }
        }
        out
    }
}

fn vector_of(value: &[f64]) -> Vec3 {
    std::array::from_fn(|c| value.get(c).copied().unwrap_or(0.0))
}
