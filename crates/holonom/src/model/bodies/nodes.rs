//! Which nodes the bodies of a model are made of.
//!
//! Where a joint makes two bodies share a point or a direction, that becomes one node of both, as far as the nodes of a
//! body stay independent: the rows that would hold the two together are then not needed (methods §7). Bodies that are
//! joined rigidly are one.

use std::collections::{BTreeSet, HashSet};

use nalgebra::{Matrix3, Vector3};

use super::frame::{Basis, Frame, edges, mass_blocks};
use super::{RigidBody, inertia};
use crate::model::ends::is_fixed;
use crate::model::geometry::{Vec3, dot, norm, rest, scale, subtract};
use crate::system::{Place, SystemBuilder, Term};

/// Smallest part of a node's edge that is at right angles to the others, over its length, for it to become a node.
const INDEPENDENT: f64 = 0.05;

/// Shortest edge between two points, over the size of the body, for both to become nodes.
const APART: f64 = 0.02;

/// Second moments below this share of the largest are none: the body is a plate or a rod.
const THIN: f64 = 1e-9;

/// One side of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    Ground,
    /// A point, by its position in the list of points.
    Point(usize),
    /// A body, by its position in the list of bodies.
    Body(usize),
    /// A bar in the plane, by its position in the list of bars.
    Bar(usize),
}

/// A point or direction that two sides of a joint have in common, with its reference coordinates on each.
#[derive(Clone, Debug)]
pub struct Shared {
    pub sides: [(Member, Vec3); 2],
    pub is_point: bool,
}

/// What a plan of nodes is made from.
pub struct Wanted<'a> {
    pub bodies: &'a [RigidBody],
    pub shared: &'a [Shared],
    /// Pairs of bodies that are joined rigidly and become one.
    pub merged: &'a [[usize; 2]],
    /// Directions that joints and forces need of a body, which a plate or a rod may lack.
    pub needed: &'a [(usize, Vec3)],
    /// Size of the mechanism, m: places are the same within round-off of it.
    pub extent: f64,
    /// Length of the nodes that are directions, m: that of a body, so that they weigh like its points.
    pub length: f64,
    /// Places of the points that may become nodes of bodies.
    pub points: &'a dyn Fn(usize) -> Option<Place>,
}

/// Makes the nodes of all bodies, their mass and the rows that keep them rigid; a frame for each body.
pub fn make(builder: &mut SystemBuilder, wanted: &Wanted<'_>) -> Vec<Frame> {
    let groups = groups(wanted);
    let sharing = Sharing::new(wanted, &groups);
    let mut places: Vec<Option<Found>> = wanted.shared.iter().map(|shared| known_place(shared, wanted)).collect();
    let mut compared: Vec<Vec<bool>> = sharing.of_group.iter().map(|shared| vec![false; shared.len()]).collect();
    sharing.spread(wanted, (0..groups.len()).collect(), &mut places, &mut compared);
    let mut needed = vec![Vec::new(); wanted.bodies.len()];
    wanted.needed.iter().for_each(|&(body, direction)| needed[body].push(direction));
    let mut kept = HashSet::new();
    let mut frames: Vec<Option<Frame>> = vec![None; wanted.bodies.len()];
    for (root, members) in groups.iter().enumerate().filter(|(_, members)| !members.is_empty()) {
        let group = Group { members, shared: &sharing.of_group[root], needed: &needed, lead: &wanted.bodies[root], wanted };
        let basis = group.basis(builder, &mut places);
        sharing.spread(wanted, sharing.beside(root), &mut places, &mut compared);
        let frame = Frame::new(builder.dimension(), basis.clone());
        group.add_mass(builder, &frame, &basis);
        keep_rigid(builder, &group.lead.name, &basis, &mut kept);
        members.iter().for_each(|&body| frames[body] = Some(frame.clone()));
    }
    frames.into_iter().map(|frame| frame.expect("every body is in a group")).collect()
}

/// The bodies of each group, at the first of them.
fn groups(wanted: &Wanted<'_>) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..wanted.bodies.len()).collect();
    let find = |root: &[usize], mut k: usize| {
        while root[k] != k {
            k = root[k];
        }
        k
    };
    for &[a, b] in wanted.merged {
        let (a, b) = (find(&root, a), find(&root, b));
        root[a.max(b)] = a.min(b);
    }
    let mut groups = vec![Vec::new(); wanted.bodies.len()];
    (0..wanted.bodies.len()).for_each(|k| groups[find(&root, k)].push(k));
    groups
}

/// The node or place of something shared, and whether a direction goes the same way (1) or the opposite one (−1).
type Found = (Place, f64);

