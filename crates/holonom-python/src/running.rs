//! A simulation between the steps of a program: what was recorded of it, and what is known of its present state.

use std::time::{Duration, Instant};

use holonom::model::Model;
use holonom::record::{Constraints, Recorder, RecorderMark};
use holonom::simulation::{Divisions, Observer, Simulation, Status, Verdict};

use crate::function::Trouble;

/// Time between two looks for signals and for other threads that wait.
const LOOK: Duration = Duration::from_millis(50);

/// Steps that take less time keep the interpreter to themselves: to give it away and to take it back would be a good part of them.
const SHORT: Duration = Duration::from_micros(100);

/// A simulation, what is recorded of it, and what is known of its present state.
pub(crate) struct Running {
    pub simulation: Simulation,
    pub recorder: Recorder,
    /// The columns at the present state, and whether they are those.
    row: Vec<f64>,
    pub is_row_new: bool,
    /// Those of the motion alone, which need no forces, and whether they are of the present state.
    motion: Vec<f64>,
    pub is_motion_new: bool,
    /// Whether forces of joints and accelerations are those of the present state: they take time, and are found when they are looked at.
    pub are_forces_new: bool,
    /// Whether inputs were set since the last step.
    pub are_inputs_new: bool,
    /// Whether the last step that was taken alone was a short one.
    pub is_short: bool,
    /// Why the last step was the last, and the event that it was.
    pub ended: Option<String>,
    pub event: Option<String>,
}

/// Lets a recorder see where a step is divided. Where measures are of the whole run, it sees every step, too.
struct Watch<'a>(&'a mut Recorder);

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

/// Has a simulation find the forces that its model records.
pub(crate) fn find_forces(model: &Model, simulation: &mut Simulation) {
    if model.output.constraints() != Constraints::Nothing || !model.channels.efforts.is_empty() {
        model.find_reactions(simulation);
    }
}

/// Records the start of a run and no row after it.
fn recorder(model: &Model) -> Recorder {
    Recorder::new(&model.channels, &model.system, u64::MAX, model.output.constraints())
}

/// Whether a recorder has measures of the whole run.
fn sees_all(recorder: &Recorder) -> bool {
    recorder.divisions() == Divisions::Inside
}

impl Running {
    /// The start of a simulation of a model.
    pub fn new(model: &Model, simulation: Simulation) -> Self {
        let mut running = Self {
            simulation,
            recorder: recorder(model),
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
        running
    }

    /// Goes on with a simulation of the same model that has come elsewhere, and with what was recorded up to there.
    pub fn go_on(&mut self, model: &Model, simulation: Simulation, mark: &RecorderMark) {
        (self.simulation, self.recorder) = (simulation, recorder(model).resume(mark));
        (self.are_inputs_new, self.ended, self.event) = (true, None, None);
        self.arrive(true);
    }

    /// Looks at the state that was just reached, of which forces were found or not.
    pub fn arrive(&mut self, are_forces_new: bool) {
        (self.is_row_new, self.is_motion_new, self.are_forces_new) = (false, false, are_forces_new);
        if sees_all(&self.recorder) {
            // A recorder wants no run to stop.
            let _ = self.recorder.after_step(&self.simulation);
        }
        self.recorder.follow(&self.simulation);
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
    pub fn advance(&mut self, count: i64, trouble: &Trouble) -> (i64, bool) {
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
    pub fn find_forces(&mut self) {
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
    pub fn value(&mut self, place: usize) -> f64 {
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
