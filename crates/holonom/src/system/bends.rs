//! Where forces jump or have kinks with what moves: numbers that go through zero there.

use serde::{Deserialize, Serialize};

use super::{Look, MAX_ARGUMENTS, System};

/// The laws and the loads whose forces bend, by their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bending {
    laws: Vec<usize>,
    loads: Vec<usize>,
}

/// What forces that bend depend on, at a time t (s): each number, and its rate.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Seen {
    t: f64,
    values: Vec<f64>,
    rates: Vec<f64>,
}

impl Seen {
    /// What is seen so much later, s, as it moves now.
    pub fn ahead(&self, later: f64) -> Self {
        let values = self.values.iter().zip(&self.rates).map(|(value, rate)| value + later * rate).collect();
        Self { t: self.t + later, values, rates: self.rates.clone() }
    }

    /// About what is seen at a share of the way to the next state: numbers by Hermite's cubic, and rates in a straight line, as those of the cubic
    /// are rounded over short ways.
    pub fn between(&self, next: &Self, share: f64) -> Self {
        let (step, s) = (next.t - self.t, share);
        let pairs = self.values.iter().zip(&self.rates).zip(next.values.iter().zip(&next.rates));
        let cubic = |((x, v), (y, w)): ((&f64, &f64), (&f64, &f64))| {
            let (rise, v, w) = (y - x, v * step, w * step);
            (x + s * (v + s * (3.0 * rise - 2.0 * v - w + s * (v + w - 2.0 * rise))), (v + s * (w - v)) / step)
        };
        let (values, rates) = pairs.map(cubic).unzip();
        Self { t: self.t + share * step, values, rates }
    }
}

impl System {
    /// The name of the force that has the number `bend` of those handed over.
    pub(crate) fn bending_force(&self, bend: usize) -> &str {
        let laws = self.bending.laws.iter().map(|&k| (self.count_of_law(k), &self.laws[k].name));
        let loads = self.bending.loads.iter().map(|&k| (self.count_of_load(k), &self.loads[k].name));
        let mut left = bend;
        let found = laws.chain(loads).find(|(count, _)| left.checked_sub(*count).map(|rest| left = rest).is_none());
        found.map_or("", |(_, name)| name)
    }

    /// How many numbers a law hands over.
    fn count_of_law(&self, k: usize) -> usize {
        let (law, nothing, mut count) = (&self.laws[k], [0.0; MAX_ARGUMENTS], 0);
        let nothing = &nothing[..law.arguments.len()];
        law.law.bends(nothing, nothing, 0.0, &mut |_| count += 1);
        count
    }

    /// How many numbers a load hands over.
    fn count_of_load(&self, k: usize) -> usize {
        let (load, mut count) = (&self.loads[k], 0);
        let nothing = vec![0.0; load.reading.nodes.len() * self.dim + load.reading.senses.len()];
        load.load.bends(&nothing, &nothing, 0.0, &mut |_| count += 1);
        count
    }

    /// The laws and loads whose forces bend.
    pub(super) fn find_bending(&self) -> Bending {
        let laws = (0..self.laws.len()).filter(|&k| self.count_of_law(k) > 0).collect();
        let loads = (0..self.loads.len()).filter(|&k| self.count_of_load(k) > 0).collect();
        Bending { laws, loads }
    }

    /// What the forces that bend depend on.
    pub(crate) fn see(&self, look: Look<'_>) -> Seen {
        let mut seen = Seen { t: look.t, ..Seen::default() };
        for law in self.bending.laws.iter().map(|k| &self.laws[*k]) {
            seen.values.extend_from_slice(&self.arguments(law, look.at)[..law.arguments.len()]);
            let rate = |quantity| self.along(&self.slots_of(quantity), &self.slots.nodes, look.at, look.v);
            seen.rates.extend(law.arguments.iter().map(|&quantity| rate(quantity)));
        }
        for load in self.bending.loads.iter().map(|k| &self.loads[*k]) {
            let [x, v] = self.read(&load.reading, look);
            seen.values.extend_from_slice(&x);
            seen.rates.extend_from_slice(&v);
        }
        seen
    }

    /// Numbers that go through zero where forces jump or have kinks, as many at every state.
    pub(crate) fn bends(&self, seen: &Seen) -> Vec<f64> {
        let (mut found, mut first) = (Vec::new(), 0);
        let mut next = |count: usize| {
            let range = first..first + count;
            first += count;
            (&seen.values[range.clone()], &seen.rates[range])
        };
        for law in self.bending.laws.iter().map(|k| &self.laws[*k]) {
            let (values, rates) = next(law.arguments.len());
            law.law.bends(values, rates, seen.t, &mut |bend| found.push(bend));
        }
        for load in self.bending.loads.iter().map(|k| &self.loads[*k]) {
            let (x, v) = next(load.reading.nodes.len() * self.dim + load.reading.senses.len());
            load.load.bends(x, v, seen.t, &mut |bend| found.push(bend));
        }
        found
    }
}
