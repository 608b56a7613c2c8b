//! `[simulation]` and `[output]`: how a model is run and what is recorded.

use wildmatch::WildMatch;

use super::assembly::Assembly;
use super::bodies::short;
use super::entry::{Entry, Spot, all};
use super::fault::{Read, suggest};
use super::fields::{Keys, List, Map, Number};
use super::key::Shape;
use crate::record::Constraints;
use crate::simulation::{Choice, ProjectionChoice, uncountable};
use crate::system::Place;

/// `[simulation]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("[simulation]")]
pub struct SimulationKeys {
    /// time at which the simulation ends; 0 for the start alone, with its forces
    #[key(unit = "s", default = "asked of the command")]
    pub end: Option<Number>,
    /// time step; with an accuracy, the interval of the results
    #[key(unit = "s", default = "asked of the command")]
    pub step: Option<Number>,
    /// chooses the steps: error of positions at the end, over the size of the mechanism
    #[key(default = "none: steps are equal")]
    pub accuracy: Option<Number>,
    /// a method by name; `holonom methods` lists them
    #[key(default = "conserving-ggl")]
    pub method: Option<String>,
    /// how constraints are put on
    #[key(default = "that of the method")]
    pub formulation: Option<String>,
    /// index of the formulations lagrange and augmented-lagrangian: 3, 2 or 1
    #[key(default = "3", shape = Shape::Whole)]
    pub index: Option<Number>,
    /// how time is stepped
    #[key(default = "that of the method")]
    pub integrator: Option<String>,
    /// order of an integrator that has several
    #[key(default = "that of the integrator", shape = Shape::Whole)]
    pub order: Option<Number>,
    /// newton, nested or simultaneous
    #[key(default = "newton")]
    pub iteration: Option<String>,
    /// α in the paper's sense
    #[key(default = "scaled to the system")]
    pub penalty: Option<Number>,
    /// Newmark's β
    #[key(default = "0.25")]
    pub beta: Option<Number>,
    /// Newmark's γ
    #[key(default = "0.5")]
    pub gamma: Option<Number>,
    /// α of hht, 0 to 1/3
    #[key(default = "0.1")]
    pub alpha: Option<Number>,
    /// ρ∞ of generalized-alpha, 0 to 1
    #[key(default = "0.8")]
    pub rho: Option<Number>,
    /// ω of the stabilised formulations
    #[key(unit = "1/s", default = "10")]
    pub omega: Option<Number>,
    /// ξ of the stabilised formulations
    #[key(default = "1")]
    pub xi: Option<Number>,
    /// which positions the conserving scheme puts on the constraints
    #[key(default = "end", shape = Shape::Choice(&["end", "mean"]))]
    pub constraint_at: Option<String>,
    /// when the iteration stops
    #[key(default = "that of the iteration")]
    pub tolerance: Option<Number>,
    /// most iterations in a step
    #[key(default = "that of the iteration", shape = Shape::Whole)]
    pub max_iterations: Option<Number>,
    /// real time: exactly so many Newton iterations in every step
    #[key(default = "as many as it takes", shape = Shape::Whole)]
    pub iterations: Option<Number>,
    /// whether a step that fails is retried in halves
    #[key(default = "true")]
    pub subdivide: Option<bool>,
    /// projections after each step
    #[key(default = "that of the method")]
    pub projection: Option<ProjectionKeys>,
}

/// `[simulation.projection]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("projection")]
pub struct ProjectionKeys {
    /// what is projected after each step
    #[key(default = "those of the method", shape = Shape::Words(&["velocity", "acceleration"]))]
    pub levels: Option<List<String>>,
    /// the metric A of the projection: mass, identity, tangent or custom
    #[key(default = "mass")]
    pub matrix: Option<String>,
    /// exact, or by penalty (10)–(13)
    #[key(default = "exact")]
    pub solve: Option<String>,
    /// penalty of the projection by penalty
    #[key(default = "1e7")]
    pub penalty: Option<Number>,
    /// share of the violation that is taken out
    #[key(default = "1")]
    pub strength: Option<Number>,
    /// true projects what is recorded and integrates on without
    #[key(default = "false")]
    pub shadow: Option<bool>,
    /// the diagonal of the matrix custom, a number for each free point
    #[key(unit = "kg", default = "none")]
    pub weights: Option<Map<Number>>,
}

