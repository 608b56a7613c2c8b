//! A rigid body as a few nodes: points and directions from which every other point and direction of it is a constant
//! linear combination (methods §6).
//!
//! All geometry of a model is given where it is at the start, so that the *reference* coordinates of a point or a
//! direction of a body are the world's at the start.

use nalgebra::{DMatrix, Matrix3, Vector3};
use smallvec::SmallVec;

use super::rigid::RigidBody;
use crate::model::geometry::{self, Vec3};
use crate::system::{NodeId, Place, Term};

/// A node of a body, with its reference coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    pub place: Place,
    pub at: Vec3,
    pub is_point: bool,
}

impl Basis {
    /// Its velocity at the start as a body is written that it is of, m/s.
    pub fn velocity(&self, body: &RigidBody) -> Vec3 {
        if self.is_point { body.velocity_at(self.at) } else { body.rate_of(self.at) }
    }
}

/// What the points and directions of a body, of a particle or of the ground are made of.
#[derive(Clone, Debug)]
pub enum Frame {
    Ground,
    /// A single point.
    Particle(Place),
    Body {
        dim: usize,
        basis: Vec<Basis>,
        /// The pseudo-inverse of the matrix S with a column (1, x) for each point and (0, u) for each direction of the
        /// basis (basis × D + 1), coordinates from the first point. In the plane its numbers are complex.
        inverse: Vec<[Factor; 4]>,
    },
    /// A bar in the plane: its ends, which are sums of nodes, with their reference coordinates.
    Bar([(Vec<Term>, Vec3); 2]),
}

/// f + g J, J the quarter turn of the plane; g is 0 in space.
type Factor = [f64; 2];

/// Largest part of a point or direction, over its size, that a basis may miss and still hold it.
const HELD: f64 = 1e-9;

/// Share of the largest parts of a factor that is round-off.
const ROUNDED: f64 = 4e-15;

impl Frame {
    /// A body with these nodes, the first of them a point.
    pub fn new(dim: usize, basis: Vec<Basis>) -> Self {
        let inverse = if dim == 2 { planar_inverse(&basis) } else { inverse(&basis) };
        Self::Body { dim, basis, inverse }
    }

    /// The point with reference coordinates `x`.
    pub fn point(&self, x: Vec3) -> Vec<Term> {
        match self {
            Self::Ground => vec![(Place::Fixed(x), 1.0).into()],
            Self::Particle(place) => vec![(*place, 1.0).into()],
            Self::Body { basis, .. } => self.combine(1.0, geometry::subtract(x, basis[0].at)),
            Self::Bar(ends) => along(ends, 1.0, geometry::subtract(x, ends[0].1)),
        }
    }

    /// The direction with reference coordinates `u`.
    ///
    /// # Panics
    /// When this is a particle, which has none.
    pub fn vector(&self, u: Vec3) -> Vec<Term> {
        match self {
            Self::Ground => vec![(Place::Fixed(u), 1.0).into()],
            Self::Particle(_) => unreachable!("a particle has no directions"),
            Self::Body { .. } => self.combine(0.0, u),
            Self::Bar(ends) => along(ends, 0.0, u),
        }
    }

    /// The nodes that can move, and whether they are points, as far as a frame knows: the end of a bar may be a place of a body.
    pub fn nodes(&self) -> Vec<(NodeId, bool)> {
        let node = |place: &Place, is_point: bool| match place {
            Place::Node(node) => Some((*node, is_point)),
            Place::Fixed(_) => None,
        };
        match self {
            Self::Ground => Vec::new(),
            Self::Particle(place) => node(place, true).into_iter().collect(),
            Self::Bar(ends) => ends.iter().flat_map(|(terms, _)| terms).filter_map(|term| node(&term.place, true)).collect(),
            Self::Body { basis, .. } => basis.iter().filter_map(|basis| node(&basis.place, basis.is_point)).collect(),
        }
    }

    /// Whether the nodes span a direction.
    pub fn holds(&self, u: Vec3) -> bool {
        match self {
            Self::Ground => true,
            Self::Particle(_) => false,
            Self::Body { dim: 2, .. } | Self::Bar(_) => true,
            Self::Body { basis, .. } => {
                let edges: Vec<Vec3> = edges(basis).into_iter().map(|edge| edge.reference).collect();
                geometry::norm(geometry::rest(&edges, u)) <= HELD * geometry::norm(u)
            }
        }
    }

