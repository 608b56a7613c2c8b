//! What can be compared: a model, the folder of a run, a table of what was measured.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use holonom::record::{Heading, Recording};
use holonom_io::{read_recording, sha256};
use serde_json::{Value, json};

use crate::checkpoint;
use crate::failure::Failure;
use crate::load::{STANDARD_INPUT, STDIN};

/// Something to compare, as it was named on the command line.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// A model file or an example.
    Model(String),
    /// The folder that a run left.
    Folder(PathBuf),
    /// A CSV file.
    Measured(PathBuf),
}

/// The status of a table of what was measured.
pub const MEASURED: &str = "measured";

/// Headings of columns by their names.
pub type Headings = HashMap<String, Heading>;

impl Subject {
    /// What a word of the command line names.
    pub fn of(argument: &str) -> Self {
        let path = Path::new(argument);
        match path.extension() {
            _ if argument.starts_with("example:") => Self::Model(argument.into()),
            _ if path.is_dir() => Self::Folder(path.into()),
            Some(ending) if ending.eq_ignore_ascii_case("csv") => Self::Measured(path.into()),
            _ => Self::Model(argument.into()),
        }
    }

    /// What it is called: a file without its ending, a folder without those around it.
    pub fn name(&self) -> String {
        let of = |path: &Path| path.file_stem().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        match self {
            Self::Model(argument) if argument == STANDARD_INPUT => STDIN.into(),
            Self::Model(argument) => argument.strip_prefix("example:").map_or_else(|| of(Path::new(argument)), str::to_string),
            // The point in a folder's name begins no ending.
            Self::Folder(path) => path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned()),
            Self::Measured(path) => of(path),
        }
    }

    /// The word that named it.
    pub fn argument(&self) -> String {
        match self {
            Self::Model(argument) if argument == STANDARD_INPUT => STDIN.into(),
            Self::Model(argument) => argument.clone(),
            Self::Folder(path) | Self::Measured(path) => path.display().to_string(),
        }
    }

    /// Adds what a folder says of its columns to what is known of columns.
    pub fn add_headings(&self, known: &mut Headings) {
        let Self::Folder(folder) = self else { return };
        // A folder may have none: it only makes plots better.
        let Some(Value::Object(columns)) =
            std::fs::read(folder.join("columns.json")).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok())
        else {
            return;
        };
        for (name, column) in columns {
            let [unit, meaning] = ["unit", "meaning"].map(|key| column[key].as_str().unwrap_or("").to_string());
            known.entry(name.clone()).or_insert_with(|| Heading { name, unit: unit.into(), meaning: meaning.into() });
        }
    }

    /// The columns and the summary of what is not to be run; `None` of a model.
    pub fn read(&self, known: &Headings) -> Result<Option<(Recording, Value)>, Failure> {
        match self {
            Self::Model(_) => Ok(None),
            Self::Folder(folder) => {
                // The second has all columns where the first is of some only, or in another format.
                let table = ["recording.csv", "trajectory.csv"].map(|name| folder.join(name)).into_iter().find(|table| table.is_file());
                let table = table.ok_or_else(|| {
                    Failure::usage(
                        format!("{} is not the folder of a run: it has neither a trajectory.csv nor a recording.csv", folder.display()),
                        "name a folder that `holonom run` left, or a table of measured data",
                    )
                })?;
                let summary = std::fs::read(folder.join("summary.json")).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
                match summary.filter(Value::is_object) {
                    Some(summary) => Ok(Some((read_table(&table, known)?.0, summary))),
                    None => Err(Failure::usage(
                        format!("{} has no summary.json of a run, which is written when a run ends", folder.display()),
                        format!("go on with the run by --resume, or name {}, whose rows are then measured data", table.display()),
                    )),
                }
            }
            Self::Measured(path) => {
                let (recording, sum) = read_table(path, known)?;
                let end = recording.column("t").and_then(|times| times.last().copied());
                let files = json!({ path.display().to_string(): sum });
                let summary = json!({ "status": MEASURED, "end": end, "rows": recording.rows(), "provenance": { "files": files } });
                Ok(Some((recording, summary)))
            }
        }
    }
}

/// A table, and the SHA-256 of its file.
fn read_table(path: &Path, known: &Headings) -> Result<(Recording, String), Failure> {
    let bytes = std::fs::read(path).map_err(|source| Failure::unread(path, source, "give a CSV file with a line for each time"))?;
    // Runs end each row with a line feed; measured tables may leave out the last.
    let is_of_run = || path.with_file_name(checkpoint::FILE).exists();
    if bytes.last().is_some_and(|last| *last != b'\n') && is_of_run() {
        let message = format!("{} is cut off within its last row, as by a kill or a full disk", path.display());
        return Err(Failure::usage(message, "go on with the run by --resume, or run it again"));
    }
    let heading = |name: &str| known.get(name).cloned().unwrap_or_else(|| name.to_string().into());
    match read_recording(&bytes, heading) {
        Ok(recording) => Ok((recording, sha256(&bytes))),
        Err(error) => Err(Failure::usage(format!("{} is no table over time: {error}", path.display()), error.cure())),
    }
}
