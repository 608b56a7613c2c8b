//! Steps by accuracy end shortly before singular positions (methods §16): a step over one may leave it on another way than the one that the motion
//! takes.

use super::Simulation;
use super::golden::highest;
use super::pilot::{Pilot, is_rough};
use crate::formulation::Failure;
use crate::integrator::Step;

/// Order of methods whose steps are too short to pass a singular position without notice. So are those of methods that hold no velocities, whose
/// round-off they follow.
const SHORT: u8 = 2;

/// How much the root of the least that a row adds to the others changes at most, over what a row turns, rad.
const STEEP: f64 = 2.0;

/// What round-off of rows looks like beside a singular position is a bend of the motion, of so much over the cube of the root there, 1/rad: steps end
/// where that is hardly a matter of the accuracy, as a bend is seen that is one of the motion.
const ROUNDED: f64 = 100.0 * f64::EPSILON;

/// A step passes a singular position where the root is below this share of what it is where steps end before one, or of what it is at both ends of
/// the step; it is looked for where the root is larger than so many of these at the start.
const PASSED: f64 = 0.5;
const DIPS: f64 = 0.1;
const FAR: f64 = 3.0;

/// The way that is left to a singular position where a step ends, in units of that on which the root becomes so small, beside that on which it
/// becomes what it is there.
const LEFT: f64 = 1.5;

/// Parts of a step that are looked into, and share of the way on which the root becomes what it is there to which a place is found.
const PART: f64 = 1.0 / 16.0;
const FOUND: f64 = 0.1;

/// Share of the way to a singular position that a step goes at least.
const LEAST_LEFT: f64 = 0.1;

/// Most times that a step is taken again.
const MOST_TRIES: u32 = 20;

/// Room for a place inside of a step (D × nodes), and for the gradients of all rows, of length one, at its start.
#[derive(Default)]
pub(super) struct Place {
    pub x: Vec<f64>,
    pub gradient: Vec<f64>,
}

/// The places between the ends of a step, and how independent rows are there: the root of the least that one adds to the others.
struct Way<'a> {
    simulation: &'a Simulation,
    pilot: &'a mut Pilot,
    /// s
    length: f64,
    /// By how much the root changes at most along it, and what it is where steps end before a singular position.
    turn: f64,
    near: f64,
    /// Below which the step passes a singular position.
    bound: f64,
    x: Vec<f64>,
}

impl Way<'_> {
    /// The root at a share of the way, by Hermite's cubic.
    fn root(&mut self, share: f64) -> f64 {
        let Self { simulation, pilot, length, x, .. } = self;
        let rest = 1.0 - share;
        let [at_start, at_end] = [rest * rest * (1.0 + 2.0 * share), share * share * (1.0 + 2.0 * rest)];
        let [along_start, along_end] = [share * rest * rest * *length, -share * share * rest * *length];
        let (start, end) = (&pilot.before, &simulation.state);
        for (i, x) in x.iter_mut().enumerate() {
            *x = at_start * start.state.x[i] + at_end * end.x[i] + along_start * start.v[i] + along_end * simulation.shown_v[i];
        }
        let t = start.state.t + share * *length;
        pilot.root_of_weakest(&simulation.system, x, t)
    }

    /// The first singular position between two shares of the way with their roots, and the root there.
    fn first(&mut self, [low, high]: [f64; 2], roots: [f64; 2]) -> Option<(f64, f64)> {
        if roots[0] + roots[1] > self.turn * (high - low) + 2.0 * self.bound {
            return None;
        }
        if high - low <= PART {
            return self.least(low, high);
        }
        let middle = 0.5 * (low + high);
        let root = self.root(middle);
        self.first([low, middle], [roots[0], root]).or_else(|| self.first([middle, high], [root, roots[1]]))
    }

    /// A singular position between two shares, by the golden section, and the root there.
    fn least(&mut self, low: f64, high: f64) -> Option<(f64, f64)> {
        let (turn, near) = (self.turn, self.near);
        let ends = |left: f64, least: f64| turn * left < FOUND * near.max(-least);
        let (place, least) = highest(|share| -self.root(share), [low, high], ends);
        (-least < self.bound).then_some((place, -least))
    }
}

impl Simulation {
    /// Where the step that was just taken passes a singular position, and has no error that would have it taken back, it is taken again and ends
    /// before that; says whether it was.
    pub(super) fn lands_before_singular(&mut self, taken: &mut Step, step: &mut f64, pilot: &mut Pilot) -> Result<bool, Failure> {
        let sees = self.method.order() > SHORT && !is_rough(&self.method);
        if !sees || pilot.ratio(self, taken, *step) > 1.0 {
            return Ok(false);
        }
        let whole = *step;
        for _ in 0..MOST_TRIES {
            let Some(share) = self.passes_singular(*step, pilot) else { break };
            let begin = pilot.before.state.t;
            pilot.before.restore(self);
            self.audit.reject(&self.newton);
            *step *= share;
            *taken = self.substep(*step, begin + *step)?;
        }
        Ok(*step < whole)
    }

    /// The share of a step of length `length` (s) after which it is to end, where it passes a singular position.
    fn passes_singular(&self, length: f64, pilot: &mut Pilot) -> Option<f64> {
        let near = (ROUNDED / pilot.control.accuracy()).cbrt();
        let (from, to) = (&pilot.before.state.x, &self.state.x);
        let moved = from.iter().zip(to).fold(0.0, |m: f64, (from, to)| m.max((to - from).abs()));
        // No row turns by more than this.
        let most = STEEP * moved / (self.work.scales.shortest * self.work.scales.length);
        if !most.is_finite() {
            return None;
        }
        pilot.clear -= most;
        if pilot.clear > most.max(FAR * near) {
            return None;
        }
        let Place { x, gradient } = std::mem::take(&mut pilot.place);
        let mut way = Way { simulation: self, x, pilot, length, turn: most, near, bound: 0.0 };
        let start = way.root(0.0);
        let mut place = Place { gradient, x: Vec::new() };
        way.pilot.keep_gradients(&mut place.gradient);
        let end = way.root(1.0);
        way.turn = most.min(STEEP * way.pilot.turned(&self.system, &place.gradient));
        way.pilot.clear = start.min(end);
        way.bound = (PASSED * near).max(DIPS * start.min(end));
        let passed = match start < FAR * near {
            true => None,
            false => way.first([0.0, 1.0], [start, end]).or((end < PASSED * near).then_some((1.0, end))),
        };
        let Way { x, pilot, .. } = way;
        pilot.place = Place { x, ..place };
        passed.map(|(share, least)| share * (1.0 - (LEFT * near + least) / start).max(LEAST_LEFT))
    }
}