    fn combine(&self, one: f64, x: Vec3) -> Vec<Term> {
        let Self::Body { basis, .. } = self else { unreachable!("only bodies combine nodes") };
        let nodes = basis.iter().zip(self.factors(one, x)).filter(|(_, factor)| *factor != [0.0; 2]);
        // A body has many of these sums: each takes the room of its terms.
        nodes.map(|(node, [factor, turn])| Term { place: node.place, factor, turn }).collect::<SmallVec<[Term; 4]>>().into_vec()
    }

    /// What each node of the basis of a body counts in a point (`one` is 1) at the way `x` from the first of them, or in a direction (0).
    fn factors(&self, one: f64, x: Vec3) -> SmallVec<[Factor; 4]> {
        let Self::Body { dim, basis, inverse } = self else { unreachable!("only bodies combine nodes") };
        let largest = |factors: &mut dyn Iterator<Item = &Factor>| factors.flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
        let (of_one, of_length) = (largest(&mut inverse.iter().map(|row| &row[0])), largest(&mut inverse.iter().flat_map(|row| &row[1..])));
        // Edges between points are differences of rounded places.
        let places = basis.iter().filter(|node| node.is_point).map(|node| geometry::norm(node.at));
        let rounded = 2.0 * f64::EPSILON * places.fold(0.0, f64::max) * of_length;
        let nothing = rounded.max(ROUNDED) * (of_one * one + of_length * geometry::norm(x));
        let factors = inverse.iter().map(|row| {
            let (mut factor, mut turn) = (row[0][0] * one, row[0][1] * one);
            if *dim == 2 {
                // Complex times complex: the row's second number times x + i y.
                let [f, g] = row[1];
                factor += f * x[0] - g * x[1];
                turn += f * x[1] + g * x[0];
            } else {
                factor += (0..3).map(|c| row[c + 1][0] * x[c]).sum::<f64>();
            }
            [factor, turn].map(|value| if value.abs() <= nothing { 0.0 } else { value })
        });
        let mut factors: SmallVec<[Factor; 4]> = factors.collect();
        keep_sum(one, basis, &mut factors);
        factors
    }
}

/// Has the factors of points sum up to one, or to nothing for a direction, as places far away would be that much times their distance off.
fn keep_sum(one: f64, basis: &[Basis], factors: &mut [Factor]) {
    let of_points = || basis.iter().enumerate().filter(|(_, node)| node.is_point).map(|(k, _)| k);
    let [factor, turn] = of_points().fold([one, 0.0], |[f, g], k| [f - factors[k][0], g - factors[k][1]]);
    let size = |k: &usize| factors[*k][0].hypot(factors[*k][1]);
    let largest = of_points().max_by(|a, b| size(a).total_cmp(&size(b))).expect("a body has a point");
    factors[largest][0] += factor;
    factors[largest][1] += turn;
}

/// A point of a bar (`one` is 1) at the way `x` from its first end, or a direction (0): (1 − z) a + z b or z (b − a) with z = x/(b − a), complex.
fn along(ends: &[(Vec<Term>, Vec3); 2], one: f64, x: Vec3) -> Vec<Term> {
    let edge = geometry::subtract(ends[1].1, ends[0].1);
    let square = geometry::dot(edge, edge);
    let (z, turn) = ((x[0] * edge[0] + x[1] * edge[1]) / square, (x[1] * edge[0] - x[0] * edge[1]) / square);
    // Ends are differences of rounded places.
    let places = ends.iter().map(|(_, at)| geometry::norm(*at)).fold(geometry::norm(x), f64::max);
    let rounded = 4.0 * f64::EPSILON * (one + (geometry::norm(x) + places) / square.sqrt());
    let clean = |value: f64| [0.0, 1.0].into_iter().find(|whole: &f64| (value - whole).abs() <= rounded).unwrap_or(value);
    let factors = [[clean(one - z), clean(-turn)], [clean(z), clean(turn)]];
    let terms = ends.iter().zip(factors).flat_map(|((terms, _), [f, g])| {
        let times =
            move |term: &Term| Term { place: term.place, factor: f * term.factor - g * term.turn, turn: f * term.turn + g * term.factor };
        terms.iter().map(times)
    });
    terms.filter(|term| term.factor != 0.0 || term.turn != 0.0).collect()
}

