//! The largest values of forces and measures between the rows of a recording: a row may lie far from where one is largest.

use serde::{Deserialize, Serialize};

use super::force::RecordedForce;
use crate::simulation::any_number;

/// The state in which something that acts is largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// The sum of the squares of its components there, and its value, which of several components is their size.
    #[serde(with = "any_number")]
    values: [f64; 2],
    /// When, s.
    t: f64,
}

impl Largest {
    /// When it was, s, the square and the value.
    pub(super) fn parts(&self) -> (f64, f64, f64) {
        let [square, value] = self.values;
        (self.t, square, value)
    }
}

/// Share of itself by which a square counts as larger than another.
const ROUND_OFF: f64 = 2e-9;

/// How far a measure has gone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Its smallest value and when, s, and its largest; none before there was a number.
    sides: Option<[(f64, f64); 2]>,
    /// Its value when last looked at, in a list as numbers are written that may be none.
    #[serde(with = "any_number", default)]
    last: [f64; 1],
}

impl Bounds {
    /// Takes the number at a time (s) in, if it is one.
    pub(super) fn see(&mut self, value: f64, t: f64) {
        self.last = [value];
        if !value.is_finite() {
            return;
        }
        let [lowest, highest] = self.sides.get_or_insert([(value, t); 2]);
        if value < lowest.0 {
            *lowest = (value, t);
        }
        if value > highest.0 {
            *highest = (value, t);
        }
    }

    /// Its value when last looked at.
    pub(super) fn last(&self) -> f64 {
        self.last[0]
    }

    /// Its smallest value and when, s, and its largest.
    pub(super) fn sides(&self) -> Option<[(f64, f64); 2]> {
        self.sides
    }
}

/// Looks at what forces exert between rows.
pub(super) struct Between {
    /// Of each group of columns that make one value their places among the columns of the forces.
    groups: Vec<Vec<usize>>,
    /// Of each of them, as far as a state was looked at.
    pub largest: Vec<Largest>,
    /// Of all forces.
    columns: usize,
}

impl Between {
    /// For the forces of a recording of a model with these axes.
    pub fn new(forces: &[RecordedForce], axes: &str) -> Self {
        let (mut groups, mut before) = (Vec::new(), 0);
        for force in forces {
            let headings = force.headings(axes);
            let place = |name: &String| headings.iter().position(|heading| heading.name == *name).expect("what acts is recorded") + before;
            groups.extend(force.acts(axes).iter().map(|names| names.iter().map(place).collect()));
            before += headings.len();
        }
        let largest = vec![Largest::default(); groups.len()];
        Self { groups, largest, columns: before }
    }

    /// How many columns the forces have.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Whether there is anything to look at.
    pub fn is_needed(&self) -> bool {
        !self.groups.is_empty()
    }

    /// Looks at a row that begins with the columns of the forces, at the time `t` (s).
    pub fn see(&mut self, row: &[f64], t: f64) {
        for (group, largest) in self.groups.iter().zip(&mut self.largest) {
            let square = group.iter().map(|&k| row[k] * row[k]).sum::<f64>();
            if square > (1.0 + ROUND_OFF) * largest.values[0] {
                let value = if let [one] = group[..] { row[one] } else { square.sqrt() };
                *largest = Largest { values: [square, value], t };
            }
        }
    }
}
