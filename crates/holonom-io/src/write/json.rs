//! JSON with line breaks, as people look at it.

use std::io::{self, Write};

use serde_json::Value;

/// Writes a value over several lines, with a line break at the end.
pub fn write_json(value: &Value, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)
}
