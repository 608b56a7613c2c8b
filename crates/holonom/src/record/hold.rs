//! What constraints that are no joints exert: forces on the places that they hold, or the moment that keeps two directions at a right angle.

use std::ops::Range;
use std::sync::Arc;

use smallvec::SmallVec;

use super::heading::{Endings, Heading};
use crate::system::{Evaluation, Quantity, Term, cross, place_of};

/// A constraint whose forces on places are recorded.
#[derive(Clone)]
pub struct RecordedHold {
    /// What the columns of each force or moment are called: the constraint, with its index where it is repeated, and behind it the place where several
    /// are named.
    pub owners: Vec<String>,
    /// What that is, for the meaning of columns.
    pub what: &'static str,
    /// Its rows among those of the system.
    pub rows: Range<usize>,
    /// What these rows exert.
    pub(crate) acts: Acts,
}

/// What rows exert.
#[derive(Clone)]
pub(crate) enum Acts {
    /// A force along a direction of the world for each row.
    Along(Vec<[f64; 3]>),
    /// Forces of places in a line.
    Straight(Vec<Straight>),
    /// A moment between two differences of places.
    Square([Vec<Term>; 2]),
    /// Forces along the slopes of a formula.
    Formula(Arc<dyn Slopes>),
}

/// Rows that keep two differences of places, u and w, parallel.
#[derive(Clone)]
pub(crate) struct Straight {
    /// One for each row: a component of u × w, or a function of the three.
    pub quantities: Vec<Quantity>,
    /// u and w.
    pub ways: [Vec<Term>; 2],
    /// Number of a force, which of the two ways it is of, and with which sign.
    pub on: Vec<(usize, usize, f64)>,
}

/// Slopes of a formula of places.
pub(crate) trait Slopes: Send + Sync {
    /// Adds what it changes by with each place (3 each), at the positions `x` of all nodes in the world and the time `t`.
    fn by_place(&self, x: &[f64], t: f64, slopes: &mut [[f64; 3]]);
}

/// Forces (N) or moments (N·m) of a constraint, one for each of its owners.
pub type Exerted = SmallVec<[[f64; 3]; 4]>;

/// Where rows exert something.
#[derive(Clone, Copy)]
pub struct Where<'a> {
    /// Values and slopes of all quantities.
    pub at: &'a Evaluation,
    /// Positions of all nodes in the world (D × nodes), m.
    pub x: &'a [f64],
    /// Coordinates a node.
    pub dim: usize,
    /// s
    pub t: f64,
}

impl RecordedHold {
    /// Whether it exerts a moment and no force.
    pub fn is_moment(&self) -> bool {
        matches!(self.acts, Acts::Square(_))
    }

    /// Which components are recorded, in the plane or in space.
    pub fn components(&self, dim: usize) -> Range<usize> {
        if self.is_moment() && dim == 2 { 2..3 } else { 0..dim }
    }

    /// How many columns it has, without those of sizes.
    pub(super) fn width(&self, dim: usize) -> usize {
        self.owners.len() * self.components(dim).len()
    }

    /// The endings of the columns of these components.
    pub fn columns(&self, axes: &str) -> Vec<String> {
        match (self.is_moment(), axes.len()) {
            (true, 2) => vec!["t".into()],
            (is_moment, _) => axes.chars().map(|axis| format!("{}{axis}", if is_moment { 't' } else { 'f' })).collect(),
        }
    }

    /// The columns of each of its forces, or of its moment, with what they are called.
    pub fn acts(&self, axes: &str) -> impl Iterator<Item = (&str, Vec<String>)> {
        let columns = self.columns(axes);
        self.owners.iter().map(move |owner| (owner.as_str(), columns.iter().map(|ending| format!("{owner}.{ending}")).collect()))
    }

    /// Its columns with their units and meanings.
    pub(super) fn headings(&self, axes: &str) -> Vec<Heading> {
        let mut endings = Endings::default();
        let (unit, way) = if self.is_moment() { ("N·m", "about") } else { ("N", "along") };
        for (k, ending) in self.columns(axes).into_iter().enumerate() {
            let along = axes.chars().nth(k).filter(|_| !(self.is_moment() && axes.len() == 2));
            let along = along.map_or(String::new(), |axis| format!(", {way} {axis} of the world"));
            endings.add(ending, unit, format!("{}{along}", self.what));
        }
        self.owners.iter().flat_map(|owner| endings.of(owner)).collect()
    }

    /// What it exerts with these multipliers of all rows: in the plane the third number is that of a moment.
    pub fn exerted(&self, lambda: &[f64], Where { at, x, dim, t }: Where<'_>) -> Exerted {
        let own = &lambda[self.rows.clone()];
        let mut out = Exerted::from_elem([0.0; 3], self.owners.len());
        match &self.acts {
            Acts::Along(directions) => own.iter().zip(directions).for_each(|(&lambda, e)| add(&mut out[0], -lambda, *e)),
            Acts::Square(ways) => {
                let [u, w] = ways.each_ref().map(|way| place_of(way, x, dim));
                // The multiplier pulls the end of w along −u and its beginning along u.
                add(&mut out[0], own[0], cross(&u, &w));
            }
            Acts::Straight(parts) => {
                let mut rest = own;
                for Straight { quantities, ways, on } in parts {
                    let (own, behind) = rest.split_at(quantities.len());
                    rest = behind;
                    let axis = product(own, quantities, at, dim);
                    let [u, w] = ways.each_ref().map(|way| place_of(way, x, dim));
                    // Of axis · (u × w) the slope by u is w × axis, and that by w is axis × u.
                    let forces = [cross(&axis, &w), cross(&u, &axis)];
                    on.iter().for_each(|&(force, way, sign)| add(&mut out[force], sign, forces[way]));
                }
            }
            Acts::Formula(formula) => {
                formula.by_place(x, t, &mut out);
                out.iter_mut().for_each(|slope| *slope = slope.map(|slope| -own[0] * slope));
            }
        }
        out
    }
}

/// The axis whose product with u × w is the sum of rows times their multipliers.
fn product(lambda: &[f64], quantities: &[Quantity], at: &Evaluation, dim: usize) -> [f64; 3] {
    let mut axis = [0.0; 3];
    for (row, (&lambda, quantity)) in lambda.iter().zip(quantities).enumerate() {
        match quantity {
            // In the plane there is the product across it alone.
            Quantity::Invariant(_) if dim == 2 => axis[2] += lambda,
            Quantity::Invariant(_) => axis[row] += lambda,
            // Its first three arguments are the components of the product.
            Quantity::Function(id) => {
                let slopes = &at.functions.local[id.0 as usize].gradient;
                axis.iter_mut().zip(slopes).for_each(|(axis, slope)| *axis += lambda * slope);
            }
        }
    }
    axis
}

fn add(sum: &mut [f64; 3], factor: f64, part: [f64; 3]) {
    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += factor * part);
}
