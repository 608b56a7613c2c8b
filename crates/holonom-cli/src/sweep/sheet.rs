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

/// What is between the notes of a run in their cell.
const BETWEEN_NOTES: &str = " | ";

/// Most notes that are told of all runs.
const MOST_NOTES: usize = 5;

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
            outcome.notes.iter().map(|note| one_line(note)).collect::<Vec<_>>().join(BETWEEN_NOTES),
        ]);
        match &outcome.figures {
            None => cells.resize(self.width() - self.shown.len(), String::new()),
            Some(figures) => {
                cells.push(figures.steps.to_string());
                cells.extend([figures.drift, figures.position, figures.velocity, figures.iterations_per_step].map(csv_number));
                cells.push(figures.rejected_steps.to_string());
            }
        }
        cells.extend(outcome.columns.iter().map(|value| optional(*value)));
        cells.resize(self.width(), String::new());
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

    /// What the runs of a table have notes of: each note once, as the first run has it, with how many have it but for its numbers.
    pub fn noted(&self, table: &Table) -> Vec<String> {
        let cells = &table.columns[self.varied.len() + ENDING.len()].1;
        let mut kinds: Vec<Noted> = Vec::new();
        for row in 0..table.rows() {
            for note in cells.text(row).split(BETWEEN_NOTES).filter(|note| !note.is_empty()) {
                let words = without_numbers(note);
                match kinds.iter_mut().find(|kind| kind.words == words) {
                    Some(kind) if kind.last == row => {}
                    Some(kind) => (kind.runs, kind.last) = (kind.runs + 1, row),
                    None => kinds.push(Noted { words, text: note.into(), first: row, last: row, runs: 1 }),
                }
            }
        }
        let told = |kind: &Noted| {
            let (have, run) = (if kind.runs == 1 { "has" } else { "have" }, table.columns[0].1.text(kind.first));
            format!("{} of {} runs {have} this note, as run {run} in the column `notes`: {}", kind.runs, table.rows(), kind.text)
        };
        let more = kinds.len().saturating_sub(MOST_NOTES);
        let more = (more > 0).then(|| format!("{more} more {} in the column `notes`", if more == 1 { "note is" } else { "notes are" }));
        kinds.iter().take(MOST_NOTES).map(told).chain(more).collect()
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

/// A note of some runs.
struct Noted {
    /// Without its numbers, which differ from run to run.
    words: String,
    /// As the first of the runs has it.
    text: String,
    /// Rows of the first and the last of the runs so far.
    first: usize,
    last: usize,
    runs: usize,
}

/// A text without its numbers and their signs; digits of names stay.
fn without_numbers(text: &str) -> String {
    let mut kept = String::new();
    let mut is_inside = false;
    for c in text.chars() {
        let begins = c.is_ascii_digit() && !kept.ends_with(|last: char| last.is_alphanumeric() || last == '_');
        is_inside = begins || (is_inside && (c.is_ascii_digit() || matches!(c, '.' | 'e' | '-' | '+')));
        if !is_inside {
            kept.push(c);
        } else if kept.ends_with('-') {
            kept.pop();
        }
    }
    kept
}

/// A text without line breaks and other things that are not to be seen.
fn one_line(text: &str) -> String {
    text.replace('\n', "; ").chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_alike_but_for_their_numbers() {
        let alike = |a: &str, b: &str| without_numbers(a) == without_numbers(b);
        assert!(alike("`arm2` began 1.5e-3 m off, -4 N", "`arm2` began 12 m off, 3e+7 N"));
        assert!(!alike("`arm2` began 1 m off", "`arm3` began 1 m off"));
        assert!(!alike("`a_2` began 1 m off", "`a_12` began 1 m off"));
        assert!(!alike("3 rows follow", "3 rows lead"));
    }
}
