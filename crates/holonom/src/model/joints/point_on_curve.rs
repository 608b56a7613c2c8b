use std::sync::Arc;

use super::curve::{Curve, Measured, What};
use super::pair::{Pair, Side};
use super::{Joint, Layout, Seat, Sides};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Site};
use crate::model::geometry::{Vec3, add, norm, subtract, unit};
use crate::model::key::Shape;
use crate::system::{Form, Term};

/// a cam, a track, a roller coaster: a point of the second body moves along a curve of the first, a cubic spline; the second may be
/// a point
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "point-on-curve",
    equations = "(a − C(s))·n_1(s) = 0, (a − C(s))·n_2(s) = 0 with a_k = d·e_k(A), the nearest s and n ⊥ C'(s); one row in the plane",
    example = r#"
[body.car]
mass = 1
inertia = [0.01, 0.01, 0.01]
position = [0, 0, 1]

[joint.track]
type = "point-on-curve"
between = ["ground", "car"]
at = [0, 0, 1]
curve = [[-1, 0.5, 2], [0, 0, 1], [1, 0, 0.5], [2, 0.5, 1]]
"#
)]
pub struct PointOnCurve {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// points that the curve goes through, at the start: at least three
    #[key(unit = "m")]
    pub curve: List<List<Number>>,
    /// whether it goes back to its first point; otherwise it goes on straight
    #[key(default = "false")]
    pub closed: Option<bool>,
}

impl Joint for PointOnCurve {
    const LAYOUT: Layout =
        Layout { freedom: [Some(4), Some(2)], at: Seat::Given, directions: [0, 0], shares: [&[], &[]], takes_point: true };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let dim = pair.assembly.dimension();
        let (points, closed) = (points(pair.entry, dim, &self.curve)?, self.closed.unwrap_or(false));
        let [origin, at] = pair.geometry.at;
        // Places are measured from where the joint sits on the first body, along the axes of the model at the start.
        let curve = Arc::new(Curve::new(dim, &points.iter().map(|&point| subtract(point, origin)).collect::<Vec<_>>(), closed));
        let length: f64 = points.windows(2).map(|pair| norm(subtract(pair[1], pair[0]))).sum();
        let place = subtract(at, origin);
        let start = curve.nearest_of_all(place);
        let off = norm(subtract(place, curve.at(start)));
        let nearest = add(curve.at(start), origin);
        pair.assembly.check_start_within(pair.entry, off, length, NEAR, || {
            format!("the point starts {off:.3e} m beside the curve, whose nearest point is {:.9?}", &nearest[..dim])
        })?;
        pair.draw_curve(curve.places(DRAWN).map(|place| add(place, origin)));
        let d = pair.d();
        let of: Vec<[Vec<Term>; 2]> = (0..dim).map(|k| [d.clone(), pair.fixed_to(Side::A, unit(k))]).collect();
        let form = |what| {
            let measured = Measured { curve: Arc::clone(&curve), start, what };
            Form::Followed { of: of.clone(), function: Arc::new(measured) }
        };
        for k in 0..dim - 1 {
            pair.keep(&[(form(What::Beside(k)), 1.0)]);
        }
        pair.coordinate("displacement", form(What::Parameter), false);
        Ok(())
    }
}

/// How far beside the curve a point may start, over the length of the curve: rounded coordinates are put right.
const NEAR: f64 = 1e-3;

/// Stretches of the curve in the picture.
const DRAWN: u32 = 200;

fn points(entry: &Entry<'_>, dim: usize, curve: &[List<Number>]) -> Read<Vec<Vec3>> {
    let spot = |k| Spot { key: "curve", item: Some(k) };
    let point = |(k, numbers): (usize, &List<Number>)| {
        if numbers.len() != dim {
            return Err(entry.refuse(spot(k), format!("a point of the curve has {dim} numbers"), "write [[x, y, z], [x, y, z], …]"));
        }
        let numbers = all(numbers.iter().map(|number| number.number(entry, spot(k))))?;
        Ok(std::array::from_fn(|c| numbers.get(c).copied().unwrap_or(0.0)))
    };
    let points: Vec<Vec3> = all(curve.iter().enumerate().map(point))?;
    if points.len() < 3 {
        return Err(entry.refuse("curve", format!("a curve has at least three points, and this has {}", points.len()), "add points"));
    }
    if points.first() == points.last() {
        let cure = "leave the last one out and write closed = true";
        return Err(entry.refuse(spot(points.len() - 1), "the curve ends where it begins", cure));
    }
    match (1..points.len()).find(|&k| points[k] == points[k - 1]) {
        Some(k) => Err(entry.refuse(spot(k), "the same point comes twice", "remove one of them; a closed curve has closed = true")),
        None => Ok(points),
    }
}
