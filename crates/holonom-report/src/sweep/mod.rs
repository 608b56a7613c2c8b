//! The page about a sweep: how each column depends on what was varied, and a table of all runs.

mod axis;
mod chart;
mod colour;
mod map;
mod plot;
mod runs;

use std::io;

use crate::escape::html;
use crate::{digits, format, page};

/// A key of the model that was varied.
pub struct SweepKey<'a> {
    /// As in the model file, such as `parameters.k`.
    pub name: &'a str,
    /// Whether its values are shown in equal ratios.
    pub is_logarithmic: bool,
}

/// A column of the table.
pub struct SweepColumn<'a> {
    /// As it was asked for.
    pub name: &'a str,
    /// SI unit; `"1"` of numbers without one.
    pub unit: &'a str,
    /// The value of each run; `None` where it has none.
    pub values: Vec<Option<f64>>,
}

/// A run with its values of the keys.
pub struct SweepRun {
    /// From 1.
    pub number: u64,
    /// The value of each key, as it was typed.
    pub settings: Vec<String>,
    /// `"completed"`, or how it failed to.
    pub status: String,
    /// Time reached by a run that stopped, s.
    pub stopped_at: Option<f64>,
    /// Why it did not complete.
    pub reason: String,
}

impl SweepRun {
    fn has_completed(&self) -> bool {
        self.status == "completed"
    }
}

/// A page about a sweep.
pub struct SweepReport<'a> {
    /// Heading of the page, as plain text.
    pub title: &'a str,
    /// What is said of it beside its results.
    pub notes: &'a [String],
    /// The model file, shown at the bottom.
    pub model_text: &'a str,
    /// What the command line set of it, as `KEY=VALUE`.
    pub set: &'a [String],
    /// Whether every value of a key was run with every value of the others, and not random ones.
    pub is_grid: bool,
    /// What was varied.
    pub keys: &'a [SweepKey<'a>],
    /// What was asked of each run.
    pub columns: &'a [SweepColumn<'a>],
    /// In the order of their numbers.
    pub runs: &'a [SweepRun],
}

/// Plots of a page.
const MOST_CHARTS: usize = 24;

/// Columns of one value that are told with it.
const CONSTANT: usize = 8;