/// `[output]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("[output]")]
pub struct OutputKeys {
    /// record every so many steps
    #[key(unit = "steps", default = "1", shape = Shape::Whole)]
    pub every: Option<Number>,
    /// points, bodies and named places of bodies to record, in this order
    #[key(default = "all")]
    pub points: Option<List<String>>,
    /// columns of the tables by their names, in which `*` stands for any letters and `?` for one; the time is always there
    #[key(default = "all")]
    pub columns: Option<List<String>>,
    /// of the constraints: true records the multiplier of each row and the force on each point, too; false neither forces of joints nor
    /// accelerations
    #[key(default = "forces of joints and accelerations")]
    pub reactions: Option<bool>,
}

/// How a model is run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// s
    pub end: Option<f64>,
    /// s
    pub step: Option<f64>,
    /// The method.
    pub choice: Choice,
}

/// What is recorded; what is not given is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Record every so many steps.
    pub every: Option<u32>,
    /// Points, bodies and places of bodies to record, in this order; all where nothing is said.
    pub points: Option<Vec<String>>,
    /// Patterns of the names of columns in tables; all where nothing is said.
    pub columns: Option<Vec<String>>,
    /// Record the forces of the constraints.
    pub reactions: Option<bool>,
}

impl SimulationKeys {
    /// What the keys come to. What is wrong with one is recorded, and it counts as not given.
    pub(super) fn settings(&self, entry: &Entry<'_>, assembly: &Assembly<'_>) -> Settings {
        let number = |key, number: &Option<Number>| entry.optional(key, number, Number::number).unwrap_or(None);
        let positive = |key, number: &Option<Number>| entry.optional(key, number, Number::positive).unwrap_or(None);
        let whole =
            |key, number: &Option<Number>| entry.optional(key, number, |number, entry, key| number.whole(entry, key, 1)).unwrap_or(None);
        let small = |number: Option<u32>| number.map(|number| number.min(u8::MAX.into()) as u8);
        let end = entry.optional("end", &self.end, Number::not_negative).unwrap_or(None);
        let step = positive("step", &self.step);
        if let (Some(end), Some(step)) = (end, step)
            && step > end
            && end > 0.0
        {
            entry.note("step", format!("the step of {} s is longer than the run of {} s", short(step), short(end)));
        }
        if let (Some(end), Some(step)) = (end, step) {
            let _: Read<()> = require_countable(entry, "step", "steps", [end, step]);
        }
        let choice = Choice {
            method: self.method.clone(),
            formulation: self.formulation.clone(),
            index: small(whole("index", &self.index)),
            integrator: self.integrator.clone(),
            order: small(whole("order", &self.order)),
            accuracy: positive("accuracy", &self.accuracy),
            iteration: self.iteration.clone(),
            penalty: positive("penalty", &self.penalty),
            beta: number("beta", &self.beta),
            gamma: number("gamma", &self.gamma),
            alpha: number("alpha", &self.alpha),
            rho: number("rho", &self.rho),
            omega: positive("omega", &self.omega),
            xi: positive("xi", &self.xi),
            constraint_at: entry
                .optional("constraint_at", &self.constraint_at, |word, entry, key| entry.choice(key, word, &["end", "mean"]))
                .unwrap_or(None)
                .map(str::to_string),
            tolerance: positive("tolerance", &self.tolerance),
            max_iterations: whole("max_iterations", &self.max_iterations).map(|most| most as usize),
            iterations: whole("iterations", &self.iterations).map(|count| count as usize),
            subdivide: self.subdivide,
            projection: self.projection.as_ref().map(|keys| entry.within("projection", keys, |inner| keys.choice(inner, assembly))),
        };
        Settings { end, step, choice }
    }
}

impl ProjectionKeys {
    fn choice(&self, entry: &Entry<'_>, assembly: &Assembly<'_>) -> ProjectionChoice {
        ProjectionChoice {
            levels: self.levels.as_ref().map(|levels| levels.to_vec()),
            matrix: self.matrix.clone(),
            solve: self.solve.clone(),
            penalty: entry.optional("penalty", &self.penalty, Number::positive).unwrap_or(None),
            strength: entry.optional("strength", &self.strength, Number::positive).unwrap_or(None),
            shadow: self.shadow,
            weights: entry
                .optional("weights", &self.weights, |weights, entry, key| node_weights(weights, entry, key, assembly))
                .unwrap_or(None),
        }
    }
}

