//! Looks at a run step by step for the columns of the table.

use holonom::model::Model;
use holonom::record::{Constraints, Recorder};
use holonom::simulation::{Divisions, Observer, Simulation, Verdict};

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
    /// Whether a run is made, and small vibrations are looked for.
    pub runs: bool,
    pub modes: bool,
    /// Whether every step is looked at, and not only the last.
    pub steps: bool,
    /// Whether these forces are needed after every step, and not only after the last.
    pub forces: bool,
}

impl Columns {
    /// The columns as they were asked for.
    pub fn texts(&self) -> Vec<&str> {
        self.asked.iter().map(|asked| asked.text.as_str()).collect()
    }
}

/// Gathers columns of one run.
pub struct Watch<'a> {
    model: &'a Model,
    constraints: Constraints,
    forces: bool,
    /// Looks at every step where that is needed: at forces of constraints only where these are found.
    recorder: Recorder,
    needs_steps: bool,
    /// What is gathered of each column; `None` for those that the run's model does not have, and for those that are not of a run.
    columns: Vec<Option<Column>>,
}

/// A column of one run.
enum Column {
    /// Of the rows.
    Of {
        /// Where it is in the rows of steps, or of a last value in the row after the last step.
        place: usize,
        is_absolute: bool,
        /// What was seen over the steps; `None` where the last value is asked for.
        gathered: Option<Gathered>,
    },
    /// When an event happens first.
    Event(String),
}

impl<'a> Watch<'a> {
    pub fn new(model: &'a Model, columns: &Columns) -> Self {
        let Columns { asked, constraints, steps, forces, .. } = columns;
        let at_end = recorder(model, *constraints);
        let recorder = recorder(model, if *forces { *constraints } else { Constraints::Nothing });
        let column = |asked: &Asked| {
            if asked.function == Function::TimeOf {
                return Some(Column::Event(asked.of.clone()));
            }
            if asked.is_of_mode() {
                return None;
            }
            let gathered = Gathered::new(asked.function);
            let row = if gathered.is_some() { &recorder } else { &at_end };
            Some(Column::Of { place: row.recording().place(&asked.of)?, is_absolute: asked.is_absolute, gathered })
        };
        Self {
            columns: asked.iter().map(column).collect(),
            needs_steps: *steps,
            model,
            constraints: *constraints,
            forces: *forces,
            recorder,
        }
    }

    /// What the columns make of the run, after its last step. Orientations and running values of measures go on from what was looked at.
    pub fn values(self, simulation: &Simulation) -> Vec<Option<f64>> {
        let mut at_end = recorder(self.model, self.constraints).resume(&self.recorder.mark());
        let row = at_end.look(simulation);
        let value = |column: &Column| match column {
            Column::Of { gathered: Some(gathered), .. } => gathered.value(),
            Column::Of { place, is_absolute, gathered: None } => Some(signed(row[*place], *is_absolute)),
            Column::Event(name) => simulation.first_time(name),
        };
        self.columns.iter().map(|column| column.as_ref().and_then(value)).collect()
    }
}

impl Watch<'_> {
    /// Lets the columns that are of all steps see the present state.
    fn see(&mut self, simulation: &Simulation, see: fn(&mut Gathered, f64, f64)) {
        if self.needs_steps {
            let (t, row) = (simulation.state().t, self.recorder.look(simulation));
            for column in self.columns.iter_mut().flatten() {
                if let Column::Of { place, is_absolute, gathered: Some(gathered) } = column {
                    see(gathered, t, signed(row[*place], *is_absolute));
                }
            }
        }
    }
}

impl Observer for Watch<'_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self.see(simulation, Gathered::see);
        Verdict::GoOn
    }

    fn divisions(&self) -> Divisions {
        if self.needs_steps { Divisions::Inside } else { Divisions::Unseen }
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.see(simulation, Gathered::see_division);
    }

    fn wants_forces(&self) -> bool {
        self.forces
    }
}

/// A recorder of every step.
pub fn recorder(model: &Model, constraints: Constraints) -> Recorder {
    Recorder::new(&model.channels, &model.system, 1, constraints)
}

fn signed(value: f64, is_absolute: bool) -> f64 {
    if is_absolute { value.abs() } else { value }
}
