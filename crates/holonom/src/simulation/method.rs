//! A method is a formulation, an integrator and projections; the names people choose, and what may go together.

use super::words::{MethodError, accuracy, iterations, name, names, order, partners, pick, positive, spell, together, within};
use super::{MethodSummary, ProjectionSummary};
use crate::formulation::{FORMULATIONS, Formulation, ITERATIONS, Iteration, Multipliers, RowsAt, SolveSettings};
use crate::integrator::{Entry, INTEGRATORS, Parameters};
use crate::projection::{METRICS, Metric, Projection, SOLVES, Solve};

/// What a user says of a method, in words; everything may be left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// One of [`NAMED`], an integrator, parts joined by strokes such as `lagrange-2/trapezoidal/velocity`, or nothing.
    pub method: Option<String>,
    /// One of [`FORMULATIONS`], with or without its index; else the method's, or the first that goes with the integrator.
    pub formulation: Option<String>,
    /// Which formulation of that name: its differentiation index. Without a formulation, of the augmented Lagrangian.
    pub index: Option<u8>,
    /// One of [`INTEGRATORS`]; else the method's, or the first that goes with the formulation.
    pub integrator: Option<String>,
    /// Order of an integrator that has several.
    pub order: Option<u8>,
    /// Relative error of position that the steps are to be chosen for.
    pub accuracy: Option<f64>,
    /// One of [`ITERATIONS`], `newton` without.
    pub iteration: Option<String>,
    /// Penalty α in the paper's sense.
    pub penalty: Option<f64>,
    /// Newmark's β, ¼ without.
    pub beta: Option<f64>,
    /// Newmark's γ, ½ without.
    pub gamma: Option<f64>,
    /// HHT's α, 0 … 1/3.
    pub alpha: Option<f64>,
    /// ρ∞ of generalized-α, 0 … 1.
    pub rho: Option<f64>,
    /// ω of the stabilised formulations, 1/s; [`OMEGA`] without.
    pub omega: Option<f64>,
    /// ξ of the stabilised formulations; [`XI`] without.
    pub xi: Option<f64>,
    /// `"end"` or `"mean"`: which positions the conserving scheme puts on the constraints.
    pub constraint_at: Option<String>,
    /// See [`SolveSettings::tolerance`]; [`TOLERANCE`] without, [`LOOP_TOLERANCE`] in the paper's loops.
    pub tolerance: Option<f64>,
    /// Most iterations of a step, [`MAX_ITERATIONS`] without.
    pub max_iterations: Option<usize>,
    /// Newton iterations of every step, no more and no fewer.
    pub iterations: Option<usize>,
    /// Whether a step that fails is retried in halves; `true` without, and never with a number of `iterations`.
    pub subdivide: Option<bool>,
    /// What differs from the projections of the method.
    pub projection: Option<ProjectionChoice>,
}

/// What a user says of projections.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProjectionChoice {
    /// `"velocity"`, `"acceleration"`.
    pub levels: Option<Vec<String>>,
    /// The metric A: one of [`METRICS`], `mass` without.
    pub matrix: Option<String>,
    /// One of [`SOLVES`], `exact` without.
    pub solve: Option<String>,
    /// α of the solve by penalty, [`PENALTY`] without.
    pub penalty: Option<f64>,
    /// θ: share of the way to the constraints that is taken, 1 without.
    pub strength: Option<f64>,
    /// Whether projected values are only shown, and the run goes on with the others; `false` without.
    pub shadow: Option<bool>,
    /// A weight for each free node, for the matrix `custom`.
    pub weights: Option<Vec<f64>>,
}

impl Choice {
    /// The same numbers for the method of a name, which replaces formulation, integrator, order and projected levels.
    pub fn named(&self, name: &str) -> Self {
        let projection = self.projection.clone().map(|projection| ProjectionChoice { levels: None, ..projection });
        Self { method: Some(name.into()), formulation: None, index: None, integrator: None, order: None, projection, ..self.clone() }
    }
}

