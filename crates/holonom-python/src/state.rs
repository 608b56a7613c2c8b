//! What a simulation goes on from.

use holonom::model::Value;
use holonom::record::RecorderMark;
use holonom::simulation::Checkpoint;
use holonom_io::Source;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::fault::refuse;

/// All that a simulation goes on from.
#[pyclass(frozen, eq, module = "holonom._engine")]
#[derive(PartialEq)]
pub struct State {
    pub point: (Checkpoint, RecorderMark),
    /// Sum of what its mechanism is made of.
    pub model: String,
}

/// Sum of what a mechanism is made of: of all of its model but how it is run and what is shown of it.
pub(crate) fn sum(source: &Source) -> String {
    let Value::Table(whole) = source.value() else { return String::new() };
    let parts: Vec<_> = whole.iter().filter(|(key, _)| !["title", "simulation", "output"].contains(key)).collect();
    holonom_io::sha256(format!("{parts:?} {:?}", source.files()).as_bytes())
}

#[pymethods]
impl State {
    /// Time, s.
    #[getter]
    fn time(&self) -> f64 {
        self.point.0.state.t
    }

    fn __repr__(&self) -> String {
        format!("<state at {} s>", self.point.0.state.t)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let State { point, model } = slf.get();
        let bytes = serde_json::to_vec(&(point, model)).expect("a state is plain data");
        Ok((slf.get_type().getattr("of_bytes")?, (PyBytes::new(slf.py(), &bytes),)))
    }

    /// What was pickled.
    #[staticmethod]
    fn of_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let (point, model) =
            serde_json::from_slice(bytes).map_err(|error| refuse(py, "state", error.to_string(), "give what a state was pickled to"))?;
        Ok(Self { point, model })
    }
}
