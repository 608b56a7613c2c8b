//! JSON with line breaks, as people look at it.

use std::io::{self, Write};

use holonom::record::{Column, Heading};
use serde::{Serialize, Serializer};

/// Writes a value over several lines, with a line break at the end.
pub fn write_json(value: &impl Serialize, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)
}

/// Unit and meaning of each column, by its name.
pub fn headings<'a>(columns: impl IntoIterator<Item = &'a Column>) -> impl Serialize {
    Headings(columns.into_iter().map(|column| &column.heading).collect())
}

struct Headings<'a>(Vec<&'a Heading>);

/// What is said of a column.
#[derive(Serialize)]
struct Said<'a> {
    unit: &'a str,
    meaning: &'a str,
}

impl Serialize for Headings<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|heading| (&heading.name, Said { unit: &heading.unit, meaning: &heading.meaning })))
    }
}
