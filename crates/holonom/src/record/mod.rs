//! What is kept of a run: named columns in memory, one row per recorded step, and how the mechanism is drawn.

mod between;
mod body;
mod channels;
mod force;
mod heading;
mod joint;
mod measure;
mod peaks;
mod recorder;
mod scene;
mod transmission;
mod works;

pub use between::{Bounds, Largest};
pub use body::RecordedBody;
pub use channels::{Channels, RecordedCoupling, RecordedEffort, RecordedPoint, RecordedRod};
pub use force::{Along, Exerts, Lengths, RecordedForce, Shows};
pub use heading::Heading;
pub use joint::RecordedJoint;
pub use measure::{Formula, RecordedInput, RecordedMeasure, Running, RunningValue};
pub(crate) use measure::{MeasureReads, Series};
pub use peaks::{Extremes, Peak, Peaks};
pub use recorder::{COLUMNS, Constraints, Recorder, RecorderMark};
pub use scene::{
    Anchor, Line, LineKind, PointKind, Scene, SceneAxis, SceneBody, SceneJoint, SceneLoad, ScenePoint, SceneShape, SceneWheels, WheelsKind,
};
pub use transmission::{RecordedTransmission, Transmission};
pub use works::{Work, Works};

/// A table of columns of equal length; row 0 is the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    columns: Vec<Column>,
    /// The columns by their names.
    by_name: Vec<u32>,
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
        let mut by_name: Vec<u32> = (0..columns.len() as u32).collect();
        by_name.sort_by_key(|&k| &columns[k as usize].heading.name);
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
        let at = self.by_name.binary_search_by_key(&name, |&k| &self.columns[k as usize].heading.name).ok()?;
        Some(self.by_name[at] as usize)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }
}
