//! Steps by accuracy end shortly before singular positions (methods §16): a step over one may leave it on another way than the one that the motion
//! takes.

use super::Simulation;
use super::golden::highest;
use super::pilot::{Moment, Pilot, is_rough};
use crate::formulation::{Failure, Independence};
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

/// How much longer than the shortest the way of a row may be that turns.
const FURTHER: f64 = 1.5;

/// What is known of singular positions ahead, and room for looks inside of a step.
pub(super) struct View {
    /// What the root is at least until rows have turned by more, where a step ends.
    pub clear: f64,
    /// A place inside of a step (D × nodes).
    x: Vec<f64>,
    /// Gradients of all rows at its start, of length one.
    gradient: Vec<f64>,
}

impl View {
    /// Nothing is known yet.
    pub fn new(x: Vec<f64>, independence: &Independence) -> Self {
        Self { clear: 0.0, x, gradient: independence.gradients().to_vec() }
    }
}

/// The places between the ends of a step, and how independent rows are there: the root of the least that one adds to the others.
struct Way<'a> {
    simulation: &'a Simulation,
    start: &'a Moment,
    /// s
    length: f64,
    independence: &'a mut Independence,
    /// How many rows are redundant everywhere.
    redundant: usize,
    /// By how much the root changes at most along it, and what it is where steps end before a singular position.
    turn: f64,
    near: f64,
    /// Below which the step passes a singular position.
    bound: f64,
    x: &'a mut [f64],
}

impl Way<'_> {
    /// The root at a share of the way, by Hermite's cubic.
    fn root(&mut self, share: f64) -> f64 {
        let Self { simulation, start, length, x, .. } = self;
        let (end, rest) = (&simulation.state, 1.0 - share);
        let [at_start, at_end] = [rest * rest * (1.0 + 2.0 * share), share * share * (1.0 + 2.0 * rest)];
        let [along_start, along_end] = [share * rest * rest * *length, -share * share * rest * *length];
        for (i, x) in x.iter_mut().enumerate() {
            *x = at_start * start.state.x[i] + at_end * end.x[i] + along_start * start.v[i] + along_end * simulation.shown_v[i];
        }
        self.independence.count_redundant(&simulation.system, x, &start.state.angle, start.state.t + share * *length);
        self.independence.weakest(self.redundant).sqrt()
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
        let Pilot { before, independence, redundant, view: View { clear, x, gradient }, .. } = pilot;
        let moved = before.state.x.iter().zip(&self.state.x).fold(0.0, |m: f64, (from, to)| m.max((to - from).abs()));
        // No row turns by more than what moves turns the shortest.
        let most = STEEP * moved / (self.work.scales.shortest * self.work.scales.length);
        if !most.is_finite() {
            return None;
        }
        *clear -= most;
        if *clear > most.max(FAR * near) {
            return None;
        }
        let redundant = *redundant;
        let mut way = Way { simulation: self, start: before, length, independence, redundant, turn: most, near, bound: 0.0, x };
        let start = way.root(0.0);
        gradient.copy_from_slice(way.independence.gradients());
        let end = way.root(1.0);
        *clear = start.min(end);
        if start < FAR * near {
            return None;
        }
        way.turn = most.min(STEEP * FURTHER * way.independence.turned_since(gradient));
        way.bound = (PASSED * near).max(DIPS * start.min(end));
        let (share, least) = way.first([0.0, 1.0], [start, end]).or((end < PASSED * near).then_some((1.0, end)))?;
        Some(share * (1.0 - (LEFT * near + least) / start).max(LEAST_LEFT))
    }
}
