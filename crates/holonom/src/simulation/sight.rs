//! What is seen of forces that bend, at a state and on the way to the next.

use std::ops::Deref;

use serde::{Deserialize, Serialize};

use super::golden::highest;
use crate::system::{Seen, System};

/// Places at which the inside of a step is looked at: one of order 8 may be a turn long.
pub(super) const INSIDE: f64 = 8.0;

/// What is seen of forces that bend: what they depend on, the numbers that go through zero at their corners (of one that has been reached with the
/// sign that it has behind), and the logarithms that are largest where they have peaks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Sight {
    pub seen: Seen,
    #[serde(with = "super::any_number")]
    pub corners: Vec<f64>,
    pub reached: Vec<bool>,
    #[serde(with = "super::any_number")]
    pub peaks: Vec<f64>,
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
    /// The first of the forces that bends on the way to what is seen `at` the end, if one does by more than what is left `open` of what it depends on.
    pub fn first_passed(&self, at: &Self, system: &System, open: &impl Deref<Target = Seen>) -> Option<Passed> {
        if self.corners.is_empty() {
            return None;
        }
        let look = |share: f64| {
            let seen = if share < 1.0 { self.seen.between(&at.seen, share) } else { at.seen.clone() };
            let corners = system.bends(&seen).corners;
            (seen, corners)
        };
        let passed = |from: f64, last: &[f64], share: f64, (seen, bends): &(Seen, Vec<f64>)| {
            let bend = (0..bends.len()).find(|&k| self.is_passed(k, bends[k]) && !self.rests(k, seen, system, open))?;
            Some(Passed { bend, shares: [from, share], values: [last[bend], bends[bend]] })
        };
        let mut before = self.corners.clone();
        let mut last = self.corners.clone();
        for part in 1..=INSIDE as u32 {
            let [from, share] = [part - 1, part].map(|part| f64::from(part) / INSIDE);
            let here = look(share);
            // What comes near zero and goes away again may have been there: look where the parabola through three has its end.
            let near = (0..last.len()).filter_map(|k| nearest([before[k], last[k], here.1[k]])).filter(|_| part > 1);
            let turn = near.map(|place| from + place / INSIDE).find_map(|turn| passed(from.min(turn), &last, turn, &look(turn)));
            if let Some(first) = turn.or_else(|| passed(from, &last, share, &here)) {
                return Some(first);
            }
            before = std::mem::replace(&mut last, here.1);
        }
        None
    }

    /// When a force has bent at one of the `stages` of a step (s) that ends on the side where it began: it was turned back by what acts on the other side,
    /// and hardly any of that may be in the estimate of its error.
    pub fn first_of(&self, stages: &[Seen], system: &System, open: &impl Deref<Target = Seen>) -> Option<f64> {
        let bends = |seen: &&Seen| {
            let corners = system.bends(seen).corners;
            (0..corners.len()).any(|bend| self.is_passed(bend, corners[bend]) && !self.rests(bend, seen, system, open))
        };
        stages.iter().find(bends).map(|seen| seen.t)
    }

    /// The share of the way to what is seen `at` the end after which a force has a peak of which neither end shows anything.
    pub fn first_hidden(&self, at: &Self, system: &System) -> Option<f64> {
        if self.peaks.is_empty() {
            return None;
        }
        let look = |share: f64| system.bends(&self.seen.between(&at.seen, share)).peaks;
        let look_at = |shares: &[f64]| -> Vec<Vec<f64>> {
            let inside = shares[1..shares.len() - 1].iter().map(|&share| look(share));
            std::iter::once(self.peaks.clone()).chain(inside).chain([at.peaks.clone()]).collect()
        };
        // Right behind the beginning and right before the end it is seen whether peaks are near them.
        let few = look_at(&[0.0, NEAR_END, 0.4, 0.6, 1.0 - NEAR_END, 1.0]);
        let falls_after_rise = |peak: usize| {
            let mut pairs = few.windows(2).map(|pair| pair[1][peak] - pair[0][peak]);
            pairs.any(|rise| rise > 0.0) && pairs.any(|rise| rise < 0.0)
        };
        if !(0..self.peaks.len()).any(falls_after_rise) {
            return None;
        }
        let inside = (1..INSIDE as u32).map(|part| f64::from(part) / INSIDE);
        let shares: Vec<f64> = [0.0, NEAR_END].into_iter().chain(inside).chain([1.0 - NEAR_END, 1.0]).collect();
        let (last, looks) = (shares.len() - 1, look_at(&shares));
        let hidden = |k: usize, peak: usize| {
            let [before, middle, after] = [k - 1, k, k + 1].map(|look| looks[look][peak]);
            let is_top = middle >= before && middle >= after && middle > before.min(after);
            let (share, height) =
                is_top.then(|| highest(|share| look(share)[peak], [shares[k - 1], shares[k + 1]], |left, _| left <= FOUND))?;
            (height - self.peaks[peak].max(at.peaks[peak]) > HIDDEN).then_some(share)
        };
        (1..last).find_map(|k| (0..self.peaks.len()).find_map(|peak| hidden(k, peak)))
    }

    /// Whether a peak of a force is gone at a share of the way to what is seen `at` the end, beside the logarithms `there` that they have at one of
    /// both ends.
    pub fn is_gone(&self, at: &Self, share: f64, there: &[f64], system: &System) -> bool {
        let gone = |(there, here): (&f64, &f64)| there - here > HIDDEN;
        !there.is_empty() && there.iter().zip(&system.bends(&self.seen.between(&at.seen, share)).peaks).any(gone)
    }

    /// Whether a force has bent so much later, s, as what it depends on moves now.
    pub fn is_beyond(&self, bend: usize, later: f64, system: &System) -> bool {
        self.is_passed(bend, system.bends(&self.seen.ahead(later)).corners[bend])
    }

    /// The first force that has, and that has not been at its kink `before` already.
    pub fn first_beyond(&self, before: &Self, later: f64, system: &System, open: &impl Deref<Target = Seen>) -> Option<usize> {
        if self.corners.is_empty() {
            return None;
        }
        let ahead = system.bends(&self.seen.ahead(later)).corners;
        (0..ahead.len())
            .find(|&bend| !self.reached[bend] && self.is_passed(bend, ahead[bend]) && !before.rests(bend, &self.seen, system, open))
    }

    /// Whether a force is at a kink here and at another state as far as can be told: what takes it across there is no motion.
    fn rests(&self, bend: usize, there: &Seen, system: &System, open: &impl Deref<Target = Seen>) -> bool {
        [&self.seen, there].iter().all(|seen| system.is_at_kink(bend, seen, open))
    }

    /// How long it takes until a force bends, s, as what it depends on moves now and for a while, s; no number where nothing tells.
    pub fn left(&self, bend: usize, a_while: f64, system: &System) -> f64 {
        a_while * self.corners[bend] / (self.corners[bend] - system.bends(&self.seen.ahead(a_while)).corners[bend])
    }

    /// Whether the number of a bend is at zero now, where forces may be those of what follows already, or on the other side. One that stays at zero
    /// there, as what is clipped does, passes it where it is clipped; one that was reached a little before zero is back where it is farther from there
    /// than it was.
    fn is_passed(&self, bend: usize, now: f64) -> bool {
        let from = self.corners[bend];
        let is_beyond = (from < 0.0 && now >= 0.0) || (from > 0.0 && now <= 0.0);
        is_beyond && (!self.reached[bend] || now.abs() > BACK * from.abs())
    }

    /// Counts a bend as reached, on the way from `before` that took `step` s, and all that are the same.
    pub fn reach(&mut self, bend: usize, before: &Self, step: f64, system: &System) {
        self.same(bend, step, system).into_iter().for_each(|k| self.turn(k, -before.corners[k]));
    }

    /// Counts a bend that is reached at the beginning of a step of length `step` (s) as passed, and all that are the same. Says whether it had been
    /// reached: what passes it comes back. One that is the same but for rounding may have been reached alone, and has not come back with it.
    pub fn pass(&mut self, bend: usize, step: f64, system: &System) -> bool {
        let comes_back = self.reached[bend];
        for k in self.same(bend, step, system) {
            if self.reached[k] == comes_back {
                self.turn(k, -self.corners[k]);
            }
        }
        comes_back
    }

    /// The bends whose numbers are those of one of them but for the sign, here and where what they depend on would be a step later: beside zero
    /// others may have the same digits.
    fn same(&self, bend: usize, step: f64, system: &System) -> Vec<usize> {
        let looks = [&self.seen, &self.seen.ahead(step)].map(|seen| system.bends(seen).corners);
        let is_same = |k: usize| looks.iter().all(|at| at[k] == at[bend]) || looks.iter().all(|at| at[k] == -at[bend]);
        (0..self.corners.len()).filter(|&k| k == bend || is_same(k)).collect()
    }

    fn turn(&mut self, bend: usize, behind: f64) {
        self.corners[bend] = self.corners[bend].abs().max(f64::MIN_POSITIVE).copysign(behind);
        self.reached[bend] = true;
    }
}

/// What was reached is back where it is so many times farther from zero than it was then.
const BACK: f64 = 2.0;

/// By how much the logarithm of a peak is higher than at both ends of a step that does not see it.
const HIDDEN: f64 = 1.0;

/// Share of a step from its ends within which peaks are not looked for, and to which their places are found.
const NEAR_END: f64 = 1e-6;
const FOUND: f64 = 1e-12;

/// Where a parabola through values at −1, 0 and 1 is nearest to zero, if that is between −1 and 1 and not beyond zero by these values already.
fn nearest([before, middle, after]: [f64; 3]) -> Option<f64> {
    let (slope, bend) = (0.5 * (after - before), after - 2.0 * middle + before);
    let place = -slope / bend;
    (middle * bend > 0.0 && place.abs() < 1.0).then_some(place)
}
