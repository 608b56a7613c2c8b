//! A simulation that a program steps.

use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};
use std::time::{Duration, Instant};

use holonom::model::nearest;
use holonom::run::RunError;
use holonom::simulation::{Method, Simulation};
use holonom_cli::Loaded;
use holonom_report::Frames;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use pyo3::{PyTraverseError, PyVisit};

use crate::draft::{Draft, run_error};
use crate::fault::refuse;
use crate::function::Trouble;
use crate::run::{read_changes, unknown};
use crate::running::{Running, find_forces};
use crate::state::{State, sum};

/// Longest time that other threads are given then.
const TURN: Duration = Duration::from_millis(1);

/// Time between two looks whether another thread is done.
const PAUSE: Duration = Duration::from_micros(20);

thread_local! {
    /// Where the simulations are within which this thread is.
    static WITHIN: RefCell<Vec<usize>> = const { RefCell::new(Vec::new()) };
}

/// Which simulation is within a step whose function waits for which other, by where they are.
static WAITS: Mutex<Vec<[usize; 2]>> = Mutex::new(Vec::new());

/// Notes that steps of the simulations `within` wait for another. False where that waits for one of them itself, so that neither would ever go on.
fn may_wait(within: &[usize], wanted: usize) -> bool {
    let mut waits = WAITS.lock().unwrap_or_else(|broken| broken.into_inner());
    let mut behind = vec![wanted];
    let mut k = 0;
    while let Some(from) = behind.get(k).copied() {
        behind.extend(waits.iter().filter(|[of, _]| *of == from).map(|[_, on]| *on));
        k += 1;
    }
    let is_free = within.iter().all(|from| !behind.contains(from));
    if is_free {
        waits.extend(within.iter().map(|from| [*from, wanted]));
    }
    is_free
}

/// A model at work, step by step.
#[pyclass(frozen, module = "holonom._engine")]
pub struct Simulator {
    loaded: Loaded,
    running: Mutex<Running>,
    /// Threads that wait for it.
    waiting: AtomicUsize,
    notes: Vec<String>,
    trouble: Trouble,
    /// Sum of what the mechanism is made of, once it was asked for.
    sum: OnceLock<String>,
}

impl Simulator {
    /// Sum of what the mechanism is made of.
    fn sum(&self) -> &str {
        self.sum.get_or_init(|| sum(&self.loaded.source))
    }