/// Where a shared point or direction is, if that is known before any body has nodes.
fn known_place(shared: &Shared, wanted: &Wanted<'_>) -> Option<Found> {
    let place = shared.sides.iter().find_map(|&(member, at)| match member {
        Member::Ground if shared.is_point => Some(Place::Fixed(at)),
        Member::Ground => Some(Place::Fixed(scale(at, wanted.length))),
        Member::Point(k) => (wanted.points)(k),
        Member::Body(_) | Member::Bar(_) => None,
    });
    place.map(|place| (place, 1.0))
}

/// What the groups of bodies share with others.
struct Sharing {
    /// Numbers of what each group shares, with its reference coordinates there.
    of_group: Vec<Vec<(usize, Vec3)>>,
    /// The groups that share each.
    groups: Vec<Vec<usize>>,
}

impl Sharing {
    fn new(wanted: &Wanted<'_>, groups: &[Vec<usize>]) -> Self {
        let mut group_of = vec![0; wanted.bodies.len()];
        for (root, members) in groups.iter().enumerate() {
            members.iter().for_each(|&body| group_of[body] = root);
        }
        let mut sharing = Self { of_group: vec![Vec::new(); groups.len()], groups: vec![Vec::new(); wanted.shared.len()] };
        for (k, shared) in wanted.shared.iter().enumerate() {
            for &(member, at) in &shared.sides {
                let Member::Body(body) = member else { continue };
                // Of two sides in a group the first counts.
                if !sharing.groups[k].contains(&group_of[body]) {
                    sharing.groups[k].push(group_of[body]);
                    sharing.of_group[group_of[body]].push((k, at));
                }
            }
        }
        sharing
    }

    /// The groups that share something with a group, and itself.
    fn beside(&self, group: usize) -> BTreeSet<usize> {
        self.of_group[group].iter().flat_map(|&(k, _)| &self.groups[k]).copied().collect()
    }

    /// Gives what is shared at one joint of a body the node of another joint that has the same point or a parallel direction
    /// there, from body to body as far as it goes, beginning with the groups `open`. What has a node is `compared` with the others of each
    /// group once.
    fn spread(&self, wanted: &Wanted<'_>, mut open: BTreeSet<usize>, places: &mut [Option<Found>], compared: &mut [Vec<bool>]) {
        let mut from = 0;
        while let Some(group) = open.range(from..).next().or(open.first()).copied() {
            open.remove(&group);
            from = group + 1;
            for (&(known, at), is_compared) in self.of_group[group].iter().zip(&mut compared[group]) {
                let Some((place, sense)) = places[known].filter(|_| !*is_compared) else { continue };
                *is_compared = true;
                for &(other, there) in self.of_group[group].iter().filter(|&&(other, _)| other != known) {
                    if places[other].is_none() && wanted.shared[known].is_point == wanted.shared[other].is_point {
                        places[other] = alike(wanted.shared[known].is_point, at, there, wanted.extent).map(|same| (place, sense * same));
                        if places[other].is_some() {
                            open.extend(&self.groups[other]);
                        }
                    }
                }
            }
        }
    }
}

/// Whether two points are the same (1), and whether two unit directions go the same way (1) or the opposite one (−1).
fn alike(are_points: bool, a: Vec3, b: Vec3, extent: f64) -> Option<f64> {
    if are_points {
        return (norm(subtract(a, b)) <= SAME * extent).then_some(1.0);
    }
    let sense = dot(a, b).signum();
    (norm(subtract(a, scale(b, sense))) <= SAME).then_some(sense)
}

/// Difference of two places, over the size of the mechanism, or of two directions that is round-off.
const SAME: f64 = 1e-13;

struct Group<'a> {
    members: &'a [usize],
    /// Numbers of what it shares, with its reference coordinates there.
    shared: &'a [(usize, Vec3)],
    /// Directions that are needed of each body of the model.
    needed: &'a [Vec<Vec3>],
    lead: &'a RigidBody,
    wanted: &'a Wanted<'a>,
}

