//! Looks at a run step by step for the columns of the table.

use holonom::model::Model;
use holonom::record::{Constraints, Recorder};
use holonom::simulation::{Observer, Simulation, Verdict};

use super::column::Asked;
use super::reduction::{Function, Gathered};

/// The columns of the table that show the motion, and what has to be found for them.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    pub asked: Vec<Asked>,
    /// The SI unit of each, `"1"` of numbers without one.
    pub units: Vec<String>,
    /// What is recorded of the forces of constraints.
    pub constraints: Constraints,
    /// Whether these forces are needed after every step, and not only after the last.
    pub forces: bool,
}

/// Gathers columns of one run.
pub struct Watch<'a> {
    model: &'a Model,
    recorder: Recorder<'a>,
    constraints: Constraints,
    forces: bool,
    /// Where each column is in the row, and what was gathered of it; `None` for those that the run's model does not have.
    gathered: Vec<Option<(usize, bool, Gathered)>>,
    /// Whether there are any that the last row is not enough for.
    needs_steps: bool,
}

impl<'a> Watch<'a> {
    pub fn new(model: &'a Model, columns: &Columns) -> Self {
        let recorder = recorder(model, columns.constraints);
        let gather = |asked: &Asked| Some((recorder.recording().place(&asked.of)?, asked.is_absolute, Gathered::new(asked.function)));
        Self {
            gathered: columns.asked.iter().map(gather).collect(),
            needs_steps: columns.asked.iter().any(|asked| asked.function != Function::Last),
            model,
            constraints: columns.constraints,
            forces: columns.forces,
            recorder,
        }
    }

    /// What was gathered of each column, with the last values as they are now.
    pub fn values(mut self, simulation: &Simulation) -> Vec<Option<f64>> {
        // Of the two quaternions of an orientation a recorder takes the one near that before: the last is not to depend on what else is asked.
        let mut last = recorder(self.model, self.constraints);
        let row = last.look(simulation);
        let value = |gathered: &mut Option<(usize, bool, Gathered)>| {
            let (place, is_absolute, gathered) = gathered.as_mut()?;
            gathered.settle(signed(row[*place], *is_absolute));
            gathered.value()
        };
        self.gathered.iter_mut().map(value).collect()
    }
}

impl Observer for Watch<'_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        if self.needs_steps {
            let (t, row) = (simulation.state().t, self.recorder.look(simulation));
            for (place, is_absolute, gathered) in self.gathered.iter_mut().flatten() {
                gathered.see(t, signed(row[*place], *is_absolute));
            }
        }
        Verdict::GoOn
    }

    fn wants_forces(&self) -> bool {
        self.forces
    }
}

/// A recorder of every step.
pub fn recorder(model: &Model, constraints: Constraints) -> Recorder<'_> {
    Recorder::new(&model.channels, &model.system, 1, constraints)
}

fn signed(value: f64, is_absolute: bool) -> f64 {
    if is_absolute { value.abs() } else { value }
}
