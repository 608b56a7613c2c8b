//! Inputs, and events: when the indicators of a system go through zero or a period is over, and what happens then.

use serde::{Deserialize, Serialize};

use super::advance::Inside;
use super::{Audit, Divisions, Observer, Simulation};
use crate::formulation::Failure;
use crate::system::{Look, PAST, Trigger};

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

/// Times of events, and of bends of forces, are found to this share of the step.
pub(super) const LOCATED: f64 = 1e-12;

/// Shortest part of a step: over a shorter one a rounding of positions would be a velocity. An event closer to the beginning of a step is taken
/// there, and one closer to its end at that end.
pub(super) const SHORTEST: f64 = 1e-6;

/// Tries to find the time of an event. Each halves the interval at least every other time.
pub(super) const MOST_TRIES: usize = 100;

/// Share of the time that is its rounding, where formulas take it apart.
const TIME_ROUNDED: f64 = 4.0 * f64::EPSILON;

/// An event that has happened so often at one time goes on for ever.
pub(super) const CHATTER: usize = 16;

impl Simulation {
    /// Events that happened so far, in their order.
    pub fn events(&self) -> &[Happening] {
        &self.happenings
    }

    /// The event that ended the last run, or the last step.
    pub fn ended_by(&self) -> Option<&Happening> {
        self.happenings.iter().rev().find(|event| self.has_ended && event.stopped)
    }

