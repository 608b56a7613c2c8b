//! A method is a formulation, an integrator and projections; the names people choose, and what may go together.

use super::{MethodError, MethodSummary, ProjectionSummary};
use crate::formulation::{ITERATIONS, Iteration, Multipliers, NAMES, RowsAt, SolveSettings};
use crate::integrator::{Entry, INTEGRATORS, Parameters};
use crate::projection::{METRICS, Metric, Projection, SOLVES, Solve};

/// What a user says of a method, in words; everything may be left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// One of [`NAMED`], or nothing.
    pub method: Option<String>,
    pub formulation: Option<String>,
    pub index: Option<u8>,
    pub integrator: Option<String>,
    pub iteration: Option<String>,
    /// Penalty α in the paper's sense.
    pub penalty: Option<f64>,
    pub beta: Option<f64>,
    pub gamma: Option<f64>,
    /// `"end"` or `"mean"`: which positions the conserving scheme puts on the constraints.
    pub constraint_at: Option<String>,
    pub tolerance: Option<f64>,
    pub max_iterations: Option<usize>,
    pub subdivide: Option<bool>,
    pub projection: Option<ProjectionChoice>,
}

/// What a user says of projections.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProjectionChoice {
    /// `"velocity"`, `"acceleration"`.
    pub levels: Option<Vec<String>>,
    pub matrix: Option<String>,
    pub solve: Option<String>,
    pub penalty: Option<f64>,
    pub strength: Option<f64>,
    pub shadow: Option<bool>,
    /// A weight for each free node, for the matrix `custom`.
    pub weights: Option<Vec<f64>>,
}

/// A method with a name.
pub struct Named {
    pub name: &'static str,
    pub integrator: &'static str,
    pub levels: &'static [&'static str],
    pub doc: &'static str,
    pub keeps: &'static str,
}

/// The methods people choose by name; the first is the default.
pub const NAMED: &[Named] = &[
    Named {
        name: "conserving-ggl",
        integrator: "conserving-ggl",
        levels: &[],
        doc: "long runs, everything exact (default)",
        keeps: "energy, momentum, Φ, Φ̇",
    },
    Named {
        name: "conserving",
        integrator: "conserving",
        levels: &[],
        doc: "the paper's conserving scheme (17)–(18)",
        keeps: "energy, momentum, Φ",
    },
    Named {
        name: "conserving-projected",
        integrator: "conserving",
        levels: &["velocity"],
        doc: "the same with velocity projection, A = M: energy never rises (§7.4)",
        keeps: "momentum, Φ, Φ̇",
    },
    Named {
        name: "trapezoidal-projected",
        integrator: "trapezoidal",
        levels: &["velocity", "acceleration"],
        doc: "real time: (7) with trapezoidal rule and projections, A = M",
        keeps: "Φ, Φ̇, Φ̈",
    },
    Named {
        name: "trapezoidal",
        integrator: "trapezoidal",
        levels: &[],
        doc: "(7) alone: the paper's unstable case, for comparison",
        keeps: "Φ",
    },
];

/// Tolerance of the Newton iteration: estimated remaining increment over the size of the mechanism. Velocities are
/// increments over the step, and energy is to be exact to round-off, so that this is below the last digit of a position.
pub const TOLERANCE: f64 = 1e-17;

/// Tolerance of the paper's loops: 2-norm of the increment, m.
pub const LOOP_TOLERANCE: f64 = 1e-9;

/// Most iterations in a step.
pub const MAX_ITERATIONS: usize = 50;

/// Penalty of the penalty formulation where none is given: the paper's.
pub const PENALTY: f64 = 1e7;

/// A method that can be run.
pub struct Method {
    pub name: String,
    pub formulation: &'static str,
    pub integrator: &'static Entry,
    pub iteration: &'static str,
    pub settings: SolveSettings,
    pub parameters: Parameters,
    pub projection: Projection,
    /// Whether a step that fails is retried in halves.
    pub subdivide: bool,
}

