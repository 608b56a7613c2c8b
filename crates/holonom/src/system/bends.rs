//! Where forces jump or have kinks with what moves, and where they may have peaks.

use serde::{Deserialize, Serialize};

use super::{Bend, Look, MAX_ARGUMENTS, System};

/// The laws and the loads whose forces bend, by their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bending {
    laws: Vec<usize>,
    /// Those of them that may have peaks.
    peaked: Vec<usize>,
    loads: Vec<usize>,
}

/// What forces that bend depend on, at a time t (s): each number, and its rate.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Seen {
    t: f64,
    values: Vec<f64>,
    rates: Vec<f64>,
}

/// Where forces bend, as much at every state: numbers that go through zero at corners, and logarithms that are largest at peaks.
#[derive(Default)]
pub(crate) struct Bends {
    pub corners: Vec<f64>,
    pub peaks: Vec<f64>,
}

impl Bends {
    fn take(&mut self, bend: Bend) {
        match bend {
            Bend::Corner(number) => self.corners.push(number),
            Bend::Peak(logarithm) => self.peaks.push(logarithm),
        }
    }
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
    /// The name of the force that has a corner.
    pub(crate) fn cornering_force(&self, corner: usize) -> &str {
        let laws = self.bending.laws.iter().map(|&k| (self.bends_of_law(k), &self.laws[k].name));
        let loads = self.bending.loads.iter().map(|&k| (self.bends_of_load(k), &self.loads[k].name));
        let mut left = corner;
        let found = laws.chain(loads).find(|([corners, _], _)| left.checked_sub(*corners).map(|rest| left = rest).is_none());
        found.map_or("", |(_, name)| name)
    }

    /// How many corners and peaks a law tells of.
    fn bends_of_law(&self, k: usize) -> [usize; 2] {
        let (law, nothing, mut bends) = (&self.laws[k], [0.0; MAX_ARGUMENTS], Bends::default());
        let nothing = &nothing[..law.arguments.len()];
        law.law.bends(nothing, nothing, 0.0, &mut |bend| bends.take(bend));
        [bends.corners.len(), bends.peaks.len()]
    }

    /// How many corners and peaks a load tells of.
    fn bends_of_load(&self, k: usize) -> [usize; 2] {
        let (load, mut bends) = (&self.loads[k], Bends::default());
        let nothing = vec![0.0; load.reading.nodes.len() * self.dim + load.reading.senses.len()];
        load.load.bends(&nothing, &nothing, 0.0, &mut |bend| bends.take(bend));
        [bends.corners.len(), bends.peaks.len()]
    }

    /// The laws and loads whose forces bend.
    pub(super) fn find_bending(&self) -> Bending {
        let told: Vec<[usize; 2]> = (0..self.laws.len()).map(|k| self.bends_of_law(k)).collect();
        Bending {
            laws: (0..told.len()).filter(|&k| told[k] != [0; 2]).collect(),
            peaked: (0..told.len()).filter(|&k| told[k][1] > 0).collect(),
            loads: (0..self.loads.len()).filter(|&k| self.bends_of_load(k) != [0; 2]).collect(),
        }
    }

    /// The laws that may have peaks, by their numbers.
    pub(crate) fn peaked_laws(&self) -> impl Iterator<Item = usize> {
        self.bending.peaked.iter().copied()
    }

    /// What the forces that bend depend on.
    pub(crate) fn see(&self, look: Look<'_>) -> Seen {
        let mut seen = Seen { t: look.t, ..Seen::default() };
        for law in self.bending.laws.iter().map(|k| &self.laws[*k]) {
            let [values, rates] = self.arguments_and_rates(law, look.at, look.v);
            seen.values.extend_from_slice(&values[..law.arguments.len()]);
            seen.rates.extend_from_slice(&rates[..law.arguments.len()]);
        }
        for load in self.bending.loads.iter().map(|k| &self.loads[*k]) {
            let [x, v] = self.read(&load.reading, look);
            seen.values.extend_from_slice(&x);
            seen.rates.extend_from_slice(&v);
        }
        seen
    }

    /// Where forces bend.
    pub(crate) fn bends(&self, seen: &Seen) -> Bends {
        let (mut found, mut first) = (Bends::default(), 0);
        let mut next = |count: usize| {
            let range = first..first + count;
            first += count;
            (&seen.values[range.clone()], &seen.rates[range])
        };
        for law in self.bending.laws.iter().map(|k| &self.laws[*k]) {
            let (values, rates) = next(law.arguments.len());
            law.law.bends(values, rates, seen.t, &mut |bend| found.take(bend));
        }
        for load in self.bending.loads.iter().map(|k| &self.loads[*k]) {
            let (x, v) = next(load.reading.nodes.len() * self.dim + load.reading.senses.len());
            load.load.bends(x, v, seen.t, &mut |bend| found.take(bend));
        }
        found
    }
}
