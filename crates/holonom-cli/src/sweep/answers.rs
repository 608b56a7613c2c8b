//! What a sweep was made for, on the terminal: the columns that were asked for.

use holonom_io::{Cells, Table};
use serde_json::{Value, json};

use crate::table::{figures, figures_beside, table as grid};

/// Most runs of which all are told; of more, where each column is least and where it is largest.
const FEW: usize = 20;

/// The columns of a sweep that were asked for, beside what was varied.
pub struct Answers<'a> {
    table: &'a Table,
    /// How many keys were varied, whose columns follow that of the number of the run.
    varied: usize,
    /// The first of the columns that were asked for.
    first: usize,
    /// The unit of each of these, `"1"` of numbers without one.
    units: &'a [String],
}

/// Where a column is least or largest.
#[derive(Clone, Copy)]
struct Side {
    row: usize,
    value: f64,
}

impl<'a> Answers<'a> {
    /// Of a table whose last columns were asked for and have these units.
    pub fn new(table: &'a Table, varied: usize, units: &'a [String]) -> Self {
        Self { table, varied, first: table.columns.len() - units.len(), units }
    }

    fn name(&self, column: usize) -> &str {
        &self.table.columns[column].0
    }

    /// The name of a column and what is told of it, with its unit where it was asked for.
    fn heading(&self, column: usize, what: &str) -> String {
        let name = format!("{}{what}", self.name(column));
        match self.units.get(column.wrapping_sub(self.first)).filter(|unit| *unit != "1") {
            Some(unit) => format!("{name} ({unit})"),
            None => name,
        }
    }

    /// A number of a column as people read it: zero where it is round-off beside the largest of its unit.
    fn figures(&self, column: usize, value: f64) -> String {
        let unit = |column: usize| &self.units[column - self.first];
        let is_like = |&other: &usize| other == column || (unit(other) == unit(column) && unit(column) != "1");
        let alike = (self.first..self.table.columns.len()).filter(is_like);
        let sizes = alike.filter_map(|column| self.sides(column)).flatten().map(|side| side.value.abs());
        figures_beside(value, sizes.fold(0.0, f64::max))
    }

    fn number(&self, column: usize, row: usize) -> Option<f64> {
        match &self.table.columns[column].1 {
            Cells::Numbers(values) => values[row],
            _ => None,
        }
    }

    /// Where a column is least and where it is largest; none where it has no numbers.
    fn sides(&self, column: usize) -> Option<[Side; 2]> {
        let all = || (0..self.table.rows()).filter_map(|row| self.number(column, row).map(|value| Side { row, value }));
        let mut all = all().filter(|side| side.value.is_finite());
        let first = all.next()?;
        Some(all.fold([first; 2], |[least, most], side| {
            [if side.value < least.value { side } else { least }, if side.value > most.value { side } else { most }]
        }))
    }

    /// What was varied in a run, as it is written behind `--set`.
    fn settings(&self, row: usize) -> String {
        let of_key = |column: usize| format!("{}={}", self.name(column), self.table.columns[column].1.text(row));
        (1..=self.varied).map(of_key).collect::<Vec<_>>().join(" ")
    }

    /// As people read them; nothing where nothing was asked for.
    pub fn words(&self) -> Option<String> {
        let asked = self.first..self.table.columns.len();
        if asked.is_empty() {
            return None;
        }
        if self.table.rows() <= FEW {
            let shown: Vec<usize> = (1..=self.varied).chain(asked).collect();
            let header: Vec<String> = shown.iter().map(|&column| self.heading(column, "")).collect();
            let header: Vec<&str> = header.iter().map(String::as_str).collect();
            let cell = |column: usize, row: usize| match self.number(column, row) {
                Some(value) if column < self.first => figures(value),
                Some(value) => self.figures(column, value),
                None if column < self.first => self.table.columns[column].1.text(row),
                None => "–".into(),
            };
            let rows: Vec<Vec<String>> =
                (0..self.table.rows()).map(|row| shown.iter().map(|&column| cell(column, row)).collect()).collect();
            return Some(grid(&header, &rows));
        }
        let lines = asked.flat_map(|column| {
            let sides = self.sides(column).map_or([None; 2], |sides| sides.map(Some));
            let line = |what: &str, side: Option<Side>| {
                let [value, place] =
                    side.map_or(["–".into(), String::new()], |side| [self.figures(column, side.value), self.settings(side.row)]);
                vec![self.heading(column, what), value, place]
            };
            [line(" least", sides[0]), line(" largest", sides[1])]
        });
        Some(grid(&["column", "value", "where"], &lines.collect::<Vec<_>>()))
    }

    /// For programs: of each column the least value and the largest, and the runs that have them.
    pub fn values(&self) -> Value {
        let of_column = |column: usize| {
            let [least, most] = self.sides(column)?;
            let values = json!({ "min": least.value, "min_run": least.row + 1, "max": most.value, "max_run": most.row + 1 });
            Some((self.name(column).to_string(), values))
        };
        (self.first..self.table.columns.len()).filter_map(of_column).collect::<serde_json::Map<_, _>>().into()
    }
}