/// A method with a name.
pub struct Named {
    /// What people call it.
    pub name: &'static str,
    /// Name of its formulation, with index where there are several of the name.
    pub formulation: &'static str,
    /// Name of its integrator, which has its usual order.
    pub integrator: &'static str,
    /// What is projected after each step: `velocity`, `acceleration`.
    pub levels: &'static [&'static str],
    /// What it is for, in one line.
    pub doc: &'static str,
}

/// The methods people choose by name; the first is the default.
pub const NAMED: &[Named] = &[
    Named {
        name: "conserving-ggl",
        formulation: "ggl",
        integrator: "conserving-ggl",
        levels: &[],
        doc: "long runs, everything exact (default)",
    },
    Named {
        name: "conserving",
        formulation: "augmented-lagrangian-3",
        integrator: "conserving",
        levels: &[],
        doc: "the paper's conserving scheme (17)–(18)",
    },
    Named {
        name: "conserving-projected",
        formulation: "augmented-lagrangian-3",
        integrator: "conserving",
        levels: &["velocity"],
        doc: "the same with velocity projection, A = M: energy never rises (the paper's §7.4)",
    },
    Named {
        name: "trapezoidal-projected",
        formulation: "augmented-lagrangian-3",
        integrator: "trapezoidal",
        levels: &["velocity", "acceleration"],
        doc: "real time: (7) with trapezoidal rule and projections, A = M",
    },
    Named {
        name: "trapezoidal",
        formulation: "augmented-lagrangian-3",
        integrator: "trapezoidal",
        levels: &[],
        doc: "(7) alone: the paper's unstable case, for comparison",
    },
    Named {
        name: "generalized-alpha",
        formulation: "lagrange-3",
        integrator: "generalized-alpha",
        levels: &[],
        doc: "stiff, damped mechanisms: Arnold and Brüls with ρ∞ = 0.8",
    },
    Named {
        name: "radau",
        formulation: "ggl",
        integrator: "radau",
        levels: &[],
        doc: "reference solutions: Radau IIA of order 5 on the GGL form",
    },
];

/// Tolerance of the Newton iteration: estimated remaining increment over the size of the mechanism. Velocities are
/// increments over the step, and energy is to be exact to round-off, so that this is below the last digit of a position.
pub const TOLERANCE: f64 = 2e-17;

/// Tolerance of the paper's loops: 2-norm of the increment, m.
pub const LOOP_TOLERANCE: f64 = 1e-9;

/// Most iterations in a step.
pub const MAX_ITERATIONS: usize = 50;

/// Penalty of the penalty formulation where none is given: the paper's.
pub const PENALTY: f64 = 1e7;

/// Natural frequency ω of stabilised rows where none is given, 1/s.
pub const OMEGA: f64 = 10.0;
/// Damping ratio ξ of stabilised rows where none is given.
pub const XI: f64 = 1.0;

/// A method that can be run.
#[derive(Clone)]
pub struct Method {
    /// One of [`NAMED`], or its parts joined by strokes, such as `lagrange-2/bdf-3/velocity`.
    pub name: String,
    /// Its line in the table of formulations.
    pub formulation: &'static Formulation,
    /// Its line in the table of integrators.
    pub integrator: &'static Entry,
    /// Name of the iteration in the settings.
    pub iteration: &'static str,
    /// What steers the solution of a step.
    pub settings: SolveSettings,
    /// What its integrator is made with.
    pub parameters: Parameters,
    /// What is projected after each step, and how.
    pub projection: Projection,
    /// Whether it is unstable on rows at position level for want of a projection.
    pub is_unstable: bool,
    /// Whether a step that fails is retried in halves.
    pub subdivide: bool,
    /// Relative error of position at the end of a run that steps are chosen for; without one they are the user's.
    pub accuracy: Option<f64>,
}

