//! Motions that a mechanism at rest is free for: all of them, or a space that has the slowest (methods §21).

use super::linear::{NoRest, Spot};
use super::places::Places;

/// Share of a motion's size that is left of it when it follows from those before: of one without order, and of what a step makes, in which the slow ones are
/// so much larger.
pub(super) const FOLLOWS: f64 = 1e-6;
const HARDLY: f64 = 1e-10;

/// The golden ratio in 64 bits.
const MIXING: u64 = 0x9e37_79b9_7f4a_7c15;

/// Independent motions q (n each) that the rows allow, with qᵀ M q = 1 each and 0 of two, and M q of each.
#[derive(Default)]
pub(crate) struct Motions {
    pub basis: Vec<Vec<f64>>,
    pub(super) momenta: Vec<Vec<f64>>,
}

/// A space of motions that steps of implicit Euler make of each other: of the motions in which it moves fast these leave least, so that it soon has the slow
/// ones. Positions and velocities times the length of the step are told by their shares of the motions, as in the two-level orthogonal Arnoldi process.
#[derive(Default)]
pub(crate) struct Slow {
    pub motions: Motions,
    /// Shares of positions and of velocities, orthonormal together.
    states: Vec<[Vec<f64>; 2]>,
    /// How many starts the states came of.
    starts: usize,
}

impl Places {
    /// Independent motions without order that the mechanism is free for where it was put last: all, or as many as are asked for.
    pub fn motions(&mut self, most: usize) -> Result<Motions, NoRest> {
        let count = self.freedom().min(most);
        let mut found = Motions::default();
        if !self.newton.factor_inertia(&self.work) {
            return Err(NoRest::Singular);
        }
        for number in 0..count {
            let q = self.newton.solve_along_rows(&self.scattered(number)).ok_or(NoRest::Singular)?;
            found.take(self, q, FOLLOWS).1.then_some(()).ok_or(NoRest::Massless)?;
        }
        Ok(found)
    }

    /// Adds motions to a space of slow ones until it has so many, with steps of length h from rest. They come of one of the starts, motions without order, and
    /// of what the steps make of that; of motions that are as fast as each other the first start has one, and the next ones have the others.
    pub fn slow_motions(&mut self, slow: &mut Slow, starts: &Motions, most: usize, spot: &Spot, h: f64) -> Result<(), NoRest> {
        self.factor_step(spot, h)?;
        let mut last = None;
        while slow.motions.basis.len() < most {
            let next = match last {
                Some(state) => Some(self.stepped(slow, state, h)?),
                None => self.begun(slow, starts)?,
            };
            let Some(state) = next else { break };
            last = slow.add(state);
        }
        Ok(())
    }

    /// A state at rest without order: the next of the starts or, where there are no more, what a step makes of momenta. `None` where nothing is left that is
    /// nearly as slow as the motions found.
    fn begun(&mut self, slow: &mut Slow, starts: &Motions) -> Result<Option<[Vec<f64>; 2]>, NoRest> {
        loop {
            let start = starts.basis.get(slow.starts).cloned();
            let is_last = start.is_none();
            let q = start.or_else(|| self.newton.solve_along_rows(&self.scattered(slow.starts))).ok_or(NoRest::Singular)?;
            slow.starts += 1;
            let (shares, is_new) = slow.motions.take(self, q, FOLLOWS);
            if is_new || is_last {
                let rates = vec![0.0; shares.len()];
                return Ok(is_new.then_some([shares, rates]));
            }
        }
    }

