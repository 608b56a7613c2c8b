//! Functions of Python that formulas call: what is called of them, and what one of them raised.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use holonom::model::{External, ExternalFunction};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};
use pyo3::{PyTraverseError, PyVisit};

use crate::native::Native;
use crate::value::is_complex;

/// What a function has raised, and that in words.
struct Raised {
    error: PyErr,
    words: String,
}

/// What the first function that failed has raised; after it all give no numbers, so that the run stops.
#[derive(Clone, Default)]
pub struct Trouble {
    raised: Arc<Mutex<Option<Raised>>>,
    /// Is set where something was raised: a run that looks at it ends, also where it needs no numbers of the function to go on.
    pub end: Arc<AtomicBool>,
    /// The functions.
    called: Arc<Mutex<Vec<Arc<Parts>>>>,
}

impl Trouble {
    fn held(&self) -> MutexGuard<'_, Option<Raised>> {
        self.raised.lock().unwrap_or_else(|broken| broken.into_inner())
    }

    /// Tells what collects circles of the functions: one may hold what is made of the model that calls it.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        let called = self.called.lock().unwrap_or_else(|broken| broken.into_inner());
        called.iter().try_for_each(|parts| visit.call(&parts.callable).and_then(|()| visit.call(&parts.gradient)))
    }

    /// Whether there are functions that may raise something.
    pub fn is_possible(&self) -> bool {
        !self.called.lock().unwrap_or_else(|broken| broken.into_inner()).is_empty()
    }

    /// Which function has raised what, in words.
    pub fn words(&self) -> Option<String> {
        self.held().as_ref().map(|raised| raised.words.clone())
    }

    /// Takes what was raised, which is nothing from here on.
    pub fn take(&self) -> Option<PyErr> {
        self.held().take().map(|raised| raised.error)
    }

    /// Says in words what was raised, and takes it, but for orders to end, which the program is to get.
    pub fn complain(&self, py: Python<'_>) -> Option<String> {
        let mut held = self.held();
        let words = held.as_ref().map(|raised| raised.words.clone());
        held.take_if(|raised| is_failure(py, &raised.error));
        words
    }
}

/// Whether an exception is a failure, and not an order to end: Ctrl-C, `sys.exit()`.
fn is_failure(py: Python<'_>, error: &PyErr) -> bool {
    error.is_instance_of::<PyException>(py)
}

/// What Python says of a function, as `holonom._functions.Function.parts` gives it.
#[derive(FromPyObject)]
pub struct Parts {
    /// What is called for the values, and for the derivatives.
    callable: Py<PyAny>,
    gradient: Option<Py<PyAny>>,
    /// Numbers of each argument: one is a float, more are an array.
    sizes: Vec<usize>,
    pub values: usize,
    /// Where its machine code is, and whether that takes pointers to arguments and to values.
    native: Option<(usize, bool)>,
}

impl Parts {
    /// How many numbers it takes.
    pub fn arguments(&self) -> usize {
        self.sizes.iter().sum()
    }

    /// Whether it is called without the interpreter.
    pub fn is_native(&self) -> bool {
        self.native.is_some()
    }
}

/// A function as the engine calls it.
pub fn external(name: &str, parts: Parts, trouble: &Trouble) -> External {
    let parts = Arc::new(parts);
    trouble.called.lock().unwrap_or_else(|broken| broken.into_inner()).push(parts.clone());
    match parts.native {
        Some((address, is_of_pointers)) => External::new(Native::new(address, is_of_pointers, parts)),
        None => External::new(Called { name: name.into(), parts, trouble: trouble.clone() }),
    }
}

/// A callable of Python.
struct Called {
    name: String,
    parts: Arc<Parts>,
    trouble: Trouble,
}

