//! The table of a sweep: which columns it has, and a line for each run.

use holonom_io::{Cells, Table, csv_cells, csv_line, csv_number};

use super::plan::Plan;
use super::run::{Ending, Outcome};
use super::vary::Setting;
use super::watch::Columns;

/// Columns between the varied keys and those of the motion.
const FIGURES: [&str; 6] = ["steps", "energy_drift", "position_violation", "velocity_violation", "iterations_per_step", "rejected_steps"];

/// Columns around the varied keys.
const RUN: &str = "run";
const ENDING: [&str; 4] = ["status", "stopped_at", "reason", "notes"];

/// What the columns of a sweep are called.
pub struct Sheet {
    /// Varied keys, and whether all their values are numbers.
    varied: Vec<(String, bool)>,
    /// Columns of the motion.
    shown: Vec<String>,
}

impl Sheet {
    /// The table of a plan with some columns of the motion.
    pub fn new(plan: &Plan, columns: &Columns) -> Self {
        Self {
            varied: plan.varied.iter().map(|vary| (vary.path.clone(), vary.is_numeric())).collect(),
            shown: columns.asked.iter().map(|asked| asked.text.clone()).collect(),
        }
    }

    /// The first column of the motion that would be called as another column of the table.
    pub fn twice(&self) -> Option<&str> {
        let varied = || self.varied.iter().map(|(path, _)| path.as_str());
        let is_taken = |name: &&String| varied().chain([RUN]).chain(ENDING).chain(FIGURES).any(|taken| taken == name.as_str());
        self.shown.iter().find(is_taken).map(String::as_str)
    }

    /// A run as a line of CSV.
    pub fn line(&self, run: u64, settings: &[Setting], outcome: &Outcome) -> String {
        let mut cells = vec![run.to_string()];
        cells.extend(settings.iter().map(|setting| one_line(&setting.text)));
        let optional = |value: Option<f64>| value.map_or(String::new(), csv_number);
        cells.extend([
            outcome.ending.word().into(),
            optional(outcome.stopped_at),
            one_line(&outcome.reason),
            one_line(&outcome.notes.join("\n")),
        ]);
        match &outcome.figures {
            None => cells.resize(self.width(), String::new()),
            Some(figures) => {
                cells.push(figures.steps.to_string());
                cells.extend([figures.drift, figures.position, figures.velocity, figures.iterations_per_step].map(csv_number));
                cells.push(figures.rejected_steps.to_string());
                cells.extend(figures.columns.iter().map(|value| optional(*value)));
            }
        }
        csv_line(&cells)
    }

    /// The number of the run that a line is of, if it is a line of this table.
    pub fn run(&self, line: &str) -> Option<u64> {
        let cells = csv_cells(line);
        let run = cells.first()?.parse().ok()?;
        (cells.len() == self.width() && Ending::ALL.iter().any(|ending| ending.word() == cells[1 + self.varied.len()])).then_some(run)
    }

    /// The table of some lines, in their order.
    pub fn table<'a>(&self, lines: impl Iterator<Item = &'a String>) -> Table {
        let mut table = self.empty();
        for line in lines {
            for ((_, column), cell) in table.columns.iter_mut().zip(csv_cells(line)) {
                column.push_text(&cell);
            }
        }
        table
    }

    /// How many runs of a table ended in a way.
    pub fn count(&self, table: &Table, ending: Ending) -> usize {
        match &table.columns[1 + self.varied.len()].1 {
            Cells::Words(cells) => cells.iter().filter(|cell| cell.as_deref() == Some(ending.word())).count(),
            _ => unreachable!("a status is a word"),
        }
    }

    /// How many runs of a table completed without a value in a column of the motion.
    pub fn lacking(&self, table: &Table, name: &str) -> usize {
        let status = &table.columns[1 + self.varied.len()].1;
        let first = self.width() - self.shown.len();
        let Some(column) = self.shown.iter().position(|shown| shown == name).map(|k| &table.columns[first + k].1) else { return 0 };
        let lacks = |row: &usize| status.text(*row) == Ending::Completed.word() && column.text(*row).is_empty();
        (0..table.rows()).filter(lacks).count()
    }

    /// What became of the runs of a table that did not complete, in words.
    pub fn failures(&self, table: &Table) -> Vec<String> {
        let cell = |column: usize, row: usize| table.columns[column].1.text(row);
        let status = 1 + self.varied.len();
        let failed = (0..table.rows()).filter(|&row| cell(status, row) != Ending::Completed.word());
        let words = |row: usize| {
            let settings: Vec<String> = (1..status).map(|k| format!("{}={}", table.columns[k].0, cell(k, row))).collect();
            let at = match cell(status + 1, row) {
                at if at.is_empty() => String::new(),
                at => format!(" at {at} s"),
            };
            format!("run {} ({}) {}{at}: {}", cell(0, row), settings.join(", "), cell(status, row), cell(status + 2, row))
        };
        failed.map(words).collect()
    }

    /// How many runs of a table have notes, with those of the first.
    pub fn noted(&self, table: &Table) -> Option<String> {
        let notes = &table.columns[self.varied.len() + ENDING.len()].1;
        let noted: Vec<usize> = (0..table.rows()).filter(|&row| !notes.text(row).is_empty()).collect();
        let first = *noted.first()?;
        let have = if noted.len() == 1 { "has" } else { "have" };
        let [run, text] = [&table.columns[0].1, notes].map(|cells| cells.text(first));
        Some(format!("{} of {} runs {have} notes, in the column `notes`: run {run}: {text}", noted.len(), table.rows()))
    }

    fn width(&self) -> usize {
        1 + self.varied.len() + ENDING.len() + FIGURES.len() + self.shown.len()
    }

    /// The table without rows.
    fn empty(&self) -> Table {
        let (whole, number, word) = (|| Cells::Whole(Vec::new()), || Cells::Numbers(Vec::new()), || Cells::Words(Vec::new()));
        let mut columns = vec![(RUN.to_string(), whole())];
        columns.extend(self.varied.iter().map(|(path, is_numeric)| (path.clone(), if *is_numeric { number() } else { word() })));
        columns.extend(ENDING.into_iter().map(String::from).zip([word(), number(), word(), word()]));
        columns.extend(FIGURES.map(|name| (name.to_string(), if name.ends_with("steps") { whole() } else { number() })));
        columns.extend(self.shown.iter().map(|name| (name.clone(), number())));
        Table { columns }
    }
}

/// A text without line breaks and other things that are not to be seen.
fn one_line(text: &str) -> String {
    text.replace('\n', "; ").chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
