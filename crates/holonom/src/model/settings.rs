//! `[simulation]` and `[output]`: how to run a model, in words that the simulation resolves later.

use super::assembly::Assembly;
use super::entry::{Entry, Spot, all};
use super::fault::{Read, suggest};
use super::key::{Key, Shape};

/// `[simulation]`; what is not given is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// s
    pub end: Option<f64>,
    /// s
    pub step: Option<f64>,
    pub method: Option<String>,
    pub formulation: Option<String>,
    pub index: Option<u32>,
    pub integrator: Option<String>,
    /// Order of an integrator that has several.
    pub order: Option<u32>,
    /// Relative error of position that steps are chosen for.
    pub accuracy: Option<f64>,
    pub iteration: Option<String>,
    /// α in the paper's sense.
    pub penalty: Option<f64>,
    /// Newmark's β and γ.
    pub beta: Option<f64>,
    pub gamma: Option<f64>,
    /// HHT's α and generalized-α's ρ∞.
    pub alpha: Option<f64>,
    pub rho: Option<f64>,
    /// ω (1/s) and ξ of stabilised formulations.
    pub omega: Option<f64>,
    pub xi: Option<f64>,
    /// `"end"` or `"mean"`.
    pub constraint_at: Option<String>,
    pub tolerance: Option<f64>,
    pub max_iterations: Option<u32>,
    /// Newton iterations of every step, no more and no fewer.
    pub iterations: Option<u32>,
    pub subdivide: Option<bool>,
    pub projection: Option<ProjectionSettings>,
}

/// `[simulation.projection]`; what is not given is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProjectionSettings {
    /// `"velocity"`, `"acceleration"`.
    pub levels: Option<Vec<String>>,
    pub matrix: Option<String>,
    pub solve: Option<String>,
    pub penalty: Option<f64>,
    pub strength: Option<f64>,
    pub shadow: Option<bool>,
    /// Weights of free points by name, in file order, kg.
    pub weights: Option<Vec<(String, f64)>>,
}

/// `[output]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Record every so many steps.
    pub every: Option<u32>,
    /// Points to record, in this order; all where nothing is said.
    pub points: Option<Vec<String>>,
    /// Record the forces of the constraints.
    pub reactions: Option<bool>,
}

/// Keys of `[simulation.projection]`.
pub const PROJECTION: &[Key] = &[
    Key::optional("levels", Shape::Words(&["velocity", "acceleration"]), "those of the method", "", "what is projected after each step"),
    Key::optional("matrix", Shape::Text, "mass", "", "the metric A of the projection: mass, identity, tangent or custom"),
    Key::optional("solve", Shape::Text, "exact", "", "exact, or by penalty (10)–(13)"),
    Key::optional("penalty", Shape::Number, "1e7", "", "penalty of the projection by penalty"),
    Key::optional("strength", Shape::Number, "1", "", "share of the violation that is taken out"),
    Key::optional("shadow", Shape::Flag, "false", "", "true projects what is recorded and integrates on without"),
    Key::optional("weights", Shape::Weights, "none", "kg", "the diagonal of the matrix custom, a number for each free point"),
];

/// Keys of `[simulation]`.
pub const SIMULATION: &[Key] = &[
    Key::optional("end", Shape::Number, "asked of the command", "s", "time at which the simulation ends"),
    Key::optional("step", Shape::Number, "asked of the command", "s", "time step; with an accuracy, the interval of the results"),
    Key::optional(
        "accuracy",
        Shape::Number,
        "none: steps are equal",
        "",
        "chooses the steps: error of positions at the end, over the size of the mechanism",
    ),
    Key::optional("method", Shape::Text, "conserving-ggl", "", "a method by name; `holonom methods` lists them"),
    Key::optional("formulation", Shape::Text, "that of the method", "", "how constraints are put on"),
    Key::optional("index", Shape::Whole, "3", "", "index of the formulations lagrange and augmented-lagrangian: 3, 2 or 1"),
    Key::optional("integrator", Shape::Text, "that of the method", "", "how time is stepped"),
    Key::optional("order", Shape::Whole, "that of the integrator", "", "order of an integrator that has several"),
    Key::optional("iteration", Shape::Text, "newton", "", "newton, nested or simultaneous"),
    Key::optional("penalty", Shape::Number, "scaled to the system", "", "α in the paper's sense"),
    Key::optional("beta", Shape::Number, "0.25", "", "Newmark's β"),
    Key::optional("gamma", Shape::Number, "0.5", "", "Newmark's γ"),
    Key::optional("alpha", Shape::Number, "0.1", "", "α of hht, 0 to 1/3"),
    Key::optional("rho", Shape::Number, "0.8", "", "ρ∞ of generalized-alpha, 0 to 1"),
    Key::optional("omega", Shape::Number, "10", "1/s", "ω of the stabilised formulations"),
    Key::optional("xi", Shape::Number, "1", "", "ξ of the stabilised formulations"),
    Key::optional(
        "constraint_at",
        Shape::Choice(&["end", "mean"]),
        "end",
        "",
        "which positions the conserving scheme puts on the constraints",
    ),
    Key::optional("tolerance", Shape::Number, "that of the iteration", "", "when the iteration stops"),
    Key::optional("max_iterations", Shape::Whole, "that of the iteration", "", "most iterations in a step"),
    Key::optional("iterations", Shape::Whole, "as many as it takes", "", "real time: exactly so many Newton iterations in every step"),
    Key::optional("subdivide", Shape::Flag, "true", "", "whether a step that fails is retried in halves"),
    Key::optional("projection", Shape::Table(PROJECTION), "that of the method", "", "projections after each step"),
];

