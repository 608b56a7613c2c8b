use std::sync::Arc;

use super::pair::{Pair, Side};
use super::{Joint, Layout, Seat, Sides};
use crate::model::fault::Read;
use crate::model::fields::{self, Keys, List, Site};
use crate::model::geometry::{across, dot, norm, scale};
use crate::model::key::Shape;
use crate::system::{Differentiated, Number, Part, PfaffianForm, SmoothFunction};

/// a disc or wheel with a sharp edge that rolls on a plane of the first body without slipping, upright or tilted; its rows hold
/// velocities along the plane, and no coordinate
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "rolling",
    equations = "d·N + R s(0) − R s = 0 and t_j·(ḋ − R/s (N·v v̇ + N·w ẇ)) = 0 in the axes of the first body, with v, w in the disc, s² = (N·v)² + (N·w)²",
    example = r#"
[body.coin]
mass = 1
shape = { cylinder = [0.5, 0.02] }
position = [0, 0, 0.5]
orientation = { axis = [1, 0, 0], angle_deg = 90 }
velocity = [1, 0, 0]
angular_velocity = [0, 2, 0.3]

[joint.table]
type = "rolling"
between = ["ground", "coin"]
at = [0, 0, 0.5]
axis = [0, 1, 0]
normal = [0, 0, 1]
radius = 0.5
"#
)]
pub struct Rolling {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// its direction at the start: a vector, "BODY.AXIS", or one for each body
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    pub axis: Option<Site>,
    /// direction away from the plane at the start
    #[key(unit = "any", shape = Shape::Vector)]
    pub normal: List<fields::Number>,
    /// R; the plane is where the disc touches it at the start
    #[key(unit = "m")]
    pub radius: fields::Number,
}

impl Joint for Rolling {
    const LAYOUT: Layout = Layout { freedom: [Some(3), None], at: Seat::Given, directions: [1, 1], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let (normal, radius) = (self.normal.vector(pair.entry, "normal", 3), self.radius.positive(pair.entry, "radius"));
        let (normal, radius) = (normal?, radius?);
        let size = norm(normal);
        if size == 0.0 {
            return Err(pair.entry.refuse("normal", "a normal of zero length has no direction", "give the direction away from the plane"));
        }
        let normal = scale(normal, 1.0 / size);
        let [_, v, w] = pair.geometry.triad[1];
        let start = (dot(normal, v).powi(2) + dot(normal, w).powi(2)).sqrt();
        if start < FLAT {
            return Err(pair.entry.refuse("axis", "the disc lies flat on the plane and does not roll", "tilt it, or use a planar joint"));
        }
        pair.draw_disc(radius);
        let d = pair.d();
        let product = |pair: &mut Pair<'_, '_>, moving: &[_], axis| {
            let axis = pair.fixed_to(Side::A, axis);
            pair.assembly.builder.dot(moving, &axis)
        };
        let (v, w) = (pair.e(Side::B, 1), pair.e(Side::B, 2));
        let [height, up_v, up_w] = [&d, &v, &w].map(|moving| product(pair, moving, normal));
        let touching = Differentiated(Touching { start });
        let lowest = Part::Smooth { of: vec![up_v, up_w], function: Arc::new(touching) };
        pair.hold_sum(&[(Part::Invariant(height), 1.0), (lowest, -radius)]);
        for along in across(normal, 3) {
            let [way, along_v, along_w] = [&d, &v, &w].map(|moving| product(pair, moving, along));
            let form = Arc::new(Differentiated(Slip { radius }));
            pair.hold(Part::Pfaffian { of: vec![way, along_v, along_w, up_v, up_w], form });
        }
        Ok(())
    }
}

/// Sine of the smallest angle between the disc and the plane at the start.
const FLAT: f64 = 1e-3;

/// A disc that turns round by more than this cosine in a step, about its axle as the plane sees it, has fallen over to its other side, where
/// the sine of its angle with the plane is less than this.
const TURNED: f64 = -0.5;
const LOW: f64 = 0.25;

/// s − s(0) of (N·v, N·w): d·N − R (s − s(0)) is where the lowest point of the disc is, which stays on the plane. Lengths and
/// numbers are not arguments of one function, as its discrete derivative would depend on the unit of length.
struct Touching {
    start: f64,
}

impl SmoothFunction for Touching {
    fn evaluate<N: Number>(&self, value: &[N]) -> N {
        (value[0] * value[0] + value[1] * value[1]).sqrt() - self.start
    }

    fn corner(&self, from: &[f64], to: &[f64]) -> Option<&'static str> {
        let [s, s_to] = [from, to].map(|value| value[0].hypot(value[1]));
        let turns = from[0] * to[0] + from[1] * to[1] < TURNED * s * s_to;
        (turns && s.min(s_to) < LOW).then_some("the disc lies down flat on the plane and does not roll on")
    }
}

/// Velocity along the plane of what touches it: coefficients of the rates of (d·t, v·t, w·t, N·v, N·w).
struct Slip {
    radius: f64,
}

impl PfaffianForm for Slip {
    fn evaluate<N: Number>(&self, value: &[N], out: &mut [N]) {
        let (v, w) = (value[3], value[4]);
        let s = (v * v + w * w).sqrt();
        let coefficients = [N::from(1.0), -v / s * self.radius, -w / s * self.radius, N::from(0.0), N::from(0.0)];
        out.copy_from_slice(&coefficients);
    }
}
