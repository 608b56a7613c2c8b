//! Many runs of a model, as the command's sweep makes them.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use holonom::model::Value;
use holonom_cli::{Ending, Failure, Line, Plan, Store, Study, Vary, table_writers};
use holonom_io::{Cells, to_json};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use pyo3::{PyTraverseError, PyVisit};

use crate::draft::Draft;
use crate::fault::{failure, model_error, refuse};
use crate::function::Trouble;
use crate::run::{has_no_signal, looked_after, read_changes};
use crate::value;

/// Runs of a model, and the lines of those that have ended.
#[pyclass(frozen, module = "holonom._engine")]
pub struct Sweep {
    study: Study,
    store: Mutex<Store>,
    /// Keys that are set in all runs, as the command takes them.
    set: Vec<String>,
    /// Whether formulas call functions, and whether any needs the interpreter.
    functions: (bool, bool),
    trouble: Trouble,
}

#[pymethods]
impl Sweep {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.trouble.traverse(&visit)
    }

    /// Checks the runs of a model: of a grid over the values of keys, or of the rows of a table with a column for each key.
    #[new]
    fn new(
        py: Python<'_>,
        draft: &Draft,
        changes: &Bound<'_, PyDict>,
        vary: &Bound<'_, PyDict>,
        is_grid: bool,
        method: Option<&str>,
        columns: Vec<String>,
    ) -> PyResult<Self> {
        let trouble = Trouble::default();
        let changes = read_changes(py, changes)?;
        let source = draft.changed(py, &changes, &trouble)?;
        let (mut varied, mut first) = (Vec::new(), changes.clone());
        for (key, given) in vary {
            let key: String = key.extract()?;
            match value::read(&key, &given, &|_, _| true).map_err(|fault| model_error(py, vec![fault.into()], None))? {
                Value::List(values) if !values.is_empty() => {
                    first.push((key.clone(), values[0].clone()));
                    varied.push(Vary::of(&key, values));
                }
                Value::List(_) => return Err(refuse(py, &key, format!("`{key}` has no values"), "give one value at least")),
                _ => {
                    return Err(refuse(
                        py,
                        &key,
                        format!("`{key}` has one value, and a list is wanted"),
                        "set what does not vary by `set`",
                    ));
                }
            }
        }
        let plan = if is_grid { Plan::grid(varied) } else { Plan::rows(varied) };
        let plan = plan.map_err(|fault| failure(py, fault))?;
        let made = py.detach(|| Study::new(source, &draft.stem(), plan, method, &columns));
        if let Some(raised) = trouble.take() {
            return Err(raised);
        }
        let mut study = made.map_err(|fault| match &fault {
            // What is wrong with the model is told in the lines of the program.
            Failure::Model(_) => draft.load_with(py, &first, &trouble).err().unwrap_or_else(|| failure(py, fault)),
            _ => failure(py, fault),
        })?;
        let functions = draft.functions(py)?;
        if functions.1 {
            let trouble = trouble.clone();
            study = study.asking(Arc::new(move || Python::attach(|py| trouble.complain(py))));
        }
        let set = changes.iter().map(|(key, value)| format!("{key}={}", to_json(value))).collect();
        Ok(Self { store: Mutex::new(Store::new(&study)), study, set, functions, trouble })
    }

    /// Number of runs.
    fn runs(&self) -> u64 {
        self.study.runs()
    }

    /// Whether runs must come one after the other, as they call functions that need the interpreter.
    fn is_serial(&self) -> bool {
        self.functions.1
    }

    /// What the table of the study follows from: two with the same have the same rows.
    fn identity(&self) -> String {
        self.identified().to_string()
    }

    /// Keeps lines in a folder, too, and takes over those of the same study there.
    fn open(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        if self.functions.0 {
            let message =
                "`out` was given, and the model calls functions: a journal cannot tell whether they are the same when it is gone on with";
            return Err(refuse(py, "out", message, "leave out `out`, and write the table at the end"));
        }
        let store = Store::open(&folder, force, &self.study, &self.identified()).map_err(|fault| failure(py, fault))?;
        *self.held() = store;
        Ok(())
    }

    /// First and last numbers of runs that have not ended, in pieces of so many at most.
    fn missing(&self, most: u64) -> Vec<(u64, u64)> {
        let mut pieces: Vec<(u64, u64)> = Vec::new();
        for run in self.held().missing() {
            match pieces.last_mut().filter(|(first, last)| last + 1 == run && run - *first < most) {
                Some((_, last)) => *last = run,
                None => pieces.push((run, run)),
            }
        }
        pieces
    }

    /// Makes the runs that have not ended, in threads; says whether all have ended then. Ctrl-C stops, and so does what `progress`
    /// raises, which is called with the number of runs that have ended since.
    fn run(&self, py: Python<'_>, threads: usize, can_interrupt: bool, progress: Option<Py<PyAny>>) -> PyResult<bool> {
        let (interrupted, ended) = (Arc::new(AtomicBool::new(false)), AtomicU64::new(0));
        let missing = self.held().missing();
        let keep = |line: Line| {
            if self.is_told_to_end(&interrupted) {
                return Ok(());
            }
            self.held().add(line)?;
            ended.fetch_add(1, Ordering::Relaxed);
            Ok(())
        };
        let look = || {
            Python::attach(|py| -> PyResult<bool> {
                if can_interrupt && !has_no_signal(py)? {
                    return Ok(false);
                }
                if let Some(progress) = &progress {
                    progress.call1(py, (ended.swap(0, Ordering::Relaxed),))?;
                }
                Ok(true)
            })
        };
        let mut raised = None;
        let work = || self.study.run(&missing, threads, &interrupted, &keep);
        let outcome = looked_after(py, &interrupted, work, || {
            if interrupted.load(Ordering::Relaxed) {
                return true;
            }
            let seen = look();
            let goes_on = matches!(seen, Ok(true));
            raised = seen.err();
            goes_on
        });
        outcome.map_err(|fault| failure(py, fault))?;
        match raised.or(self.trouble.take()) {
            Some(raised) => Err(raised),
            None => look().map(|_| self.held().is_whole()),
        }
    }

    /// The lines of some runs, for the program that keeps them.
    fn lines(&self, py: Python<'_>, first: u64, last: u64) -> PyResult<String> {
        let (runs, lines): (Vec<u64>, _) = ((first..=last).collect(), Mutex::new(String::new()));
        let interrupted = Arc::new(AtomicBool::new(false));
        let keep = |line: Line| {
            if !self.is_told_to_end(&interrupted) {
                lines.lock().expect("no line panics").push_str(&line.text);
            }
            Ok(())
        };
        let ended = py.detach(|| self.study.run(&runs, 1, &interrupted, &keep));
        ended.map_err(|fault| failure(py, fault))?;
        self.trouble.take().map_or(Ok(()), Err)?;
        Ok(lines.into_inner().expect("no line panics"))
    }

    /// Keeps lines that were made elsewhere; gives their number.
    fn add(&self, py: Python<'_>, lines: &str) -> PyResult<u64> {
        let mut store = self.held();
        let mut count = 0;
        for line in lines.split_inclusive('\n') {
            count += u64::from(store.add_text(line, &self.study).map_err(|fault| failure(py, fault))?);
        }
        Ok(count)
    }

    /// Whether all runs have ended.
    fn is_whole(&self) -> bool {
        self.held().is_whole()
    }

    /// Leaves table and report in the folder, where there is one.
    fn finish(&self, py: Python<'_>, formats: Vec<String>, report: bool) -> PyResult<()> {
        let written = py.detach(|| {
            let store = self.held();
            store.finish(&self.study, &store.table(&self.study), &table_writers(&formats)?, report.then_some(&self.set))
        });
        written.map_err(|fault| failure(py, fault))
    }

    /// Lets go of the folder, for others that write there.
    fn release(&self) {
        self.held().release();
    }

    /// Names and cells of all columns. Cells without a value are NaN, or None where they are words.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let table = self.held().table(&self.study);
        table.columns.into_iter().map(|(name, cells)| Ok((name, column(py, cells)?))).collect()
    }

    /// The bytes of the table in a format.
    fn written(&self, py: Python<'_>, format: &str) -> PyResult<Vec<u8>> {
        let written = py.detach(|| {
            let writers = table_writers(&[format.to_string()])?;
            let (_, write) = writers.iter().find(|(writer, _)| writer.name == format).expect("it was asked for");
            let mut bytes = Vec::new();
            write(&self.held().table(&self.study), &mut bytes).expect("memory takes everything");
            Ok(bytes)
        });
        written.map_err(|fault| failure(py, fault))
    }

    /// The report as text of HTML.
    fn report(&self, py: Python<'_>) -> String {
        let page = py.detach(|| {
            let mut page = Vec::new();
            self.study.report(&self.set, &self.held().table(&self.study), &mut page).expect("memory takes everything");
            page
        });
        String::from_utf8(page).expect("a page is text")
    }

    /// Keys and values of the run with a number.
    fn settings<'py>(&self, py: Python<'py>, run: u64) -> PyResult<Bound<'py, PyDict>> {
        let settings = PyDict::new(py);
        for (key, value) in self.study.settings(run) {
            settings.set_item(key, value::write(py, &value)?)?;
        }
        Ok(settings)
    }

    /// How many runs completed, stopped and were refused.
    fn counts(&self) -> [usize; 3] {
        let table = self.held().table(&self.study);
        Ending::ALL.map(|ending| self.study.count(&table, ending))
    }

    /// What is said of the study beside its table.
    fn notes(&self) -> Vec<String> {
        self.study.notes(&self.held().table(&self.study))
    }

    /// Why runs did not complete, in a line for each.
    fn failures(&self) -> Vec<String> {
        self.study.failures(&self.held().table(&self.study))
    }
}

