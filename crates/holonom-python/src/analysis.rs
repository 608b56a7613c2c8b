//! What is asked of a model or of several runs, as the command answers it.

use std::sync::atomic::AtomicBool;

use holonom_cli::{Finished, Found, Loaded, Vibrations, checked, largest_steps, side_by_side, write_side_by_side};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::draft::{Draft, run_error};
use crate::fault::failure;
use crate::function::Trouble;
use crate::run::{Recorded, read_changes, watched};

/// JSON, and the text of the command.
type Answer = (String, String);

fn answer(Found { value, text }: Found) -> Answer {
    (value.to_string(), text)
}

/// What a model is made of, and with the projection what that can do to its energy.
#[pyfunction]
pub fn check(py: Python<'_>, draft: &Bound<'_, Draft>, changes: &Bound<'_, PyDict>, projection: bool) -> PyResult<Answer> {
    let trouble = Trouble::default();
    // What is wrong with the model is told in the lines of the program.
    let loaded = Draft::snapshot(draft)?.load_with(py, &read_changes(py, changes)?, &trouble)?;
    let found = py.detach(|| checked(loaded.source, &loaded.name, projection));
    match trouble.take() {
        Some(raised) => Err(raised),
        None => found.map(answer).map_err(|fault| failure(py, fault)),
    }
}

/// The small vibrations about the start of a model.
#[pyfunction]
pub fn modes(py: Python<'_>, draft: &Bound<'_, Draft>, changes: &Bound<'_, PyDict>) -> PyResult<Answer> {
    let found = vibrations(py, draft, changes)?;
    Ok((found.value().to_string(), found.describe()))
}

/// The page on which a model swings in its modes.
#[pyfunction]
pub fn modes_report(py: Python<'_>, draft: &Bound<'_, Draft>, changes: &Bound<'_, PyDict>) -> PyResult<String> {
    let found = vibrations(py, draft, changes)?;
    let mut page = Vec::new();
    found.report(&mut page).expect("memory takes everything");
    Ok(String::from_utf8(page).expect("a page is text"))
}

fn vibrations(py: Python<'_>, draft: &Bound<'_, Draft>, changes: &Bound<'_, PyDict>) -> PyResult<Vibrations> {
    let trouble = Trouble::default();
    let loaded = Draft::snapshot(draft)?.load_with(py, &read_changes(py, changes)?, &trouble)?;
    let found = py.detach(|| Vibrations::of(loaded));
    match trouble.take() {
        Some(raised) => Err(raised),
        None => found.map_err(|fault| failure(py, fault)),
    }
}

/// The largest steps with which some methods complete, or all.
#[pyfunction]
pub fn stability(
    py: Python<'_>,
    draft: &Bound<'_, Draft>,
    changes: &Bound<'_, PyDict>,
    methods: Vec<String>,
    can_interrupt: bool,
) -> PyResult<Answer> {
    let trouble = Trouble::default();
    let loaded = Draft::snapshot(draft)?.load_with(py, &read_changes(py, changes)?, &trouble)?;
    loaded.model.times().map_err(|error| run_error(py, error))?;
    let interrupted = AtomicBool::new(false);
    let search = || largest_steps(&loaded, &methods, &interrupted);
    let found = if can_interrupt { watched(py, &interrupted, search)? } else { py.detach(search) };
    if let Some(raised) = trouble.take() {
        return Err(raised);
    }
    match found.map_err(|fault| failure(py, fault))? {
        Some(found) => Ok(answer(found)),
        None => Err(PyKeyboardInterrupt::new_err("the search was interrupted")),
    }
}

/// Runs by their labels.
type Runs<'py> = Vec<(String, PyRef<'py, Recorded>)>;

fn parts<'a>(runs: &'a Runs<'_>) -> Vec<(String, &'a Loaded, &'a Finished)> {
    let part = |(label, run): &'a (String, PyRef<'_, Recorded>)| {
        let (loaded, finished) = run.with_model();
        (label.clone(), loaded, finished)
    };
    runs.iter().map(part).collect()
}

/// Summaries of runs with the differences of some columns to the first.
#[pyfunction]
pub fn compare(py: Python<'_>, runs: Runs<'_>, columns: Vec<String>) -> PyResult<Answer> {
    side_by_side(&parts(&runs), &columns).map(answer).map_err(|fault| failure(py, fault))
}

/// The report of runs with the summaries that they have side by side.
#[pyfunction]
pub fn compared_report(runs: Runs<'_>, columns: Vec<String>, summaries: &str) -> PyResult<String> {
    let summaries = serde_json::from_str(summaries).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let mut page = Vec::new();
    write_side_by_side(&parts(&runs), &columns, &summaries, &mut page).expect("memory takes everything");
    Ok(String::from_utf8(page).expect("a page is text"))
}
