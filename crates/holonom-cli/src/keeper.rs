//! A run on disk while it goes on, so that a kill costs no more than its last second or two.

use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::time::{Duration, Instant};

use holonom::record::Recording;
use holonom_io::Writer;

use crate::checkpoint::{FILE, Kept, Point};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::load::Loaded;
use crate::message::note;
use crate::output::has_all;
use crate::provenance::Provenance;

/// Least time between two savings.
pub const PAUSE: Duration = Duration::from_secs(1);

/// The time between two savings is at least so many times what the last one took.
const COST: u32 = 50;

/// Bytes of rows that are ready to be written: the text of others is made when it is written.
const MOST_TEXT: usize = 1 << 23;

/// Bytes of rows that are written between two checkpoints, as they are still in the cache of the processor: a run that is resumed cuts off those that
/// its checkpoint does not count.
const AT_ONCE: usize = 1 << 19;

/// Writes the rows and the checkpoint of a run from time to time. Rows are appended, and come before the checkpoint that counts them, so
/// that a checkpoint always has its rows.
pub struct Keeper<'a> {
    folder: &'a Folder,
    provenance: Provenance,
    table: &'static str,
    /// Rows of the table that are on disk, and the bytes that they take.
    rows: usize,
    bytes: u64,
    /// The text of the rows behind these that are written, and how many rows are.
    text: Vec<u8>,
    written: usize,
    /// Time of the results in the folder, s: they are replaced when the run is beyond it.
    beyond: f64,
    /// Whether results in the folder are of an earlier end.
    is_stale: bool,
    next: Instant,
}

/// The file that has the rows of all columns: the trajectory, where that is CSV and not of some points only.
fn table(loaded: &Loaded, writers: &[&Writer]) -> &'static str {
    let is_whole = has_all(&loaded.model) && writers.iter().any(|writer| writer.extension == "csv");
    if is_whole { "trajectory.csv" } else { "recording.csv" }
}

impl<'a> Keeper<'a> {
    /// For a run from its start, into a folder that is free or has the same run.
    pub fn new(folder: &'a Folder, loaded: &Loaded, writers: &[&Writer], provenance: &Provenance) -> Self {
        let (table, next) = (table(loaded, writers), Instant::now() + PAUSE);
        let beyond = folder.reached().unwrap_or(f64::NEG_INFINITY);
        Self {
            folder,
            provenance: provenance.clone(),
            table,
            rows: 0,
            bytes: 0,
            text: Vec::new(),
            written: 0,
            beyond,
            is_stale: true,
            next,
        }
    }

    /// For a run that goes on from a checkpoint: the table in `file` of the same folder has so many rows of it, in so many bytes.
    pub fn go_on(&mut self, file: &str, rows: usize, bytes: u64) {
        self.beyond = f64::NEG_INFINITY;
        if file == self.table {
            (self.rows, self.bytes, self.written) = (rows, bytes, rows);
        }
    }

    /// Has all rows written once more, as the last of them is another now than it may be on disk.
    pub fn begin_anew(&mut self) {
        self.rows = 0;
        self.forget_text();
    }

    /// Has the text of new rows ready, as far as there is room, and once there are rows on disk writes it behind them.
    pub fn prepare(&mut self, recording: &Recording) {
        if self.written < recording.rows() && self.text.len() < MOST_TEXT {
            holonom_io::append_csv_text(recording, self.written, &mut self.text);
            self.written = recording.rows();
        }
        if self.rows > 0 && !self.is_stale && self.beyond < f64::INFINITY && self.text.len() >= AT_ONCE {
            let before = (self.rows, self.bytes);
            if let Err(failure) = self.append(recording) {
                self.take_back(before);
                self.give_up(&failure);
            }
        }
    }

    fn forget_text(&mut self) {
        self.text.clear();
        self.written = self.rows;
    }

    /// Whether a run at the time `t` (s) is to be saved, where it has many new rows at once.
    pub fn is_due(&self, t: f64, has_many: bool) -> bool {
        t > self.beyond && (has_many || Instant::now() >= self.next)
    }

