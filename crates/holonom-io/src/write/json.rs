//! JSON with line breaks, as people look at it.

use std::io::{self, Write};

use holonom::record::Recording;
use serde_json::{Value, json};

/// Writes a value over several lines, with a line break at the end.
pub fn write_json(value: &Value, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)
}

/// Unit and meaning of each column of a recording, by its name.
pub fn headings(recording: &Recording) -> Value {
    let of = |heading: &holonom::record::Heading| (heading.name.clone(), json!({ "unit": heading.unit, "meaning": heading.meaning }));
    Value::Object(recording.columns().iter().map(|column| of(&column.heading)).collect())
}