impl Method {
    /// Turns words into a method, or says what is wrong and what would be right.
    pub fn resolve(choice: &Choice) -> Result<Self, MethodError> {
        let named = match &choice.method {
            Some(name) => pick("method", name, NAMED, |named| named.name)?,
            None => &NAMED[0],
        };
        // Parts that are spelled out replace those of the named method; a formulation alone needs an integrator that takes it.
        let fallback =
            if choice.method.is_none() && choice.formulation.as_deref() == Some("penalty") { "conserving" } else { named.integrator };
        let integrator = pick("integrator", choice.integrator.as_deref().unwrap_or(fallback), INTEGRATORS, |entry| entry.name)?;
        let formulation = pick("formulation", choice.formulation.as_deref().unwrap_or(NAMES[0].0), NAMES, |f| f.0)?.0;
        let iteration = pick("iteration", choice.iteration.as_deref().unwrap_or("newton"), ITERATIONS, |i| i.0)?;
        together("integrator", integrator.name, "formulation", formulation, integrator.formulations)?;
        together("integrator", integrator.name, "iteration", iteration.0, integrator.iterations)?;
        if formulation == "penalty" {
            together("formulation", "penalty", "iteration", iteration.0, &["newton"])?;
        }
        if let Some(index) = choice.index.filter(|&index| index != 3) {
            return Err(MethodError::Value { key: "index", given: index.to_string(), allowed: "3".into() });
        }
        let spelled = choice.integrator.as_deref().is_some_and(|name| name != named.integrator);
        let levels: Vec<String> = match choice.projection.as_ref().and_then(|projection| projection.levels.clone()) {
            Some(levels) => levels,
            None if spelled => Vec::new(),
            None => named.levels.iter().map(|&level| level.to_string()).collect(),
        };
        if !levels.is_empty() && !integrator.projects {
            let partners: Vec<&str> = INTEGRATORS.iter().filter(|entry| entry.projects).map(|entry| entry.name).collect();
            return Err(MethodError::Pair {
                kind: "projection",
                name: levels.join(", "),
                with: "integrator",
                given: integrator.name.into(),
                partners: partners.join(", "),
            });
        }
        let loops = iteration.1 != Iteration::Newton;
        Ok(Self {
            name: name(choice, named, integrator.name, formulation, &levels),
            formulation,
            integrator,
            iteration: iteration.0,
            settings: SolveSettings {
                multipliers: match formulation {
                    "penalty" => Multipliers::Penalty(positive("penalty", choice.penalty, PENALTY)?),
                    _ => Multipliers::Augmented(choice.penalty.map(|alpha| positive("penalty", Some(alpha), PENALTY)).transpose()?),
                },
                iteration: iteration.1,
                tolerance: positive("tolerance", choice.tolerance, if loops { LOOP_TOLERANCE } else { TOLERANCE })?,
                max_iterations: choice.max_iterations.unwrap_or(MAX_ITERATIONS).max(1),
            },
            parameters: Parameters {
                beta: positive("beta", choice.beta, 0.25)?,
                gamma: positive("gamma", choice.gamma, 0.5)?,
                rows: match choice.constraint_at.as_deref() {
                    None | Some("end") => RowsAt::End,
                    Some("mean") => RowsAt::Mean,
                    Some(other) => {
                        return Err(MethodError::Value { key: "constraint_at", given: other.into(), allowed: "end, mean".into() });
                    }
                },
            },
            projection: projection(choice.projection.as_ref(), &levels, formulation)?,
            subdivide: choice.subdivide.unwrap_or(true),
        })
    }

    /// The method as the summary has it.
    pub fn summary(&self) -> MethodSummary {
        let mut levels = Vec::new();
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
            formulation: self.formulation.into(),
            index: 3,
            integrator: self.integrator.name.into(),
            iteration: self.iteration.into(),
            projection: ProjectionSummary { levels, matrix: matrix.into(), solve: solve.into() },
        }
    }
}

/// The name of a method: its own, or its parts where they were spelled out.
fn name(choice: &Choice, named: &Named, integrator: &str, formulation: &str, levels: &[String]) -> String {
    let levels: Vec<&str> = levels.iter().map(String::as_str).collect();
    let usual = NAMED.iter().find(|known| known.integrator == integrator && known.levels == levels);
    let base = match usual {
        Some(known) => known.name.to_string(),
        None if levels.is_empty() => integrator.to_string(),
        None => format!("{integrator}-projected"),
    };
    let base = if formulation == "penalty" { format!("penalty-{base}") } else { base };
    if choice.method.as_deref() == Some(named.name) && base == named.name { named.name.to_string() } else { base }
}

/// Off the manifold redundant rows are no longer so, and an exact projection would take motion away that the mechanism
/// has: with the penalty formulation the penalty solve is the default.
fn projection(choice: Option<&ProjectionChoice>, levels: &[String], formulation: &str) -> Result<Projection, MethodError> {
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
    let solve = match pick(
        "projection solve",
        choice.solve.as_deref().unwrap_or(if formulation == "penalty" { "penalty" } else { "exact" }),
        SOLVES,
        |s| s.0,
    )?
    .0
    {
        "exact" => Solve::Exact,
        _ => Solve::Penalty(positive("projection.penalty", choice.penalty, PENALTY)?),
    };
    let has = |name: &str| levels.iter().any(|level| level == name);
    Ok(Projection {
        velocity: has("velocity"),
        acceleration: has("acceleration"),
        metric,
        solve,
        strength: positive("projection.strength", choice.strength, 1.0)?,
        shadow: choice.shadow.unwrap_or(false),
    })
}

/// The entry of a table that has a name.
fn pick<'a, T>(kind: &'static str, given: &str, table: &'a [T], name: impl Fn(&'a T) -> &'static str) -> Result<&'a T, MethodError> {
    table.iter().find(|entry| name(entry) == given).ok_or_else(|| MethodError::Unknown {
        kind,
        given: given.into(),
        known: table.iter().map(&name).collect::<Vec<_>>().join(", "),
    })
}

fn together(kind: &'static str, name: &str, with: &'static str, given: &str, partners: &[&str]) -> Result<(), MethodError> {
    match partners.contains(&given) {
        true => Ok(()),
        false => Err(MethodError::Pair { kind, name: name.into(), with, given: given.into(), partners: partners.join(", ") }),
    }
}

fn positive(key: &'static str, given: Option<f64>, default: f64) -> Result<f64, MethodError> {
    match given {
        None => Ok(default),
        Some(value) if value > 0.0 && value.is_finite() => Ok(value),
        Some(value) => Err(MethodError::Value { key, given: value.to_string(), allowed: "a positive number".into() }),
    }
}