fn inverse(basis: &[Basis]) -> Vec<[Factor; 4]> {
    let relative = |node: &Basis| if node.is_point { geometry::subtract(node.at, basis[0].at) } else { node.at };
    // In units of its size: products of three lengths could vanish or overflow.
    let size = basis.iter().flat_map(relative).fold(0.0_f64, |size, c| size.max(c.abs()));
    let unit = if size > 0.0 { size } else { 1.0 };
    // Directions beside points that are very far apart count in a length of their own, by a power of two, which rounds nothing.
    let own = |node: &Basis| match node.is_point {
        true => 1.0,
        false => 2.0_f64.powi((geometry::norm(node.at).log2() - unit.log2()) as i32),
    };
    let s = DMatrix::from_fn(4, basis.len(), |row, column| match row {
        0 => f64::from(u8::from(basis[column].is_point)),
        _ => relative(&basis[column])[row - 1] / unit / own(&basis[column]),
    });
    // SᵀS is well conditioned, as nodes are chosen to be far from dependent.
    let inverse = match s.is_square() {
        true => s.clone().try_inverse(),
        false => (s.transpose() * &s).try_inverse().map(|inner| inner * s.transpose()),
    };
    let inverse = inverse.expect("the nodes of a body are independent");
    let row = |k: usize| std::array::from_fn(|c| [inverse[(k, c)] / own(&basis[k]) / if c == 0 { 1.0 } else { unit }, 0.0]);
    (0..basis.len()).map(row).collect()
}

/// With two points a and b: (1 − z) a + z b and z = x/(b − a); with a point and a direction u: z = x/u.
fn planar_inverse(basis: &[Basis]) -> Vec<[Factor; 4]> {
    let edge = if basis[1].is_point { geometry::subtract(basis[1].at, basis[0].at) } else { basis[1].at };
    let square = geometry::dot(edge, edge);
    let z = [edge[0] / square, -edge[1] / square];
    let own = if basis[1].is_point { [-z[0], -z[1]] } else { [0.0; 2] };
    vec![[[1.0, 0.0], own, [0.0; 2], [0.0; 2]], [[0.0; 2], z, [0.0; 2], [0.0; 2]]]
}

/// An edge of a body: from its first point to another one, or a direction.
pub struct Edge {
    pub terms: Vec<Term>,
    pub reference: Vec3,
}

/// The edges of a basis, in its order.
pub fn edges(basis: &[Basis]) -> Vec<Edge> {
    let first = basis[0];
    let edge = |node: &Basis| match node.is_point {
        true => {
            Edge { terms: vec![(node.place, 1.0).into(), (first.place, -1.0).into()], reference: geometry::subtract(node.at, first.at) }
        }
        false => Edge { terms: vec![(node.place, 1.0).into()], reference: node.at },
    };
    basis[1..].iter().map(edge).collect()
}

/// The mass matrix of a body: the blocks (a, b, m, s) of its nodes, of its mass (kg) at its centre and of its second moments ∫ x xᵀ dm
/// (kg·m²) about that. They come apart from each other: those of a small body would be round-off of its mass at the end of a long arm.
pub fn mass_blocks(frame: &Frame, mass: f64, centre: Vec3, second: &Matrix3<f64>) -> Vec<(Place, Place, f64, f64)> {
    let Frame::Body { dim, basis, inverse } = frame else { return Vec::new() };
    let pairs = || (0..basis.len()).flat_map(|a| (0..basis.len()).map(move |b| [a, b]));
    let turning = |[a, b]: [usize; 2]| match dim {
        2 => product(inverse[a][1], inverse[b][1]).map(|c| c * second.trace()),
        _ => {
            let [left, right] = [a, b].map(|k| Vector3::from_fn(|c, _| inverse[k][c + 1][0]));
            [left.dot(&(second * right)), 0.0]
        }
    };
    // Round-off is no mass: the nodes across a plate have none.
    let largest = pairs().flat_map(turning).fold(0.0, |largest: f64, c| largest.max(c.abs()));
    let clean = |value: f64| if value.abs() <= 1e-14 * largest { 0.0 } else { value };
    let at_centre = frame.factors(1.0, geometry::subtract(centre, basis[0].at));
    let block = |[a, b]: [usize; 2]| {
        let ([m, s], moving) = (turning([a, b]).map(clean), product(at_centre[a], at_centre[b]).map(|c| mass * c));
        (basis[a].place, basis[b].place, moving[0] + m, moving[1] + s)
    };
    pairs().map(block).collect()
}

/// conj(a) b: its real part and its imaginary one, the turn of b against a.
fn product([a, b]: Factor, [c, d]: Factor) -> Factor {
    [a * c + b * d, a * d - b * c]
}