    /// The simulation, once no other thread is at it. A function that a step calls cannot have it.
    fn running(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Running>> {
        self.require_outside(py)?;
        if let Some(running) = self.free() {
            return Ok(running);
        }
        let within = WITHIN.with_borrow(Clone::clone);
        if !may_wait(&within, self.address()) {
            let why = "functions of two simulations, which are within a step each, wait for each other's simulation";
            return Err(refuse(py, "", why, "step both in one thread, or give the functions what they read as arguments or inputs"));
        }
        let wait = || loop {
            // The other thread may need the interpreter.
            py.detach(|| std::thread::sleep(PAUSE));
            py.check_signals()?;
            if let Some(running) = self.free() {
                return Ok(running);
            }
        };
        let outcome = self.waiting(wait);
        WAITS.lock().unwrap_or_else(|broken| broken.into_inner()).retain(|[from, _]| !within.contains(from));
        outcome
    }

    /// The simulation, where no other thread is at it.
    fn free(&self) -> Option<MutexGuard<'_, Running>> {
        match self.running.try_lock() {
            Ok(running) => Some(running),
            Err(TryLockError::Poisoned(broken)) => Some(broken.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Waits for the simulation, of which the thread that has it is told.
    fn waiting<T>(&self, wait: impl FnOnce() -> T) -> T {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        let done = wait();
        self.waiting.fetch_sub(1, Ordering::Relaxed);
        done
    }

    /// Gives other threads that wait for the simulation time to get it.
    fn let_others(&self) {
        let begun = Instant::now();
        while self.waiting.load(Ordering::Relaxed) > 0 && begun.elapsed() < TURN {
            std::thread::sleep(PAUSE);
        }
    }

    fn require_outside(&self, py: Python<'_>) -> PyResult<()> {
        match WITHIN.with_borrow(|within| within.contains(&self.address())) {
            false => Ok(()),
            true => Err(refuse(
                py,
                "",
                "the simulation is within a step, and a function of its model wants to have it",
                "give the function what it reads as arguments",
            )),
        }
    }

    fn address(&self) -> usize {
        std::ptr::from_ref(self).addr()
    }

    /// Does something in which functions of Python may be called.
    fn within<T>(&self, running: &mut Running, work: impl FnOnce(&mut Running) -> T) -> T {
        WITHIN.with_borrow_mut(|within| within.push(self.address()));
        let done = work(running);
        WITHIN.with_borrow_mut(Vec::pop);
        done
    }

    /// Raises what a function has raised. What it gave no numbers for is to be found again, so that it raises again.
    fn raise(&self, running: &mut Running) -> PyResult<()> {
        self.trouble.take().map_or(Ok(()), |raised| {
            (running.is_row_new, running.is_motion_new, running.are_forces_new) = (false, false, false);
            Err(raised)
        })
    }
}

#[pymethods]
impl Simulator {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.trouble.traverse(&visit)
    }

    /// Puts a model at its start, with some keys of it set to other values.
    #[new]
    fn new(py: Python<'_>, draft: &Bound<'_, Draft>, changes: &Bound<'_, PyDict>, method: Option<&str>) -> PyResult<Self> {
        let trouble = Trouble::default();
        let loaded = Draft::snapshot(draft)?.load_with(py, &read_changes(py, changes)?, &trouble)?;
        let model = &loaded.model;
        let begin = || {
            let method = Method::resolve(&model.choice(method))?;
            let mut simulation = Simulation::new(model.system.clone(), method, model.step()?)?;
            find_forces(model, &mut simulation);
            Ok(simulation)
        };
        let begun = py.detach(begin);
        if let Some(raised) = trouble.take() {
            return Err(raised);
        }
        let simulation = begun.map_err(|error: RunError| run_error(py, error))?;
        let running = Running::new(model, simulation);
        let notes = holonom_cli::notes(&loaded, &running.simulation);
        trouble.take().map_or(
            Ok(Self { running: Mutex::new(running), waiting: AtomicUsize::new(0), notes, loaded, trouble, sum: OnceLock::new() }),
            Err,
        )
    }

    /// What looks like a slip, and what was put right before the start.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Takes nominal steps, and says whether the simulation goes on.
    #[pyo3(signature = (count = 1))]
    fn step(&self, py: Python<'_>, count: i64) -> PyResult<bool> {
        if count < 0 {
            return Err(refuse(py, "count", format!("`count` is {count}, and steps only go forward"), "give 0 or more"));
        }
        let mut running = self.running(py)?;
        if count == 1 && running.is_short {
            let (_, goes_on) = self.within(&mut running, |running| running.advance(1, &self.trouble));
            return self.raise(&mut running).map(|()| goes_on);
        }
        drop(running);
        let mut left = count;
        loop {
            py.detach(|| self.let_others());
            let mut running = self.running(py)?;
            let at = &mut *running;
            let (taken, goes_on) = py.detach(|| {
                let taken = self.within(at, |running| running.advance(left, &self.trouble));
                self.raise(at).map(|()| taken)
            })?;
            left -= taken;
            if left == 0 || !goes_on {
                return Ok(goes_on);
            }
            drop(running);
            py.check_signals()?;
        }
    }

    /// Time, s.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.running(py)?.simulation.state().t)
    }

    /// Nominal step, s.
    #[getter]
    fn nominal_step(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.running(py)?.simulation.nominal_step())
    }