    /// What a step of length h, whose matrix is factored, makes of a state.
    fn stepped(&mut self, slow: &mut Slow, state: usize, h: f64) -> Result<[Vec<f64>; 2], NoRest> {
        let [q, hv] = slow.states[state].each_ref().map(|shares| slow.motions.sum(shares));
        let [momentum, more] = [&q, &hv].map(|motion| self.momentum(motion));
        let mut right = self.work.pushed_on(&self.system, &q, &momentum, h);
        right.iter_mut().zip(&more).for_each(|(right, more)| *right += more);
        let q = self.newton.solve_along_rows(&right).ok_or(NoRest::Singular)?;
        let shares = slow.motions.take(self, q, HARDLY).0;
        let before = slow.states[state][0].iter().chain(std::iter::repeat(&0.0));
        let rates = shares.iter().zip(before).map(|(share, before)| share - before).collect();
        Ok([shares, rates])
    }

    /// M q of the free coordinates.
    fn momentum(&self, q: &[f64]) -> Vec<f64> {
        let mut all = q.to_vec();
        all.resize(self.work.end.x.len(), 0.0);
        let mut out = vec![0.0; q.len()];
        self.system.mass.times(self.system.dim, &all, &mut out);
        out
    }

    /// Momenta without order, as large as nodes are heavy: what light ones do is then no rounding of the others.
    fn scattered(&self, number: usize) -> Vec<f64> {
        let n = self.system.coordinates();
        let weight = |k: usize| self.system.mass.diagonal(k / self.system.dim).sqrt();
        (0..n).map(|k| weight(k) * scattered(number * n + k)).collect()
    }
}

impl Motions {
    /// Adds what is left of a motion beside the others, unless it follows from them (what is left is that share of it), and gives its shares of all.
    fn take(&mut self, places: &Places, mut q: Vec<f64>, follows: f64) -> (Vec<f64>, bool) {
        let mut shares = vec![0.0; self.basis.len()];
        let whole = dot(&q, &places.momentum(&q));
        // What rounding leaves of the others after once is gone after twice.
        for _ in 0..2 {
            for (share, (other, momentum)) in shares.iter_mut().zip(self.basis.iter().zip(&self.momenta)) {
                let own = dot(&q, momentum);
                *share += own;
                q.iter_mut().zip(other).for_each(|(q, other)| *q -= own * other);
            }
        }
        let own = dot(&q, &places.momentum(&q));
        if own.is_nan() || own <= follows * follows * whole {
            return (shares, false);
        }
        let left = own.sqrt();
        q.iter_mut().for_each(|q| *q /= left);
        self.momenta.push(places.momentum(&q));
        self.basis.push(q);
        shares.push(left);
        (shares, true)
    }

    /// The motion that has these shares of the first ones.
    fn sum(&self, shares: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.basis.first().map_or(0, Vec::len)];
        for (motion, share) in self.basis.iter().zip(shares) {
            sum.iter_mut().zip(motion).for_each(|(sum, q)| *sum += share * q);
        }
        sum
    }
}

impl Slow {
    /// Adds what is left of a state beside the others, unless it follows from them, and gives its place among them.
    fn add(&mut self, mut state: [Vec<f64>; 2]) -> Option<usize> {
        let size = |[q, hv]: &[Vec<f64>; 2]| (dot(q, q) + dot(hv, hv)).sqrt();
        let whole = size(&state);
        for _ in 0..2 {
            for other in &self.states {
                // Those before have no shares of later motions.
                let own = dot(&state[0], &other[0]) + dot(&state[1], &other[1]);
                for (numbers, other) in state.iter_mut().zip(other) {
                    numbers.iter_mut().zip(other).for_each(|(number, other)| *number -= own * other);
                }
            }
        }
        let left = size(&state);
        (left > HARDLY * whole).then(|| {
            state.iter_mut().flatten().for_each(|number| *number /= left);
            self.states.push(state);
            self.states.len() - 1
        })
    }
}

/// Numbers between −½ and ½ without order. Fractional parts of squares have one: such vectors may follow from each other.
fn scattered(k: usize) -> f64 {
    let mixed = (0..3).fold(k as u64 + 1, |bits, _| (bits ^ (bits >> 32)).wrapping_mul(MIXING));
    mixed as f64 / u64::MAX as f64 - 0.5
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
