//! The page about a sweep: how each column depends on what was varied, and a table of all runs.

mod axis;
mod chart;
mod colour;
mod map;
mod plot;
mod runs;

use std::io;

use crate::escape::html;
use crate::page;

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

impl SweepReport<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        page::head(self.title, "", out)?;
        writeln!(out, "<header>\n<h1>{}</h1>\n<p class=\"method\">{}</p>\n</header>\n<main>", html(self.title), self.question())?;
        self.charts(out)?;
        runs::write(self, out)?;
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

    /// Of a grid over one key a curve for each column, over two a map; else points over each key.
    fn charts(&self, out: &mut dyn io::Write) -> io::Result<()> {
        let shown: Vec<&SweepColumn> = self.columns.iter().filter(|column| column.values.iter().flatten().any(|v| v.is_finite())).collect();
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
