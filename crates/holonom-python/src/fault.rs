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

/// What the command would have said.
pub fn failure(py: Python<'_>, failure: Failure) -> PyErr {
    match failure {
        Failure::Model(text) => model_error(py, vec![Fault::new("", "", text.clone(), "").into()], Some(text)),
        Failure::Usage { message, cure } => refuse(py, "", message, cure),
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
