//! Measures: formulas of the columns of a recording, with running values.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::between::Bounds;
use crate::simulation::{Divisions, any_number};

/// A formula of some numbers.
pub trait Formula: Send + Sync {
    /// Its value.
    fn evaluate(&self, values: &[f64]) -> f64;
}

/// A value of a run so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Running {
    /// Largest value.
    Max,
    /// Smallest value.
    Min,
    /// Mean over time.
    Mean,
    /// Root of the mean square over time.
    Rms,
    /// Integral over time.
    Integral,
}

/// An input of a model, whose value is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedInput {
    /// With its index where it is repeated; the name of its column.
    pub name: String,
    /// As the author states it; `"1"` where nothing is said.
    pub unit: String,
    /// In a line.
    pub meaning: String,
}

/// A measure of a model: a formula of other columns.
#[derive(Clone)]
pub struct RecordedMeasure {
    /// With its index where it is repeated; the name of its column.
    pub name: String,
    /// As the author states it.
    pub unit: String,
    /// In a line.
    pub meaning: String,
    pub(crate) formula: Arc<dyn Formula>,
    /// What its variables are, in order.
    pub(crate) reads: Vec<MeasureReads>,
    pub(crate) series: Vec<Series>,
}

/// A variable of a measure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum MeasureReads {
    /// The column of this name.
    Column(String),
    /// A running value.
    Series(usize),
}

/// A running value of a formula of the same variables.
#[derive(Clone)]
pub(crate) struct Series {
    pub running: Running,
    pub of: Arc<dyn Formula>,
}

impl RecordedMeasure {
    /// Whether it has running values, so that every step counts.
    pub fn is_running(&self) -> bool {
        !self.series.is_empty()
    }

    /// Names of the columns that it reads.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.reads.iter().filter_map(|read| match read {
            MeasureReads::Column(name) => Some(name.as_str()),
            MeasureReads::Series(_) => None,
        })
    }
}

/// A running value while the run goes on. Between two times the number goes straight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunningValue {
    /// Times of the first number and of the last, s.
    times: [f64; 2],
    /// The last number, and the largest, the smallest or the integral.
    #[serde(with = "any_number")]
    values: [f64; 2],
    /// Whether there was a number yet.
    has_begun: bool,
}

impl RunningValue {
    /// Takes the number at a time in, and hands back the running value. What is no number shows, and stays.
    pub fn add(&mut self, running: Running, t: f64, value: f64) -> f64 {
        let [since, before] = if self.has_begun { self.times } else { [t, t] };
        let (step, [last, sum]) = (t - before, self.values);
        let sum = match running {
            // What is set at the start counts from there.
            Running::Max | Running::Min if t == since => value,
            _ if !self.has_begun => 0.0,
            Running::Max if value <= sum || sum.is_nan() => sum,
            Running::Min if value >= sum || sum.is_nan() => sum,
            Running::Max | Running::Min => value,
            Running::Integral | Running::Mean => sum + 0.5 * step * (last + value),
            Running::Rms => sum + step / 3.0 * (last * last + last * value + value * value),
        };
        *self = Self { times: [since, t], values: [value, sum], has_begun: true };
        let whole = t - since;
        match running {
            Running::Max | Running::Min | Running::Integral => sum,
            Running::Mean if whole > 0.0 => sum / whole,
            Running::Mean => value,
            Running::Rms if whole > 0.0 => (sum / whole).sqrt(),
            Running::Rms => value.abs(),
        }
    }
}

/// The measures of a recording while it goes on.
pub(super) struct Measures {
    measures: Vec<RecordedMeasure>,
    /// Of each measure the places of its variables in the row, or which series they are; none of a column that is not recorded.
    places: Vec<Vec<Option<Place>>>,
    /// Of each measure the sums of its series.
    pub sums: Vec<Vec<RunningValue>>,
    /// How far each has gone.
    pub bounds: Vec<Bounds>,
    /// Room for variables.
    values: Vec<f64>,
}

#[derive(Clone, Copy)]
enum Place {
    Column(usize),
    Series(usize),
}

impl Measures {
    /// Of a recording with columns at these places, among them those of the measures.
    pub fn new(measures: &[RecordedMeasure], column: impl Fn(&str) -> Option<usize>) -> Self {
        let place = |read: &MeasureReads| match read {
            MeasureReads::Column(name) => column(name).map(Place::Column),
            MeasureReads::Series(k) => Some(Place::Series(*k)),
        };
        Self {
            places: measures.iter().map(|measure| measure.reads.iter().map(place).collect()).collect(),
            sums: measures.iter().map(|measure| vec![RunningValue::default(); measure.series.len()]).collect(),
            bounds: vec![Bounds::default(); measures.len()],
            values: Vec::new(),
            measures: measures.to_vec(),
        }
    }

    /// Where else than in the rows they are looked at: what is of the whole run, or reads columns that follow from forces of the constraints, which are
    /// at the places `found`, inside of long steps, too.
    pub fn divisions(&self, found: &[Range<usize>]) -> Divisions {
        let is_found = |place: &Option<Place>| matches!(place, Some(Place::Column(k)) if found.iter().any(|found| found.contains(k)));
        let are_running = self.sums.iter().any(|sums| !sums.is_empty());
        if are_running || self.places.iter().flatten().any(is_found) {
            Divisions::Inside
        } else if self.measures.is_empty() {
            Divisions::Unseen
        } else {
            Divisions::Ends
        }
    }

    /// Appends their values to a row that begins with the time.
    pub fn append(&mut self, row: &mut Vec<f64>) {
        let own = self.sums.iter_mut().zip(&mut self.bounds);
        for ((measure, places), (sums, bounds)) in self.measures.iter().zip(&self.places).zip(own) {
            self.values.clear();
            for place in places {
                let value = match *place {
                    Some(Place::Column(k)) => row[k],
                    // A series stands behind all that it is of.
                    Some(Place::Series(k)) => {
                        let series = &measure.series[k];
                        let value = series.of.evaluate(&self.values);
                        sums[k].add(series.running, row[0], value)
                    }
                    None => f64::NAN,
                };
                self.values.push(value);
            }
            let value = measure.formula.evaluate(&self.values);
            bounds.see(value, row[0]);
            row.push(value);
        }
    }
}
