//! What a run leaves: tables and summaries.

mod csv;
mod json;
mod npz;

use std::io::{self, Write};

use holonom::record::Recording;

pub use json::write_json;

/// A format for recordings.
pub struct Writer {
    pub name: &'static str,
    pub extension: &'static str,
    pub doc: &'static str,
    pub write: fn(&Recording, &mut dyn Write) -> io::Result<()>,
}

/// All formats; the first is the default.
pub const WRITERS: &[Writer] = &[
    Writer { name: "csv", extension: "csv", doc: "one row a step; numbers read back to the same bits", write: csv::write },
    Writer { name: "npz", extension: "npz", doc: "one array a column, for numpy.load", write: npz::write },
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
