//! Inputs, and events: when the indicators of a system go through zero, and what happens then.

use serde::{Deserialize, Serialize};

use super::{Checkpoint, Simulation};
use crate::formulation::Failure;
use crate::system::Look;

/// An event that happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Happening {
    /// Of the event.
    pub event: String,
    /// When, s.
    pub t: f64,
    /// Whether the run ended there.
    pub stopped: bool,
}

/// Times of events are found to this share of the step.
const LOCATED: f64 = 1e-12;

/// Shortest part of a step: over a shorter one a rounding of positions would be a velocity. An event closer to the beginning of a step is taken
/// there, and what is left of a step behind one is left out.
const SHORTEST: f64 = 1e-6;

/// Tries to find the time of an event. Each halves the interval at least every other time.
const MOST_TRIES: usize = 100;

impl Simulation {
    /// Events that happened so far, in their order.
    pub fn events(&self) -> &[Happening] {
        &self.happenings
    }

    /// Sets a number from outside, which counts from here on; says whether there is an input of that name. Set between steps, it is the same
    /// within each.
    pub fn set_input(&mut self, name: &str, value: f64) -> bool {
        let Some(at) = self.system.inputs.iter().position(|(known, _)| known == name) else { return false };
        self.set_inputs(&[(at, value)]);
        true
    }

    /// A number from outside, by its name.
    pub fn input(&self, name: &str) -> Option<f64> {
        let at = self.system.inputs.iter().position(|(known, _)| known == name)?;
        Some(self.state.inputs[at])
    }

    fn set_inputs(&mut self, set: &[(usize, f64)]) {
        let mut has_changed = false;
        for &(input, value) in set {
            has_changed |= self.state.inputs[input] != value;
            self.state.inputs[input] = value;
        }
        self.work.inputs.copy_from_slice(&self.state.inputs);
        // The conserving schemes carry no accelerations on.
        if has_changed && !self.method.integrator.conserves {
            self.begin_anew();
        }
    }

    /// Advances to `target`, or to the first event on the way that ends the run: whether there was one.
    pub(super) fn advance_through_events(&mut self, target: f64, wants_forces: bool) -> Result<bool, Failure> {
        if self.system.events.is_empty() {
            return self.advance(target, wants_forces).map(|()| false);
        }
        let system = self.system.clone();
        let shortest = SHORTEST * (target - self.state.t);
        let mut first_part = None;
        // Indicators where the part begins; zero of events that happened there, also at the end of the step before.
        let mut from = self.indicate();
        for last in self.happenings.iter().rev().take_while(|last| (self.state.t - last.t).abs() <= shortest) {
            let same = system.events.iter().zip(&mut from).filter(|(event, _)| event.name == last.event);
            same.for_each(|(_, from)| *from = 0.0);
        }
        loop {
            let before = self.checkpoint();
            self.advance(target, wants_forces)?;
            let first = first_part.get_or_insert_with(|| before.clone());
            self.join_parts(first);
            let to = self.indicate();
            let crossed = |to: &[f64]| (0..to.len()).find(|&k| system.events[k].crossing.is_between(from[k], to[k]));
            let Some(k) = crossed(&to) else { return Ok(false) };
            let (t, k) = self.locate(&before, k, &from, shortest, wants_forces, &crossed)?;
            let now = self.indicate();
            let happens = |at: usize| at == k || system.events[at].crossing.is_between(from[at], now[at]);
            let happening: Vec<usize> = (0..now.len()).filter(|&at| happens(at)).collect();
            from = now;
            let mut stops = false;
            for k in happening {
                let event = &system.events[k];
                from[k] = 0.0;
                self.set_inputs(&event.set);
                stops |= event.stops;
                self.happenings.push(Happening { event: event.name.clone(), t, stopped: event.stops });
            }
            if let Some(first) = &first_part {
                self.join_parts(first);
            }
            if stops || target - self.state.t < shortest {
                return Ok(stops);
            }
        }
    }

    /// Goes to where the first event happens in the part that began at `before` and in which the k-th has happened, and says when that is
    /// and which it is.
    fn locate(
        &mut self,
        before: &Checkpoint,
        mut k: usize,
        from: &[f64],
        shortest: f64,
        wants_forces: bool,
        crossed: &dyn Fn(&[f64]) -> Option<usize>,
    ) -> Result<(f64, usize), Failure> {
        let begin = before.state.t;
        // None has happened at `low`, and the k-th has at `high`.
        let (mut low, mut high) = (begin, self.state.t);
        let width = (LOCATED * (high - low)).max(f64::EPSILON * high.abs());
        let (mut at_low, mut at_high) = (from[k], self.indicate()[k]);
        let (mut here, mut bisects) = (high, false);
        for _ in 0..MOST_TRIES {
            if high - low <= width {
                break;
            }
            let secant = high - at_high * (high - low) / (at_high - at_low);
            if high - begin <= 1.5 * shortest {
                // Over so short a time all that moves goes straight.
                self.restore(before);
                return Ok((secant, k));
            }
            // Just beside the secant, towards the farther end, so that both ends come close.
            let aim = if secant - low < high - secant { secant + 0.25 * width } else { secant - 0.25 * width };
            let next = if bisects || !(aim > low && aim < high) { 0.5 * (low + high) } else { aim };
            let next = next.max(begin + shortest).min(high);
            let whole = high - low;
            self.restore(before);
            self.advance(next, wants_forces)?;
            here = next;
            let now = self.indicate();
            match crossed(&now) {
                Some(other) => {
                    at_low = if other == k { at_low } else { from[other] };
                    (high, at_high, k) = (next, now[other], other);
                }
                None => (low, at_low) = (next, now[k]),
            }
            bisects = high - low > 0.5 * whole;
        }
        if here != high {
            self.restore(before);
            self.advance(high, wants_forces)?;
        }
        Ok((high, k))
    }

    /// Values of all indicators at the present state.
    fn indicate(&self) -> Vec<f64> {
        let (state, at) = (&self.state, &self.work.start.at);
        self.system.indicators(Look { x: &state.x, v: &self.shown_v, t: state.t, at, inputs: &state.inputs, span: None })
    }
}
