//! What the scripts in `benches` measured.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

/// Everything the chapter shows.
pub struct Results {
    pub times: Times,
    pub counts: Counts,
}

/// `benches/side-by-side/results.json`.
#[derive(Deserialize)]
pub struct Times {
    pub machine: Machine,
    pub rounds: Rounds,
    pub versions: BTreeMap<String, String>,
    pub cost: Vec<Cost>,
    /// Errors that the table of work against precision asks for, m or rad.
    pub goals: Vec<f64>,
    pub precision: Vec<Precision>,
}

#[derive(Deserialize)]
pub struct Machine {
    pub processor: String,
    pub cores: u32,
    /// Processes that ran when the measurement began.
    pub load: f64,
}

#[derive(Deserialize)]
pub struct Rounds {
    pub cost: u32,
    pub precision: u32,
}

/// A program on a problem at one step.
#[derive(Deserialize)]
pub struct Cost {
    pub problem: String,
    pub title: String,
    pub bodies: u32,
    /// s
    pub step: f64,
    /// s
    pub end: f64,
    pub program: String,
    pub setting: String,
    /// µs a step
    pub us: Option<f64>,
    pub failed: Option<String>,
    pub error: Option<f64>,
    /// J
    pub drift: Option<f64>,
    pub position: Option<f64>,
    pub velocity: Option<f64>,
}

/// A program on a problem at many steps.
#[derive(Deserialize)]
pub struct Precision {
    pub problem: String,
    pub title: String,
    pub program: String,
    pub setting: String,
    pub points: Vec<Point>,
    /// CPU time to each of the goals, s.
    pub to: Vec<Option<f64>>,
    pub failed: Option<String>,
}

#[derive(Deserialize)]
pub struct Point {
    /// s
    pub cpu: Option<f64>,
    pub error: f64,
}

/// `benches/counts/results.json`.
#[derive(Deserialize)]
pub struct Counts {
    pub gallery: Vec<Count>,
    pub benches: Vec<Count>,
}

/// What a step takes on any machine.
#[derive(Deserialize)]
pub struct Count {
    pub name: String,
    pub method: String,
    /// s
    pub step: f64,
    pub iterations: f64,
    pub factorizations: f64,
    pub instructions: f64,
}

impl Results {
    pub fn read(root: &Path) -> Result<Self, String> {
        Ok(Self { times: read(root, "benches/side-by-side/results.json")?, counts: read(root, "benches/counts/results.json")? })
    }
}

fn read<T: DeserializeOwned>(root: &Path, file: &str) -> Result<T, String> {
    let text = std::fs::read_to_string(root.join(file)).map_err(|error| format!("{file}: {error}"))?;
    serde_json::from_str(&text).map_err(|error| format!("{file}: {error}"))
}

/// Program and setting for people: methods of holonom have names of their own.
pub fn label(program: &str, setting: &str) -> String {
    if program == "holonom" { setting.into() } else { format!("{program} {setting}") }
}
