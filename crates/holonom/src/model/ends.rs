//! Ends of things: points, places of bodies and fixed places, as sums of nodes.

use super::assembly::CONTRADICTION;
use super::geometry::{add, norm};
use crate::system::{NodeId, Place, Term};

/// An end of something: a point of the model or a fixed place.
#[derive(Clone, Debug)]
pub struct End {
    /// The nodes it is made of.
    pub terms: Vec<Term>,
    /// Position at the start in the axes of the model, m.
    pub start: [f64; 3],
    /// Whether its motion is sought.
    pub free: bool,
    /// Position in the list of points, if it is one.
    pub point: Option<usize>,
    /// Position in the list of bodies, if it is a place of one.
    pub body: Option<usize>,
    /// As it was written, for messages.
    pub name: String,
}

impl End {
    /// Whether it is a place of the world.
    pub fn never_moves(&self) -> bool {
        is_fixed(&self.terms)
    }

    /// The node or place it is, where it is a single one.
    pub fn place(&self) -> Option<Place> {
        match self.terms[..] {
            [Term { place, factor: 1.0, turn: 0.0 }] => Some(place),
            _ => None,
        }
    }
}

/// Whether a sum is of fixed places alone.
pub fn is_fixed(terms: &[Term]) -> bool {
    terms.iter().all(|term| matches!(term.place, Place::Fixed(_)))
}

/// A place that never moves.
pub fn fixed(start: [f64; 3], name: String) -> End {
    End { terms: vec![(Place::Fixed(start), 1.0).into()], start, free: false, point: None, body: None, name }
}

/// A node as an end.
pub fn node(id: NodeId, start: [f64; 3], free: bool, point: usize, name: &str) -> End {
    End { terms: vec![(Place::Node(id), 1.0).into()], start, free, point: Some(point), body: None, name: name.to_string() }
}

/// The terms of the way from one end to another, those of the same node together.
pub fn from_to(from: &End, to: &End) -> Vec<Term> {
    subtract(&to.terms, &from.terms)
}

/// The terms of a difference: those of the same node together, all fixed places together, and none that vanishes.
pub fn subtract(to: &[Term], from: &[Term]) -> Vec<Term> {
    let negative = from.iter().map(|term| Term { factor: -term.factor, turn: -term.turn, ..*term });
    let (mut difference, mut fixed, mut size) = (Vec::<Term>::new(), [0.0; 3], 0.0);
    for term in to.iter().copied().chain(negative) {
        if let Place::Fixed(x) = term.place {
            let part = [term.factor * x[0] - term.turn * x[1], term.factor * x[1] + term.turn * x[0], term.factor * x[2]];
            size += norm(part);
            fixed = add(fixed, part);
            continue;
        }
        match difference.iter_mut().find(|known| known.place == term.place) {
            Some(known) => {
                let sum = |a: f64, b: f64| if (a + b).abs() <= GONE * a.abs().max(b.abs()) { 0.0 } else { a + b };
                (known.factor, known.turn) = (sum(known.factor, term.factor), sum(known.turn, term.turn));
            }
            None => difference.push(term),
        }
    }
    difference.retain(|term| term.factor != 0.0 || term.turn != 0.0);
    if norm(fixed) > GONE * size {
        difference.push((Place::Fixed(fixed), 1.0).into());
    }
    difference
}

/// What a difference leaves of its terms, over their size, that is round-off.
const GONE: f64 = 1e-12;

/// The same of what two bodies have at a joint, where they may share nodes: nothing where only what was written is off is left, as of the second
/// hinge of a door. A row of that would turn the smallest of differences into a lock. `size` is that of the mechanism, or of a direction, and
/// `reach` the length of a node's way, by which its factor counts.
pub fn subtract_shared(to: &[Term], from: &[Term], size: f64, reach: impl Fn(NodeId) -> f64) -> Vec<Term> {
    let mut difference = subtract(to, from);
    let is_small = |term: &Term| {
        let reach = match term.place {
            Place::Fixed(x) => norm(x),
            Place::Node(node) => reach(node),
        };
        reach * term.factor.abs().max(term.turn.abs()) <= CONTRADICTION * size
    };
    if difference.iter().all(is_small) {
        difference.clear();
    }
    difference
}

/// Position of the second end minus that of the first, at the start.
pub fn difference(from: &End, to: &End) -> [f64; 3] {
    std::array::from_fn(|c| to.start[c] - from.start[c])
}
