//! What is kept of a run: named columns in memory, one row per recorded step, and how the mechanism is drawn.

mod between;
mod body;
mod channels;
mod composer;
mod force;
mod heading;
mod hold;
mod joint;
mod measure;
mod peaks;
mod recorder;
mod sampler;
mod scene;
mod transmission;
mod works;

use std::hash::{DefaultHasher, Hash, Hasher};

pub use between::{Bounds, Largest};
pub use body::RecordedBody;
pub use channels::{Channels, RecordedCoupling, RecordedEffort, RecordedPoint, RecordedRod};
pub use composer::Composer;
pub use force::{Along, Exerts, Lengths, RecordedForce, Shows};
pub use heading::Heading;
pub(crate) use hold::{Acts, Slopes, Straight};
pub use hold::{Exerted, RecordedHold, Where};
pub use joint::RecordedJoint;
pub use measure::{Formula, RecordedInput, RecordedMeasure, Running, RunningValue};
pub(crate) use measure::{MeasureReads, Series};
pub use peaks::{Extremes, Peak, Peaks};
pub use recorder::{COLUMNS, Constraints, Recorder, RecorderMark};
pub use sampler::{Sampler, SamplerMark, Samples};
pub use scene::{
    Anchor, Line, LineKind, PointKind, Scene, SceneAxis, SceneBody, SceneJoint, SceneLoad, ScenePoint, SceneShape, SceneWheels, WheelsKind,
};
pub use transmission::{RecordedTransmission, Transmission};
pub use works::{Work, Works};

/// A table of columns of equal length; row 0 is the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    columns: Vec<Column>,
    /// The hash of the name of each column, and behind it where the column stands, in order: there may be millions of names.
    by_name: Vec<[u32; 2]>,
    /// The largest values of forces between the rows, of each that [`Peaks`] has, where that was looked at.
    pub(crate) between: Vec<Largest>,
    /// How far each measure has gone, rows or not.
    pub(crate) bounds: Vec<Bounds>,
}

/// One channel over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it shows.
    pub heading: Heading,
    /// Values, one per recorded step.
    pub values: Vec<f64>,
}

impl Recording {
    /// An empty table with the given columns.
    pub fn new(headings: impl IntoIterator<Item = impl Into<Heading>>) -> Self {
        let columns: Vec<Column> = headings.into_iter().map(|heading| Column { heading: heading.into(), values: Vec::new() }).collect();
        let mut by_name: Vec<[u32; 2]> = columns.iter().zip(0..).map(|(column, k)| [hash(&column.heading.name), k]).collect();
        by_name.sort_unstable();
        Self { columns, by_name, between: Vec::new(), bounds: Vec::new() }
    }

    /// A table of columns that are there already; none where their numbers or lengths differ.
    pub fn of_columns(headings: impl IntoIterator<Item = impl Into<Heading>>, values: Vec<Vec<f64>>) -> Option<Self> {
        let mut table = Self::new(headings);
        let is_even = values.len() == table.columns.len() && values.windows(2).all(|two| two[0].len() == two[1].len());
        table.columns.iter_mut().zip(values).for_each(|(column, values)| column.values = values);
        is_even.then_some(table)
    }

    /// Appends one row.
    ///
    /// # Panics
    /// When `row` has not one value per column.
    pub fn push(&mut self, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "one value per column");
        for (column, &value) in self.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
    }

    /// Has room for so many rows more, which are then not moved as their number grows.
    pub(crate) fn make_room(&mut self, rows: usize) {
        self.columns.iter_mut().for_each(|column| column.values.reserve(rows));
    }

    /// Appends rows that stand one after the other: each column, which is far from the next, takes its values of all of them at once.
    pub(crate) fn extend(&mut self, rows: &[f64]) {
        let width = self.columns.len();
        for (k, column) in self.columns.iter_mut().enumerate() {
            column.values.extend(rows.chunks_exact(width).map(|row| row[k]));
        }
    }

    /// Takes the last row away; nothing where there is none.
    pub(crate) fn pop(&mut self) -> Option<Vec<f64>> {
        self.columns.iter_mut().map(|column| column.values.pop()).collect()
    }

    /// All columns, in the order of the file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The values of one column, if there is one of that name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.find(name).map(|column| column.values.as_slice())
    }

    /// One column, if there is one of that name.
    pub fn find(&self, name: &str) -> Option<&Column> {
        self.place(name).map(|k| &self.columns[k])
    }

    /// Where the column of a name stands among all, counted from 0.
    pub fn place(&self, name: &str) -> Option<usize> {
        let hash = hash(name);
        let first = self.by_name.partition_point(|[other, _]| *other < hash);
        let alike = self.by_name[first..].iter().take_while(|[other, _]| *other == hash);
        alike.map(|[_, k]| *k as usize).find(|&k| self.columns[k].heading.name == name)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }
}

fn hash(name: &str) -> u32 {
    let mut hasher = DefaultHasher::new();
    name.hash(&mut hasher);
    hasher.finish() as u32
}
