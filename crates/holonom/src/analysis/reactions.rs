//! Which forces of joints redundant rows leave undetermined.

use std::borrow::Cow;
use std::ops::Range;

use super::constraint_jacobian;
use crate::formulation::{VANISHED, extent, natural_sizes};
use crate::linalg::{largest, null_space};
use crate::simulation::{Simulation, wrench};
use crate::system::{Evaluation, NodeId, System};

/// Multipliers λ with Gᵀλ = 0 at a position: what may be added to the multipliers without any effect on the motion.
pub struct Undetermined<'s> {
    system: &'s System,
    /// One for each redundant row.
    spaces: Vec<Space>,
    at: Evaluation,
    x: Vec<f64>,
    t: f64,
}

/// Multipliers that have no effect together.
struct Space {
    /// By the rows (r).
    lambda: Vec<f64>,
    /// By the rows scaled to unit gradients (r), so that all are forces, and the largest of them.
    scaled: Vec<f64>,
    largest: f64,
}

/// Eigenvalue of the scaled G Gᵀ, over the largest, below which a combination of rows holds nothing: the square of what
/// the rank takes for independent.
const NOTHING: f64 = 1e-14;

/// Most rows for which this dense analysis is made.
pub const MOST_ROWS: usize = 1500;

/// Finds what redundant rows leave undetermined at the positions `x` of all nodes and time `t`. `None` without rows and for more than
/// [`MOST_ROWS`] rows.
pub fn undetermined<'s>(system: &'s System, x: &[f64], t: f64) -> Option<Undetermined<'s>> {
    let (rows, n) = (system.constraints(), system.coordinates());
    if rows == 0 || rows > MOST_ROWS {
        return None;
    }
    let mut scaled = Vec::with_capacity(rows * n);
    let mut sizes = Vec::with_capacity(rows);
    let mut at = system.evaluation();
    for (line, natural) in constraint_jacobian(system, x, t).iter().zip(natural_sizes(system).0) {
        let size = line.iter().map(|g| g * g).sum::<f64>().sqrt();
        // A gradient that has vanished is round-off, which points anywhere.
        let [factor, size] = if size > VANISHED * natural { [1.0 / size, size] } else { [0.0, 1.0] };
        scaled.extend(line.iter().map(|g| g * factor));
        sizes.push(size);
    }
    let gram = gram(rows, n, &scaled);
    let space = |scaled: Vec<f64>| Space {
        lambda: scaled.iter().zip(&sizes).map(|(scaled, size)| scaled / size).collect(),
        largest: largest(&scaled),
        scaled,
    };
    let spaces = null_space(rows, &gram, NOTHING).into_iter().map(space).collect();
    system.evaluate_again(x, t, &mut at);
    Some(Undetermined { system, spaces, at, x: x.to_vec(), t })
}

/// Products of all pairs of rows of n numbers each (rows × rows). Most numbers are zero, so that only rows that meet in one are multiplied.
fn gram(rows: usize, n: usize, values: &[f64]) -> Vec<f64> {
    let mut gram = vec![0.0; rows * rows];
    for i in 0..n {
        let held: Vec<(usize, f64)> = (0..rows).map(|row| (row, values[row * n + i])).filter(|(_, g)| *g != 0.0).collect();
        for &(a, g) in &held {
            held.iter().for_each(|&(b, h)| gram[a * rows + b] += g * h);
        }
    }
    gram
}

/// Finds what redundant rows leave undetermined of the forces that a simulation finds at its present state, with its positions on the rows: beside
/// them redundant rows are independent. `None` as above, and for more than `most` rows.
pub fn undetermined_of(simulation: &Simulation, most: usize) -> Option<Undetermined<'_>> {
    let system = simulation.found().system;
    if system.constraints() > most {
        return None;
    }
    undetermined(system, &simulation.reacting_x_on_rows(), simulation.state().t)
}

impl<'s> Undetermined<'s> {
    /// The system that they are found in.
    pub fn system(&self) -> &'s System {
        self.system
    }

    /// Positions of all nodes in the world (D × nodes), m, at which they are found.
    pub fn positions(&self) -> Cow<'_, [f64]> {
        self.system.in_world(&self.x)
    }

    /// Values and slopes of all quantities there.
    pub fn evaluation(&self) -> &Evaluation {
        &self.at
    }

    /// The time of that, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Number of independent combinations: the redundant rows.
    pub fn count(&self) -> usize {
        self.spaces.len()
    }

    /// The rows that take part in a redundancy: any one of the combination may be left out.
    pub fn rows(&self) -> Vec<usize> {
        let takes_part = |row: &usize| self.spaces.iter().any(|space| space.scaled[*row].abs() > SMALL * space.largest);
        (0..self.system.constraints()).filter(takes_part).collect()
    }

    /// Whether the components of force (3) and moment about a place (3) of some rows on some nodes (points or directions)
    /// are unique, with what is borne beside these rows, by the multipliers of all rows.
    pub fn are_unique(
        &self,
        rows: &Range<usize>,
        nodes: &[(NodeId, bool)],
        about: [f64; 3],
        borne: impl Fn(&[f64]) -> ([f64; 3], [f64; 3]),
    ) -> [bool; 6] {
        let (mut unique, length) = ([true; 6], extent(self.system));
        let none = borne(&vec![0.0; self.system.constraints()]);
        for space in &self.spaces {
            let (force, moment) = wrench(self.system, rows.clone(), &space.lambda, &self.at.gradient, nodes, about, &self.x);
            let more = borne(&space.lambda);
            let scale = SMALL * space.largest;
            for c in 0..3 {
                unique[c] &= (force[c] + more.0[c] - none.0[c]).abs() <= scale;
                unique[3 + c] &= (moment[c] + more.1[c] - none.1[c]).abs() <= scale * length;
            }
        }
        unique
    }

    /// Whether the components of forces, or of moments, are unique that follow from the multipliers of all rows, in which they are linear.
    pub fn exerted_are_unique<F: AsRef<[[f64; 3]]>>(&self, are_moments: bool, exerted: impl Fn(&[f64]) -> F) -> Vec<[bool; 3]> {
        let length = if are_moments { extent(self.system) } else { 1.0 };
        let mut unique = vec![[true; 3]; exerted(&vec![0.0; self.system.constraints()]).as_ref().len()];
        for space in &self.spaces {
            let scale = SMALL * space.largest * length;
            for (unique, exerted) in unique.iter_mut().zip(exerted(&space.lambda).as_ref()) {
                unique.iter_mut().zip(exerted).for_each(|(unique, part)| *unique &= part.abs() <= scale);
            }
        }
        unique
    }
}

/// Share of a combination that is round-off.
const SMALL: f64 = 1e-6;
