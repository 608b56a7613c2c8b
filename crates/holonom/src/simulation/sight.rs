//! What is seen of forces that bend, at a state and on the way to the next.

use serde::{Deserialize, Serialize};

use crate::system::{Crossing, Seen, System};

/// Places at which the inside of a step is looked at: one of order 8 may be a turn long.
pub(super) const INSIDE: f64 = 8.0;

/// What is seen of forces that bend: what they depend on, and the numbers that go through zero where they do; next to nothing of one that has
/// been reached, with the sign that it has behind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Sight {
    pub seen: Seen,
    pub bends: Vec<f64>,
}

/// The first force that bends on a way.
pub(super) struct Passed {
    /// Its number.
    pub bend: usize,
    /// Shares of the way between which it does, and the numbers that go through zero there.
    pub shares: [f64; 2],
    pub values: [f64; 2],
}

impl Sight {
    /// The first of the forces that bends on the way to what is seen `at` the end, if one does.
    pub fn first_passed(&self, at: &Self, system: &System) -> Option<Passed> {
        if self.bends.is_empty() {
            return None;
        }
        let look = |share: f64| if share < 1.0 { system.bends(&self.seen.between(&at.seen, share)) } else { at.bends.clone() };
        let passed = |from: f64, last: &[f64], share: f64, bends: &[f64]| {
            let bend = (0..bends.len()).find(|&k| Crossing::Both.is_between(self.bends[k], bends[k]))?;
            Some(Passed { bend, shares: [from, share], values: [last[bend], bends[bend]] })
        };
        let mut before = self.bends.clone();
        let mut last = self.bends.clone();
        for part in 1..=INSIDE as u32 {
            let [from, share] = [part - 1, part].map(|part| f64::from(part) / INSIDE);
            let bends = look(share);
            // What comes near zero and goes away again may have been there: look where the parabola through three has its end.
            let near = (0..bends.len()).filter_map(|k| nearest([before[k], last[k], bends[k]])).filter(|_| part > 1);
            let turn = near.map(|place| from + place / INSIDE).find_map(|turn| passed(from.min(turn), &last, turn, &look(turn)));
            if let Some(first) = turn.or_else(|| passed(from, &last, share, &bends)) {
                return Some(first);
            }
            before = std::mem::replace(&mut last, bends);
        }
        None
    }

    /// Whether a force has bent so much later, s, as what it depends on moves now.
    pub fn is_beyond(&self, bend: usize, later: f64, system: &System) -> bool {
        Crossing::Both.is_between(self.bends[bend], system.bends(&self.seen.ahead(later))[bend])
    }

    /// How long it takes until a force bends, s, as what it depends on moves now and for a while, s; no number where nothing tells.
    pub fn left(&self, bend: usize, a_while: f64, system: &System) -> f64 {
        a_while * self.bends[bend] / (self.bends[bend] - system.bends(&self.seen.ahead(a_while))[bend])
    }

    /// Counts a bend as reached, on the way from `before`, and all that are the same.
    pub fn reach(&mut self, bend: usize, before: &Self) {
        let (here, behind) = (self.bends[bend], REACHED.copysign(-before.bends[bend]));
        self.bends.iter_mut().filter(|now| **now == here).for_each(|now| *now = behind);
    }
}

/// The number of a bend that has been reached, with the sign that it has behind.
pub(super) const REACHED: f64 = f64::MIN_POSITIVE;

/// Where a parabola through values at −1, 0 and 1 is nearest to zero, if that is between −1 and 1 and not beyond zero by these values already.
fn nearest([before, middle, after]: [f64; 3]) -> Option<f64> {
    let (slope, bend) = (0.5 * (after - before), after - 2.0 * middle + before);
    let place = -slope / bend;
    (middle * bend > 0.0 && place.abs() < 1.0).then_some(place)
}
