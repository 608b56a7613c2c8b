//! A model's own run: the method and the step that its `[simulation]` asks for, and what its joints do meanwhile, by name.

use crate::model::Model;
use crate::simulation::{Choice, Method, MethodError, Simulation, StartError};

/// Why a model does not run as it says.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A time that the model does not give.
    #[error("the model has no `{key}` in [simulation]")]
    Missing {
        /// `step` or `end`.
        key: &'static str,
    },
    /// Neither of the times that a run needs.
    #[error("the model has neither `end` nor `step` in [simulation]")]
    NoTimes,
    /// There is no method of this name, or its parts do not go together.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The method cannot begin where the model starts.
    #[error(transparent)]
    Start(#[from] StartError),
}

/// Force (N) and moment (N·m) that a joint transmits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// On the second body of the joint, in world axes.
    pub force: [f64; 3],
    /// On it about the joint's place there.
    pub moment: [f64; 3],
}

/// Rows of results where only an accuracy is given.
const ROWS_BY_ACCURACY: f64 = 200.0;

/// The step of a run that takes none, s.
const NOT_TAKEN: f64 = 1e-3;

impl Model {
    /// What the model says of the method, or what is left of that with a method of another name.
    pub fn choice(&self, name: Option<&str>) -> Choice {
        let own = &self.settings.choice;
        name.map_or_else(|| own.clone(), |name| own.named(name))
    }

    /// Nominal step, s: with an accuracy and without a step, the interval of the results; any where a run ends at its start.
    ///
    /// # Errors
    /// A model without either.
    pub fn step(&self) -> Result<f64, RunError> {
        let shown = match self.settings.end {
            Some(0.0) => Some(NOT_TAKEN),
            end => self.settings.choice.accuracy.and(end).map(|end| end / ROWS_BY_ACCURACY),
        };
        self.settings.step.or(shown).ok_or(RunError::Missing { key: "step" })
    }

    /// End of the run, s.
    ///
    /// # Errors
    /// A model without one.
    pub fn end(&self) -> Result<f64, RunError> {
        self.settings.end.ok_or(RunError::Missing { key: "end" })
    }

    /// Nominal step and end of the run, s.
    ///
    /// # Errors
    /// A model without one of them, or without both.
    pub fn times(&self) -> Result<[f64; 2], RunError> {
        match (self.step(), self.end()) {
            (Err(_), Err(end)) => Err(if self.settings.choice.accuracy.is_some() { end } else { RunError::NoTimes }),
            (step, end) => Ok([step?, end?]),
        }
    }

    /// The simulation that the model asks for, at its start.
    ///
    /// # Errors
    /// What its method lacks, or why it cannot start.
    pub fn simulation(&self) -> Result<Simulation, RunError> {
        Ok(Simulation::new(self.system.clone(), Method::resolve(&self.choice(None))?, self.step()?)?)
    }

    /// Has a simulation of this model find the forces of its constraints.
    pub fn find_reactions(&self, simulation: &mut Simulation) {
        match &self.channels.apart {
            Some(apart) => simulation.find_reactions_apart(&apart.0),
            None => simulation.find_reactions(),
        }
    }

    /// Force and moment that the joint `name` transmitted after the last step; inputs that were set since count once forces are
    /// [found anew](Simulation::update_reactions). `None` where there is no such joint, where this model did not ask the simulation for forces
    /// ([`Model::find_reactions`]), and where the bodies share nodes at the joint and the model was not [told](Model::tell_forces) how to find
    /// its force.
    pub fn reaction(&self, simulation: &Simulation, name: &str) -> Option<Reaction> {
        let joint = self.channels.told().joints.iter().position(|joint| joint.name == name)?;
        let (force, moment) = self.channels.wrench(joint, simulation)?;
        Some(Reaction { force, moment })
    }
}
