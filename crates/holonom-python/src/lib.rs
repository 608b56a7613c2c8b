//! The Python module `holonom._engine`: what the package `holonom` needs of the engine, one function for one need. What people call is
//! in `python/holonom`.

mod analysis;
mod definitions;
mod draft;
mod fault;
mod function;
mod native;
mod run;
mod running;
mod simulator;
mod state;
mod study;
mod value;

use std::ffi::OsString;
use std::process::ExitCode;

use pyo3::prelude::*;

#[pymodule]
mod _engine {
    #[pymodule_export]
    use crate::analysis::{check, compare, compared_report, modes, modes_report, stability};
    #[pymodule_export]
    use crate::definitions::definitions;
    #[pymodule_export]
    use crate::draft::Draft;
    #[pymodule_export]
    use crate::run::{Recorded, run};
    #[pymodule_export]
    use crate::simulator::Simulator;
    #[pymodule_export]
    use crate::state::State;
    #[pymodule_export]
    use crate::study::Sweep;
    #[pymodule_export]
    use crate::{command, example, live};

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

/// Does what was typed, of which the first word is the program, and gives the exit status.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let ended = py.detach(|| holonom_cli::command(words));
    (0..=u8::MAX).find(|&status| ExitCode::from(status) == ended).unwrap_or(u8::MAX)
}

/// The text of an example of the gallery.
#[pyfunction]
fn example(py: Python<'_>, name: &str) -> PyResult<&'static str> {
    holonom_cli::example(name).map_err(|fault| fault::failure(py, fault))
}

/// Script and style sheet of the widget that shows a simulation in a notebook; nothing where the viewer was left out.
#[pyfunction]
fn live() -> Option<(&'static str, &'static str)> {
    holonom_report::LIVE
}