impl SweepReport<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        page::head(self.title, "", out)?;
        writeln!(out, "<header>\n<h1>{}</h1>\n<p class=\"method\">{}</p>\n</header>\n<main>", html(self.title), self.question())?;
        page::notes(self.notes.iter().cloned(), out)?;
        let (differing, constant): (Vec<&SweepColumn>, Vec<&SweepColumn>) = self.columns.iter().partition(|column| self.differs(column));
        self.charts(&differing, out)?;
        runs::write(self, &differing, out)?;
        self.constant_note(&constant, out)?;
        page::model(self.model_text, out)?;
        if !self.set.is_empty() {
            writeln!(out, "<p class=\"note\">Set on the command line: <code>{}</code></p>", html(&self.set.join(", ")))?;
        }
        writeln!(out, "</main>")?;
        page::end(out)
    }

    /// How many runs there are, how they ended, and over what they are.
    fn question(&self) -> String {
        let count = |what: &str| self.runs.iter().filter(|run| run.status == what).count();
        let ends = ["completed", "stopped", "refused"].map(|what| (count(what), what));
        let ends = ends.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
        let keys: Vec<&str> = self.keys.iter().map(|key| key.name).collect();
        let over = format!("{} of {}", if self.is_grid { "grid" } else { "random samples" }, html(&keys.join(", ")));
        let runs = match self.runs.len() {
            1 => "1 run".to_string(),
            count => format!("{count} runs"),
        };
        std::iter::once(runs).chain(ends).chain([over]).collect::<Vec<_>>().join(" · ")
    }

    /// The largest value of a column, and of all of its unit, which have one round-off.
    fn largest(&self, column: &SweepColumn) -> f64 {
        let alike = self.columns.iter().filter(|other| other.unit == column.unit && other.unit != "1").chain([column]);
        alike.flat_map(|column| &column.values).flatten().filter(|v| v.is_finite()).fold(0.0, |most: f64, v| most.max(v.abs()))
    }

    /// Whether a column is not the same in all runs, but for round-off.
    fn differs(&self, column: &SweepColumn) -> bool {
        let least = digits::ROUND_OFF * self.largest(column);
        let is_as_first = |value: &Option<f64>| match (value, column.values[0]) {
            (Some(value), Some(first)) => *value == first || (value - first).abs() <= least,
            (value, first) => value.is_none() && first.is_none(),
        };
        column.values.len() < 2 || !column.values.iter().all(is_as_first)
    }

    /// Columns that are the same in all runs, which are no part of plots and table.
    fn constant_note(&self, columns: &[&SweepColumn], out: &mut dyn io::Write) -> io::Result<()> {
        let told = columns.iter().take(CONSTANT).map(|column| {
            let value = column.values[0].map_or("–".to_owned(), |value| format::answer_beside(value, self.largest(column)));
            let unit = if column.unit == "1" { String::new() } else { format!(" {}", html(column.unit)) };
            format!("<code>{}</code> = {value}{unit}", html(column.name))
        });
        let mut told: Vec<String> = told.collect();
        if let more @ 1.. = columns.len().saturating_sub(CONSTANT) {
            told.push(format!("and {more} more, in sweep.csv"));
        }
        if told.is_empty() { Ok(()) } else { writeln!(out, "<p class=\"note\">The same in all runs: {}.</p>", told.join(", ")) }
    }

    /// Of a grid over one key a curve for each column, over two a map; else points over each key.
    fn charts(&self, columns: &[&SweepColumn], out: &mut dyn io::Write) -> io::Result<()> {
        let has_values = |column: &&&SweepColumn| column.values.iter().flatten().any(|v| v.is_finite());
        let shown: Vec<&SweepColumn> = columns.iter().filter(has_values).copied().collect();
        if shown.is_empty() {
            return Ok(());
        }
        let is_map = self.is_grid && self.keys.len() == 2;
        let over: Vec<usize> = if is_map { vec![0] } else { (0..self.keys.len()).collect() };
        let pairs = shown.iter().flat_map(|column| over.iter().map(move |key| (column, *key)));
        writeln!(out, "<section>\n<div class=\"charts\">")?;
        for (column, key) in pairs.take(MOST_CHARTS) {
            writeln!(out, "<figure>\n<figcaption>{}</figcaption>", heading(column))?;
            match is_map {
                true => map::write(self, column, out)?,
                false => plot::write(self, column, key, out)?,
            }
            writeln!(out, "</figure>")?;
        }
        writeln!(out, "</div>")?;
        self.notes(shown.len() * over.len(), out)?;
        writeln!(out, "</section>")
    }

    /// What a reader has to know of the plots.
    fn notes(&self, charts: usize, out: &mut dyn io::Write) -> io::Result<()> {
        let mut notes = Vec::new();
        if self.runs.iter().any(|run| !run.has_completed()) {
            notes.push("Runs that did not complete are crosses; what a run that stopped had reached is no part of a curve.".to_string());
        }
        if self.runs.len() > plot::MOST_POINTS && !(self.is_grid && self.keys.len() == 2) {
            notes.push(format!("Plots show {} of {} runs.", plot::MOST_POINTS, self.runs.len()));
        }
        if self.is_grid && self.keys.len() == 2 && self.keys.iter().enumerate().any(|(k, _)| map::is_thinned(self, k)) {
            notes.push(format!("Maps show at most {} values of a key.", map::MOST_CELLS));
        }
        if charts > MOST_CHARTS {
            notes.push(format!(
                "{MOST_CHARTS} of {charts} plots are shown; <code>--columns</code> chooses what is asked, and sweep.csv has all."
            ));
        }
        if notes.is_empty() { Ok(()) } else { writeln!(out, "<p class=\"note\">{}</p>", notes.join(" ")) }
    }
}

/// Name and unit of a column.
fn heading(column: &SweepColumn) -> String {
    let unit = if column.unit == "1" || column.unit.is_empty() { String::new() } else { format!(" <small>{}</small>", html(column.unit)) };
    format!("{}{unit}", html(column.name))
}