    /// Nominal steps taken.
    #[getter]
    fn steps(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.running(py)?.simulation.steps())
    }

    /// Why the last step was the last; None while the simulation goes on.
    #[getter]
    fn ended(&self, py: Python<'_>) -> PyResult<Option<String>> {
        Ok(self.running(py)?.ended.clone())
    }

    /// Name of the event that made the last step the last.
    #[getter]
    fn event(&self, py: Python<'_>) -> PyResult<Option<String>> {
        Ok(self.running(py)?.event.clone())
    }

    /// Heading of its model.
    #[getter]
    fn title(&self) -> &str {
        self.loaded.title()
    }

    /// Name of its method.
    #[getter]
    fn method(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.running(py)?.simulation.method().name.clone())
    }

    /// Names of the columns.
    fn names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.running(py)?.recorder.recording().columns().iter().map(|column| column.heading.name.clone()).collect())
    }

    /// Where the column of a name stands among them.
    fn place(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let running = self.running(py)?;
        let recording = running.recorder.recording();
        recording.place(name).ok_or_else(|| unknown(name, recording.columns().iter().map(|column| column.heading.name.as_str()).collect()))
    }

    /// Value of a column at the present state.
    fn value(&self, py: Python<'_>, place: usize) -> PyResult<f64> {
        let mut running = self.running(py)?;
        let value = self.within(&mut running, |running| running.value(place));
        self.raise(&mut running).map(|()| value)
    }

    /// What frames are made of, as the viewer reads it, and the places of their columns.
    fn layout(&self, py: Python<'_>) -> PyResult<(String, Vec<usize>)> {
        let running = self.running(py)?;
        let recording = running.recorder.recording();
        let frames = Frames::new(&self.loaded.model.scene, |name| recording.place(name).is_some());
        let places = frames.columns().iter().filter_map(|name| recording.place(name)).collect();
        Ok((serde_json::to_string(&frames).expect("a scene is plain data"), places))
    }

    /// Values of some columns at the present state, as 64-bit floats.
    fn frame<'py>(&self, py: Python<'py>, places: Vec<usize>) -> PyResult<Bound<'py, PyBytes>> {
        let mut running = self.running(py)?;
        let bytes: Vec<u8> =
            self.within(&mut running, |running| places.iter().flat_map(|&place| running.value(place).to_le_bytes()).collect());
        self.raise(&mut running).map(|()| PyBytes::new(py, &bytes))
    }

    /// Name, unit and meaning of each input.
    fn inputs(&self) -> Vec<[&str; 3]> {
        self.loaded.model.channels.inputs.iter().map(|input| [&*input.name, &*input.unit, &*input.meaning]).collect()
    }

    /// Value of an input.
    fn input(&self, py: Python<'_>, name: &str) -> PyResult<f64> {
        self.running(py)?.simulation.input(name).ok_or_else(|| self.no_input(name))
    }

    /// Sets an input, which counts from here on.
    fn set_input(&self, py: Python<'_>, name: &str, value: f64) -> PyResult<()> {
        if !value.is_finite() {
            return Err(refuse(py, name, format!("the input `{name}` cannot be {value}"), "set it to a finite number"));
        }
        let mut running = self.running(py)?;
        (running.is_row_new, running.are_forces_new, running.are_inputs_new) = (false, false, true);
        self.within(&mut running, |running| running.simulation.set_input(name, value)).then_some(()).ok_or_else(|| self.no_input(name))
    }

    /// A copy of the present state.
    fn state(&self, py: Python<'_>) -> PyResult<State> {
        let mut running = self.running(py)?;
        self.within(&mut running, Running::find_forces);
        self.raise(&mut running)?;
        Ok(State { point: (running.simulation.checkpoint(), running.recorder.mark()), model: self.sum().into() })
    }

    /// Goes on from a state of this model.
    fn set_state(&self, py: Python<'_>, state: &State) -> PyResult<()> {
        let (checkpoint, mark) = &state.point;
        let model = &self.loaded.model;
        let running = &mut *self.running(py)?;
        let method = running.simulation.method().clone();
        let resume = || Simulation::resume(model.system.clone(), method, running.simulation.nominal_step(), checkpoint.clone());
        let resumed = (state.model == self.sum()).then(resume).flatten();
        let Some(mut simulation) = resumed else {
            return Err(refuse(
                py,
                "state",
                "the state is that of another model or method",
                "take one that state() of this simulation gave",
            ));
        };
        find_forces(model, &mut simulation);
        running.go_on(model, simulation, mark);
        self.raise(running)
    }
}

impl Simulator {
    fn no_input(&self, name: &str) -> PyErr {
        let known = || self.loaded.model.channels.inputs.iter().map(|input| input.name.as_str());
        let cure = match (nearest(name, known()), known().next()) {
            (Some(near), _) => format!("did you mean `{near}`?"),
            (None, Some(_)) => format!("there are: {}", known().collect::<Vec<_>>().join(", ")),
            (None, None) => "add it with m.input(…) before".into(),
        };
        PyKeyError::new_err(format!("no input is called `{name}`: {cure}"))
    }
}