impl Method {
    /// Turns words into a method, or says what is wrong and what would be right.
    pub fn resolve(choice: &Choice) -> Result<Self, MethodError> {
        let spelled = spell(choice);
        let choice = spelled.as_ref().unwrap_or(choice);
        let named = choice.method.as_deref().map(|name| pick("method", name, NAMED, |named| named.name)).transpose()?;
        let (formulation, integrator) = partners(choice, named)?;
        let iteration = pick("iteration", choice.iteration.as_deref().unwrap_or("newton"), ITERATIONS, |i| i.0)?;
        together("integrator", integrator.name, "iteration", iteration.0, integrator.iterations)?;
        together("formulation", &formulation.full_name(), "iteration", iteration.0, formulation.iterations)?;
        let order = order(choice, integrator)?;
        let usual = named.is_some_and(|named| named.integrator == integrator.name) || choice.integrator.is_none();
        let levels: Vec<String> = match choice.projection.as_ref().and_then(|projection| projection.levels.clone()) {
            Some(levels) => levels,
            None if usual => named.map_or(&[][..], |named| named.levels).iter().map(|&level| level.to_string()).collect(),
            None => Vec::new(),
        };
        if !levels.is_empty() && (!integrator.projects || formulation.doubled || formulation.soft) {
            return Err(match integrator.projects {
                true => MethodError::Pair {
                    kind: "projection",
                    name: levels.join(", "),
                    with: "formulation",
                    given: formulation.full_name(),
                    partners: names(FORMULATIONS.iter().filter(|line| !line.doubled && !line.soft).map(Formulation::full_name)),
                },
                false => MethodError::Pair {
                    kind: "projection",
                    name: levels.join(", "),
                    with: "integrator",
                    given: integrator.name.into(),
                    partners: names(INTEGRATORS.iter().filter(|entry| entry.projects).map(|entry| entry.name.into())),
                },
            });
        }
        let is_unstable = integrator.needs_projection && formulation.is_at_position() && !levels.iter().any(|level| level == "velocity");
        let accuracy = accuracy(choice, integrator, order, is_unstable)?;
        let iterations = iterations(choice, integrator, iteration.0)?;
        let loops = iteration.1 != Iteration::Newton;
        let (omega, xi) = (positive("omega", choice.omega, OMEGA)?, positive("xi", choice.xi, XI)?);
        Ok(Self {
            name: name(formulation, integrator, order, &levels),
            is_unstable,
            formulation,
            integrator,
            iteration: iteration.0,
            settings: SolveSettings {
                level: (formulation.level)(omega, xi),
                doubled: formulation.doubled,
                multipliers: match formulation.soft {
                    true => Multipliers::Penalty(positive("penalty", choice.penalty, PENALTY)?),
                    false => Multipliers::Augmented(choice.penalty.map(|alpha| positive("penalty", Some(alpha), PENALTY)).transpose()?),
                },
                iteration: iteration.1,
                tolerance: positive("tolerance", choice.tolerance, if loops { LOOP_TOLERANCE } else { TOLERANCE })?,
                max_iterations: iterations.or(choice.max_iterations).unwrap_or(MAX_ITERATIONS).max(1),
                iterations,
            },
            parameters: Parameters {
                beta: positive("beta", choice.beta, 0.25)?,
                gamma: positive("gamma", choice.gamma, 0.5)?,
                alpha: within("alpha", choice.alpha, 0.1, 0.0, 1.0 / 3.0, "0 … 1/3")?,
                rho: within("rho", choice.rho, 0.8, 0.0, 1.0, "0 … 1")?,
                rows: match choice.constraint_at.as_deref() {
                    None | Some("end") => RowsAt::End,
                    Some("mean") => RowsAt::Mean,
                    Some(other) => {
                        return Err(MethodError::Value { key: "constraint_at", given: other.into(), allowed: "end, mean".into() });
                    }
                },
                order,
                adapts: accuracy.is_some(),
            },
            projection: {
                let asked = projection(choice.projection.as_ref(), &levels)?;
                // What positions and velocities drift by is no error that shorter steps would see.
                let drifts = accuracy.is_some() && integrator.is_explicit() && !formulation.soft && !asked.shadow;
                Projection { position: drifts, velocity: drifts || asked.velocity, ..asked }
            },
            subdivide: iterations.is_none() && choice.subdivide.unwrap_or(true),
            accuracy,
        })
    }

    /// Order of convergence of positions, velocities and reactions.
    pub fn convergence(&self) -> [u8; 3] {
        let projected = self.projection.velocity && !self.projection.shadow;
        (self.integrator.convergence)(&self.parameters, self.formulation, projected)
    }

