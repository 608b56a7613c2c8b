//! Events that happen at a fixed rate.

use super::Simulation;
use super::events::SHORTEST;
use super::pilot::is_rough;
use crate::formulation::Failure;
use crate::system::{Rounding, Trigger};

/// Periods of a span that can be counted one by one in floating point: of more, time does not move by one at the span's end.
const COUNTABLE: f64 = 1.0 / f64::EPSILON;

/// How many steps or periods, of so many seconds each, a span has where these are too many to be counted. A span without an end has none to count to.
pub(crate) fn uncountable(span: f64, period: f64) -> Option<f64> {
    Some(span / period).filter(|count| *count > COUNTABLE && span.is_finite())
}

impl Simulation {
    /// Why no run goes to a time, in words, if none does.
    pub(super) fn cannot_run(&self, end: f64) -> Option<String> {
        let reason = match self.method.accuracy {
            _ if end.is_nan() => "the time that the run is to end at is not a number",
            Some(_) if end.is_infinite() => "an accuracy is that of a run with an end, and this one has none",
            Some(_) if self.pilot.is_none() => {
                "an element panicked in an earlier step, and what chooses the steps is lost: begin a new simulation"
            }
            _ => return self.is_endless(end),
        };
        Some(reason.into())
    }

    /// Why a run to a time would never get there, in words, if it would not.
    fn is_endless(&self, end: f64) -> Option<String> {
        let span = end - self.state.t;
        let of_steps = uncountable(span, self.step).map(|count| format!("{count:e} nominal steps of {} s", self.step));
        // Periods are counted from t = 0.
        let of_event = |(k, period, _): (usize, f64, u64)| {
            let count = uncountable(end, period)?;
            Some(format!("{count:e} periods of the event `{}`", self.system.events[k].name))
        };
        let many = of_steps.or_else(|| self.periods().find_map(of_event))?;
        Some(format!("the run to {end} s has {many}, more than can be counted"))
    }

    /// Periods of events, with how often they have happened.
    fn periods(&self) -> impl Iterator<Item = (usize, f64, u64)> {
        let period = |(k, taken): (usize, &u64)| match self.system.events[k].trigger {
            Trigger::Every(period) => Some((k, period, *taken)),
            Trigger::When(..) => None,
        };
        self.samples.iter().enumerate().filter_map(period)
    }

    /// When an event happened first; one with a period does at t = 0, where runs begin.
    pub fn first_time(&self, event: &str) -> Option<f64> {
        let has_period = |(k, _, taken): &(usize, f64, u64)| self.system.events[*k].name == event && *taken > 0;
        let of_period = self.periods().any(|period| has_period(&period)).then_some(0.0);
        of_period.or_else(|| self.happenings.iter().find(|happening| happening.event == event).map(|happening| happening.t))
    }

    /// How often events happened so far, those with a period among them: at most so many steps were divided by them.
    pub fn times_of_events(&self) -> u64 {
        self.happenings.len() as u64 + self.periods().map(|(_, _, taken)| taken).sum::<u64>()
    }

    /// When the next event with a period happens.
    pub(super) fn next_sample(&self) -> Option<f64> {
        self.periods().map(|(_, period, taken)| taken as f64 * period).reduce(f64::min)
    }

    /// Events whose periods are over, up to so much later.
    pub(super) fn due(&self, within: f64) -> Vec<usize> {
        self.periods().filter(|(_, period, taken)| *taken as f64 * period <= self.state.t + within).map(|(k, ..)| k).collect()
    }

    /// Lets these happen.
    pub(super) fn sample(&mut self, due: &[usize], within: f64) -> Result<(), Failure> {
        for &k in due {
            self.set_by(k)?;
            self.samples[k] = self.taken(k, within);
        }
        Ok(())
    }

    /// How often an event with a period happens up to the present time, from t = 0 on.
    fn taken(&self, event: usize, within: f64) -> u64 {
        match self.system.events[event].trigger {
            Trigger::Every(period) => ((self.state.t + within) / period).floor().max(0.0) as u64 + 1,
            Trigger::When(..) => 0,
        }
    }

    /// Shortest part of a step of some length and of the shortest period, s. Where steps are chosen for an accuracy it is that of the next one, but for the
    /// time in which something moves by what rounding leaves of places.
    pub(super) fn shortest(&self, length: f64) -> f64 {
        let longest = SHORTEST * self.periods().map(|(_, period, _)| period).fold(length, f64::min);
        let Some(step) = self.chosen_step() else { return longest };
        let [places, _] = self.rounding().of_points;
        (places / self.system.largest_of_points(&self.shown_v)).max(SHORTEST * step).min(longest)
    }

    /// What rounding leaves open of the present state.
    pub(super) fn rounding(&self) -> Rounding {
        let step = is_rough(&self.method).then(|| self.chosen_step().unwrap_or(self.step));
        self.system.rounding(&self.state.x, &self.shown_v, step)
    }

    /// The length of the next step that is chosen for an accuracy, s.
    fn chosen_step(&self) -> Option<f64> {
        self.pilot.as_ref().map(|pilot| pilot.control.step).filter(|step| *step > 0.0)
    }

    /// Whether a time is not so far ahead that a part of a step could be taken to it.
    pub(super) fn is_there(&self, t: f64) -> bool {
        t - self.state.t <= self.shortest(self.step)
    }

    /// Counts as happened what lies before the present time, at which a run begins.
    pub(super) fn begin_periods(&mut self) {
        let before = -self.shortest(self.step);
        self.samples = (0..self.system.events.len()).map(|k| if self.state.t > 0.0 { self.taken(k, before) } else { 0 }).collect();
    }

    /// Lets what happens at the beginning of a run happen, and says whether there was anything.
    pub(super) fn begin_sampling(&mut self) -> Result<bool, Failure> {
        if self.watched.as_ref().is_none_or(|(t, _)| *t != self.state.t) {
            self.watched = Some((self.state.t, self.indicate()?));
        }
        let within = self.shortest(self.step);
        let due = self.due(within);
        self.sample(&due, within).map(|()| !due.is_empty())
    }
}
