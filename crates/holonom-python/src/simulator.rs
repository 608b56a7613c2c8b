//! A simulation that a program steps.

use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, TryLockError};
use std::time::{Duration, Instant};

use holonom::model::{Value, nearest};
use holonom::record::{Constraints, Recorder, RecorderMark};
use holonom::run::RunError;
use holonom::simulation::{Checkpoint, Divisions, Method, Observer, Simulation, Status, Verdict};
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

/// Time between two looks for signals and for other threads that wait.
const LOOK: Duration = Duration::from_millis(50);

/// Longest time that other threads are given then.
const TURN: Duration = Duration::from_millis(1);

/// Steps that take less time keep the interpreter to themselves: to give it away and to take it back would be a good part of them.
const SHORT: Duration = Duration::from_micros(100);

/// Time between two looks whether another thread is done.
const PAUSE: Duration = Duration::from_micros(20);

thread_local! {
    /// Where the simulations are within which this thread is.
    static WITHIN: RefCell<Vec<usize>> = const { RefCell::new(Vec::new()) };
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

struct Running {
    simulation: Simulation,
    recorder: Recorder<'static>,
    /// The columns at the present state, and whether they are those.
    row: Vec<f64>,
    is_row_new: bool,
    /// Those of the motion alone, which need no forces, and whether they are of the present state.
    motion: Vec<f64>,
    is_motion_new: bool,
    /// Whether forces of joints and accelerations are those of the present state: they take time, and are found when they are looked at.
    are_forces_new: bool,
    /// Whether inputs were set since the last step.
    are_inputs_new: bool,
    /// Whether the last step that was taken alone was a short one.
    is_short: bool,
    /// Why the last step was the last, and the event that it was.
    ended: Option<String>,
    event: Option<String>,
}

/// Lets a recorder see where a step is divided. Where measures are of the whole run, it sees every step, too.
struct Watch<'a>(&'a mut Recorder<'static>);

impl Observer for Watch<'_> {
    fn after_step(&mut self, _: &Simulation) -> Verdict {
        Verdict::GoOn
    }

    fn wants_forces(&self) -> bool {
        sees_all(self.0)
    }

    fn divisions(&self) -> Divisions {
        if sees_all(self.0) { Divisions::Inside } else { Divisions::Unseen }
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.0.at_division(simulation);
    }
}

/// Whether a recorder has measures of the whole run.
fn sees_all(recorder: &Recorder<'_>) -> bool {
    recorder.divisions() == Divisions::Inside
}

/// All that a simulation goes on from.
#[pyclass(frozen, eq, module = "holonom._engine")]
#[derive(PartialEq)]
pub struct State {
    point: (Checkpoint, RecorderMark),
    /// Sum of what its mechanism is made of.
    model: String,
}

impl Running {
    /// Looks at the state that was just reached, of which forces were found or not.
    fn arrive(&mut self, are_forces_new: bool) {
        (self.is_row_new, self.is_motion_new, self.are_forces_new) = (false, false, are_forces_new);
        if sees_all(&self.recorder) {
            // A recorder wants no run to stop.
            let _ = self.recorder.after_step(&self.simulation);
        }
    }

    /// Whether the run goes on after a step. What a function has raised is why it does not, whatever came of that.
    fn judge(&mut self, status: Status, trouble: &Trouble) -> bool {
        (self.ended, self.event) = match (trouble.words(), status) {
            (Some(words), _) => (Some(words), None),
            (None, Status::Stopped { reason, .. }) => (Some(reason), None),
            (None, Status::Completed) => {
                let event = self.simulation.ended_by().map(|last| last.event.clone());
                (event.as_ref().map(|event| format!("ended by the event `{event}`")), event)
            }
        };
        self.ended.is_none()
    }

