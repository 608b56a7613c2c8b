//! A sweep that was checked, ready to run: on this machine or, some of its runs at a time, on many.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use holonom::linalg::Plans;
use holonom::model::Value;
use holonom_io::{Source, Table, sha256};
use rayon::prelude::*;
use serde_json::json;

use super::check::{check, files, slips};
use super::column::Asked;
use super::plan::Plan;
use super::reduction::Function;
use super::report::write_report;
use super::run::{Ending, Outcome, Runner};
use super::sheet::Sheet;
use super::watch::Columns;
use crate::failure::Failure;
use crate::provenance::VERSION;

/// What functions that a model calls say of the run that has just ended, where something went wrong in them.
pub type Complaint = Arc<dyn Fn() -> Option<String> + Send + Sync>;

/// A model, and the runs of it that are to be made.
pub struct Study {
    source: Source,
    name: String,
    plan: Plan,
    method: Option<String>,
    columns: Columns,
    sheet: Sheet,
    eliminations: Arc<Plans>,
    complaint: Option<Complaint>,
}

/// A run that has ended.
pub struct Line {
    /// Its number, from 1.
    pub run: u64,
    /// Its line of the table.
    pub text: String,
    /// Its nominal steps.
    pub steps: u64,
}

impl Study {
    /// The SI unit of each column of the motion, `"1"` of numbers without one.
    pub fn units(&self) -> &[String] {
        &self.columns.units
    }

    /// Checks a plan: its keys, the model and the columns asked for, without which there are the last values of everything.
    ///
    /// # Errors
    /// Keys that nothing can be made of, a model that is not sound, and columns that there are not.
    pub fn new(mut source: Source, name: &str, plan: Plan, method: Option<&str>, columns: &[String]) -> Result<Self, Failure> {
        let columns = check(columns, &mut source, method, &plan)?;
        let sheet = Sheet::new(&plan, &columns);
        if let Some(name) = sheet.twice() {
            let message = format!("the table would have two columns `{name}`: one of the motion, and one that it has for every run");
            return Err(Failure::usage(message, format!("ask for last({name}), or give what is recorded as `{name}` another name")));
        }
        let (eliminations, method) = (Arc::default(), method.map(str::to_string));
        Ok(Self { source, name: name.into(), plan, method, columns, sheet, eliminations, complaint: None })
    }

    /// The same of a model that calls functions. They are asked after every run, which must come one after the other then.
    pub fn asking(mut self, complaint: Complaint) -> Self {
        self.complaint = Some(complaint);
        self
    }

    /// What looks like a slip in it.
    pub fn slips(&self) -> Vec<String> {
        slips(&self.source, &self.plan).into_iter().chain(self.idle()).collect()
    }

    /// What was given for runs, where no column asks for one.
    fn idle(&self) -> Option<String> {
        let varied = self.plan.varied.iter().map(|vary| vary.path.as_str());
        let keys = varied.chain(self.source.replaced().iter().map(|(key, _)| key.as_str()));
        let of_runs = keys.filter(|key| key.starts_with("simulation.") || key.starts_with("output."));
        let given: Vec<String> = of_runs.map(|key| format!("`{key}`")).chain(self.method.iter().map(|_| "the method".into())).collect();
        (!self.columns.runs && !given.is_empty()).then(|| {
            let make = if given.len() == 1 { "makes" } else { "make" };
            format!("the columns are those of modes, which take no run, so that {} {make} no difference", given.join(", "))
        })
    }

    /// Columns that runs of a table lack, as they ended before a time, or as there is no such vibration.
    fn lacking(&self, table: &Table) -> Vec<String> {
        let told = |asked: &Asked| {
            let count = self.sheet.lacking(table, &asked.text);
            let why = match asked.function {
                Function::At(t) => format!("which ended before {t} s or {} the column", if count == 1 { "lacks" } else { "lack" }),
                Function::Mode(_, number) => format!("where mode {number} does not vibrate or there are fewer"),
                _ => return None,
            };
            let runs = if count == 1 { "one run".into() } else { format!("{count} runs") };
            (count > 0).then(|| format!("`{}` has no value in {runs} of {}, {why}", asked.text, table.rows()))
        };
        self.columns.asked.iter().filter_map(told).collect()
    }

