//! A mechanism from its file to its verdicts, whatever the engine does with it.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use holonom::model::Model;
use holonom::simulation::Named;
use holonom_io::Source;

use crate::judge::{self, Ending, Run};
use crate::mechanism::Mechanism;
use crate::rank::{self, Agreement};
use crate::start;

/// What became of a mechanism.
pub struct Case {
    pub seed: u64,
    /// n and r; nothing where the model was refused or its reading panicked.
    pub size: Option<[usize; 2]>,
    /// Why there is no model.
    pub refused: Option<Ending>,
    pub rank: Option<Agreement>,
    pub start: Option<Agreement>,
    /// A run for each method.
    pub runs: Vec<Run>,
}

/// What is asked of every mechanism.
pub struct Demand {
    pub methods: Vec<&'static Named>,
    /// Of a processor, for a run, s.
    pub limit: f64,
}

thread_local! {
    /// Where the last panic of this thread was, and what it said.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Has panics noted and not printed.
pub fn note_panics() {
    std::panic::set_hook(Box::new(|info| {
        let message = info.payload_as_str().unwrap_or("").lines().next().unwrap_or("").to_string();
        let place = info.location().map_or(String::new(), |place| format!("{}:{}", place.file(), place.line()));
        PANIC.with(|panic| *panic.borrow_mut() = format!("{place}: {message}"));
    }));
}

/// The value of a function, or where it panicked and why.
fn caught<T>(function: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(function)).map_err(|_| PANIC.with(|panic| panic.borrow().clone()))
}

/// Reads, ranks and runs a mechanism.
pub fn judge(seed: u64, mechanism: &Mechanism, demand: &Demand) -> Case {
    let without_model = |ending| Case { seed, size: None, refused: Some(ending), rank: None, start: None, runs: Vec::new() };
    let text = mechanism.toml();
    let model = match caught(|| Source::read("model.toml", text.as_bytes())?.model()) {
        Ok(Ok(model)) => model,
        Ok(Err(message)) => return without_model(Ending::Refused(message)),
        Err(panic) => return without_model(Ending::Panicked(panic)),
    };
    let rank = caught(|| rank::compare(&model, mechanism.size)).unwrap_or_else(|panic| Agreement::Differ("panicked", panic));
    let start = caught(|| start::compare(seed, mechanism, &model)).unwrap_or_else(|panic| Agreement::Differ("panicked", panic));
    let runs = demand.methods.iter().map(|named| run(mechanism, &model, named, demand.limit)).collect();
    Case {
        seed,
        size: Some([model.system.coordinates(), model.system.constraints()]),
        refused: None,
        rank: Some(rank),
        start: Some(start),
        runs,
    }
}

fn run(mechanism: &Mechanism, model: &Model, named: &Named, limit: f64) -> Run {
    let run = caught(|| judge::run(mechanism, model, named, limit));
    run.unwrap_or_else(|panic| Run::without_figures(Ending::Panicked(panic)))
}

impl Ending {
    /// The word for it.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Stopped(_) => "stopped",
            Self::Refused(_) => "refused",
            Self::Broken(_) => "broken",
            Self::Slow(_) => "slow",
            Self::Panicked(_) => "panicked",
        }
    }

    /// Why, if there is something to say.
    pub fn reason(&self) -> &str {
        match self {
            Self::Kept => "",
            Self::Stopped(reason) | Self::Refused(reason) | Self::Broken(reason) | Self::Slow(reason) | Self::Panicked(reason) => reason,
        }
    }

    /// Whether the engine has done wrong: stopping or refusing in words is honest.
    pub fn is_failure(&self) -> bool {
        matches!(self, Self::Broken(_) | Self::Slow(_) | Self::Panicked(_))
    }
}

impl Case {
    /// What was asked and went wrong, each in a line that begins with its sort.
    pub fn failures(&self, demand: &Demand) -> Vec<String> {
        let model = self.refused.iter().filter(|ending| ending.is_failure()).map(|ending| line("model", ending));
        let differ = |what: &str, found: &Option<Agreement>| match found {
            Some(Agreement::Differ(sort, how)) => Some(format!("{what} {sort}: {how}")),
            _ => None,
        };
        let starts = [differ("rank", &self.rank), differ("difference", &self.start)].into_iter().flatten();
        let runs = demand.methods.iter().zip(&self.runs).filter(|(_, run)| run.ending.is_failure());
        model.chain(starts).chain(runs.map(|(named, run)| line(named.name, &run.ending))).collect()
    }
}

/// What happened to whom, in a line.
pub fn line(who: &str, ending: &Ending) -> String {
    match ending.reason() {
        "" => format!("{who}: {}", ending.word()),
        reason => format!("{who}: {}: {reason}", ending.word()),
    }
}
