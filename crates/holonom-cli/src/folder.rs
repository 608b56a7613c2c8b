//! Folders of results. What another run has left there is not overwritten.

use std::fs::{File, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use holonom_io::Writer;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::checkpoint;
use crate::failure::Failure;
use crate::message::note;
use crate::options::Destination;

/// Files by which a folder is known to hold results.
const RESULTS: [&str; 12] = [
    "summary.json",
    "stability.json",
    "modes.json",
    "checkpoint.json",
    "sweep.journal",
    "sweep.csv",
    "trajectory.csv",
    "trajectory.npz",
    "trajectory.parquet",
    "recording.csv",
    "columns.json",
    "report.html",
];

/// The key of a compared run's summary that says what its tables are called, without their endings.
pub const TABLE: &str = "table";

/// A folder, into which files are written through a closure for each.
pub struct Folder {
    pub path: PathBuf,
    /// The folder, locked against other runs where the system can lock folders.
    _lock: Option<File>,
}

impl Folder {
    /// Creates the folder where it is missing.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        std::fs::create_dir_all(path).map_err(|source| Failure::File { doing: "create", path: path.into(), source })?;
        Ok(Self { path: path.into(), _lock: None })
    }

    /// The folder that was asked for, or the first of `results/usual`, `results/usual-2`, … that is free or holds the same results,
    /// which `is_same` finds out.
    pub fn claim(to: &Destination, usual: &str, is_same: impl Fn(&Path) -> bool) -> Result<Self, Failure> {
        if let Some(path) = &to.out {
            let folder = Self::create(path)?.locked().ok_or_else(|| {
                Failure::usage(format!("another run is writing to {}", path.display()), "wait for it, or give another --out")
            })?;
            let is_foreign = folder.has_results() && !is_same(path);
            return match (is_foreign, to.force) {
                (false, _) => Ok(folder),
                (true, true) => folder.remove_results(&[]).map(|()| folder),
                (true, false) => Err(Failure::usage(
                    format!("{} holds the results of another run{}", path.display(), folder.made_by()),
                    "give another --out, or --force to overwrite them",
                )),
            };
        }
        let path = |number: u32| PathBuf::from(if number == 1 { format!("results/{usual}") } else { format!("results/{usual}-{number}") });
        for number in 1.. {
            let Some(folder) = Self::create(&path(number))?.locked() else { continue };
            if !folder.has_results() || is_same(&folder.path) {
                if number > 1 && !to.quiet {
                    note(&format!("{} holds another run; this one goes to {}", path(1).display(), folder.path.display()));
                }
                return Ok(folder);
            }
            if to.force {
                return folder.remove_results(&[]).map(|()| folder);
            }
        }
        unreachable!("numbers do not end")
    }

    /// The same folder for this run alone; nothing where another run has it. Systems that cannot lock a folder give it to both.
    fn locked(self) -> Option<Self> {
        let lock = File::open(&self.path).ok();
        match lock.as_ref().map(File::try_lock) {
            Some(Err(TryLockError::WouldBlock)) => None,
            _ => Some(Self { _lock: lock, ..self }),
        }
    }

    fn has_results(&self) -> bool {
        RESULTS.iter().any(|name| self.path.join(name).exists())
    }

    /// What was typed for the results that are there, where they say so.
    fn made_by(&self) -> String {
        let made = summary(&self.path);
        let made = if made.is_array() { &made[0] } else { &made };
        made["provenance"]["command"].as_str().map_or(String::new(), |command| format!(": {command}"))
    }

    /// The folder of an earlier run, to go on in.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        Self::create(path)?
            .locked()
            .ok_or_else(|| Failure::usage(format!("another run is writing to {}", path.display()), "wait for it, or end it"))
    }

    /// The time of the checkpoint that is there, s.
    pub fn reached(&self) -> Option<f64> {
        #[derive(Deserialize)]
        struct Reached {
            state: Time,
        }
        #[derive(Deserialize)]
        struct Time {
            t: f64,
        }
        Some(in_checkpoint::<Reached>(&self.path)?.state.t)
    }

    /// Removes all results but some, so that none of them is taken for those that come.
    pub fn remove_results(&self, but: &[&str]) -> Result<(), Failure> {
        let names = RESULTS.iter().map(|name| name.to_string()).chain(self.tables());
        // Of both what a kill has left of writing them.
        let names = names.flat_map(|name| [format!("{name}.new"), name]);
        self.remove(names.filter(|name| !but.contains(&name.as_str())))
    }

    /// Removes files, where they are there.
    pub fn remove(&self, names: impl IntoIterator<Item = String>) -> Result<(), Failure> {
        for name in names {
            let path = self.path.join(name);
            match std::fs::remove_file(&path) {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(Failure::File { doing: "remove", path, source });
                }
                _ => (),
            }
        }
        Ok(())
    }

    /// Files that tables of compared runs may be in, from what the results say of themselves.
    fn tables(&self) -> Vec<String> {
        let compared: Value = read(&self.path.join("summary.json")).unwrap_or_default();
        let stems = compared.as_array().into_iter().flatten().filter_map(|run| Some(file_stem(run[TABLE].as_str()?)));
        stems.flat_map(|stem| holonom_io::WRITERS.iter().map(move |writer| table_name(&stem, writer))).collect()
    }

    /// Refuses to write tables over files that are no results, such as measured data that are called like a model.
    pub fn refuse_foreign_tables<'a>(&self, stems: impl Iterator<Item = &'a String>, writers: &[&Writer]) -> Result<(), Failure> {
        let own = self.tables();
        let mut names = stems.flat_map(|stem| writers.iter().map(move |writer| table_name(stem, writer)));
        match names.find(|name| !own.contains(name) && self.path.join(name).exists()) {
            None => Ok(()),
            Some(name) => Err(Failure::usage(
                format!("a table would be written over {}, which is no result", self.path.join(name).display()),
                "give another --out",
            )),
        }
    }

    /// Writes one file in full before it takes the place of an older one.
    pub fn write(&self, name: &str, write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>) -> Result<(), Failure> {
        let (path, new) = (self.path.join(name), self.path.join(format!("{name}.new")));
        let file = File::create(&new).and_then(|file| {
            let mut out = BufWriter::new(file);
            write(&mut out)?;
            out.flush()
        });
        file.and_then(|()| std::fs::rename(&new, &path)).map_err(|source| {
            // Half a file is of no use; that it cannot be written is said in any case.
            let _ = std::fs::remove_file(new);
            Failure::File { doing: "write", path, source }
        })
    }
}

