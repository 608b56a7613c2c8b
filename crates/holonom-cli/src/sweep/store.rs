//! Where the lines of a study go as its runs end: into memory, or into a folder as well, where the same study goes on with them.

use std::path::Path;

use holonom_io::{Table, WriteTable, Writer};
use serde_json::Value;

use super::journal::Journal;
use super::study::{Line, Study};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::options::Destination;

/// The file in the folder that holds finished runs.
pub const JOURNAL: &str = "sweep.journal";

/// The lines of a study.
pub struct Store {
    folder: Option<Folder>,
    journal: Journal,
}

impl Store {
    /// In memory.
    pub fn new(study: &Study) -> Self {
        Self { folder: None, journal: Journal::in_memory(study.runs()) }
    }

    /// In a folder: the one that was asked for, or one with the usual name.
    ///
    /// # Errors
    /// A folder with other results, and what cannot be read or written.
    pub(crate) fn claim(to: &Destination, usual: &str, study: &Study, identity: &Value) -> Result<Self, Failure> {
        let folder = Folder::claim(to, usual, |path| is_of(path, to, identity))?;
        let (journal, table) = (folder.path.join(JOURNAL), folder.path.join("sweep.csv"));
        // A table that no journal vouches for is left alone.
        if table.exists() && !journal.exists() {
            return Err(Failure::usage(
                format!("{} is there without its {JOURNAL}", table.display()),
                "give another --out, or --force to overwrite it",
            ));
        }
        let journal = Journal::open(&journal, identity, study.runs(), study.sheet())?;
        Ok(Self { folder: Some(folder), journal })
    }

    /// In a folder by its name.
    ///
    /// # Errors
    /// A folder with other results that are not to be overwritten, and what cannot be read or written.
    pub fn open(path: &Path, force: bool, study: &Study, identity: &Value) -> Result<Self, Failure> {
        Self::claim(&Destination { out: Some(path.into()), force, json: false, quiet: true }, "", study, identity)
    }

    /// Notes a run that has ended.
    ///
    /// # Errors
    /// A journal that cannot be written.
    pub fn add(&mut self, line: Line) -> Result<(), Failure> {
        self.journal.add(line.run, line.text)
    }

    /// Notes a run that has ended somewhere else, by its line; says whether it is one of the study.
    ///
    /// # Errors
    /// A journal that cannot be written.
    pub fn add_text(&mut self, text: &str, study: &Study) -> Result<bool, Failure> {
        match study.sheet().run(text).filter(|run| (1..=study.runs()).contains(run)) {
            Some(run) => self.journal.add(run, text.into()).map(|()| true),
            None => Ok(false),
        }
    }

    /// Numbers of the runs that are still to be made.
    pub fn missing(&self) -> Vec<u64> {
        self.journal.missing()
    }

    /// Whether all runs have ended.
    pub fn is_whole(&self) -> bool {
        self.journal.lines.iter().all(Option::is_some)
    }

    /// The table of the runs that have ended, in their order.
    pub fn table(&self, study: &Study) -> Table {
        study.table(self.journal.lines.iter().flatten())
    }

    /// Lets go of the folder, for others that write there; the lines stay.
    pub fn release(&mut self) {
        self.folder = None;
        self.journal.release();
    }

    /// The folder, where there is one.
    pub fn path(&self) -> Option<&Path> {
        self.folder.as_ref().map(|folder| folder.path.as_path())
    }

    /// Leaves the table of all runs in the folder, and the report. Of `set` it says that it was set.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn finish(&self, study: &Study, table: &Table, writers: &[(&Writer, WriteTable)], set: Option<&[String]>) -> Result<(), Failure> {
        let Some(folder) = &self.folder else { return Ok(()) };
        for (writer, write) in writers {
            folder.write(&format!("sweep.{}", writer.extension), |out| write(table, out))?;
        }
        match set {
            Some(set) => folder.write("report.html", |out| study.report(set, table, out)),
            None => Ok(()),
        }
    }
}

/// Whether a folder holds runs of the same sweep. Where the user names a folder with another sweep in it, its journal says what differs.
fn is_of(path: &Path, to: &Destination, identity: &Value) -> bool {
    let journal = path.join(JOURNAL);
    let is_named = to.out.is_some() && !to.force;
    Journal::is_of(&journal, identity) || (is_named && (journal.exists() || path.join("sweep.csv").exists()))
}
