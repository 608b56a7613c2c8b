//! Corners of forces within what is left open of a state: whether that takes it from one side to the other, and whether the force jumps there.

use super::bends::Bent;
use super::rounding::{WAYS, changed};
use super::{Bends, Evaluation, Local, Rounding, Seen, System};

/// How many times what is left open makes a force change by about as many times more at a kink, and by the same at a jump.
const FAR: f64 = 1e3;

/// Which share of that tells them apart.
const JUMPS: f64 = 0.01;

impl System {
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