impl Called {
    /// Runs what may raise, once nothing was raised before; else no numbers are given.
    fn attempt(&self, out: &mut [f64], work: impl FnOnce(Python<'_>, &mut [f64]) -> PyResult<()>) {
        if self.trouble.held().is_none() {
            let outcome = Python::attach(|py| work(py, out).map_err(|error| self.failure(py, error)));
            match outcome {
                Ok(()) => return,
                Err(raised) => drop(self.trouble.held().get_or_insert(raised)),
            }
            self.trouble.end.store(true, Ordering::Relaxed);
        }
        out.fill(f64::NAN);
    }

    fn given<'py>(&self, py: Python<'py>, arguments: &[f64]) -> PyResult<Bound<'py, PyTuple>> {
        let mut at = 0;
        let each = self.parts.sizes.iter().map(|&size| {
            let numbers = &arguments[at..at + size];
            at += size;
            match size {
                1 => PyFloat::new(py, numbers[0]).into_any(),
                _ => PyArray1::from_slice(py, numbers).into_any(),
            }
        });
        PyTuple::new(py, each.collect::<Vec<_>>())
    }

    /// The exception that the run raises: orders to end as they are.
    fn failure(&self, py: Python<'_>, error: PyErr) -> Raised {
        let repr = error.value(py).repr().map_or_else(|_| "an exception".to_string(), |repr| repr.to_string_lossy().into_owned());
        let words = format!("the function `{}` raised {repr}", self.name);
        if !is_failure(py, &error) {
            return Raised { error, words };
        }
        let make = || {
            let class = py.import("holonom._errors")?.getattr("FunctionError")?;
            let failure = PyErr::from_value(class.call1((&words,))?);
            failure.set_cause(py, Some(error.clone_ref(py)));
            Ok(failure)
        };
        let error = make().unwrap_or_else(|error: PyErr| error);
        Raised { error, words }
    }

    fn wrong<T>(&self, given: &Bound<'_, PyAny>) -> PyResult<T> {
        let values = self.parts.values;
        let wanted = if values == 1 { "a number is".to_string() } else { format!("{values} numbers are") };
        let given = given.repr().map_or(String::new(), |text| text.to_string_lossy().chars().take(60).collect());
        Err(pyo3::exceptions::PyTypeError::new_err(format!("it gave {given}, and {wanted} wanted")))
    }
}

/// What a function gave as a real number, if it is one.
fn real(given: &Bound<'_, PyAny>) -> Option<f64> {
    match given.cast::<PyFloat>() {
        Ok(number) => Some(number.value()),
        Err(_) if is_complex(given) => None,
        Err(_) => given.extract().ok(),
    }
}

impl ExternalFunction for Called {
    fn arguments(&self) -> usize {
        self.parts.arguments()
    }

    fn values(&self) -> usize {
        self.parts.values
    }

    fn call(&self, arguments: &[f64], values: &mut [f64]) {
        self.attempt(values, |py, values| {
            let given = self.parts.callable.bind(py).call1(self.given(py, arguments)?)?;
            if let [value] = values {
                return match real(&given) {
                    Some(number) => {
                        *value = number;
                        Ok(())
                    }
                    None => self.wrong(&given),
                };
            }
            if let Ok(array) = given.extract::<PyReadonlyArray1<'_, f64>>()
                && array.len()? == values.len()
            {
                values.iter_mut().zip(array.as_array()).for_each(|(value, given)| *value = *given);
                return Ok(());
            }
            let numbers = given.extract::<Vec<Bound<'_, PyAny>>>();
            match numbers.map(|numbers| numbers.iter().map(real).collect::<Option<Vec<f64>>>()) {
                Ok(Some(numbers)) if numbers.len() == values.len() => {
                    values.copy_from_slice(&numbers);
                    Ok(())
                }
                _ => self.wrong(&given),
            }
        });
    }

    fn gradient(&self, arguments: &[f64], gradient: &mut [f64]) {
        let Some(of) = &self.parts.gradient else { return holonom::model::differences(self, arguments, gradient) };
        self.attempt(gradient, |py, gradient| {
            let given = of.bind(py).call1(self.given(py, arguments)?)?;
            let matrix: PyReadonlyArray2<'_, f64> = given.extract()?;
            gradient.iter_mut().zip(matrix.as_array()).for_each(|(slope, given)| *slope = *given);
            Ok(())
        });
    }
}
