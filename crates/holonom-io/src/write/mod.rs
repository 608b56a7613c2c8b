//! What a run leaves: tables and summaries.

mod csv;
mod json;
mod model;
mod npz;
#[cfg(feature = "parquet")]
mod parquet;
mod table;

use std::io::{self, Write};

use holonom::record::Recording;

pub use csv::{append_csv, append_csv_text, csv_cells, csv_line, csv_number};
pub use json::{headings, write_json};
pub use model::model_text;
pub use table::{Cells, Table};

/// How a table with words is written.
pub type WriteTable = fn(&Table, &mut dyn Write) -> io::Result<()>;

/// A format for recordings, and where it can hold them for tables with words.
pub struct Writer {
    /// As a user names it.
    pub name: &'static str,
    /// Ending of its files, without the dot.
    pub extension: &'static str,
    /// What it is good for, in one line.
    pub doc: &'static str,
    /// Writes a recording.
    pub write: fn(&Recording, &mut dyn Write) -> io::Result<()>,
    /// Writes a table with words; `None` where the format holds numbers only.
    pub write_table: Option<WriteTable>,
}

/// All formats; the first is the default.
pub const WRITERS: &[Writer] = &[
    Writer {
        name: "csv",
        extension: "csv",
        doc: "one row a step; numbers read back to the same bits",
        write: csv::write,
        write_table: Some(csv::write_table),
    },
    Writer { name: "npz", extension: "npz", doc: "one array a column, for numpy.load", write: npz::write, write_table: None },
    #[cfg(feature = "parquet")]
    Writer {
        name: "parquet",
        extension: "parquet",
        doc: "columns of doubles, for data frames",
        write: parquet::write,
        write_table: Some(parquet::write_table),
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_have_names_of_their_own() {
        for (k, writer) in WRITERS.iter().enumerate() {
            assert!(WRITERS[..k].iter().all(|other| other.name != writer.name && other.extension != writer.extension));
            assert!(!writer.doc.is_empty());
        }
    }
}