    /// Saves a run while it goes on.
    pub fn keep(&mut self, recording: &Recording, last: Point) {
        let begun = Instant::now();
        match self.save(recording, last, None) {
            Ok(()) => self.next = Instant::now() + PAUSE.max(COST * begun.elapsed()),
            Err(failure) => self.give_up(&failure),
        }
    }

    fn give_up(&mut self, failure: &Failure) {
        let failure = failure.to_string();
        let reason = failure.strip_prefix("error: ").unwrap_or(&failure);
        note(&format!("{reason}; the run goes on, and is not saved before its end"));
        self.beyond = f64::INFINITY;
    }

    /// Saves rows and checkpoint.
    pub fn save(&mut self, recording: &Recording, last: Point, before_end: Option<Point>) -> Result<(), Failure> {
        if self.is_stale && self.rows > 0 {
            // A table that a kill leaves with more rows than the earlier run had is not to be taken for its.
            self.folder.remove(["summary.json", "report.html"].map(String::from))?;
        }
        let before = (self.rows, self.bytes);
        let kept = Kept { last, before_end, table: self.table.into(), provenance: self.provenance.clone() };
        let saved = self.append(recording).and_then(|()| self.folder.write(FILE, |out| Ok(serde_json::to_writer(out, &kept)?)));
        if saved.is_err() {
            self.take_back(before);
        }
        saved?;
        if std::mem::take(&mut self.is_stale) {
            self.folder.remove_results(&[self.table, FILE])?;
            self.folder.write("columns.json", |out| holonom_io::write_json(&holonom_io::headings(recording.columns()), out))?;
        }
        Ok(())
    }

    /// Has so many rows on disk, in so many bytes, after others could not be written: on a full disk they may have been in part.
    fn take_back(&mut self, (rows, bytes): (usize, u64)) {
        if rows > 0 {
            (self.rows, self.bytes) = (rows, bytes);
            self.forget_text();
            // Where they cannot be cut off either, whoever goes on does it.
            let _ = OpenOptions::new().write(true).open(self.folder.path.join(self.table)).and_then(|file| file.set_len(bytes));
        }
    }

    /// The time (s) that the results in the folder reach, where the same run ended later there than at `t`.
    pub fn is_behind(&self, t: f64) -> Option<f64> {
        Some(self.beyond).filter(|&beyond| t < beyond && beyond.is_finite())
    }

    /// Saves the end of a run. Results of the same run may stay beside it.
    pub fn finish(&mut self, recording: &Recording, last: Point, before_end: Option<Point>) -> Result<(), Failure> {
        self.is_stale &= self.beyond == f64::NEG_INFINITY;
        self.save(recording, last, before_end)
    }

    /// The writers of the tables that are not written yet.
    pub fn others<'w>(&self, writers: &[&'w Writer]) -> Vec<&'w Writer> {
        writers.iter().copied().filter(|writer| format!("trajectory.{}", writer.extension) != self.table).collect()
    }

    /// Appends the rows that are not on disk yet. What is behind those that are, a kill has left.
    fn append(&mut self, recording: &Recording) -> Result<(), Failure> {
        let path = self.folder.path.join(self.table);
        let (text, written) = (&self.text, self.written);
        let write = |out: &mut BufWriter<File>| {
            out.write_all(text)?;
            holonom_io::append_csv(recording, written, out)
        };
        if self.rows == 0 {
            self.folder.write(self.table, write)?;
            self.bytes = std::fs::metadata(&path).map_or(0, |file| file.len());
        } else {
            let appended = OpenOptions::new().write(true).open(&path).and_then(|mut file| {
                file.set_len(self.bytes)?;
                file.seek(SeekFrom::End(0))?;
                let mut out = BufWriter::new(file);
                write(&mut out)?;
                out.flush()?;
                out.stream_position()
            });
            self.bytes = appended.map_err(|source| Failure::File { doing: "write", path, source })?;
        }
        self.rows = recording.rows();
        self.forget_text();
        Ok(())
    }
}
