//! Where forces jump or have kinks with what moves, and where they may have peaks.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::evaluate::Local;
use super::{Bend, LawEntry, LoadEntry, Look, Response, Sense, System};

/// The laws and the loads whose forces bend, by their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Bending {
    laws: Vec<usize>,
    /// Those of them that may have peaks.
    peaked: Vec<usize>,
    loads: Vec<usize>,
    /// Of each of them, laws first, which of the numbers seen are its own, and which of the corners.
    pub(super) seen: Vec<Range<usize>>,
    pub(super) corners: Vec<Range<usize>>,
    /// Those of all that have corners with what moves, and not with time alone.
    switching: Vec<usize>,
}

/// What forces that bend depend on, at a time t (s): each number, and its rate.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Seen {
    pub t: f64,
    pub(super) values: Vec<f64>,
    pub(super) rates: Vec<f64>,
}

/// Where forces bend, as much at every state: numbers that go through zero at corners, and logarithms that are largest at peaks.
#[derive(Default)]
pub(crate) struct Bends {
    pub corners: Vec<f64>,
    pub peaks: Vec<f64>,
}

/// Two numbers that nobody writes into a model.
const PLACES: [f64; 2] = [0.577_215_664_901_532_9, 0.915_965_594_177_219];

/// Halves by which a corner is closed in on: what is left of the way is its rounding.
const HALVES: u32 = 50;

/// Share of a force by which it must differ on the two sides of a corner to jump there.
const JUMP: f64 = 0.5;

/// A law or a load, the force of which may bend.
#[derive(Clone, Copy)]
pub(super) enum Bent<'a> {
    Law(&'a LawEntry),
    Load(&'a LoadEntry),
}

impl<'a> Bent<'a> {
    pub fn name(self) -> &'a str {
        match self {
            Self::Law(law) => &law.name,
            Self::Load(load) => &load.name,
        }
    }

    /// On how many numbers it depends, in so many dimensions.
    pub fn width(self, dim: usize) -> usize {
        match self {
            Self::Law(law) => law.arguments.len(),
            Self::Load(load) => load.reading.nodes.len() * dim + load.reading.senses.len(),
        }
    }

    /// Hands over where it bends.
    pub fn bends(self, x: &[f64], v: &[f64], t: f64, out: &mut Bends) {
        let note = &mut |bend| out.take(bend);
        match self {
            Self::Law(law) => law.law.bends(x, v, t, note),
            Self::Load(load) => load.load.bends(x, v, t, note),
        }
    }

    /// How many corners and peaks it tells of, in so many dimensions.
    pub fn count(self, dim: usize) -> [usize; 2] {
        let (nothing, mut bends) = (Local::from_elem(0.0, self.width(dim)), Bends::default());
        self.bends(&nothing, &nothing, 0.0, &mut bends);
        [bends.corners.len(), bends.peaks.len()]
    }

    /// Whether it has corners that move where the numbers of what moves do that it depends on; inputs stay.
    fn switches(self, dim: usize) -> bool {
        let corners = |number: f64| {
            let (mut numbers, mut bends) = (Local::from_elem(number, self.width(dim)), Bends::default());
            if let Self::Load(LoadEntry { reading, .. }) = self {
                let senses = numbers[reading.nodes.len() * dim..].iter_mut().zip(&reading.senses);
                senses.filter(|(_, sense)| matches!(sense, Sense::Input(_))).for_each(|(number, _)| *number = 1.0);
            }
            self.bends(&numbers, &numbers, 0.0, &mut bends);
            bends.corners
        };
        corners(PLACES[0]) != corners(PLACES[1])
    }

    /// Its forces on these numbers.
    pub fn force(self, x: &[f64], v: &[f64], t: f64) -> Local {
        match self {
            Self::Law(law) => {
                let mut out = Response::default();
                law.law.at(x, v, t, &mut out);
                out.force[..x.len()].iter().copied().collect()
            }
            Self::Load(load) => {
                let mut force = Local::from_elem(0.0, x.len());
                load.load.force(x, v, t, &mut force);
                force
            }
        }
    }
}

impl Bending {
    /// The law or load that has a corner.
    pub fn force_of(&self, corner: usize) -> usize {
        self.corners.partition_point(|own| own.end <= corner)
    }
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

    /// What is seen at a share of the straight way to another state.
    fn mixed(&self, other: &Self, share: f64) -> Self {
        let mix = |from: f64, to: f64| from + share * (to - from);
        let all = |from: &[f64], to: &[f64]| from.iter().zip(to).map(|(from, to)| mix(*from, *to)).collect();
        Self { t: mix(self.t, other.t), values: all(&self.values, &other.values), rates: all(&self.rates, &other.rates) }
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
        self.bent(self.bending.force_of(corner)).name()
    }

