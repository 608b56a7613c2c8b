//! What a joint transmits.

use super::heading::Endings;
use crate::simulation::Found;
use crate::system::{NodeId, Term, place_of};

/// Force (N) and moment (N·m).
pub(super) type Wrench = ([f64; 3], [f64; 3]);

/// A joint whose force is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedJoint {
    /// With its index where it is repeated.
    pub name: String,
    /// Its rows among those of the system.
    pub rows: std::ops::Range<usize>,
    /// Whether these rows are all that holds it: where its bodies share nodes, its force is not known.
    pub is_known: bool,
    /// The nodes of its second body, or of the first where the second is the ground, and whether they are points.
    pub nodes: Vec<(NodeId, bool)>,
    /// 1 when they are those of the second body, −1 when of the first.
    pub sign: f64,
    /// Its place on the second body.
    pub at: Vec<Term>,
}

impl RecordedJoint {
    /// Which components of force (0 to 2) and moment (3 to 5) are recorded, in space or in the plane.
    pub(super) fn components(dim: usize) -> &'static [usize] {
        if dim == 2 { &[0, 1, 5] } else { &[0, 1, 2, 3, 4, 5] }
    }

    /// These components with the endings of their columns.
    pub fn columns(axes: &str) -> Vec<(usize, String)> {
        let ending = |k: usize| match (axes.len(), k) {
            (2, 5) => "t".to_string(),
            _ => format!("{}{}", if k < 3 { 'f' } else { 't' }, char::from(axes.as_bytes()[k % 3])),
        };
        Self::components(axes.len()).iter().map(|&k| (k, ending(k))).collect()
    }

    /// The columns of its force and of its moment.
    pub fn acts(&self, axes: &str) -> [Vec<String>; 2] {
        let columns = Self::columns(axes);
        [false, true].map(|is_moment| {
            columns.iter().filter(|(k, _)| (*k > 2) == is_moment).map(|(_, ending)| format!("{}.{ending}", self.name)).collect()
        })
    }

    /// The columns of a joint.
    pub(super) fn endings(axes: &str) -> Endings {
        let mut endings = Endings::default();
        for (k, ending) in Self::columns(axes) {
            let along = axes.chars().nth(k % 3).filter(|_| k < 3 || axes.len() == 3);
            let along = along.map_or(String::new(), |axis| format!(", along {axis} of the world"));
            let (unit, what) =
                if k < 3 { ("N", "force on the second body") } else { ("N·m", "moment on the second body about the joint") };
            endings.add(ending, unit, format!("{what}{along}"));
        }
        endings
    }

    /// Where it is at the positions `x` of all nodes in the world, m.
    pub fn place(&self, x: &[f64], dim: usize) -> [f64; 3] {
        place_of(&self.at, x, dim)
    }

    /// Force (N) on its second body and moment (N·m) on it about the joint's place there, in world axes, at the state where forces were found, of
    /// which `x` are the positions of all nodes. `None` where no forces are found or bodies share nodes at the joint. What it bears of teeth and
    /// belts is not in it.
    pub(super) fn wrench(&self, found: &Found<'_>, x: &[f64]) -> Option<Wrench> {
        if !self.is_known {
            return None;
        }
        let about = self.place(x, found.system.dimension());
        let (force, moment) = found.wrench(self.rows.clone(), &self.nodes, about)?;
        Some((force.map(|f| self.sign * f), moment.map(|m| self.sign * m)))
    }
}