    /// What is said of it beside the results: slips, and of all runs of a table what they lack and what is said of them.
    pub fn notes(&self, table: &Table) -> Vec<String> {
        self.slips().into_iter().chain(self.of_runs(table)).collect()
    }

    /// The same of the runs alone.
    pub fn of_runs(&self, table: &Table) -> Vec<String> {
        self.lacking(table).into_iter().chain(self.sheet.noted(table)).collect()
    }

    /// Number of runs.
    pub fn runs(&self) -> u64 {
        self.plan.runs
    }

    /// What two sweeps must have in common for one to go on with the other's runs, but for how their runs were asked for.
    pub fn identity(&self, set: &[String]) -> serde_json::Value {
        json!({
            "version": VERSION, "set": set, "method": self.method,
            "columns": self.columns.texts(), "model": self.source.text(), "files": files(&self.source, &self.plan),
        })
    }

    /// What stands for all values that a program has given.
    pub fn digest(&self) -> String {
        let mut text = format!("{}\n", self.plan.is_grid());
        for vary in &self.plan.varied {
            text.extend([&vary.path, "\n"]);
            vary.each().for_each(|setting| text.extend([&setting.text, "\n"]));
        }
        sha256(text.as_bytes())
    }

    /// Keys and values of a run.
    pub fn settings(&self, run: u64) -> Vec<(&str, Value)> {
        let settings = self.plan.settings(run).into_iter().map(|setting| setting.value);
        self.plan.varied.iter().map(|vary| vary.path.as_str()).zip(settings).collect()
    }

    /// Makes some runs, several at a time and in no order; says of each that ended. The flag ends them all.
    ///
    /// # Errors
    /// What `ended` fails with, which ends them, too; threads that cannot be started.
    pub fn run(
        &self,
        runs: &[u64],
        threads: usize,
        interrupted: &Arc<AtomicBool>,
        ended: &(dyn Fn(Line) -> Result<(), Failure> + Sync),
    ) -> Result<(), Failure> {
        let runner = Runner {
            source: &self.source,
            plan: &self.plan,
            method: self.method.as_deref(),
            columns: &self.columns,
            eliminations: self.eliminations.clone(),
            interrupted: interrupted.clone(),
        };
        let one = |&run: &u64| {
            let settings = self.plan.settings(run);
            let outcome = runner.run(&settings);
            let complaint = self.complaint.as_ref().and_then(|complaint| complaint());
            let Some(outcome) = outcome else { return Ok(()) };
            let outcome = match complaint {
                Some(text) => complained(text, outcome),
                None => outcome,
            };
            let steps = outcome.figures.as_ref().map_or(0, |figures| figures.steps);
            ended(Line { run, text: self.sheet.line(run, &settings, &outcome), steps })
        };
        if threads == 1 {
            return runs.iter().try_for_each(one);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| Failure::usage(format!("the threads cannot be started: {error}"), "give fewer threads"))?;
        pool.install(|| runs.par_iter().with_max_len(1).try_for_each(one))
    }

    /// The table of some lines, in their order.
    pub fn table<'a>(&self, lines: impl Iterator<Item = &'a String>) -> Table {
        self.sheet.table(lines)
    }

    /// How many runs of a table ended in a way.
    pub fn count(&self, table: &Table, ending: Ending) -> usize {
        self.sheet.count(table, ending)
    }

    /// What became of the runs of a table that did not complete, in words.
    pub fn failures(&self, table: &Table) -> Vec<String> {
        self.sheet.failures(table)
    }

    /// Writes the page about all runs of a table.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn report(&self, set: &[String], table: &Table, out: &mut dyn std::io::Write) -> std::io::Result<()> {
        write_report((&self.source, &self.name), set, &self.plan, &self.columns, (table, &self.notes(table)), out)
    }

    pub(super) fn sheet(&self) -> &Sheet {
        &self.sheet
    }
}

/// A run in which a function failed: it gave no numbers from there on, so that nothing is to be made of what completed all the same.
fn complained(text: String, outcome: Outcome) -> Outcome {
    let ending = if outcome.ending == Ending::Refused { Ending::Refused } else { Ending::Stopped };
    Outcome { ending, reason: text, ..outcome }
}
