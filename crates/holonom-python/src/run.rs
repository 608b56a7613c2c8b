//! Runs, and what they leave.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use holonom::model::{Value, nearest};
use holonom::record::{Heading, Recording};
use holonom_cli::{Finished, Loaded, Order, simulate};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3::{PyTraverseError, PyVisit};

use crate::draft::{self, Draft, run_error};
use crate::fault::{failure, model_error, refuse};
use crate::function::Trouble;
use crate::value;

/// Of parts that no run has given.
const BROKEN: &str = "this is not what a run was pickled to";

/// Time between two looks whether Ctrl-C was pressed.
const LOOK: Duration = Duration::from_millis(50);

/// A run that was made, with its model.
#[pyclass(frozen, module = "holonom._engine")]
pub struct Recorded {
    /// What the model was loaded from.
    draft: Draft,
    changes: Changes,
    loaded: Loaded,
    finished: Finished,
    trouble: Trouble,
}

/// Keys of a model with their values for a run.
type Changes = Vec<(String, Value)>;

/// What a pickled run is made of: that of its draft, changed keys, method, headings, values column by column, summary as text.
type Parts<'py> = (draft::Parts, Bound<'py, PyDict>, String, Vec<(String, String, String)>, Vec<Bound<'py, PyArray1<f64>>>, String);

/// Simulates a model with some of its keys set to other values. `can_interrupt` says whether this is the thread that signals come to.
#[pyfunction(name = "simulate")]
pub fn run(
    py: Python<'_>,
    draft: &Bound<'_, Draft>,
    changes: &Bound<'_, PyDict>,
    method: Option<&str>,
    can_interrupt: bool,
) -> PyResult<Recorded> {
    let trouble = Trouble::default();
    let (draft, changes) = (Draft::snapshot(draft)?, read_changes(py, changes)?);
    let loaded = draft.load_with(py, &changes, &trouble)?;
    loaded.model.times().map_err(|error| run_error(py, error))?;
    let mut order = Order::new(&loaded, method, None, true).map_err(|fault| failure(py, fault))?;
    order.provenance.command = "holonom in Python".into();
    order.has_thread = !trouble.is_possible();
    let finished = match can_interrupt {
        true => watched(py, &trouble.end, || simulate(&loaded, order, &trouble.end))?,
        false => py.detach(|| simulate(&loaded, order, &trouble.end)),
    };
    // What a function has raised at the start is why there is no run.
    let mut finished = finished.map_err(|fault| trouble.take().unwrap_or_else(|| failure(py, fault)))?;
    if let Some(words) = trouble.words() {
        // And later why the run ended, whatever came of the numbers that it did not give.
        finished.summary["reason"] = words.into();
    }
    Ok(Recorded { draft, changes, finished, loaded, trouble })
}

/// Keys of the model with other values.
pub fn read_changes(py: Python<'_>, changes: &Bound<'_, PyDict>) -> PyResult<Changes> {
    let read = |(key, given): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key: String = key.extract()?;
        let value = value::read(&key, &given, &|_, _| true).map_err(|fault| model_error(py, vec![fault.into()], None))?;
        Ok((key, value))
    };
    changes.iter().map(read).collect()
}

/// Works in a thread while this one waits for it and for signals. Ctrl-C sets the flag; so does what another handler raises, which is raised.
pub fn watched<T: Send>(py: Python<'_>, interrupted: &AtomicBool, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let mut raised = None;
    let done = looked_after(py, interrupted, work, || {
        let seen = Python::attach(has_no_signal);
        let goes_on = matches!(seen, Ok(true));
        raised = raised.take().or(seen.err());
        goes_on
    });
    raised.map_or(Ok(done), Err)
}

/// Whether Ctrl-C was not pressed. What handlers of other signals raise is raised.
pub fn has_no_signal(py: Python<'_>) -> PyResult<bool> {
    match py.check_signals() {
        Err(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => Ok(false),
        seen => seen.map(|()| true),
    }
}

/// Works in a thread while this one waits for it and looks from time to time whether it is to go on; if not, it sets the flag.
pub fn looked_after<T: Send>(
    py: Python<'_>,
    interrupted: &AtomicBool,
    work: impl FnOnce() -> T + Send,
    mut goes_on: impl FnMut() -> bool + Send,
) -> T {
    py.detach(|| {
        std::thread::scope(|scope| {
            let (done, finished) = channel();
            scope.spawn(move || {
                // The other end waits until this is sent.
                let _ = done.send(attached(work));
            });
            loop {
                match finished.recv_timeout(LOOK) {
                    Ok(finished) => return finished,
                    Err(RecvTimeoutError::Timeout) if !goes_on() => interrupted.store(true, Ordering::Relaxed),
                    Err(RecvTimeoutError::Timeout) => (),
                    // The thread has panicked, which the end of the scope hands on.
                    Err(RecvTimeoutError::Disconnected) => panic!("the work has ended without a result"),
                }
            }
        })
    })
}

/// Does work in a thread that the interpreter knows, so that functions of Python need not make themselves known with every call.
fn attached<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    Python::attach(|py| py.detach(work))
}