    /// One of the laws and loads whose forces bend, in the order in which their numbers are seen.
    pub(super) fn bent(&self, number: usize) -> Bent<'_> {
        match self.bending.laws.get(number) {
            Some(&law) => Bent::Law(&self.laws[law]),
            None => Bent::Load(&self.loads[self.bending.loads[number - self.bending.laws.len()]]),
        }
    }

    /// The laws and loads whose forces bend.
    pub(super) fn find_bending(&self) -> Bending {
        let of_laws: Vec<[usize; 2]> = self.laws.iter().map(|law| Bent::Law(law).count(self.dim)).collect();
        let of_loads: Vec<[usize; 2]> = self.loads.iter().map(|load| Bent::Load(load).count(self.dim)).collect();
        let bending = |told: &[[usize; 2]]| -> Vec<usize> { (0..told.len()).filter(|&k| told[k] != [0; 2]).collect() };
        let (laws, loads) = (bending(&of_laws), bending(&of_loads));
        let bent = laws.iter().map(|&k| Bent::Law(&self.laws[k])).chain(loads.iter().map(|&k| Bent::Load(&self.loads[k])));
        let switching = bent.enumerate().filter(|(_, bent)| bent.switches(self.dim)).map(|(number, _)| number).collect();
        let widths = laws.iter().map(|&k| Bent::Law(&self.laws[k])).chain(loads.iter().map(|&k| Bent::Load(&self.loads[k])));
        let corners = laws.iter().map(|&k| of_laws[k][0]).chain(loads.iter().map(|&k| of_loads[k][0]));
        Bending {
            seen: one_after_the_other(widths.map(|bent| bent.width(self.dim))),
            corners: one_after_the_other(corners),
            switching,
            peaked: laws.iter().copied().filter(|&k| of_laws[k][1] > 0).collect(),
            laws,
            loads,
        }
    }

    /// Whether any force bends.
    pub(crate) fn has_bends(&self) -> bool {
        !self.bending.seen.is_empty()
    }

    /// Names of the forces that bend with what moves, and not with time alone, in the order of [`System::acting`].
    pub(crate) fn switching_forces(&self) -> impl Iterator<Item = &str> {
        self.bending.switching.iter().map(|&number| self.bent(number).name())
    }

    /// The sizes of these forces at a state, and the power that they have there, W.
    pub(crate) fn acting(&self, look: Look<'_>) -> impl Iterator<Item = [f64; 2]> {
        self.bending.switching.iter().map(move |&number| self.acts(self.bent(number), look))
    }

    /// The power of each law and then of each load at a state, W: of a law what it takes, of a load what it gives.
    pub(crate) fn powers(&self, look: Look<'_>) -> impl Iterator<Item = f64> {
        let all = self.laws.iter().map(Bent::Law).chain(self.loads.iter().map(Bent::Load));
        all.map(move |force| self.acts(force, look)[1])
    }

    fn acts(&self, force: Bent<'_>, look: Look<'_>) -> [f64; 2] {
        let size = |force: &[f64]| force.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let power = |force: &[f64], rates: &[f64]| force.iter().zip(rates).map(|(force, rate)| force * rate).sum();
        match force {
            Bent::Law(law) => {
                let mut own = Response::default();
                let rates = self.respond(law, look.at, look.v, look.t, &mut own);
                let force = &own.force[..law.arguments.len()];
                [size(force), power(force, &rates)]
            }
            Bent::Load(load) => {
                let mut force = Local::from_elem(0.0, load.nodes.len() * self.dim);
                self.load_forces(load, look, &mut force);
                let parts = force.chunks_exact(self.dim).zip(&load.nodes);
                let power = parts.map(|(force, node)| power(force, &look.v[node.index() * self.dim..])).sum();
                [size(&force), power]
            }
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
            let [x, v] = &self.read(&load.reading, look);
            seen.values.extend_from_slice(x);
            seen.rates.extend_from_slice(v);
        }
        seen
    }

    /// The force, by name, that jumps on the straight way from one state to another. Each corner on the way is closed in on, and the forces on its two
    /// sides are compared there.
    pub(crate) fn jumping_between(&self, from: &Seen, to: &Seen) -> Option<&str> {
        let [first, last] = [from, to].map(|seen| self.bends(seen).corners);
        (0..first.len()).filter(|&corner| first[corner] * last[corner] < 0.0).find_map(|corner| {
            let mut sides = [0.0, 1.0];
            for _ in 0..HALVES {
                let middle = 0.5 * (sides[0] + sides[1]);
                let is_before = self.bends(&from.mixed(to, middle)).corners[corner] * first[corner] > 0.0;
                sides[usize::from(!is_before)] = middle;
            }
            let number = self.bending.force_of(corner);
            let (force, own) = (self.bent(number), self.bending.seen[number].clone());
            let [before, behind, first, last] = [sides[0], sides[1], 0.0, 1.0].map(|share| {
                let seen = from.mixed(to, share);
                force.force(&seen.values[own.clone()], &seen.rates[own.clone()], seen.t)
            });
            // A force that goes through zero at a corner differs there by little of what it is on the way.
            let size = before.iter().chain(&behind).chain(&first).chain(&last).fold(0.0_f64, |most, force| most.max(force.abs()));
            before.iter().zip(&behind).any(|(before, behind)| (before - behind).abs() > JUMP * size).then(|| force.name())
        })
    }

    /// Where forces bend.
    pub(crate) fn bends(&self, seen: &Seen) -> Bends {
        let mut found = Bends::default();
        for (number, own) in self.bending.seen.iter().enumerate() {
            self.bent(number).bends(&seen.values[own.clone()], &seen.rates[own.clone()], seen.t, &mut found);
        }
        found
    }
}

/// Ranges of these lengths.
fn one_after_the_other(lengths: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let next = |first: &mut usize, length| {
        let range = *first..*first + length;
        *first = range.end;
        Some(range)
    };
    lengths.scan(0, next).collect()
}
