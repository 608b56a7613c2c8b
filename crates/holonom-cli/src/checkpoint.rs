//! `checkpoint.json`: what a run goes on from, and whether another may.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use holonom::record::{Recorder, RecorderMark, Recording};
use holonom::simulation::{Checkpoint, Simulation};
use holonom_io::Source;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::failure::Failure;
use crate::folder::Folder;
use crate::load::OF_METHOD;
use crate::message::listed;
use crate::provenance::{Provenance, VERSION};

/// Name of the file.
pub const FILE: &str = "checkpoint.json";

/// Content of the file.
#[derive(Serialize, Deserialize)]
pub struct Kept {
    /// Where the run is.
    #[serde(flatten)]
    pub last: Point,
    /// Where it was before a last step that its end cut short: a run to a later end goes on from there, as it would have without that end.
    pub before_end: Option<Point>,
    /// The file beside this one that has the rows of all columns.
    pub table: String,
    pub provenance: Provenance,
}

/// A run between two nominal steps, and what was recorded up to there.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Point {
    #[serde(flatten)]
    pub run: Checkpoint,
    pub recorder: RecorderMark,
    pub rows: usize,
    /// What was found and put right before the start, in words: a run that goes on from elsewhere would find something else.
    pub corrections: Vec<String>,
}

impl Point {
    /// Where a simulation is.
    pub fn of(simulation: &Simulation, recorder: &Recorder, corrections: &[String]) -> Self {
        Self { run: simulation.checkpoint(), recorder: recorder.mark(), rows: recorder.recording().rows(), corrections: corrections.into() }
    }
}

/// What a run goes on from.
pub struct Resumed {
    pub folder: Folder,
    /// Time that the earlier run was to reach, s.
    pub end: f64,
    pub point: Point,
    /// The file with the rows.
    pub table: String,
}

impl Resumed {
    /// Reads a checkpoint, or that of a folder, for a run that is the same but for its end.
    pub fn open(path: &Path, run: &Provenance, source: &Source) -> Result<Self, Failure> {
        let path = if path.is_dir() { path.join(FILE) } else { path.into() };
        let fail = |source| Failure::unread(&path, source, "give the folder of an earlier run, or run from the start, without --resume");
        let mut file = File::open(&path).map_err(fail)?;
        let folder = Folder::of(path.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new(".")))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(fail)?;
        let refuse = |why: String, cure: &str| Failure::usage(format!("{} {why}", path.display()), cure);
        let is_none = |error: serde_json::Error| {
            refuse(format!("is no checkpoint: {error}"), "give the folder or the checkpoint.json of an earlier run")
        };
        let value: Value = serde_json::from_slice(&bytes).map_err(is_none)?;
        let again = "run from the start, without --resume, or with the build of holonom that wrote it";
        match value["provenance"]["version"].as_str() {
            Some(VERSION) => (),
            Some(version) => return Err(refuse(format!("is of version {version}, and this is {VERSION}"), again)),
            None if value["state"].is_object() => return Err(refuse(format!("is of a version before {VERSION}"), again)),
            None => (),
        }
        let is_own = value["provenance"]["version"].is_string();
        let kept: Kept = serde_json::from_value(value).map_err(|error| match is_own {
            true => refuse(format!("was written by another build of holonom {VERSION}: {error}"), again),
            false => is_none(error),
        })?;
        let differences = differences(&kept.provenance, run, source);
        if !differences.is_empty() {
            // Without a step the rows of a run by accuracy are a share of its end apart.
            let follows = holonom_io::to_json(source.value())["simulation"]["step"].is_null();
            let cure = match kept.provenance.step {
                step if step != run.step && follows => {
                    format!(
                        "give --step {step}, which followed from the end of that run, and what else it had, or run from the start, without --resume"
                    )
                }
                _ => "give the model and the options of that run, or run from the start, without --resume".into(),
            };
            return Err(refuse(format!("is of another run: {}", listed(&differences)), &cure));
        }
        let reached = kept.last.run.state.t;
        // A run that was killed while its results were written has still to write them.
        let is_written = folder.path.join("summary.json").exists();
        if reached > run.end || (reached == run.end && is_written) {
            return Err(refuse(format!("is at {reached} s, and the run ends at {} s", run.end), "give a later --end"));
        }
        let point = kept.before_end.unwrap_or(kept.last);
        if !point.run.goes_on_unbroken() {
            let message = format!("is of a run that an event or a failed step ended at {reached} s, where an unbroken run ends, too");
            return Err(refuse(message, "run from the start without that event, or with another step, method or accuracy"));
        }
        Ok(Self { folder, end: kept.provenance.end, point, table: kept.table })
    }

    /// Whether a folder is that of the earlier run.
    pub fn is_in(&self, folder: &Path) -> bool {
        match (folder.canonicalize(), self.folder.path.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => false,
        }
    }

    /// Reads the rows up to the checkpoint into a recording without rows, and says how many bytes of their file they take.
    pub fn rows(&self, recording: &mut Recording) -> Result<u64, Failure> {
        let path = self.folder.path.join(&self.table);
        let bytes = std::fs::read(&path).map_err(|source| Failure::File { doing: "read", path: path.clone(), source })?;
        let read = holonom_io::read_csv(&bytes, self.point.rows, recording);
        read.map(|bytes| bytes as u64).map_err(|why| {
            let message = format!("{} has not the {} rows up to the checkpoint: {why}", path.display(), self.point.rows);
            Failure::usage(message, "run from the start, without --resume")
        })
    }
}