    /// Takes nominal steps, but no more than there is time for until the next look. Gives their number, and whether the run goes on.
    fn advance(&mut self, count: i64, trouble: &Trouble) -> (i64, bool) {
        let begun = Instant::now();
        if std::mem::take(&mut self.are_inputs_new) && sees_all(&self.recorder) {
            // What jumps with an input is seen before and after, as where an event sets it.
            self.find_forces();
            self.recorder.at_division(&self.simulation);
        }
        let (mut taken, mut goes_on) = (0, true);
        while goes_on && taken < count && (taken == 0 || begun.elapsed() < LOOK) {
            let status = self.simulation.step_observed(&mut Watch(&mut self.recorder));
            self.arrive(sees_all(&self.recorder));
            goes_on = self.judge(status, trouble);
            taken += 1;
        }
        self.is_short = count == 1 && begun.elapsed() < SHORT;
        (taken, goes_on)
    }

    /// Finds the forces at the present state, where they are not known.
    fn find_forces(&mut self) {
        if !std::mem::replace(&mut self.are_forces_new, true) {
            self.simulation.update_reactions();
        }
    }

    /// All columns.
    fn look(&mut self) -> &[f64] {
        if !self.is_row_new {
            self.find_forces();
            self.row.clear();
            self.row.extend_from_slice(match sees_all(&self.recorder) {
                true => self.recorder.look_beside_run(&self.simulation),
                false => self.recorder.look(&self.simulation),
            });
            self.is_row_new = true;
        }
        &self.row
    }

    /// The value of a column.
    fn value(&mut self, place: usize) -> f64 {
        if self.is_row_new || !self.recorder.is_of_motion(place) {
            return self.look()[place];
        }
        if !self.is_motion_new {
            self.motion.clear();
            self.motion.extend_from_slice(self.recorder.look_at_motion(&self.simulation));
            self.is_motion_new = true;
        }
        self.motion[place]
    }
}

impl Simulator {
    /// Sum of what the mechanism is made of: of all of the model but how it is run and what is shown of it.
    fn sum(&self) -> &str {
        self.sum.get_or_init(|| {
            let Value::Table(whole) = self.loaded.source.value() else { return String::new() };
            let parts: Vec<_> = whole.iter().filter(|(key, _)| !["title", "simulation", "output"].contains(key)).collect();
            holonom_io::sha256(format!("{parts:?} {:?}", self.loaded.source.files()).as_bytes())
        })
    }

    /// The simulation, once no other thread is at it. A function that a step calls cannot have it.
    fn running(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Running>> {
        self.require_outside(py)?;
        if let Some(running) = self.free() {
            return Ok(running);
        }
        // The other thread may need the interpreter.
        let wait = || std::iter::repeat_with(|| py.detach(|| std::thread::sleep(PAUSE))).find_map(|()| self.free());
        Ok(self.waiting(wait).expect("it waits until it has it"))
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
            if model.output.constraints() != Constraints::Nothing || !model.channels.efforts.is_empty() {
                model.find_reactions(&mut simulation);
            }
            Ok(simulation)
        };
        let begun = py.detach(begin);
        if let Some(raised) = trouble.take() {
            return Err(raised);
        }
        let simulation = begun.map_err(|error: RunError| run_error(py, error))?;
        // The start is the only row that it keeps.
        let recorder = Recorder::new(&model.channels, &model.system, u64::MAX, model.output.constraints()).into_owned();
        let mut running = Running {
            simulation,
            recorder,
            row: Vec::new(),
            is_row_new: false,
            motion: Vec::new(),
            is_motion_new: false,
            are_forces_new: false,
            are_inputs_new: false,
            is_short: false,
            ended: None,
            event: None,
        };
        running.arrive(true);
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
            let (taken, goes_on) = py.detach(|| {
                self.let_others();
                let mut running = self.waiting(|| self.running.lock().unwrap_or_else(|broken| broken.into_inner()));
                let taken = self.within(&mut running, |running| running.advance(left, &self.trouble));
                self.raise(&mut running).map(|()| taken)
            })?;
            left -= taken;
            if left == 0 || !goes_on {
                return Ok(goes_on);
            }
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
        if model.output.constraints() != Constraints::Nothing || !model.channels.efforts.is_empty() {
            model.find_reactions(&mut simulation);
        }
        let recorder = Recorder::new(&model.channels, &model.system, u64::MAX, model.output.constraints()).into_owned().resume(mark);
        (running.simulation, running.recorder, running.is_row_new) = (simulation, recorder, false);
        running.are_inputs_new = true;
        (running.ended, running.event) = (None, None);
        running.arrive(true);
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
