//! What is kept of a run: named columns in memory, one row per recorded step, and how the mechanism is drawn.

pub(crate) mod channels;
mod recorder;
mod scene;

pub use channels::{Channels, RecordedBody, RecordedEffort, RecordedJoint, RecordedPoint};
pub use recorder::{COLUMNS, Recorder, RecorderMark};
pub use scene::{Anchor, Line, LineKind, PointKind, Scene, SceneBody, SceneJoint, ScenePoint, SceneShape};

/// A table of columns of equal length; row 0 is the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    columns: Vec<Column>,
    /// The columns by their names.
    by_name: Vec<u32>,
}

/// One channel over time, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name as in the header of `trajectory.csv`, e.g. `energy` or `m1.x`.
    pub name: String,
    /// Values, one per recorded step.
    pub values: Vec<f64>,
}

impl Recording {
    /// An empty table with the given column names.
    pub fn new(names: impl IntoIterator<Item = String>) -> Self {
        let columns: Vec<Column> = names.into_iter().map(|name| Column { name, values: Vec::new() }).collect();
        let mut by_name: Vec<u32> = (0..columns.len() as u32).collect();
        by_name.sort_by_key(|&k| &columns[k as usize].name);
        Self { columns, by_name }
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

    /// All columns, in the order of the file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The values of one column, if there is one of that name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let at = self.by_name.binary_search_by_key(&name, |&k| &self.columns[k as usize].name).ok()?;
        Some(&self.columns[self.by_name[at] as usize].values)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }
}
