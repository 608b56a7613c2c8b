//! What is wrong, as `holonom.ModelError`.

use std::path::PathBuf;

use holonom::model::Fault;
use holonom_cli::Failure;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

/// A fault, and where it is: in a file or in the lines of a program; empty where neither has it.
pub struct Placed {
    pub fault: Fault,
    pub place: String,
}

impl From<Fault> for Placed {
    fn from(fault: Fault) -> Self {
        Self { fault, place: String::new() }
    }
}

/// The exception with these faults; `text` is what it says where that is more than the faults themselves.
pub fn model_error(py: Python<'_>, faults: Vec<Placed>, text: Option<String>) -> PyErr {
    let make = || {
        let module = py.import("holonom._errors")?;
        let fault = module.getattr("Fault")?;
        let faults = faults.into_iter().map(|Placed { fault: of, place }| fault.call1((of.message, place, of.path, of.cure)));
        let faults = faults.collect::<PyResult<Vec<_>>>()?;
        module.getattr("ModelError")?.call1((faults, text))
    };
    make().map_or_else(|error| error, PyErr::from_value)
}

/// The exception with one fault that is in no particular place.
pub fn refuse(py: Python<'_>, path: &str, message: impl Into<String>, cure: impl Into<String>) -> PyErr {
    model_error(py, vec![Fault::new(path, "", message, cure).into()], None)
}

/// Options of the command in messages, and the arguments of Python that stand for them.
const WORDS: [(&str, &str); 8] = [
    ("give another --out, or --force to overwrite", "give another `out`, or force=True to overwrite"),
    ("give another --out", "give another `out`"),
    ("and --columns tells differences", "and `columns` tells differences"),
    ("give --set output.reactions=true", "give reactions=True"),
    ("or give a later --end", "or give a later `end`"),
    ("leave out --method", "leave out `method`"),
    ("and --method replaces it", "and `method` replaces it"),
    ("--columns has an empty place in its list", "`columns` has an empty text"),
];

/// What the command would have said, with the arguments of Python.
pub fn failure(py: Python<'_>, failure: Failure) -> PyErr {
    let of_python = |text: String| WORDS.iter().fold(text, |text, (words, ours)| text.replace(words, ours));
    match failure {
        Failure::Model(text) => model_error(py, vec![Fault::new("", "", text.clone(), "").into()], Some(text)),
        Failure::Usage { message, cure } => refuse(py, "", of_python(message), of_python(cure)),
        Failure::NotThere { path, source, cure } => {
            system_error(format!("cannot read {}: {source} ({cure})", path.display()), &source, path)
        }
        Failure::File { doing, path, source } => system_error(format!("cannot {doing} {}: {source}", path.display()), &source, path),
    }
}

/// What the system said about a file.
fn system_error(text: String, source: &std::io::Error, path: PathBuf) -> PyErr {
    match source.raw_os_error() {
        Some(number) => PyOSError::new_err((number, text, path)),
        None => PyOSError::new_err(text),
    }
}