/// Keys of `[output]`.
pub const OUTPUT: &[Key] = &[
    Key::optional("every", Shape::Whole, "1", "steps", "record every so many steps"),
    Key::optional("points", Shape::Points, "all", "", "points to record, in this order"),
    Key::optional("reactions", Shape::Flag, "false", "", "record the multiplier of each row and the constraints' force on each point"),
];

/// Reads `[simulation]`.
pub fn read(root: &Entry<'_>, assembly: &Assembly<'_>) -> Read<Settings> {
    let Some(entry) = inner(root, "simulation", "simulation")? else {
        return Ok(Settings::default());
    };
    entry.refuse_unknown_keys("[simulation]", &SIMULATION.iter().collect::<Vec<_>>());
    let word = |key| entry.optional(key, |entry, key| entry.text(key).map(str::to_string));
    let number = |key| entry.optional(key, Entry::number);
    let positive = |key| entry.optional(key, Entry::positive);
    let settings = Settings {
        end: positive("end").unwrap_or(None),
        step: positive("step").unwrap_or(None),
        method: word("method").unwrap_or(None),
        formulation: word("formulation").unwrap_or(None),
        index: entry.optional("index", |entry, key| entry.whole(key, 1)).unwrap_or(None),
        integrator: word("integrator").unwrap_or(None),
        order: entry.optional("order", |entry, key| entry.whole(key, 1)).unwrap_or(None),
        accuracy: positive("accuracy").unwrap_or(None),
        iteration: word("iteration").unwrap_or(None),
        penalty: positive("penalty").unwrap_or(None),
        beta: number("beta").unwrap_or(None),
        gamma: number("gamma").unwrap_or(None),
        alpha: number("alpha").unwrap_or(None),
        rho: number("rho").unwrap_or(None),
        omega: positive("omega").unwrap_or(None),
        xi: positive("xi").unwrap_or(None),
        constraint_at: entry
            .optional("constraint_at", |entry, key| entry.choice(key, &["end", "mean"]).map(str::to_string))
            .unwrap_or(None),
        tolerance: positive("tolerance").unwrap_or(None),
        max_iterations: entry.optional("max_iterations", |entry, key| entry.whole(key, 1)).unwrap_or(None),
        iterations: entry.optional("iterations", |entry, key| entry.whole(key, 1)).unwrap_or(None),
        subdivide: entry.optional("subdivide", Entry::flag).unwrap_or(None),
        projection: projection(&entry, assembly).unwrap_or(None),
    };
    Ok(settings)
}

fn projection(simulation: &Entry<'_>, assembly: &Assembly<'_>) -> Read<Option<ProjectionSettings>> {
    let Some(entry) = inner(simulation, "projection", "simulation.projection")? else {
        return Ok(None);
    };
    entry.refuse_unknown_keys("projection", &PROJECTION.iter().collect::<Vec<_>>());
    let words = |entry: &Entry<'_>, key: &str| entry.texts(key).map(|words| words.into_iter().map(str::to_string).collect());
    Ok(Some(ProjectionSettings {
        levels: entry.optional("levels", words).unwrap_or(None),
        matrix: entry.optional("matrix", |entry, key| entry.text(key).map(str::to_string)).unwrap_or(None),
        solve: entry.optional("solve", |entry, key| entry.text(key).map(str::to_string)).unwrap_or(None),
        penalty: entry.optional("penalty", Entry::positive).unwrap_or(None),
        strength: entry.optional("strength", Entry::not_negative).unwrap_or(None),
        shadow: entry.optional("shadow", Entry::flag).unwrap_or(None),
        weights: weights(&entry, assembly).unwrap_or(None),
    }))
}

fn weights(projection: &Entry<'_>, assembly: &Assembly<'_>) -> Read<Option<Vec<(String, f64)>>> {
    let Some(entry) = inner(projection, "weights", "simulation.projection.weights")? else {
        return Ok(None);
    };
    let weight = |name: &str| {
        let weight = entry.positive(name)?;
        match assembly.by_name.get(name) {
            Some(_) => Ok((name.to_string(), weight)),
            None => Err(entry.refuse_key(
                name,
                format!("there is no point `{name}`"),
                suggest(name, assembly.points.iter().map(|point| point.name.as_str())),
            )),
        }
    };
    all(entry.table.keys().map(weight)).map(Some)
}

/// Reads `[output]`.
pub fn output(root: &Entry<'_>, assembly: &Assembly<'_>) -> Read<Output> {
    let Some(entry) = inner(root, "output", "output")? else {
        return Ok(Output::default());
    };
    entry.refuse_unknown_keys("[output]", &OUTPUT.iter().collect::<Vec<_>>());
    let points = |entry: &Entry<'_>, key: &str| {
        let known = |(k, name): (usize, &str)| match assembly.by_name.contains_key(name) || assembly.faulty.contains(name) {
            true => Ok(name.to_string()),
            false => {
                let cure = suggest(name, assembly.points.iter().map(|point| point.name.as_str()));
                Err(entry.refuse(Spot { key, item: Some(k) }, format!("there is no point `{name}`"), cure))
            }
        };
        all(entry.texts(key)?.into_iter().enumerate().map(known))
    };
    Ok(Output {
        every: entry.optional("every", |entry, key| entry.whole(key, 1)).unwrap_or(None),
        points: entry.optional("points", points).unwrap_or(None),
        reactions: entry.optional("reactions", Entry::flag).unwrap_or(None),
    })
}

/// A table inside another one, if it is there.
fn inner<'a>(outer: &Entry<'a>, key: &str, path: &'a str) -> Read<Option<Entry<'a>>> {
    let Some(table) = outer.optional(key, Entry::table)? else {
        return Ok(None);
    };
    Ok(Some(Entry { name: "", path, table, ..*outer }))
}