    /// Order of a step's result: the lower one of positions and velocities.
    pub fn order(&self) -> u8 {
        let [q, v, _] = self.convergence();
        q.min(v).max(1)
    }

    /// The method as the summary has it.
    pub fn summary(&self) -> MethodSummary {
        let mut levels = Vec::new();
        if self.projection.position {
            levels.push("position".to_string());
        }
        if self.projection.velocity {
            levels.push("velocity".to_string());
        }
        if self.projection.acceleration {
            levels.push("acceleration".to_string());
        }
        let matrix = match self.projection.metric {
            Metric::Mass => "mass",
            Metric::Identity => "identity",
            Metric::Tangent => "tangent",
            Metric::Custom(_) => "custom",
        };
        let solve = if self.projection.solve == Solve::Exact { "exact" } else { "penalty" };
        MethodSummary {
            name: self.name.clone(),
            formulation: self.formulation.name.into(),
            index: self.formulation.index,
            integrator: self.integrator.name.into(),
            order: self.parameters.order,
            iteration: self.iteration.into(),
            accuracy: self.accuracy,
            projection: ProjectionSummary { levels, matrix: matrix.into(), solve: solve.into() },
        }
    }
}

/// Projection levels that can be asked for.
pub const LEVELS: &[&[&str]] = &[&[], &["velocity"], &["velocity", "acceleration"]];

/// Every combination of formulation, integrator, order, iteration and projection levels that goes together.
pub fn combinations() -> Vec<Choice> {
    let mut all = Vec::new();
    for entry in INTEGRATORS {
        for (formulation, &order) in entry.formulations().flat_map(|line| entry.orders.iter().map(move |order| (line.full_name(), order))) {
            for (iteration, levels) in entry.iterations.iter().flat_map(|name| LEVELS.iter().map(move |levels| (name, levels))) {
                let levels = levels.iter().map(|level| level.to_string()).collect();
                let choice = Choice {
                    formulation: Some(formulation.clone()),
                    integrator: Some(entry.name.into()),
                    order: Some(order),
                    iteration: Some(iteration.to_string()),
                    projection: Some(ProjectionChoice { levels: Some(levels), ..ProjectionChoice::default() }),
                    ..Choice::default()
                };
                if Method::resolve(&choice).is_ok() {
                    all.push(choice);
                }
            }
        }
    }
    all
}

/// Projections from words.
fn projection(choice: Option<&ProjectionChoice>, levels: &[String]) -> Result<Projection, MethodError> {
    let default = ProjectionChoice::default();
    let choice = choice.unwrap_or(&default);
    for level in levels {
        if level != "velocity" && level != "acceleration" {
            return Err(MethodError::Value { key: "projection.levels", given: level.clone(), allowed: "velocity, acceleration".into() });
        }
    }
    let metric = match pick("projection matrix", choice.matrix.as_deref().unwrap_or("mass"), METRICS, |m| m.0)?.0 {
        "mass" => Metric::Mass,
        "identity" => Metric::Identity,
        "tangent" => Metric::Tangent,
        _ => match &choice.weights {
            Some(weights) if weights.iter().all(|w| *w > 0.0) => Metric::Custom(weights.clone()),
            _ => {
                return Err(MethodError::Value {
                    key: "projection.weights",
                    given: "none".into(),
                    allowed: "a positive weight for each free point".into(),
                });
            }
        },
    };
    let solve = match pick("projection solve", choice.solve.as_deref().unwrap_or("exact"), SOLVES, |s| s.0)?.0 {
        "exact" => Solve::Exact,
        _ => Solve::Penalty(positive("projection.penalty", choice.penalty, PENALTY)?),
    };
    let has = |name: &str| levels.iter().any(|level| level == name);
    Ok(Projection {
        position: false,
        velocity: has("velocity"),
        acceleration: has("acceleration"),
        metric,
        solve,
        strength: positive("projection.strength", choice.strength, 1.0)?,
        shadow: choice.shadow.unwrap_or(false),
    })
}
