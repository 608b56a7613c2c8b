//! Corners of forces within what is left open of a state: whether that takes it from one side to the other, and whether the force jumps there.

use super::bends::Bent;
use super::rounding::{WAYS, changed};
use super::{Bends, Evaluation, Local, Rounding, Seen, System};

/// How many times what is left open makes a force change by about as many times more at a kink, and by the same at a jump.
const FAR: f64 = 1e3;

/// Which share of that tells them apart.
const JUMPS: f64 = 0.01;

/// By what share of the slope of a force that on the other side of a kink differs.
const STEEPER: f64 = 0.01;

/// A way that is so much shorter, and the least share of what slopes differ by on the whole that is left on it: of a curve less is left.
const SHORTER: f64 = 0.1;
const KINKED: f64 = 0.03;

/// The least share of what a force that jumps changes by on the whole that is left on it, in both directions alike: of a slope as much as the way is shorter.
const JUMPED: f64 = 0.5;

/// Roundings of a force that are no difference.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

impl System {
    /// The names of the forces that jump or have kinks at a place at rest, `seen` with the rates of a motion that goes through it, of which rounding leaves
    /// some `open`: so far, in seconds of it, or so many times as fast.
    pub(crate) fn kinked(&self, seen: &Seen, open: &Seen, [way, pace]: [f64; 2]) -> impl Iterator<Item = &str> {
        let bent = (0..self.bending.seen.len()).map(|number| (self.bent(number), self.bending.seen[number].clone()));
        bent.filter(move |(force, own)| {
            let moves = |(rate, open): (&f64, &f64)| if rate.abs() > FAR * open { *rate } else { 0.0 };
            let x = &seen.values[own.clone()];
            let rates: Local = seen.rates[own.clone()].iter().zip(&open.rates[own.clone()]).map(moves).collect();
            let at = |way: f64, pace: f64| {
                let x: Local = x.iter().zip(&rates).map(|(x, rate)| x + way * rate).collect();
                let v: Local = rates.iter().map(|rate| pace * rate).collect();
                force.force(&x, &v, seen.t)
            };
            let here = at(0.0, 0.0);
            let most = |of: &dyn Fn(usize) -> f64| (0..here.len()).fold(0.0, |most: f64, k| most.max(of(k).abs()));
            let rounding = ROUNDED * most(&|k| here[k]);
            // What slopes differ by to both sides, and what the force changes by in all.
            let differ = |way: f64, pace: f64| {
                let [up, down] = [at(way, pace), at(-way, -pace)];
                [most(&|k| (up[k] - here[k]) - (here[k] - down[k])), most(&|k| up[k] - down[k])]
            };
            [[way, 0.0], [0.0, pace]].iter().any(|[way, pace]| {
                let [whole, change] = differ(*way, *pace);
                let [part, left] = differ(SHORTER * way, SHORTER * pace);
                let is_kink = whole > STEEPER * change && part > KINKED * whole && part > rounding;
                is_kink || (left > JUMPED * change && left > rounding)
            })
        })
        .map(|(force, _)| force.name())
    }

    /// What is left open of what the forces that bend depend on, and of its rates.
    pub(crate) fn open(&self, at: &Evaluation, rounding: Rounding) -> Seen {
        let mut open = Seen::default();
        for number in 0..self.bending.seen.len() {
            let [values, rates] = match self.bent(number) {
                Bent::Law(law) => {
                    let of_arguments = law.arguments.iter().map(|argument| self.rounding_of_quantity(*argument, at, rounding));
                    let (values, rates) = of_arguments.map(|[value, rate]| (value, rate)).unzip();
                    [values, rates]
                }
                Bent::Load(load) => self.rounding_of_reading(&load.reading, at, rounding),
            };
            open.values.extend_from_slice(&values);
            open.rates.extend_from_slice(&rates);
        }
        open
    }

    /// Whether a corner is no more than a kink, and what is left `open` takes what is `seen` from one side of it to the other.
    pub(crate) fn is_at_kink(&self, corner: usize, seen: &Seen, open: &Seen) -> bool {
        let force = self.bending.force_of(corner);
        let number = |way: usize, times: f64| {
            let ([x, v], mut bends) = (self.changed(force, seen, open, way, times), Bends::default());
            self.bent(force).bends(&x, &v, seen.t, &mut bends);
            bends.corners[corner - self.bending.corners[force].start]
        };
        let mut across = (0..WAYS).filter(|&way| number(way, 1.0) * number(way, -1.0) <= 0.0).peekable();
        across.peek().is_some() && across.all(|way| self.with_same_name(force).all(|force| self.is_kink(force, seen, open, way)))
    }

    /// Whether a force changes so many times more where what it depends on changes as much more in a way.
    fn is_kink(&self, force: usize, seen: &Seen, open: &Seen, way: usize) -> bool {
        let change = |times: f64| {
            let [up, down] = [times, -times].map(|times| {
                let [x, v] = self.changed(force, seen, open, way, times);
                self.bent(force).force(&x, &v, seen.t)
            });
            up.iter().zip(&down).fold(0.0, |most: f64, (up, down)| most.max((up - down).abs()))
        };
        change(1.0) <= JUMPS * change(FAR)
    }

    /// The forces of one name, as what pulls and what damps of a rope: they follow each other.
    fn with_same_name(&self, force: usize) -> impl Iterator<Item = usize> {
        let name = self.bent(force).name();
        let is_same = move |other: &usize| self.bent(*other).name() == name;
        let (before, behind) = ((0..force).rev(), force..self.bending.seen.len());
        before.take_while(is_same).chain(behind.take_while(is_same))
    }

    /// What a force sees, and its rates, changed in a way by so many `times` what is left open of them.
    fn changed(&self, force: usize, seen: &Seen, open: &Seen, way: usize, times: f64) -> [Local; 2] {
        let own = self.bending.seen[force].clone();
        [(&seen.values, &open.values), (&seen.rates, &open.rates)].map(|(of, by)| changed(&of[own.clone()], &by[own.clone()], way, times))
    }
}
