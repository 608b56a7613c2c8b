//! A model's own run: the method and the step that its `[simulation]` asks for, and what its joints do meanwhile, by name.

use crate::model::{Model, ProjectionSettings};
use crate::simulation::{Choice, Method, MethodError, ProjectionChoice, Simulation, StartError};
use crate::system::Place;

/// Why a model does not run as it says.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    #[error("the model has no `{key}` in [simulation]")]
    Missing { key: &'static str },
    #[error("the projection has no weight for the point `{point}`")]
    Unweighted { point: String },
    #[error(transparent)]
    Method(#[from] MethodError),
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

impl Model {
    /// What the model says of the method. A name replaces what it says of formulation, integrator and projection levels, and
    /// keeps the numbers.
    ///
    /// # Errors
    /// A projection with weights that leave a free point out.
    pub fn choice(&self, name: Option<&str>) -> Result<Choice, RunError> {
        let settings = &self.settings;
        let own = name.is_none();
        let part = |text: &Option<String>| text.clone().filter(|_| own);
        Ok(Choice {
            method: name.map(str::to_string).or_else(|| settings.method.clone()),
            formulation: part(&settings.formulation),
            index: settings.index.filter(|_| own).map(|index| index.min(u8::MAX.into()) as u8),
            integrator: part(&settings.integrator),
            iteration: settings.iteration.clone(),
            penalty: settings.penalty,
            beta: settings.beta,
            gamma: settings.gamma,
            alpha: settings.alpha,
            rho: settings.rho,
            omega: settings.omega,
            xi: settings.xi,
            accuracy: settings.accuracy,
            order: settings.order.filter(|_| own).map(|order| order.min(u8::MAX.into()) as u8),
            constraint_at: settings.constraint_at.clone(),
            tolerance: settings.tolerance,
            max_iterations: settings.max_iterations.map(|most| most as usize),
            iterations: settings.iterations.map(|count| count as usize),
            subdivide: settings.subdivide,
            projection: settings.projection.as_ref().map(|projection| self.projection_choice(projection, own)).transpose()?,
        })
    }

    fn projection_choice(&self, settings: &ProjectionSettings, own: bool) -> Result<ProjectionChoice, RunError> {
        Ok(ProjectionChoice {
            levels: settings.levels.clone().filter(|_| own),
            matrix: settings.matrix.clone(),
            solve: settings.solve.clone(),
            penalty: settings.penalty,
            strength: settings.strength,
            shadow: settings.shadow,
            weights: settings.weights.as_ref().map(|weights| self.free_weights(weights)).transpose()?,
        })
    }

    /// A weight for each free node, from weights by name.
    fn free_weights(&self, weights: &[(String, f64)]) -> Result<Vec<f64>, RunError> {
        let mut of_nodes = vec![0.0; self.system.free_nodes()];
        for point in &self.points {
            if let Place::Node(node) = point.place
                && node.index() < of_nodes.len()
            {
                let weight = weights.iter().find(|(name, _)| *name == point.name).map(|(_, weight)| *weight);
                of_nodes[node.index()] = weight.ok_or_else(|| RunError::Unweighted { point: point.name.clone() })?;
            }
        }
        Ok(of_nodes)
    }

    /// Nominal step, s: with an accuracy and without a step, the interval of the results.
    ///
    /// # Errors
    /// A model without either.
    pub fn step(&self) -> Result<f64, RunError> {
        let shown = self.settings.accuracy.and(self.settings.end).map(|end| end / ROWS_BY_ACCURACY);
        self.settings.step.or(shown).ok_or(RunError::Missing { key: "step" })
    }

    /// End of the run, s.
    ///
    /// # Errors
    /// A model without one.
    pub fn end(&self) -> Result<f64, RunError> {
        self.settings.end.ok_or(RunError::Missing { key: "end" })
    }

    /// The simulation that the model asks for, at its start.
    ///
    /// # Errors
    /// What its method lacks, or why it cannot start.
    pub fn simulation(&self) -> Result<Simulation, RunError> {
        Ok(Simulation::new(self.system.clone(), Method::resolve(&self.choice(None)?)?, self.step()?)?)
    }

    /// Force and moment that the joint `name` transmits at the present state. `None` where there is no such joint, where the
    /// simulation was not asked for forces ([`Simulation::find_reactions`]), and where the bodies share nodes at the joint, which
    /// `reactions = true` in `[output]` prevents.
    pub fn reaction(&self, simulation: &Simulation, name: &str) -> Option<Reaction> {
        let joint = self.channels.joints.iter().find(|joint| joint.name == name)?;
        let (force, moment) = joint.wrench(simulation, &self.system.in_world(&simulation.state().x))?;
        Some(Reaction { force, moment })
    }
}