impl Group<'_> {
    /// Chooses the nodes: shared points, shared directions, then its own; the first is a point. Those of a plate or a rod
    /// lie in it, but for directions of its own across it, which then have no mass.
    fn basis(&self, builder: &mut SystemBuilder, places: &mut [Option<Found>]) -> Vec<Basis> {
        let (dim, centre, solid) = (builder.dimension(), self.centre(), self.solid(builder.dimension()));
        // The way to a place at the centre is rounding.
        let rounded = SAME * self.wanted.extent;
        let lies_in = |edge: Vec3| solid.len() == 3 || norm(rest(&solid, edge)) <= (THIN * norm(edge)).max(rounded);
        let mut own = self.shared.to_vec();
        let is_point = |k: usize| self.wanted.shared[k].is_point;
        // Fixed places first, as they are no unknowns; then points.
        own.sort_by_key(|&(k, _)| (!matches!(places[k], Some((Place::Fixed(_), _))), !is_point(k)));
        let size = own.iter().filter(|&&(k, _)| is_point(k)).map(|&(_, at)| norm(subtract(at, centre))).fold(0.0, f64::max);
        let edges = self.needed_edges(dim, &solid, &own);
        let (mut basis, mut spanned) = (Vec::<Basis>::new(), Vec::<Vec3>::new());
        // The first node is a point.
        let first = own.iter().copied().find(|&(k, at)| is_point(k) && lies_in(subtract(at, centre)));
        let (at, place) = match first {
            Some((k, at)) => (at, self.place(builder, &mut places[k], at, true)),
            None => (centre, self.place(builder, &mut None, centre, true)),
        };
        basis.push(Basis { place, at, is_point: true });
        for (k, at) in own {
            let edge = if is_point(k) { subtract(at, basis[0].at) } else { scale(at, self.wanted.length) };
            let is_short = is_point(k) && norm(edge) <= APART * size;
            if spanned.len() == edges || is_short || !lies_in(edge) || !is_independent(&spanned, edge) {
                continue;
            }
            spanned.push(edge);
            let node = if is_point(k) { at } else { edge };
            let place = self.place(builder, &mut places[k], node, is_point(k));
            // A direction may have the node of its opposite.
            let sense = places[k].map_or(1.0, |(_, sense)| sense);
            basis.push(Basis { place, at: scale(node, sense), is_point: is_point(k) });
        }
        while spanned.len() < edges {
            let at = scale(self.own_direction(dim, &solid, &spanned), self.wanted.length);
            spanned.push(at);
            basis.push(Basis { place: self.place(builder, &mut None, at, false), at, is_point: false });
        }
        basis
    }

    /// The node of a point or direction, made where there is none yet.
    fn place(&self, builder: &mut SystemBuilder, known: &mut Option<Found>, at: Vec3, is_point: bool) -> Place {
        let mut node = || match is_point {
            true => builder.free_node(at, self.lead.velocity_at(at)),
            false => builder.free_direction(at, self.lead.rate_of(at)),
        };
        known.get_or_insert_with(|| (Place::Node(node()), 1.0)).0
    }

    /// A direction that is not yet spanned: as much of one of the principal axes as is new, those in a plate or along a rod
    /// first.
    fn own_direction(&self, dim: usize, solid: &[Vec3], spanned: &[Vec3]) -> Vec3 {
        if dim == 2 {
            return self.lead.direction([1.0, 0.0, 0.0]);
        }
        let (_, axes) = self.principal();
        let longest = |axes: &[Vec3]| {
            let new = axes.iter().map(|&axis| rest(spanned, axis));
            new.max_by(|a, b| norm(*a).total_cmp(&norm(*b))).expect("there are axes")
        };
        let inside = longest(solid);
        let new = if norm(inside) > INDEPENDENT { inside } else { longest(&axes) };
        scale(new, 1.0 / norm(new))
    }

    /// Second moments ∫ x² dm along the principal axes, kg·m², and these axes.
    fn principal(&self) -> ([f64; 3], [Vec3; 3]) {
        let tensor = self.inertia();
        let (moments, axes) = inertia::principal(std::array::from_fn(|i| std::array::from_fn(|j| tensor[(i, j)])));
        let half: f64 = 0.5 * moments.iter().sum::<f64>();
        (moments.map(|moment| half - moment), axes)
    }

    /// The principal axes along which the body extends: three, two of a plate, one of a rod. Second moments below zero are those of an
    /// inertia that was not to be checked.
    fn solid(&self, dim: usize) -> Vec<Vec3> {
        let (second, axes) = self.principal();
        let largest = second.iter().copied().fold(0.0, f64::max);
        let solid: Vec<Vec3> = (0..3).filter(|&k| second[k].abs() > THIN * largest).map(|k| axes[k]).collect();
        if dim == 2 || solid.is_empty() { axes.to_vec() } else { solid }
    }

    /// How many edges it takes: three, and of a plate two and of a rod one, where nothing needs more.
    fn needed_edges(&self, dim: usize, solid: &[Vec3], shared: &[(usize, Vec3)]) -> usize {
        if dim == 2 {
            return 1;
        }
        if solid.len() == 3 {
            return 3;
        }
        let centre = self.centre();
        let needed = self.members.iter().flat_map(|&body| self.needed[body].iter().copied());
        let edge = |&(k, at): &(usize, Vec3)| if self.wanted.shared[k].is_point { subtract(at, centre) } else { at };
        let edges = shared.iter().map(edge).chain(needed);
        let held = edges.into_iter().all(|edge| norm(rest(solid, edge)) <= THIN * norm(edge));
        if held { solid.len() } else { 3 }
    }

    fn centre(&self) -> Vec3 {
        let bodies = self.members.iter().map(|&k| &self.wanted.bodies[k]);
        let mass: f64 = bodies.clone().map(|body| body.mass).sum();
        let moment = bodies.fold(Vector3::zeros(), |sum, body| sum + body.mass * Vector3::from(body.position));
        (moment / mass).into()
    }

    /// Inertia tensor about the centre of mass of all, kg·m².
    fn inertia(&self) -> Matrix3<f64> {
        let centre = Vector3::from(self.centre());
        self.members.iter().map(|&k| &self.wanted.bodies[k]).fold(Matrix3::zeros(), |sum, body| {
            let x = Vector3::from(body.position) - centre;
            sum + body.inertia + body.mass * (Matrix3::identity() * x.norm_squared() - x * x.transpose())
        })
    }

    fn add_mass(&self, builder: &mut SystemBuilder, frame: &Frame, basis: &[Basis]) {
        let mass: f64 = self.members.iter().map(|&k| self.wanted.bodies[k].mass).sum();
        let blocks = mass_blocks(frame, mass, self.centre(), &second_moments(builder.dimension(), self.inertia()));
        for (k, (a, b, m, s)) in blocks.into_iter().enumerate() {
            if k / basis.len() <= k % basis.len() {
                builder.inertia(a, b, m, s);
            }
        }
        frame.point(self.centre()).into_iter().for_each(|term| builder.weight(term, mass));
        for body in self.members.iter().map(|&k| &self.wanted.bodies[k]) {
            let blocks = mass_blocks(frame, body.mass, body.position, &second_moments(builder.dimension(), body.inertia));
            for (k, (a, b, m, s)) in blocks.into_iter().enumerate() {
                builder.moves(a, b, m, s, basis[k % basis.len()].velocity(body));
            }
        }
    }
}