    /// Sets a number from outside, which counts from here on; says whether there is an input of that name. Set between steps, it is the same
    /// within each.
    #[must_use = "there may be no input of that name"]
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
            if let Some(mut pilot) = self.pilot.take() {
                pilot.begin_anew(self);
                self.pilot = Some(pilot);
            }
        }
    }

    /// Advances to `target`, or to the first event on the way that ends the run: whether there was one.
    pub(super) fn advance_through_events(&mut self, target: f64, observer: &mut dyn Observer) -> Result<bool, Failure> {
        let (wants_forces, divisions) = (observer.wants_forces(), observer.divisions());
        if self.system.events.is_empty() {
            let mut show = |simulation: &mut Self| {
                simulation.show_inside(divisions, observer);
                Ok(false)
            };
            let mut inside = Inside { look: &mut show, everywhere: divisions == Divisions::Inside };
            return self.advance(target, wants_forces, (divisions != Divisions::Unseen).then_some(&mut inside)).map(|()| false);
        }
        let system = self.system.clone();
        let length = target - self.state.t;
        let shortest = self.shortest(length);
        let first = (self.audit.clone(), self.steps);
        // Indicators where the part begins, before inputs were set there; zero of events that happened there, also at the end of the step
        // before.
        let mut from = match self.watched.take().filter(|(t, _)| *t == self.state.t) {
            Some((_, from)) => from,
            None => {
                let mut from = self.indicate()?;
                for last in self.happenings.iter().rev().take_while(|last| (self.state.t - last.t).abs() <= 2.0 * shortest) {
                    let same = system.events.iter().zip(&mut from).filter(|(event, _)| event.name == last.event);
                    same.for_each(|(_, from)| *from = 0.0);
                }
                from
            }
        };
        // Indicators that went through zero here and lie beside it again before anything else happens.
        let mut turned: Vec<(usize, f64)> = Vec::new();
        // Indicators at the last event, and when it has happened: that may lie a little behind the state at which it was taken.
        let (mut at_last, mut last) = (vec![f64::NAN; from.len()], self.state.t);
        loop {
            // The step that an accuracy takes is another after each event.
            let shortest = self.shortest(length);
            let due = self.due(shortest);
            let samples = !due.is_empty();
            if samples {
                observer.at_division(self);
                self.sample(&due, shortest)?;
            }
            let jumped = self.jump(&mut from, &mut at_last, shortest)?;
            let stops = jumped == Some(true);
            if samples || jumped.is_some() {
                self.show_division(observer);
            }
            if stops || self.state.t >= target {
                self.watched = Some((self.state.t, from));
                self.join_parts(&first);
                return Ok(stops);
            }
            turned.drain(..).for_each(|(at, beside)| from[at] = PAST.copysign(beside));
            let before = self.moment();
            let begin = before.t();
            let next = self.next_sample().unwrap_or(f64::INFINITY);
            let until = if next < target - shortest { next } else { target };
            // Where a sample follows, forces are found when it is taken, unless somebody looks at those before it.
            let reacts = wants_forces && (divisions == Divisions::Inside || next > until + shortest);
            let crossed = |from: &[f64], to: &[f64]| (0..to.len()).find(|&k| system.events[k].trigger.is_between(from[k], to[k]));
            let seen = |simulation: &Self, from: &[f64]| {
                let now = simulation.indicate()?;
                // What time alone takes back in a jump has been there before it.
                let t = simulation.state.t - TIME_ROUNDED * simulation.state.t.abs();
                if t <= last || crossed(from, &now).is_some() {
                    return Ok(now);
                }
                let before = simulation.indicate_by(Look { t, ..simulation.look() })?;
                Ok(if crossed(from, &before).is_some() { before } else { now })
            };
            // Where the step is taken in parts it ends with the part in which something happens.
            let (mut low, mut lower) = (self.state.t, self.state.t);
            let mut look = |simulation: &mut Self| {
                // So shortly behind an event rounding decides on which side of zero its indicator is.
                if simulation.state.t <= last + shortest {
                    return Ok(false);
                }
                let now = seen(simulation, &from)?;
                if crossed(&from, &now).is_some() {
                    return Ok(true);
                }
                (lower, low) = (low, simulation.state.t);
                pass(&mut from, now);
                simulation.show_inside(divisions, observer);
                Ok(false)
            };
            self.advance(until, reacts, Some(&mut Inside { look: &mut look, everywhere: true }))?;
            if self.state.t <= last + shortest {
                continue;
            }
            let to = seen(self, &from).inspect_err(|_| self.restore(&before))?;
            let (t, behind, k, beside) = match crossed(&from, &to) {
                Some(k) => {
                    self.locate(before, [lower, low, until], (k, to), &from, shortest, wants_forces, &|to: &[f64]| crossed(&from, to))?
                }
                None => {
                    // What happens within the rounding of a nominal time is taken there.
                    let at = self.indicate_about(to)?;
                    match crossed(&from, &at) {
                        Some(k) => (self.state.t, self.state.t, k, at),
                        None => {
                            pass(&mut from, at);
                            continue;
                        }
                    }
                }
            };
            let now = self.indicate()?;
            at_last.copy_from_slice(&now);
            let now = if self.state.t == until { self.indicate_about(now)? } else { now };
            let happens = |at: usize| at == k || system.events[at].trigger.is_between(from[at], now[at]);
            let due = self.due(shortest);
            let happening: Vec<usize> = (0..now.len()).filter(|at| happens(*at) || due.contains(at)).collect();
            if self.state.t > begin {
                pass(&mut from, now);
            } else {
                // What went through zero here, and turned round when inputs were set, may go through it again; so may what does without its event,
                // which happens the other way.
                let against = |at: usize, beside: f64| from[at] * beside < 0.0 && !system.events[at].trigger.is_between(from[at], beside);
                let turns = |&(at, beside): &(usize, f64)| (from[at] == 0.0 && beside != 0.0) || against(at, beside);
                turned.extend((0..).zip(beside).filter(turns));
            }
            self.require_no_chatter(k, t, shortest)?;
            last = behind;
            self.show_inside(divisions, observer);
            if !due.is_empty() {
                observer.at_division(self);
            }
            let stops = self.happen(&happening, t, shortest, true, &mut from, &mut at_last)?;
            self.show_division(observer);
            if stops {
                self.join_parts(&first);
                return Ok(true);
            }
        }
    }

    /// Lets events happen at a time, those with a period as samples that are due within so much of it, and says whether one ends the run. What they
    /// wait for has come to zero, or has jumped through it.
    fn happen(
        &mut self,
        events: &[usize],
        t: f64,
        within: f64,
        at_zero: bool,
        from: &mut [f64],
        at_last: &mut [f64],
    ) -> Result<bool, Failure> {
        let mut stops = false;
        let inputs = self.state.inputs.clone();
        for &k in events {
            if let Trigger::Every(_) = self.system.events[k].trigger {
                self.sample(&[k], within)?;
                continue;
            }
            self.set_by(k)?;
            let event = &self.system.events[k];
            stops |= event.stops;
            self.happenings.push(Happening { event: event.name.clone(), t, stopped: event.stops });
            // What an event waits for may depend on what it sets: then it is not at zero any more. Where inputs are set velocities may be put on the
            // rows, which changes indicators, too: what they were with the inputs from before is taken with these velocities.
            let now = self.indicate()?;
            let before = self.indicate_by(Look { inputs: &inputs, ..self.look() })?;
            from[k] = if at_zero && now[k] == before[k] { 0.0 } else { self.indicate_about(now)?[k] };
            // What the next ones set may take it back.
            at_last[k] = f64::NAN;
        }
        Ok(stops)
    }

    /// Refuses an event that happens again and again at the same time.
    fn require_no_chatter(&self, event: usize, t: f64, shortest: f64) -> Result<(), Failure> {
        let name = &self.system.events[event].name;
        let here = self.happenings.iter().rev().take_while(|last| (t - last.t).abs() <= 2.0 * shortest);
        match here.filter(|last| last.event == *name).count() {
            CHATTER.. => Err(Failure::Chattering { event }),
            _ => Ok(()),
        }
    }

    /// Shows the present state where a step is divided, with the forces of its inputs.
    pub(super) fn show_division(&mut self, observer: &mut dyn Observer) {
        if observer.wants_forces() {
            self.update_reactions();
        }
        observer.at_division(self);
    }

    /// Shows the present state inside a nominal step to an observer that looks there.
    fn show_inside(&mut self, divisions: Divisions, observer: &mut dyn Observer) {
        match divisions {
            Divisions::Unseen => (),
            Divisions::Ends => observer.at_division(self),
            Divisions::Inside => self.show_division(observer),
        }
    }

    /// Lets the events happen whose indicators jumped through zero when inputs were set, and those that jump by what these set, and says whether
    /// one ends the run; nothing where there were none. What is as it was at the last event has not jumped since, nor has
    /// what has come to zero and is past it.
    fn jump(&mut self, from: &mut [f64], at_last: &mut [f64], shortest: f64) -> Result<Option<bool>, Failure> {
        let mut jumps = None;
        while jumps != Some(true) {
            let exact = self.indicate()?;
            let mut now = self.indicate_about(exact.clone())?;
            let is_past = |k: usize| exact[k] == 0.0 && from[k].abs() == PAST;
            (0..now.len()).filter(|&k| exact[k] == at_last[k] || is_past(k)).for_each(|k| now[k] = from[k]);
            let jumped: Vec<usize> = (0..now.len()).filter(|&k| self.system.events[k].trigger.is_between(from[k], now[k])).collect();
            from.iter_mut().zip(now).filter(|(from, _)| **from != 0.0).for_each(|(from, now)| *from = now);
            if jumped.is_empty() {
                break;
            }
            at_last.copy_from_slice(&exact);
            jumped.iter().try_for_each(|&k| self.require_no_chatter(k, self.state.t, shortest))?;
            jumps = Some(self.happen(&jumped, self.state.t, 0.0, false, from, at_last)?);
        }
        Ok(jumps)
    }

    /// Sets inputs as an event says.
    pub(super) fn set_by(&mut self, event: usize) -> Result<(), Failure> {
        let system = self.system.clone();
        let set = system.settings(&system.events[event], self.look());
        if set.iter().any(|(_, value)| !value.is_finite()) {
            return Err(Failure::NoSetting { event });
        }
        self.set_inputs(&set);
        Ok(())
    }

    pub(super) fn look(&self) -> Look<'_> {
        let (state, at) = (&self.state, &self.work.start.at);
        Look { x: &state.x, v: &self.shown_v, t: state.t, at, inputs: &state.inputs, span: None }
    }

    /// Makes one nominal step of the parts that were taken since the audit and the count of steps were as in `first`. Where an event stops
    /// the run at once there is none.
    fn join_parts(&mut self, first: &(Audit, u64)) {
        self.audit.join_parts(&first.0);
        self.steps = self.steps.min(first.1 + 1);
    }

    /// Values of all indicators at the present state.
    pub(super) fn indicate(&self) -> Result<Vec<f64>, Failure> {
        self.indicate_by(self.look())
    }

    /// These values, where all have one.
    fn indicate_by(&self, look: Look<'_>) -> Result<Vec<f64>, Failure> {
        let found = self.system.indicators(look, || self.rounding());
        match found.iter().position(|found| found.is_nan()) {
            Some(event) => Err(Failure::NoIndicator { event }),
            None => Ok(found),
        }
    }

    /// These values `now`, but of those that time alone takes to the other side of zero within its rounding, that behind it: at a nominal time
    /// rounding decides on which side they are.
    fn indicate_about(&self, mut now: Vec<f64>) -> Result<Vec<f64>, Failure> {
        let t = self.state.t;
        let ahead = self.indicate_by(Look { t: t + TIME_ROUNDED * t.abs(), ..self.look() })?;
        now.iter_mut().zip(ahead).filter(|(now, ahead)| **now * ahead <= 0.0 && *ahead != 0.0).for_each(|(now, ahead)| *now = ahead);
        Ok(now)
    }
}

/// Goes from indicators to what they are `now`. One that has come to zero without its event, which happens the other way, is past it, and one that
/// stays there is at zero.
fn pass(from: &mut [f64], now: Vec<f64>) {
    let passed = |from: f64| if from == 0.0 || from.abs() == PAST { 0.0 } else { -PAST.copysign(from) };
    from.iter_mut().zip(now).for_each(|(from, now)| *from = if now == 0.0 { passed(*from) } else { now });
}
