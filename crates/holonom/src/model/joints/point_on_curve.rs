use std::sync::Arc;

use super::curve::{Curve, Measured, What};
use super::pair::{Pair, Side, build};
use super::{AT, BETWEEN, JointKind, Site};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::geometry::{Vec3, add, norm, subtract, unit};
use crate::model::key::{Key, Kind, Shape};
use crate::model::value::Value;
use crate::system::{Differentiated, Form, Term};

pub(super) const JOINT: JointKind = JointKind {
    kind: Kind {
        name: "point-on-curve",
        doc: "a cam, a track, a roller coaster: a point of the second body moves along a curve of the first, a cubic spline; the \
              second may be a point",
        equations: "(a − C(s))·n_1(s) = 0, (a − C(s))·n_2(s) = 0 with a_k = d·e_k(A), the nearest s and n ⊥ C'(s); one row in the plane",
        keys: &[
            BETWEEN,
            AT,
            Key::required("curve", Shape::Curve, "m", "points that the curve goes through, at the start: at least three"),
            Key::optional("closed", Shape::Flag, "false", "", "whether it goes back to its first point; otherwise it goes on straight"),
        ],
        example: r#"
[body.car]
mass = 1
inertia = [0.01, 0.01, 0.01]
position = [0, 0, 1]

[joint.track]
type = "point-on-curve"
between = ["ground", "car"]
at = [0, 0, 1]
curve = [[-1, 0.5, 2], [0, 0, 1], [1, 0, 0.5], [2, 0.5, 1]]
"#,
        build,
    },
    freedom: [Some(4), Some(2)],
    at: Site::Given,
    axes: [0, 0],
    shares: [&[], &[]],
    rows,
};

fn rows(pair: &mut Pair<'_, '_>) -> Read<()> {
    let dim = pair.assembly.dimension();
    let points = points(pair.entry, dim);
    let closed = pair.entry.optional("closed", Entry::flag)?.unwrap_or(false);
    let points = points?;
    let [origin, at] = pair.geometry.at;
    // Places are measured from where the joint sits on the first body, along the axes of the model at the start.
    let curve = Arc::new(Curve::new(dim, &points.iter().map(|&point| subtract(point, origin)).collect::<Vec<_>>(), closed));
    let length: f64 = points.windows(2).map(|pair| norm(subtract(pair[1], pair[0]))).sum();
    let place = subtract(at, origin);
    let start = curve.nearest_of_all(place, length);
    let off = norm(subtract(place, curve.at(start)));
    let nearest = add(curve.at(start), origin);
    pair.assembly.check_start_within(pair.entry, off, length, NEAR, || {
        format!("the point starts {off:.3e} m beside the curve, whose nearest point is {:.9?}", &nearest[..dim])
    })?;
    let d = pair.d();
    let of: Vec<[Vec<Term>; 2]> = (0..dim).map(|k| [d.clone(), pair.fixed_to(Side::A, unit(k))]).collect();
    let form = |what| {
        let measured = Measured { curve: Arc::clone(&curve), start, what };
        Form::Followed { of: of.clone(), function: Arc::new(Differentiated(measured)) }
    };
    for k in 0..dim - 1 {
        pair.keep(&[(form(What::Beside(k)), 1.0)]);
    }
    pair.coordinate("displacement", form(What::Parameter), false);
    Ok(())
}

/// How far beside the curve a point may start, over the length of the curve: rounded coordinates are put right.
const NEAR: f64 = 1e-3;

fn points(entry: &Entry<'_>, dim: usize) -> Read<Vec<Vec3>> {
    let items = entry.list("curve")?;
    let spot = |k| Spot { key: "curve", item: Some(k) };
    let point = |(k, item): (usize, &Value)| match item {
        Value::List(numbers) if numbers.len() == dim => {
            let numbers = all(numbers.iter().map(|number| entry.number_in(spot(k), number)))?;
            Ok(std::array::from_fn(|c| numbers.get(c).copied().unwrap_or(0.0)))
        }
        _ => Err(entry.refuse(spot(k), format!("a point of the curve has {dim} numbers"), "write [[x, y, z], [x, y, z], …]")),
    };
    let points: Vec<Vec3> = all(items.iter().enumerate().map(point))?;
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
