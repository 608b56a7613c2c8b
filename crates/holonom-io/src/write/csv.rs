//! Comma-separated values.

use std::io::{self, Write};

use holonom::record::Recording;

use super::Table;

/// Columns are in memory one after the other: of each so many rows come along with the first.
const ROWS_AT_ONCE: usize = 8;

/// Bytes of the longest number, `-2.2250738585072014e-308`.
const WIDEST: usize = 24;

/// Room for a number and a comma, and half of it.
const ROOM: usize = 32;
const HALF: usize = ROOM / 2;

/// Bytes that are written at once: to ask the system for a few lines each takes as long as to make them.
const BYTES_AT_ONCE: usize = 1 << 18;

/// Writes a header and one line a row. Numbers are the shortest that read back to the same bits.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    append_csv(recording, 0, out)
}

/// Writes the rows from `first` on, as they follow those before in a file; the header, too, where there are none before.
pub fn append_csv(recording: &Recording, first: usize, out: &mut dyn Write) -> io::Result<()> {
    if first == 0 {
        write_header(recording, out)?;
    }
    let mut text = Vec::new();
    append_lines(recording, first, &mut text, |text| {
        if text.len() >= BYTES_AT_ONCE {
            out.write_all(text)?;
            text.clear();
        }
        Ok(())
    })?;
    out.write_all(&text)?;
    out.flush()
}

/// The same at the end of a text in memory.
pub fn append_csv_text(recording: &Recording, first: usize, text: &mut Vec<u8>) {
    let header = if first == 0 { write_header(recording, text) } else { Ok(()) };
    header.and_then(|()| append_lines(recording, first, text, |_| Ok(()))).expect("memory takes everything");
}

fn write_header(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    // There may be millions of names: they are not put together in memory.
    let names = recording.columns().iter().map(|column| &column.heading.name);
    let mut header = csv::Writer::from_writer(out);
    header.write_record(names)?;
    header.flush()
}

/// Appends lines to a text, of which something is done after each.
fn append_lines(
    recording: &Recording,
    first: usize,
    text: &mut Vec<u8>,
    mut after_line: impl FnMut(&mut Vec<u8>) -> io::Result<()>,
) -> io::Result<()> {
    let (width, mut number) = (recording.columns().len(), zmij::Buffer::new());
    let mut cells = vec![0.0; ROWS_AT_ONCE.min(recording.rows() - first) * width];
    // Numbers are never quoted.
    let mut line = vec![0; width * (WIDEST + 1) + ROOM];
    for from in (first..recording.rows()).step_by(ROWS_AT_ONCE) {
        let rows = ROWS_AT_ONCE.min(recording.rows() - from);
        for (k, column) in recording.columns().iter().enumerate() {
            column.values[from..from + rows].iter().enumerate().for_each(|(row, value)| cells[row * width + k] = *value);
        }
        for cells in cells.chunks_exact(width).take(rows) {
            let end = cells.iter().fold(0, |end, cell| end + put(shortest(*cell, &mut number), &mut line[end..]));
            line[end - 1] = b'\n';
            text.extend_from_slice(&line[..end]);
            after_line(text)?;
        }
    }
    Ok(())
}

/// Puts a number and a comma at the beginning of a line, in which there is [`ROOM`]; says how many bytes they are. Most numbers have more than half as
/// many, and two copies of sixteen, each of which the processor does at once, take less time than one of any length.
fn put(number: &str, line: &mut [u8]) -> usize {
    let (number, length) = (number.as_bytes(), number.len());
    let to = line.first_chunk_mut::<ROOM>().expect("there is room");
    match (number.first_chunk::<HALF>(), number.last_chunk::<HALF>()) {
        (Some(first), Some(last)) => {
            to[..HALF].copy_from_slice(first);
            to[length - HALF..length].copy_from_slice(last);
        }
        _ => to[..length].copy_from_slice(number),
    }
    to[length] = b',';
    length + 1
}

/// The shortest text of a number that reads back to the same bits.
fn shortest(value: f64, buffer: &mut zmij::Buffer) -> &str {
    let digits = buffer.format(value);
    // Looked at by its bytes, which takes less time.
    if let [.., b'.', b'0'] = digits.as_bytes() { &digits[..digits.len() - 2] } else { digits }
}

/// A number as it stands in a cell: the shortest text that reads back to the same bits.
pub fn csv_number(value: f64) -> String {
    shortest(value, &mut zmij::Buffer::new()).to_string()
}

/// Writes a header and one line a row of a table with words; empty cells where there is nothing.
pub(super) fn write_table(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    let names: Vec<&str> = table.columns.iter().map(|(name, _)| name.as_str()).collect();
    out.write_all(csv_line(&names).as_bytes())?;
    for row in 0..table.rows() {
        let cells: Vec<String> = table.columns.iter().map(|(_, cells)| cells.text(row)).collect();
        out.write_all(csv_line(&cells).as_bytes())?;
    }
    Ok(())
}

/// Cells as one line of CSV, with its end.
pub fn csv_line(cells: &[impl AsRef<[u8]>]) -> String {
    let mut line = csv::Writer::from_writer(Vec::new());
    line.write_record(cells).expect("memory takes everything");
    String::from_utf8_lossy(&line.into_inner().expect("memory takes everything")).into_owned()
}

/// The cells of one line of CSV, none of which has a line break in it.
pub fn csv_cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let (mut is_quoted, mut rest) = (false, line.trim_end_matches(['\r', '\n']).chars().peekable());
    while let Some(c) = rest.next() {
        match c {
            '"' if is_quoted && rest.next_if_eq(&'"').is_some() => cells.last_mut().expect("there is a cell").push(c),
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            c => cells.last_mut().expect("there is a cell").push(c),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let mut recording = Recording::new(["t", "a,b"].map(String::from));
        let values =
            [0.1, -1.0 / 3.0, 5e-324, 1.7976931348623157e308, 0.0, -f64::MIN_POSITIVE, 123456789012.25, f64::NAN, f64::NEG_INFINITY];
        for (k, value) in values.iter().enumerate() {
            recording.push(&[k as f64, *value]);
        }
        let mut text = Vec::new();
        write(&recording, &mut text).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_slice());
        assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), ["t", "a,b"]);
        let read: Vec<f64> = reader.records().map(|record| record.unwrap()[1].parse().unwrap()).collect();
        assert!(read.iter().zip(&values).all(|(a, b)| a.to_bits() == b.to_bits()), "{read:?}");
        assert_eq!(read.len(), values.len());
    }

    #[test]
    fn a_line_reads_back_whatever_is_in_its_cells() {
        let cells = ["1", "", "a, \"b\"", "0.1"];
        let line = csv_line(&cells);
        assert!(line.ends_with('\n') && line.lines().count() == 1, "{line}");
        assert_eq!(csv_cells(&line), cells);
    }
}
