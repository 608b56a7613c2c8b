//! Messages as people see them: what is wrong, the place, the line itself, the cure.

use std::ops::Range;

use holonom::model::{Fault, Value};
use unicode_width::UnicodeWidthChar;

use super::places::Places;
use super::toml::SyntaxError;

/// Longest line that is shown, characters.
const WIDEST: usize = 120;

/// A fault of a file as TOML.
pub(super) fn syntax(name: &str, text: &str, error: &SyntaxError) -> String {
    let message = error.message.trim().replace('\n', ", ");
    at(name, text, error.bytes.clone(), "", &message, &error.cure)
}

/// A fault of a description.
pub(super) fn fault(name: &str, text: &str, places: &Places, fault: &Fault) -> String {
    match bytes(text, places, fault) {
        Some(bytes) => at(name, text, bytes, &fault.path, &fault.message, &fault.cure),
        None => {
            let place = if fault.path.is_empty() { format!("{name}:1:1") } else { format!("{name} ({})", fault.path) };
            whole(&place, &format!("{}{}", fault.message, offending(fault)), &fault.cure)
        }
    }
}

/// The bytes of a file that a fault is about.
pub(super) fn bytes(text: &str, places: &Places, fault: &Fault) -> Option<Range<usize>> {
    let bytes = places.find(&fault.path, fault.on_key)?;
    Some(match fault.character {
        Some(character) => inside(text, bytes, character),
        None => bytes,
    })
}

/// Line and column of a byte, both from 1.
pub(super) fn position(text: &str, byte: usize) -> [usize; 2] {
    let before = &text[..floor(text, byte.min(text.len()))];
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    [1 + before.matches('\n').count(), 1 + before[line_start..].chars().count()]
}

/// What was written, for faults of what does not stand in the file.
fn offending(fault: &Fault) -> String {
    if fault.offending.is_empty() { String::new() } else { format!(": {}", fault.offending) }
}

/// A key with the value that it is set to, as it is written.
pub(super) fn setting(key: &str, value: Option<&Value>) -> String {
    let text = value.map_or(String::new(), Value::quoted);
    let (shown, _) = window(&text, 1);
    format!("{key} = {shown}")
}

/// The byte of a character in a text value, behind its opening quote. Escapes before it would shift it; then the mark
/// stays inside the value all the same.
fn inside(text: &str, bytes: Range<usize>, character: usize) -> Range<usize> {
    let value = &text[bytes.clone()];
    let start = value.char_indices().nth(character + 1).map_or(bytes.start, |(at, _)| bytes.start + at);
    let start = start.min(bytes.end.saturating_sub(1)).max(bytes.start);
    let width = text[start..].chars().next().map_or(1, char::len_utf8);
    start..start + width
}

/// A message about a file as a whole.
pub(super) fn whole(place: &str, message: &str, cure: &str) -> String {
    format!("error: {message}\n  --> {place}\n{}", cure_line("  ", cure))
}

/// A message about some bytes of a file.
pub(super) fn at(name: &str, text: &str, bytes: Range<usize>, path: &str, message: &str, cure: &str) -> String {
    let start = floor(text, bytes.start.min(text.len()));
    let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let [number, column] = position(text, start);
    let end = floor(text, bytes.end.clamp(start, line_end));
    let marks = text[start..end].chars().count().max(1);
    let path = if path.is_empty() { String::new() } else { format!(" ({path})") };
    let margin = " ".repeat(number.to_string().len());
    let line = text[line_start..line_end].trim_end();
    let (line, column_shown) = window(line, column);
    let pad: String = line.chars().take(column_shown - 1).map(blanks).collect();
    let marks = "^".repeat(marks.min(WIDEST));
    format!(
        "error: {message}\n{margin}--> {name}:{number}:{column}{path}\n{margin} |\n{number} | {line}\n{margin} | {pad}{marks}\n{}",
        cure_line(&margin, cure)
    )
}

/// Blanks as wide as a character: a terminal shows those of East Asia, and emoji, two columns wide.
fn blanks(c: char) -> &'static str {
    match (c, c.width()) {
        ('\t', _) => "\t",
        (_, Some(2)) => "  ",
        (_, Some(0)) => "",
        _ => " ",
    }
}

/// The part of a long line around a column, and where the column is in it.
fn window(line: &str, column: usize) -> (String, usize) {
    // What cannot be printed must not reach a terminal.
    let clean = |c: char| if c.is_control() && c != '\t' { '·' } else { c };
    if line.chars().count() <= WIDEST {
        return (line.chars().map(clean).collect(), column);
    }
    let skipped = column.saturating_sub(WIDEST / 2);
    (line.chars().skip(skipped).take(WIDEST).map(clean).collect(), column - skipped)
}

fn cure_line(margin: &str, cure: &str) -> String {
    if cure.is_empty() { String::new() } else { format!("{margin} = cure: {cure}\n") }
}

/// The largest boundary of a character at or before a byte.
fn floor(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