impl Sweep {
    /// Sets the flag where a function has raised an order to end: Ctrl-C, `sys.exit()`. The run in which it did so is not kept.
    fn is_told_to_end(&self, interrupted: &AtomicBool) -> bool {
        let is_told = self.trouble.words().is_some();
        interrupted.fetch_or(is_told, Ordering::Relaxed);
        is_told
    }

    fn held(&self) -> MutexGuard<'_, Store> {
        self.store.lock().expect("no run panics while it writes")
    }

    fn identified(&self) -> serde_json::Value {
        let mut identity = self.study.identity(&self.set);
        identity["vary"] = self.study.digest().into();
        identity
    }
}

/// A column as an array of NumPy, or of words as a list.
fn column(py: Python<'_>, cells: Cells) -> PyResult<Bound<'_, PyAny>> {
    Ok(match cells {
        Cells::Whole(cells) if cells.iter().all(Option::is_some) => {
            PyArray1::from_vec(py, cells.into_iter().flatten().collect::<Vec<i64>>()).into_any()
        }
        Cells::Whole(cells) => {
            PyArray1::from_vec(py, cells.into_iter().map(|cell| cell.map_or(f64::NAN, |cell| cell as f64)).collect()).into_any()
        }
        Cells::Numbers(cells) => PyArray1::from_vec(py, cells.into_iter().map(|cell| cell.unwrap_or(f64::NAN)).collect()).into_any(),
        Cells::Words(cells) => PyList::new(py, cells)?.into_any(),
    })
}
