//! Columns of numbers from the bytes of a CSV file: names in the first line, then lines of as many cells.

use csv::{ErrorKind, ReaderBuilder, Trim};

/// Why a CSV file is no table of numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Bytes that are no text.
    #[error("it is not text (UTF-8)")]
    NotText,
    /// Columns are apart by something else than commas.
    #[error("its first line has no `,` between columns")]
    NoCommas,
    /// No columns beside that of time.
    #[error("its first line names no columns beside the time")]
    NoColumns,
    /// Numbers where the names of columns should be.
    #[error("the first line has numbers where the names of the columns should be")]
    Nameless,
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
        line: usize,
        /// Cells of it.
        found: u64,
        /// Cells of the first line.
        wanted: u64,
    },
    /// A cell that is not the number that is wanted there.
    #[error("line {line} has `{text}` in the column `{column}`, which is no number")]
    NoNumber {
        /// From 1.
        line: usize,
        /// What it is called.
        column: String,
        /// What stands there.
        text: String,
    },
    /// A time that is not after the one before.
    #[error("the time in line {line} is not after that of the line before")]
    Backwards {
        /// From 1.
        line: usize,
    },
    /// Fewer than two rows.
    #[error("it has {rows} {}, and a comparison takes two or more", if *.rows == 1 { "row" } else { "rows" })]
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
            Self::NoCommas => "put commas between columns, and a point into numbers",
            Self::NoColumns => "name the columns in the first line as a run does, such as t,chassis.z",
            Self::Nameless => "write the names into a line before it, such as t,force",
            Self::Twice { .. } => "rename one of them",
            Self::Uneven { .. } => "give each line a cell for each column; it may be empty",
            Self::NoNumber { .. } => "write numbers with a point, such as 0.5 or 5e-1, and nothing where there is no value",
            Self::Backwards { .. } => "sort the lines by time, and keep one for each time",
            Self::FewRows { .. } => "give a table with a line for each time",
        }
    }
}

/// The beginning of lines that are left out, as those without a character are.
const COMMENT: u8 = b'#';

/// What a CSV file has.
pub(super) struct Columns<'a> {
    text: &'a str,
    pub names: Vec<String>,
    pub columns: Vec<Vec<f64>>,
    /// Where the reader began to look for each row.
    starts: Vec<u64>,
}

impl<'a> Columns<'a> {
    /// Reads a file. `number` makes a number of what stands in the column of an index among these names.
    pub fn read(bytes: &'a [u8], number: impl Fn(&[String], usize, &str) -> Option<f64>) -> Result<Self, TableError> {
        let text = std::str::from_utf8(bytes).map_err(|_| TableError::NotText)?.trim_start_matches('\u{feff}');
        let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(COMMENT)).from_reader(text.as_bytes());
        let names: Vec<String> = reader.headers().map_err(|error| uneven(text, &error))?.iter().map(str::to_string).collect();
        if matches!(&names[..], [only] if only.contains([';', '\t'])) {
            return Err(TableError::NoCommas);
        }
        // Of a row of numbers some may be missing.
        let is_number = |name: &String| name.parse::<f64>().is_ok();
        if names.iter().any(is_number) && names.iter().all(|name| name.is_empty() || is_number(name)) {
            return Err(TableError::Nameless);
        }
        if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
            return Err(TableError::Twice { name: names[k].clone() });
        }
        let mut read = Self { text, columns: vec![Vec::new(); names.len()], names, starts: Vec::new() };
        for record in reader.records() {
            let record = record.map_err(|error| uneven(text, &error))?;
            read.starts.push(record.position().map_or(0, csv::Position::byte));
            for (k, cell) in record.iter().enumerate() {
                let no_number =
                    || TableError::NoNumber { line: read.line(read.rows() - 1), column: read.names[k].clone(), text: cell.into() };
                let number = number(&read.names, k, cell).ok_or_else(no_number)?;
                read.columns[k].push(number);
            }
        }
        Ok(read)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.starts.len()
    }

    /// The line of a row, from 1.
    pub fn line(&self, row: usize) -> usize {
        line(self.text, self.starts[row])
    }
}

/// The line, from 1, that a reader finds from a byte on: it leaves out blank lines and comments, and of an end of two characters the second.
fn line(text: &str, start: u64) -> usize {
    let (before, rest) = text.split_at(start as usize);
    let is_left_out = |line: &&str| line.trim_end_matches(['\r', '\n']).is_empty() || line.as_bytes().first() == Some(&COMMENT);
    1 + before.matches('\n').count() + rest.split_inclusive('\n').take_while(is_left_out).count()
}

/// The only thing that can be wrong with lines of text.
fn uneven(text: &str, error: &csv::Error) -> TableError {
    match error.kind() {
        ErrorKind::UnequalLengths { pos, expected_len, len } => {
            TableError::Uneven { line: line(text, pos.as_ref().map_or(0, csv::Position::byte)), found: *len, wanted: *expected_len }
        }
        _ => TableError::NotText,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_counted_as_editors_do() {
        for (text, line) in [
            ("a,b\n1,2\n3,x\n", 3),
            ("a,b\r\n1,2\r\n3,x\r\n", 3),
            ("a,b\n1,2\n\n\n3,x", 5),
            ("a,b\r\n\r\n1,2\r\n\r\n3,x\r\n", 5),
            ("# rig\na,b\n1,2\n# pause\n\n3,x\n", 6),
            ("\u{feff}a,b\n1,2\n\"3\",x\n", 3),
        ] {
            let read = |text: &str| Columns::read(text.as_bytes(), |_, _, cell| cell.parse().ok()).map(|read| read.rows());
            let (column, word) = ("b".to_string(), "x".to_string());
            assert_eq!(read(text), Err(TableError::NoNumber { line, column, text: word }), "{text:?}");
            let uneven = text.replace(",x", "");
            assert_eq!(read(&uneven), Err(TableError::Uneven { line, found: 1, wanted: 2 }), "{uneven:?}");
        }
    }
}