#[pymethods]
impl Recorded {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.draft.traverse(&visit).and_then(|()| self.trouble.traverse(&visit))
    }

    /// What a function has raised, which has stopped the run.
    fn trouble<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.trouble.take().map(|raised| raised.value(py).clone().into_any())
    }

    /// Names of all columns, in the order of tables.
    fn names(&self) -> Vec<&str> {
        self.finished.recording.columns().iter().map(|column| column.heading.name.as_str()).collect()
    }

    /// Unit and meaning of a column.
    fn heading(&self, name: &str) -> PyResult<(&str, &str)> {
        let column = self.finished.recording.find(name).ok_or_else(|| self.unknown(name))?;
        Ok((&column.heading.unit, &column.heading.meaning))
    }

    /// A copy of the values of a column.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.finished.recording.column(name).ok_or_else(|| self.unknown(name))?;
        Ok(PyArray1::from_slice(py, values))
    }

    /// Number of rows.
    fn rows(&self) -> usize {
        self.finished.recording.rows()
    }

    /// What `summary.json` has, as its text.
    fn summary(&self) -> String {
        self.finished.summary.to_string()
    }

    /// Heading of the report.
    fn title(&self) -> &str {
        self.loaded.title()
    }

    /// The summary as the command prints it.
    fn describe(&self) -> String {
        holonom_cli::describe(&self.loaded, &self.finished.summary)
    }

    /// All that it is made of.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Parts<'py>> {
        let changes = PyDict::new(py);
        self.changes.iter().try_for_each(|(key, value)| changes.set_item(key, value::write(py, value)?))?;
        let columns = self.finished.recording.columns();
        let heading = |Heading { name, unit, meaning }: &Heading| (name.clone(), unit.to_string(), meaning.to_string());
        let headings = columns.iter().map(|column| heading(&column.heading)).collect();
        let values = columns.iter().map(|column| PyArray1::from_slice(py, &column.values)).collect();
        Ok((self.draft.parts(py), changes, self.finished.method.clone(), headings, values, self.summary()))
    }

    /// What has these parts.
    #[staticmethod]
    fn of_parts(py: Python<'_>, parts: Parts<'_>) -> PyResult<Self> {
        let (draft, changes, method, headings, values, summary) = parts;
        let (draft, changes) = (Draft::of_parts(py, draft)?, read_changes(py, &changes)?);
        let trouble = Trouble::default();
        let loaded = draft.load_with(py, &changes, &trouble)?;
        let headings = headings.into_iter().map(|(name, unit, meaning)| Heading { name, unit: unit.into(), meaning: meaning.into() });
        let values = values.iter().map(|column| column.to_vec()).collect::<Result<_, _>>()?;
        let recording = Recording::of_columns(headings, values).ok_or_else(|| refuse(py, "", BROKEN, ""))?;
        let summary: serde_json::Value = serde_json::from_str(&summary).map_err(|_| refuse(py, "", BROKEN, ""))?;
        let completed = summary["status"] == "completed";
        Ok(Self { draft, changes, loaded, finished: Finished { method, recording, summary, completed }, trouble })
    }

    /// Leaves the run in a folder as the command does.
    fn write(&self, py: Python<'_>, folder: PathBuf, formats: Vec<String>, report: bool, force: bool) -> PyResult<()> {
        let written = py.detach(|| self.finished.write_to(&folder, &self.loaded, &formats, report, force));
        written.map_err(|fault| failure(py, fault))
    }

    /// The report as text of HTML.
    fn report(&self, py: Python<'_>) -> String {
        let page = py.detach(|| {
            let mut page = Vec::new();
            self.finished.report(&self.loaded, &mut page).expect("memory takes everything");
            page
        });
        String::from_utf8(page).expect("a page is text")
    }
}

impl Recorded {
    /// The model and what its run has left.
    pub fn with_model(&self) -> (&Loaded, &Finished) {
        (&self.loaded, &self.finished)
    }

    fn unknown(&self, name: &str) -> PyErr {
        unknown(name, self.names())
    }
}

/// There is no column of a name.
pub fn unknown(name: &str, names: Vec<&str>) -> PyErr {
    let cure = nearest(name, names).map_or("`columns` has the names of all".to_string(), |near| format!("did you mean `{near}`?"));
    PyKeyError::new_err(format!("no column is called `{name}`: {cure}"))
}