/// Most bytes of the name of a file without its ending: systems take some 250, and folders have the name of their model in front.
const LONGEST_STEM: usize = 100;

fn table_name(stem: &str, writer: &Writer) -> String {
    format!("{stem}.{}", writer.extension)
}

/// The name of a run as the name of a file.
pub fn file_stem(label: &str) -> String {
    let plain = label.replace(", ", "-").replace(' ', "");
    let mut stem: String = plain.chars().map(|c| if c.is_alphanumeric() || "._-+=()".contains(c) { c } else { '-' }).collect();
    stem.truncate(stem.floor_char_boundary(LONGEST_STEM));
    stem
}

/// The same of several runs: all different.
pub fn file_stems<'a>(labels: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut stems: Vec<String> = Vec::new();
    for label in labels {
        let mut stem = file_stem(label);
        while stems.contains(&stem) {
            stem.push('_');
        }
        stems.push(stem);
    }
    stems
}

/// What the results in a folder say of themselves; null where there are none that do.
fn summary(folder: &Path) -> Value {
    #[derive(Serialize, Deserialize)]
    struct Origin {
        provenance: Value,
    }
    let written = ["summary.json", "stability.json", "modes.json"].into_iter().find_map(|name| read(&folder.join(name)));
    written.or_else(|| Some(json!(in_checkpoint::<Origin>(folder)?))).unwrap_or(Value::Null)
}

/// Parts of the checkpoint in a folder, whose whole is large.
fn in_checkpoint<Part: DeserializeOwned>(folder: &Path) -> Option<Part> {
    read(&folder.join(checkpoint::FILE))
}

/// What a file of JSON holds, where it does.
fn read<Content: DeserializeOwned>(path: &Path) -> Option<Content> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Whether the results in a folder are those of a run with this summary, or of several with these, whenever they ran and however that was
/// typed.
pub fn holds(folder: &Path, summaries: &Value) -> bool {
    identity(&summary(folder)) == identity(summaries)
}

/// Where results come from, without what differs between equal runs.
fn identity(summary: &Value) -> Value {
    if let Value::Array(all) = summary {
        return all.iter().map(identity).collect();
    }
    let mut provenance = summary["provenance"].clone();
    if let Value::Object(provenance) = &mut provenance {
        ["date", "command"].into_iter().for_each(|key| drop(provenance.shift_remove(key)));
        if let Some(Value::Array(overrides)) = provenance.get_mut("overrides") {
            overrides.retain(|change| change["file"] != change["run"]);
            overrides.sort_by_key(|change| change["key"].to_string());
        }
    }
    provenance
}
