//! Where the joints of a mechanism lie to each other, from anywhere to singular.

use nalgebra::Vector3;

use crate::random::Random;

/// A pattern of places and axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// Anywhere, with an axis now and then that was there before.
    Anywhere,
    /// All axes parallel: planar mechanisms in space, whose loops have redundant rows.
    Parallel,
    /// On a grid with axes along it: many redundancies and right angles.
    Grid,
    /// All places on one line: stretched out and singular.
    Stretched,
}

/// Chooses places and axes.
pub struct Layout {
    pub dim: usize,
    pub pattern: Pattern,
    size: f64,
    /// The last axis.
    axis: Vector3<f64>,
}

impl Layout {
    pub fn new(random: &mut Random, dim: usize, size: f64) -> Self {
        let patterns = [Pattern::Anywhere, Pattern::Anywhere, Pattern::Anywhere, Pattern::Parallel, Pattern::Grid, Pattern::Stretched];
        let pattern = random.pick(&patterns);
        let axis = if pattern == Pattern::Anywhere || random.chance(0.5) { random.direction(dim) } else { Vector3::x() };
        Self { dim, pattern, size, axis }
    }

    /// From a place to the next, about as long as `length`.
    pub fn way(&mut self, random: &mut Random, length: f64) -> Vector3<f64> {
        match self.pattern {
            Pattern::Anywhere | Pattern::Parallel => random.direction(self.dim) * length * random.between(0.3, 1.0),
            Pattern::Grid => {
                let steps = random.pick(&[-2.0, -1.0, 1.0, 2.0]);
                self.unit(random) * (0.5 * self.size * steps)
            }
            Pattern::Stretched => self.axis * length * random.between(0.3, 1.0) * random.sign(),
        }
    }

    /// An axis of a joint.
    pub fn axis(&mut self, random: &mut Random) -> Vector3<f64> {
        match self.pattern {
            Pattern::Anywhere if !random.chance(0.2) => self.axis = random.direction(self.dim),
            Pattern::Anywhere | Pattern::Parallel => (),
            Pattern::Grid => self.axis = self.unit(random),
            Pattern::Stretched if self.dim == 3 && random.chance(0.5) => return random.across(&self.axis),
            Pattern::Stretched => (),
        }
        self.axis
    }

    fn unit(&self, random: &mut Random) -> Vector3<f64> {
        Vector3::ith(random.below(self.dim), 1.0)
    }
}
