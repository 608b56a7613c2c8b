//! Velocities of steps gone by, and the derivatives that their differences show.

use serde::{Deserialize, Serialize};

/// Velocities that third derivatives are taken from, the present ones included.
const KEPT: usize = 4;

/// Times and velocities of some accepted steps, the latest first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Past {
    times: [f64; KEPT],
    velocities: [Vec<f64>; KEPT],
    count: usize,
}

impl Past {
    /// None yet, of `n` coordinates.
    pub fn new(n: usize) -> Self {
        Self { times: [0.0; KEPT], velocities: std::array::from_fn(|_| vec![0.0; n]), count: 0 }
    }

    /// How many there are to go by.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Goes by the latest `count` from now on.
    pub fn keep(&mut self, count: usize) {
        self.count = count;
    }

    /// Whether there are as many as there can be.
    pub fn is_full(&self) -> bool {
        self.count == KEPT
    }

    /// Whether they and the present velocities show third derivatives.
    pub fn tells_thirds(&self) -> bool {
        self.count + 1 >= KEPT
    }

    /// Takes note of a time (s) and its velocities (n and more).
    pub fn remember(&mut self, t: f64, v: &[f64]) {
        self.velocities.rotate_right(1);
        self.times.rotate_right(1);
        self.times[0] = t;
        let n = self.velocities[0].len();
        self.velocities[0].copy_from_slice(&v[..n]);
        self.count = (self.count + 1).min(KEPT);
    }

    /// The latest time, and the velocities then.
    pub fn latest(&self) -> (f64, &[f64]) {
        (self.times[0], &self.velocities[0])
    }

    /// Leaves out every other one, the latest but one first.
    pub fn thin(&mut self) {
        for k in 0..KEPT / 2 {
            self.times.swap(k, 2 * k);
            self.velocities.swap(k, 2 * k);
        }
        self.count = self.count.div_ceil(2);
    }

    /// How far back `k` steps go from `now`, s.
    pub fn back(&self, now: f64, k: usize) -> f64 {
        now - self.times[k - 1]
    }

    /// Divided differences of the velocities `latest` at `now` and of those before: the first, half a second, a sixth of a third derivative, as far
    /// as there are enough.
    pub fn differences(&self, i: usize, now: f64, latest: f64) -> [f64; KEPT - 1] {
        let t = |k: usize| if k == 0 { now } else { self.times[k - 1] };
        let v = |k: usize| if k == 0 { latest } else { self.velocities[k - 1][i] };
        let slope = |k: usize| (v(k) - v(k + 1)) / (t(k) - t(k + 1));
        let second = |k: usize| (slope(k) - slope(k + 1)) / (t(k) - t(k + 2));
        match self.count {
            0 => [0.0; 3],
            1 => [slope(0), 0.0, 0.0],
            2 => [slope(0), second(0), 0.0],
            _ => [slope(0), second(0), (second(0) - second(1)) / (t(0) - t(3))],
        }
    }
}
