//! Tables of columns over time: what a run left, and what was measured.

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};
use holonom::record::{Heading, Recording};

/// Why some text is no table of columns over time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Bytes that are no text.
    #[error("it is not text (UTF-8)")]
    NotText,
    /// Columns are apart by something else than commas.
    #[error("its first line has `;` and no `,`")]
    Semicolons,
    /// No columns beside that of time.
    #[error("its first line names no columns beside the time")]
    NoColumns,
    /// Two columns of one name.
    #[error("it has two columns `{name}`")]
    Twice {
        /// Of both.
        name: String,
    },
    /// A line with more or fewer cells than the first.
    #[error("line {line} has {found} cells, and the first has {wanted}")]
    Uneven {
        /// From 1.
        line: u64,
        /// Cells of it.
        found: u64,
        /// Cells of the first line.
        wanted: u64,
    },
    /// A cell that is neither empty nor a number, or a time that is none.
    #[error("line {line} has `{text}` in the column `{column}`, which is no number")]
    NoNumber {
        /// From 1.
        line: u64,
        /// What it is called.
        column: String,
        /// What stands there.
        text: String,
    },
    /// A time that is not after the one before.
    #[error("the time in line {line} is not after that of the line before")]
    Backwards {
        /// From 1.
        line: u64,
    },
    /// Fewer than two rows.
    #[error("it has {rows} rows, and a comparison takes two or more")]
    FewRows {
        /// How many it has.
        rows: usize,
    },
}

impl TableError {
    /// What to do about it.
    pub fn cure(&self) -> &'static str {
        match self {
            Self::NotText => "give a CSV file: text with a line for each time",
            Self::Semicolons => "put commas between columns, and a point into numbers",
            Self::NoColumns => "name the columns in the first line as a run does, such as t,chassis.z",
            Self::Twice { .. } => "rename one of them",
            Self::Uneven { .. } => "give each line a cell for each column; it may be empty",
            Self::NoNumber { .. } => "write numbers with a point, such as 0.5 or 5e-1, and nothing where there is no value",
            Self::Backwards { .. } => "sort the lines by time, and keep one for each time",
            Self::FewRows { .. } => "give a table with a line for each time",
        }
    }
}

/// Name of the column of time.
const TIME: &str = "t";

/// Reads CSV: names in the first line, then a line for each time. The time is the column `t`, or else the first. Cells may be empty, and lines with a `#` at
/// their start are left out. What is known of a column beside its name, `heading` tells.
///
/// # Errors
/// When the bytes are no such table.
pub fn read_recording(bytes: &[u8], heading: impl Fn(&str) -> Heading) -> Result<Recording, TableError> {
    let text = std::str::from_utf8(bytes).map_err(|_| TableError::NotText)?.trim_start_matches('\u{feff}');
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let names = names(reader.headers().map_err(uneven)?)?;
    let time = names.iter().position(|name| name == TIME).unwrap_or(0);
    let order = || std::iter::once(time).chain((0..names.len()).filter(move |k| *k != time));
    let headings = order().map(|k| if k == time { heading(TIME) } else { heading(&names[k]) });
    let (mut recording, mut before, mut row) = (Recording::new(headings), f64::NEG_INFINITY, Vec::new());
    for record in reader.records() {
        let record = record.map_err(uneven)?;
        let line = record.position().map_or(0, |position| position.line());
        let cell = |k: usize| match &record[k] {
            "" if k != time => Ok(f64::NAN),
            text => text.parse().ok().filter(|number: &f64| k != time || number.is_finite()).ok_or_else(|| TableError::NoNumber {
                line,
                column: names[k].clone(),
                text: text.into(),
            }),
        };
        row.clear();
        for k in order() {
            row.push(cell(k)?);
        }
        if row[0] <= before {
            return Err(TableError::Backwards { line });
        }
        before = row[0];
        recording.push(&row);
    }
    if recording.rows() < 2 { Err(TableError::FewRows { rows: recording.rows() }) } else { Ok(recording) }
}

/// Names of the columns, all different.
fn names(first: &StringRecord) -> Result<Vec<String>, TableError> {
    let names: Vec<String> = first.iter().map(str::to_string).collect();
    match &names[..] {
        [only] if only.contains(';') => return Err(TableError::Semicolons),
        [] | [_] => return Err(TableError::NoColumns),
        _ => (),
    }
    match (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        Some(k) => Err(TableError::Twice { name: names[k].clone() }),
        None => Ok(names),
    }
}

/// The only thing that can be wrong with lines of text.
fn uneven(error: csv::Error) -> TableError {
    match error.kind() {
        ErrorKind::UnequalLengths { pos, expected_len, len } => {
            TableError::Uneven { line: pos.as_ref().map_or(0, |pos| pos.line()), found: *len, wanted: *expected_len }
        }
        _ => TableError::NotText,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Recording, TableError> {
        read_recording(text.as_bytes(), |name| Heading::from(name.to_string()))
    }

    #[test]
    fn the_time_is_its_column_or_the_first() {
        for text in
            ["t,a.z,b\n0,1,\n0.5,2,3\n", "\u{feff}a.z, t ,b\r\n# rig 3\r\n1,0,\r\n2,0.5,3\r\n\r\n", "time,a.z,\"b\"\n0,1,\n5e-1,2,3"]
        {
            let recording = read(text).unwrap();
            let names: Vec<&str> = recording.columns().iter().map(|column| column.heading.name.as_str()).collect();
            assert_eq!(names, ["t", "a.z", "b"], "{text}");
            assert_eq!((recording.column("t").unwrap(), recording.column("a.z").unwrap()), (&[0.0, 0.5][..], &[1.0, 2.0][..]));
            assert!(recording.column("b").unwrap()[0].is_nan() && recording.column("b").unwrap()[1] == 3.0);
        }
    }

    #[test]
    fn what_is_no_such_table_is_told_with_its_line() {
        let twice = TableError::Twice { name: "a".into() };
        let no_number = |line, column: &str, text: &str| TableError::NoNumber { line, column: column.into(), text: text.into() };
        for (text, error) in [
            ("", TableError::NoColumns),
            ("t\n1\n2\n", TableError::NoColumns),
            ("t;a\n0;1\n", TableError::Semicolons),
            ("t,a,a\n", twice),
            ("t,a\n0,1\n", TableError::FewRows { rows: 1 }),
            ("t,a\n0,1\n1,2,3\n", TableError::Uneven { line: 3, found: 3, wanted: 2 }),
            ("t,a\n0,1\n1,x\n", no_number(3, "a", "x")),
            ("t,a\n0,1\n,2\n", no_number(3, "t", "")),
            ("t,a\n0,1\nNaN,2\n", no_number(3, "t", "NaN")),
            ("t,a\n0,1\n1,2\n1,3\n", TableError::Backwards { line: 4 }),
        ] {
            let found = read(text).unwrap_err();
            assert_eq!(found, error, "{text}");
            assert!(!found.cure().is_empty());
        }
        assert_eq!(read_recording(&[0xff, 0xfe], |name| Heading::from(name.to_string())).unwrap_err(), TableError::NotText);
    }
}
