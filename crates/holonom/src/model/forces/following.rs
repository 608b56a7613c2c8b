//! Numbers of springs and ropes that follow time, inputs or what moves, and the loads that take the place of laws then: their work is no
//! change of a potential, and is booked.

use num_dual::Dual;
use smallvec::SmallVec;

use super::rope_laws::{is_taut, taken_up};
use crate::model::assembly::Assembly;
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::Number;
use crate::model::signals::{ROOM, Reader, Readings};
use crate::system::{Bend, ForceFunction, Number as AnyNumber};

/// The value of a key.
pub(super) enum Follows {
    /// A number.
    Known(f64),
    /// A formula of the time and of what is read.
    Formula(Program),
}

impl Follows {
    /// Reads a key: a number passes `check`, a formula may name what moves.
    pub fn read(
        assembly: &mut Assembly<'_>,
        readings: &mut Readings,
        (entry, key): (&Entry<'_>, &str),
        number: &Number,
        check: impl FnOnce(&Number, &Entry<'_>, &str) -> Read<f64>,
    ) -> Read<Self> {
        let program = number.formula_reading(entry, key, &["t"], &mut Reader::new(assembly, entry, readings))?;
        match program.as_constant() {
            Some(_) => check(number, entry, key).map(Self::Known),
            None => Ok(Self::Formula(program)),
        }
    }

    /// The same of a key that may be left out.
    pub fn optional(
        assembly: &mut Assembly<'_>,
        readings: &mut Readings,
        (entry, key): (&Entry<'_>, &str),
        number: &Option<Number>,
        check: impl FnOnce(&Number, &Entry<'_>, &str) -> Read<f64>,
    ) -> Read<Option<Self>> {
        entry.optional(key, number, |number, entry, key| Self::read(assembly, readings, (entry, key), number, check))
    }

    /// The number, where it is one.
    pub fn known(&self) -> Option<f64> {
        if let Self::Known(number) = self { Some(*number) } else { None }
    }

    pub fn is_formula(&self) -> bool {
        self.known().is_none()
    }

    fn bends(&self, read: &[f64], note: &mut dyn FnMut(Bend)) {
        if let Self::Formula(program) = self {
            program.bends(read, note);
        }
    }

    fn at<N: AnyNumber>(&self, read: &[N]) -> N {
        match self {
            Self::Known(number) => N::from(*number),
            Self::Formula(program) => program.evaluate(read),
        }
    }
}

/// A number that is not negative.
pub(super) fn not_negative(number: &Number, entry: &Entry<'_>, key: &str) -> Read<f64> {
    number.not_negative(entry, key)
}

/// Any number.
pub(super) fn any(number: &Number, entry: &Entry<'_>, key: &str) -> Read<f64> {
    number.number(entry, key)
}

/// The time and what is read.
fn read<N: AnyNumber>(readings: &Readings, x: &[N], v: &[N], t: N) -> SmallVec<[N; ROOM]> {
    let mut read = SmallVec::from_slice(&[t]);
    readings.append(x, v, &mut read);
    read
}

/// A length and its rate from half its square and the rate of that, where a distance counts as `shortest` at least (m).
fn length<N: AnyNumber>(half_square: N, rate: N, shortest: f64) -> [N; 2] {
    let square = half_square * 2.0;
    let r = if square.re() > shortest * shortest { square.sqrt() } else { N::from(shortest) };
    [r, rate / r]
}

/// A spring of which some numbers follow something, along half the square of a distance or along a coordinate. What it has not is zero.
pub(super) struct SpringLoad {
    /// Where the quantity that it acts on is among what it reads.
    pub own: usize,
    /// Whether that is half the square of the length, and not the length itself.
    pub is_square: bool,
    /// Distances below this count as this, m.
    pub shortest: f64,
    pub stiffness: Option<Follows>,
    pub rest: Follows,
    pub damping: Option<Follows>,
    /// A formula of length, rate, time, rest, extension and what is read.
    pub force: Option<Program>,
    pub readings: Readings,
}

impl SpringLoad {
    /// Length and rate.
    fn own<N: AnyNumber>(&self, x: &[N], v: &[N]) -> [N; 2] {
        if self.is_square { length(x[self.own], v[self.own], self.shortest) } else { [x[self.own], v[self.own]] }
    }

    /// What the formula of the force is of, where the rest length is `rest`.
    fn variables<N: AnyNumber>([length, rate]: [N; 2], rest: N, read: &[N]) -> SmallVec<[N; ROOM]> {
        let mut variables = SmallVec::from_slice(&[length, rate, read[0], rest, length - rest]);
        variables.extend_from_slice(&read[1..]);
        variables
    }
}

impl ForceFunction for SpringLoad {
    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        let read = read(&self.readings, x, v, t);
        [self.stiffness.as_ref(), Some(&self.rest), self.damping.as_ref()].into_iter().flatten().for_each(|key| key.bends(&read, note));
        if let Some(formula) = &self.force {
            formula.bends(&Self::variables(self.own(x, v), self.rest.at(&read), &read), note);
        }
    }

    fn evaluate<N: AnyNumber>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        let read = read(&self.readings, x, v, t);
        let [length, rate] = self.own(x, v);
        let rest = self.rest.at(&read);
        let mut tension = N::from(0.0);
        if let Some(stiffness) = &self.stiffness {
            tension += stiffness.at(&read) * (length - rest);
        }
        if let Some(damping) = &self.damping {
            tension += damping.at(&read) * rate;
        }
        if let Some(formula) = &self.force {
            tension += formula.evaluate(&Self::variables([length, rate], rest, &read));
        }
        force.fill(N::from(0.0));
        force[self.own] = -if self.is_square { tension / length } else { tension };
    }
}

/// A rope of which some numbers follow something.
pub(super) struct RopeLoad {
    /// Where half the squares of its lengths begin among what it reads; the coordinate of the drum comes behind them.
    pub own: usize,
    /// How many stretches have each of the lengths.
    pub factors: Vec<f64>,
    /// R, where there is a drum.
    pub radius: Option<f64>,
    /// The sum of the stretches that never change, m.
    pub fixed: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
    pub length: Follows,
    pub stiffness: Follows,
    pub damping: Follows,
    pub readings: Readings,
}

impl RopeLoad {
    /// How far it is stretched, and the rate of that, in which the free length moves as what it follows does.
    fn stretch<N: AnyNumber>(&self, x: &[N], v: &[N], t: N) -> [N; 2] {
        let along = |x: &N, rate: &N| Dual::new(*x, *rate);
        let moving: SmallVec<[Dual<N>; ROOM]> = x.iter().zip(v).map(|(x, v)| along(x, v)).collect();
        // Lengths that follow velocities are refused.
        let still: SmallVec<[Dual<N>; ROOM]> = v.iter().map(|v| along(v, &N::from(0.0))).collect();
        let free = self.length.at(&read(&self.readings, &moving, &still, along(&t, &N::from(1.0))));
        let mut sum = [N::from(self.fixed) - free.re, -free.eps];
        for (k, factor) in self.factors.iter().enumerate() {
            let own = length(x[self.own + k], v[self.own + k], self.shortest);
            (0..2).for_each(|i| sum[i] += own[i] * *factor);
        }
        if let Some(radius) = self.radius {
            let drum = self.own + self.factors.len();
            sum = [sum[0] - x[drum] * radius, sum[1] - v[drum] * radius];
        }
        sum
    }

    /// The whole length of its stretches, m.
    fn whole<N: AnyNumber>(&self, x: &[N], v: &[N]) -> f64 {
        self.factors.iter().enumerate().map(|(k, factor)| factor * length(x[self.own + k], v[self.own + k], self.shortest)[0].re()).sum()
    }

    /// What its spring and its damper pull with.
    fn tension<N: AnyNumber>(&self, [stretch, speed]: [N; 2], read: &[N]) -> N {
        self.stiffness.at(read) * stretch + self.damping.at(read) * speed
    }
}

impl ForceFunction for RopeLoad {
    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        let read = read(&self.readings, x, v, t);
        [&self.length, &self.stiffness, &self.damping].into_iter().for_each(|key| key.bends(&read, note));
        let [stretch, speed] = self.stretch(x, v, t);
        note(Bend::Corner(taken_up(stretch, speed, self.whole(x, v))));
        // Where a taut rope would begin to push.
        note(Bend::Corner(if stretch > 0.0 { self.tension([stretch, speed], &read) } else { 0.0 }));
    }

    fn evaluate<N: AnyNumber>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        force.fill(N::from(0.0));
        let [stretch, speed] = self.stretch(x, v, t);
        if !is_taut(stretch.re(), || speed.re(), || self.whole(x, v)) {
            return;
        }
        let tension = self.tension([stretch, speed], &read(&self.readings, x, v, t));
        if tension.re() <= 0.0 {
            return;
        }
        for (k, factor) in self.factors.iter().enumerate() {
            let [r, _] = length(x[self.own + k], v[self.own + k], self.shortest);
            force[self.own + k] = -tension * *factor / r;
        }
        if let Some(radius) = self.radius {
            force[self.own + self.factors.len()] = tension * radius;
        }
    }
}
