//! What rounding leaves open of a state, and of what is read of it.

use super::evaluate::Local;
use super::{Evaluation, Quantity, Reading, Sense, System};
use crate::linalg::largest;

/// Roundings of numbers of about one that what follows from a state may be off by.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Roundings of the origin of the system: places are counted from there, and it is added once, where they are read.
const ADDED: f64 = 4.0 * f64::EPSILON;

/// In how many ways numbers are changed together: in one, what some do might take back what others do.
pub(super) const WAYS: usize = 4;

/// What rounding leaves open of places (m) and velocities (m/s) of points, and of directions and their rates (1/s).
#[derive(Clone, Copy)]
pub(crate) struct Rounding {
    pub of_points: [f64; 2],
    pub of_directions: [f64; 2],
}

impl Rounding {
    /// The same where an accuracy leaves open a share of the `size` of places (m) and of directions, and of `speed` (m/s), if that is more.
    pub fn or_share(self, share: f64, [size, of_directions]: [f64; 2], speed: f64) -> Self {
        let most = |[x, v]: [f64; 2], of: f64, rate: f64| [x.max(share * of), v.max(share * rate)];
        Self {
            of_points: most(self.of_points, size, speed),
            of_directions: most(self.of_directions, of_directions, of_directions * speed / size),
        }
    }
}

impl System {
    /// What rounding leaves open of positions and velocities of all nodes: places near the origin are no surer than others, as the fixed ones that
    /// they are compared with are rounded, too. Velocities that no row holds are the ways of a `step` (s) over its length.
    pub(crate) fn rounding(&self, x: &[f64], v: &[f64], step: Option<f64>) -> Rounding {
        let of = |size: f64, speed: f64| [ROUNDED * size, ROUNDED * (speed + step.map_or(0.0, |step| size / step))];
        let [places, speeds] = of(self.largest_of_points(x), self.largest_of_points(v));
        Rounding { of_points: [places + ADDED * largest(&self.origin), speeds], of_directions: of(1.0, self.largest_of(false, v)) }
    }

    /// The largest of some numbers of all nodes that are those of points: directions have other units.
    pub(crate) fn largest_of_points(&self, numbers: &[f64]) -> f64 {
        self.largest_of(true, numbers)
    }

    /// The same of directions.
    pub(crate) fn largest_of_directions(&self, numbers: &[f64]) -> f64 {
        self.largest_of(false, numbers)
    }

    fn largest_of(&self, points: bool, numbers: &[f64]) -> f64 {
        let nodes = numbers.chunks_exact(self.dim).zip(&self.is_point);
        nodes.filter(|(_, is_point)| **is_point == points).fold(0.0, |most: f64, (node, _)| most.max(largest(node)))
    }

    /// What rounding leaves open of the numbers that are read and of their rates.
    pub(crate) fn rounding_of_reading(&self, reading: &Reading, at: &Evaluation, rounding: Rounding) -> [Local; 2] {
        let of_nodes = reading.nodes.iter().flat_map(|node| std::iter::repeat_n(self.rounding_of_node(node.index(), rounding), self.dim));
        let of_senses = reading.senses.iter().map(|sense| match *sense {
            Sense::Input(_) => [0.0; 2],
            Sense::Quantity(quantity) => self.rounding_of_quantity(quantity, at, rounding),
        });
        let (x, v) = of_nodes.chain(of_senses).map(|[x, v]| (x, v)).unzip();
        [x, v]
    }

    /// What rounding leaves open of a quantity and of its rate.
    pub(crate) fn rounding_of_quantity(&self, quantity: Quantity, at: &Evaluation, rounding: Rounding) -> [f64; 2] {
        // Itself it is rounded as a number of its size is.
        let own = [ROUNDED * at.value[self.value_index(quantity)].abs(), 0.0];
        self.slots_of(quantity).fold(own, |[x, v], slot| {
            let gradient = largest(&at.gradient[slot * self.dim..(slot + 1) * self.dim]);
            let [of_x, of_v] = self.rounding_of_node(self.slots.nodes[slot] as usize, rounding);
            [x + gradient * of_x, v + gradient * of_v]
        })
    }

    fn rounding_of_node(&self, node: usize, rounding: Rounding) -> [f64; 2] {
        if self.is_point[node] { rounding.of_points } else { rounding.of_directions }
    }
}

/// Numbers, each changed by so many `times` half of what is left open of it, or up to the whole of that; which of them up and which down depends on
/// the way.
pub(super) fn changed(numbers: &[f64], open: &[f64], way: usize, times: f64) -> Local {
    let by = |k: usize| {
        // No two ways have the same signs: multiples of the golden section are spread evenly.
        let spread = (((k + 1) * (way + 1)) as f64 * 0.618_033_988_749_895).fract() - 0.5;
        times * (spread + 0.5_f64.copysign(spread))
    };
    (0..).zip(numbers.iter().zip(open)).map(|(k, (number, open))| number + by(k) * open).collect()
}