/// Refuses steps or periods so short that time does not move by one, or that nobody can count them up to the end of the run (s).
pub(super) fn require_countable(entry: &Entry<'_>, key: &'static str, them: &str, [end, period]: [f64; 2]) -> Read<()> {
    uncountable(end, period).map_or(Ok(()), |count| {
        let message = format!("a run of {} s has {count:.0e} {them} of {period:e} s, more than can be counted", short(end));
        Err(entry.refuse(key, message, "write a longer time, in s"))
    })
}

/// A weight for each free node, from weights by the names of points.
fn node_weights(weights: &Map<Number>, entry: &Entry<'_>, key: &str, assembly: &Assembly<'_>) -> Read<Vec<f64>> {
    let known = || assembly.points.iter().map(|point| point.name.as_str());
    let weight = |(name, weight): &(String, Number), entry: &Entry<'_>| {
        let weight = weight.positive(entry, name.as_str())?;
        match assembly.by_name.contains_key(name) {
            true => Ok((name.clone(), weight)),
            false => Err(entry.refuse_key(name, format!("there is no point `{name}`"), suggest(name, known()))),
        }
    };
    let given = entry.within(key, weights, |entry| all(weights.iter().map(|given| weight(given, entry))))?;
    let mut of_nodes = vec![0.0; assembly.builder.free_nodes()];
    for point in assembly.points.iter().filter(|point| point.end.free) {
        let Some(Place::Node(node)) = point.end.place() else { continue };
        let Some((_, weight)) = given.iter().find(|(name, _)| *name == point.name) else {
            let message = format!("the projection has no weight for the point `{}`", point.name);
            return Err(entry.refuse(key, message, "give every free point one"));
        };
        of_nodes[node.index()] = *weight;
    }
    Ok(of_nodes)
}

impl OutputKeys {
    /// What the keys come to. What is wrong with one is recorded, and it counts as not given.
    pub(super) fn output(&self, entry: &Entry<'_>, assembly: &Assembly<'_>) -> Output {
        let places = || assembly.bodies.iter().flat_map(|body| body.points.iter().map(|(place, _)| format!("{}.{place}", body.name)));
        let is_faulty = |name: &str| assembly.faulty.contains(name.split(['[', '.']).next().unwrap_or(name));
        let is_there = |name: &String| assembly.by_name.contains_key(name) || assembly.body_by_name(name).is_some();
        let point = |(k, name): (usize, &String)| match is_there(name) || is_faulty(name) || places().any(|place| place == *name) {
            true => Ok(name.clone()),
            false => {
                let owners = assembly.points.iter().map(|point| &point.name).chain(assembly.bodies.iter().map(|body| &body.name));
                let known: Vec<String> = owners.cloned().chain(places()).collect();
                let cure = suggest(name, known.iter().map(String::as_str));
                Err(entry.refuse(Spot { key: "points", item: Some(k) }, format!("there is no point `{name}`"), cure))
            }
        };
        Output {
            every: entry.optional("every", &self.every, |every, entry, key| every.whole(entry, key, 1)).unwrap_or(None),
            points: self.points.as_ref().and_then(|points| all(points.iter().enumerate().map(point)).ok()),
            columns: self.columns.as_ref().map(|columns| columns.to_vec()),
            reactions: self.reactions,
        }
    }

    /// Refuses patterns that no column has.
    pub(super) fn require_columns(&self, entry: &Entry<'_>, names: &[String]) {
        for (k, pattern) in self.columns.iter().flat_map(|columns| columns.iter().enumerate()) {
            if !names.iter().any(|name| matches(pattern, name)) {
                let cure = suggest(pattern, names.iter().map(String::as_str));
                entry.refuse(Spot { key: "columns", item: Some(k) }, format!("no column is called `{pattern}`"), cure);
            }
        }
    }
}

impl Output {
    /// What a run records of the forces of its constraints.
    pub fn constraints(&self) -> Constraints {
        match self.reactions {
            Some(false) => Constraints::Nothing,
            None => Constraints::Joints,
            Some(true) => Constraints::Rows,
        }
    }

    /// Whether tables have a column.
    pub fn has_column(&self, name: &str) -> bool {
        self.columns.as_ref().is_none_or(|patterns| patterns.iter().any(|pattern| matches(pattern, name)))
    }
}

/// Whether a name is as a pattern says.
fn matches(pattern: &str, name: &str) -> bool {
    WildMatch::new(pattern).matches(name)
}
