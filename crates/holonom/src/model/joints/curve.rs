//! A curve in space or in the plane: a cubic spline through points, and how far a point is beside it.

use std::sync::Arc;

use crate::model::geometry::{Vec3, across, add, carried, cross, dot, norm, scale, subtract};
use crate::model::spline::Spline;
use crate::system::{FollowedFunction, Number};

/// A spline through points over the length of its chords, with a direction across it at each, carried along it.
#[derive(Debug)]
pub struct Curve {
    place: Vec<Spline>,
    /// A direction across, by its components; none in the plane, where that is the tangent's quarter turn.
    across: Vec<Spline>,
    /// Length of all chords.
    length: f64,
}

/// Share of its length in which a curve bends so little that the mean of a derivative by Simpson's rule has no error but round-off, also where a
/// thousand points bend it.
const STRAIGHT: f64 = 1e-5;

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
        let across = if dim == 2 { Vec::new() } else { (0..3).map(|c| spline(carried_across(&place, &knots, closed, c))).collect() };
        Self { place, across, length: knots[knots.len() - 1] }
    }

    /// The place at `s`.
    pub fn at(&self, s: f64) -> Vec3 {
        vector(&self.place, |spline| spline.evaluate(s))
    }

    /// So many places along it, for the picture.
    pub fn places(&self, count: u32) -> impl Iterator<Item = Vec3> {
        (0..=count).map(move |k| self.at(self.length * f64::from(k) / f64::from(count)))
    }

    /// The tangent at `s`, not of unit length.
    pub fn tangent(&self, s: f64) -> Vec3 {
        vector(&self.place, |spline| spline.slope(s))
    }

    /// How far beyond `start` the parameter of the point nearest to `x` is, from `near` on: |x − C(s)|² is least. From what it has found it
    /// finds the same again, to the bit, so that a resumed run goes on with the numbers of one that was not stopped.
    fn nearest(&self, x: Vec3, start: f64, near: f64) -> f64 {
        let mut way = near;
        for _ in 0..STEPS {
            let s = start + way;
            let (arm, tangent) = (subtract(x, self.at(s)), self.tangent(s));
            let bend = vector(&self.place, |spline| spline.bend(s));
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
    pub fn nearest_of_all(&self, x: Vec3, length: f64) -> f64 {
        let samples = 400;
        let distance = |s: f64| norm(subtract(x, self.at(s)));
        let best = (0..=samples).map(|k| length * f64::from(k) / f64::from(samples)).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        self.nearest(x, 0.0, best.expect("samples"))
    }

    /// s with derivatives: the root of (x − C(s))·C'(s) for an `x` that carries some, from the root for its value.
    fn parameter<N: Number>(&self, x: &[N], root: f64) -> N {
        let tangent = self.tangent(root);
        let arm: Vec3 =
            std::array::from_fn(|c| x.get(c).map_or(0.0, |x| x.re()) - self.place.get(c).map_or(0.0, |spline| spline.evaluate(root)));
        let curvature = dot(tangent, tangent) - dot(arm, vector(&self.place, |spline| spline.bend(root)));
        let mut s = N::from(root);
        // Each step adds an order of derivatives.
        for _ in 0..3 {
            let mut along = N::from(0.0);
            for (x, spline) in x.iter().zip(&self.place) {
                along += (*x - spline.evaluate(s)) * spline.slope(s);
            }
            s += along / curvature;
        }
        s
    }
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

impl FollowedFunction for Measured {
    fn locate(&self, value: &[f64], near: f64) -> f64 {
        let x = std::array::from_fn(|c| value.get(c).copied().unwrap_or(0.0));
        self.curve.nearest(x, self.start, near)
    }

    fn least_change(&self) -> f64 {
        STRAIGHT * self.curve.length
    }

    fn evaluate<N: Number>(&self, value: &[N], at: f64) -> N {
        let s = self.curve.parameter(value, at + self.start);
        let What::Beside(k) = self.what else { return s - self.start };
        let zero = N::from(0.0);
        let (mut arm, mut tangent, mut first) = ([zero; 3], [zero; 3], [zero; 3]);
        for (c, spline) in self.curve.place.iter().enumerate() {
            arm[c] = value[c] - spline.evaluate(s);
            tangent[c] = spline.slope(s);
        }
        let square = tangent[0] * tangent[0] + tangent[1] * tangent[1] + tangent[2] * tangent[2];
        if value.len() == 2 {
            return (arm[1] * tangent[0] - arm[0] * tangent[1]) / square.sqrt();
        }
        self.curve.across.iter().zip(&mut first).for_each(|(spline, first)| *first = spline.evaluate(s));
        let dot = |u: [N; 3], w: [N; 3]| u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
        let along = dot(first, tangent) / square;
        (0..3).for_each(|c| first[c] -= tangent[c] * along);
        let across = match k {
            0 => first,
            _ => std::array::from_fn(|c| {
                let (i, j) = ((c + 1) % 3, (c + 2) % 3);
                (tangent[i] * first[j] - tangent[j] * first[i]) / square.sqrt()
            }),
        };
        dot(arm, across) / dot(first, first).sqrt()
    }
}