/// Keys that may differ, or that are compared by what follows from them.
const COMPARED_OTHERWISE: [&str; 4] = ["title", "simulation.end", "simulation.step", "output.every"];

/// Characters of a value that are shown.
const LONGEST: usize = 60;

/// What the numbers of two runs follow from that is not the same, but for their ends.
fn differences(was: &Provenance, is: &Provenance, source: &Source) -> Vec<String> {
    let mut found = Vec::new();
    let mut differ = |what: &str, was: &Value, is: &Value| {
        let word = |value: &Value| match value {
            Value::Null => "not there".to_string(),
            value => value.to_string().chars().take(LONGEST).collect(),
        };
        if was != is {
            found.push(format!("{what} was {} and is {}", word(was), word(is)));
        }
    };
    differ("the method", &was.method.as_str().into(), &is.method.as_str().into());
    differ("`simulation.step`", &was.step.into(), &is.step.into());
    differ("`output.every`", &was.every.into(), &is.every.into());
    let [old, new] = [entries(&described(was)), entries(&holonom_io::to_json(source.value()))];
    let [by_old, by_new] = [&old, &new].map(|entries| entries.iter().map(|(key, value)| (key, value)).collect::<HashMap<_, _>>());
    old.iter().for_each(|(key, value)| differ(&format!("`{key}`"), value, by_new.get(key).unwrap_or(&&Value::Null)));
    new.iter().filter(|(key, _)| !by_old.contains_key(key)).for_each(|(key, value)| differ(&format!("`{key}`"), &Value::Null, value));
    for (name, sum) in &was.files {
        if is.files.get(name) != Some(sum) {
            found.push(format!("the file `{name}` was changed"));
        }
    }
    // Coordinates are in the order of the file.
    if found.is_empty() && old != new {
        found.push("the entries of the model were in another order".into());
    }
    found
}

/// The description that was run; nothing where the text is not that of a model, which is a difference to every model.
fn described(run: &Provenance) -> Value {
    let mut value = Source::read("", run.model.as_bytes()).map_or(Value::Null, |source| holonom_io::to_json(source.value()));
    for change in &run.overrides {
        let mut place = &mut value;
        for part in change.key.split('.') {
            if !place.is_object() {
                *place = Value::Null;
            }
            place = &mut place[part];
        }
        *place = change.run.clone();
    }
    value
}

/// Keys with their values, tables within tables spread out, in their order.
fn entries(description: &Value) -> Vec<(String, Value)> {
    fn spread(path: &str, value: &Value, found: &mut Vec<(String, Value)>) {
        match value {
            Value::Object(table) => table
                .iter()
                .for_each(|(key, value)| spread(&if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, value, found)),
            value => found.push((path.into(), value.clone())),
        }
    }
    let mut found = Vec::new();
    spread("", description, &mut found);
    found.retain(|(key, _)| !COMPARED_OTHERWISE.contains(&key.as_str()) && !OF_METHOD.contains(&key.as_str()));
    found
}
