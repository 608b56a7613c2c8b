//! How long each step takes, where every step is to take as long as the others.

use std::time::Instant;

use holonom::simulation::{Divisions, Observer, Simulation, Verdict};
use serde_json::{Value, json};

/// Measures the nominal steps that another observer watches, without the time that this one takes.
pub struct Clock<'a, O> {
    watched: &'a mut O,
    begun: Option<Instant>,
    /// µs
    steps: Vec<f64>,
}

impl<'a, O: Observer> Clock<'a, O> {
    /// Measures a run of about `steps` steps.
    pub fn new(watched: &'a mut O, steps: usize) -> Self {
        Self { watched, begun: None, steps: Vec::with_capacity(steps.min(1 << 24)) }
    }

    /// Median, 90 %, 99 % and longest, µs; nothing where no step was taken.
    pub fn summary(mut self) -> Value {
        self.steps.sort_by(f64::total_cmp);
        let Some(&max) = self.steps.last() else { return Value::Null };
        // The shortest time that this share of the steps does not exceed.
        let quantile = |share: f64| self.steps[(share * self.steps.len() as f64).ceil() as usize - 1];
        json!({ "median": quantile(0.5), "p90": quantile(0.9), "p99": quantile(0.99), "max": max })
    }
}

impl<O: Observer> Observer for Clock<'_, O> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        if let Some(begun) = self.begun {
            self.steps.push(1e6 * begun.elapsed().as_secs_f64());
        }
        let verdict = self.watched.after_step(simulation);
        self.begun = Some(Instant::now());
        verdict
    }

    fn wants_forces(&self) -> bool {
        self.watched.wants_forces()
    }

    fn divisions(&self) -> Divisions {
        self.watched.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.watched.at_division(simulation);
    }
}
