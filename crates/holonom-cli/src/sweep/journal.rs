//! Finished runs on disk as they come, so that a sweep goes on where it was ended.
//!
//! The first line says which sweep it is, word for word; then there is a line for each finished run, in the order in which
//! they ended. A line without its end was torn, and does not count.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::sheet::Sheet;
use crate::failure::Failure;

/// The journal of a sweep, open for more lines.
pub struct Journal {
    /// Nothing where lines are kept in memory alone.
    written: Option<Written>,
    /// The line of each finished run.
    pub lines: Vec<Option<String>>,
}

/// The file of a journal.
struct Written {
    file: File,
    path: PathBuf,
    /// Bytes of whole lines.
    length: u64,
}

impl Journal {
    /// The journal of a sweep of some runs without a file.
    pub fn in_memory(runs: u64) -> Self {
        Self { written: None, lines: vec![None; runs as usize] }
    }

    /// Opens the journal of a sweep of some runs, or begins it. `identity` is what two sweeps must have in common to be the
    /// same.
    pub fn open(path: &Path, identity: &Value, runs: u64, sheet: &Sheet) -> Result<Self, Failure> {
        let fail = |doing| move |source| Failure::File { doing, path: path.into(), source };
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(fail("open"))?;
        if file.try_lock().is_err() {
            return Err(Failure::usage(format!("another sweep is writing {}", path.display()), "wait for it, or give another --out"));
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(fail("read"))?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        let text = String::from_utf8_lossy(&bytes[..whole]);
        let mut found = vec![None; runs as usize];
        let mut lines = text.split_inclusive('\n');
        match lines.next() {
            Some(first) => check(first, identity, path)?,
            None => whole_file_is_torn(&bytes, path)?,
        }
        file.set_len(whole as u64).map_err(fail("write"))?;
        let mut written = Written { file, path: path.into(), length: whole as u64 };
        if whole == 0 {
            written.append(&format!("{identity}\n"))?;
        }
        for line in lines {
            if let Some(run) = sheet.run(line).filter(|run| (1..=runs).contains(run)) {
                found[run as usize - 1] = Some(line.into());
            }
        }
        Ok(Self { written: Some(written), lines: found })
    }

    /// Whether a journal is of this sweep; one that was torn before it said so has nothing of another.
    pub fn is_of(path: &Path, identity: &Value) -> bool {
        let Ok(bytes) = std::fs::read(path) else { return false };
        match bytes.iter().position(|&byte| byte == b'\n') {
            Some(end) => check(&String::from_utf8_lossy(&bytes[..end]), identity, path).is_ok(),
            None => whole_file_is_torn(&bytes, path).is_ok(),
        }
    }

    /// Notes a finished run.
    pub fn add(&mut self, run: u64, line: String) -> Result<(), Failure> {
        if let Some(written) = &mut self.written {
            written.append(&line)?;
        }
        self.lines[run as usize - 1] = Some(line);
        Ok(())
    }

    /// Closes the file; the lines stay.
    pub fn release(&mut self) {
        self.written = None;
    }

    /// Numbers of the runs that are still to be done.
    pub fn missing(&self) -> Vec<u64> {
        (1..).zip(&self.lines).filter(|(_, line)| line.is_none()).map(|(run, _)| run).collect()
    }
}

impl Written {
    /// A line that cannot be written whole, as on a full disk, is taken back: others may come behind it.
    fn append(&mut self, line: &str) -> Result<(), Failure> {
        if let Err(source) = self.file.write_all(line.as_bytes()) {
            // Where that fails, too, the torn line stays, and the message is the same.
            let _ = self.file.set_len(self.length);
            return Err(Failure::File { doing: "write", path: self.path.clone(), source });
        }
        self.length += line.len() as u64;
        Ok(())
    }
}

/// Refuses the journal of another sweep.
fn check(first: &str, identity: &Value, path: &Path) -> Result<(), Failure> {
    let Ok(Value::Object(found)) = serde_json::from_str(first) else { return Err(foreign(path)) };
    let wanted = identity.as_object().expect("an identity is an object");
    let differing: Vec<&str> = wanted.iter().filter(|(key, value)| found.get(*key) != Some(value)).map(|(key, _)| key.as_str()).collect();
    match differing.is_empty() {
        true => Ok(()),
        false => Err(Failure::usage(
            format!("{} is of another sweep, which differs in: {}", path.display(), differing.join(", ")),
            "give another --out, or --force to overwrite it",
        )),
    }
}

/// Without a whole line, a file is empty or the beginning of one's own first line.
fn whole_file_is_torn(bytes: &[u8], path: &Path) -> Result<(), Failure> {
    if bytes.is_empty() || bytes.starts_with(b"{") { Ok(()) } else { Err(foreign(path)) }
}

fn foreign(path: &Path) -> Failure {
    Failure::usage(format!("{} is not the journal of a sweep", path.display()), "give another --out, or --force to overwrite it")
}