/// Second moments ∫ x xᵀ dm, kg·m², of what has this inertia tensor; in the plane any two that add up to the polar one.
fn second_moments(dim: usize, tensor: Matrix3<f64>) -> Matrix3<f64> {
    match dim {
        2 => Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 0.0)) * tensor[(2, 2)],
        _ => Matrix3::identity() * (0.5 * tensor.trace()) - tensor,
    }
}

fn is_independent(spanned: &[Vec3], edge: Vec3) -> bool {
    norm(rest(spanned, edge)) > INDEPENDENT * norm(edge)
}

/// What tells a node or a place from others.
pub type PlaceCode = [u64; 3];

pub fn code_of(place: Place) -> PlaceCode {
    match place {
        // No finite place has these bits.
        Place::Node(node) => [u64::MAX, 0, node.index() as u64],
        Place::Fixed(x) => x.map(f64::to_bits),
    }
}

/// The nodes that an edge is made of, whichever way it goes.
type EdgeCode = [PlaceCode; 2];

fn code(terms: &[Term]) -> EdgeCode {
    let mut nodes = [[u64::MAX; 3]; 2];
    nodes.iter_mut().zip(terms).for_each(|(code, term)| *code = code_of(term.place));
    nodes.sort_unstable();
    nodes
}

/// The rows of a rigid body: all products of its edges. What holds between the same nodes for another body already, or
/// between fixed places, is left out.
fn keep_rigid(builder: &mut SystemBuilder, name: &str, basis: &[Basis], kept: &mut HashSet<[EdgeCode; 2]>) {
    let edges = edges(basis);
    for (i, a) in edges.iter().enumerate() {
        for (j, b) in edges.iter().enumerate().skip(i) {
            if is_fixed(&a.terms) && is_fixed(&b.terms) {
                continue;
            }
            let mut key = [a, b].map(|edge| code(&edge.terms));
            key.sort_unstable();
            if !kept.insert(key) {
                continue;
            }
            let product = dot(a.reference, b.reference);
            let (invariant, target) = match i == j {
                true => (builder.square(&a.terms), 0.5 * product),
                false => (builder.dot(&a.terms, &b.terms), product),
            };
            builder.implied_row(format!("{name}[{}{}]", i + 1, j + 1), invariant, target);
        }
    }
}
