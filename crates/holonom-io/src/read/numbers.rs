//! Columns of numbers from the bytes of a CSV file.

use holonom::model::NumberFile;

/// Largest CSV file that is read, bytes.
pub const LARGEST_NUMBERS: usize = 256_000_000;

/// Why a CSV file is no table of numbers.
#[derive(Debug, thiserror::Error)]
pub enum NumbersError {
    /// It is not CSV.
    #[error("`{name}` is no CSV file: {error}")]
    Csv {
        /// Of the file.
        name: String,
        /// What the reader says.
        error: csv::Error,
    },
    /// A word where a number is wanted.
    #[error("`{name}`, line {line}: `{word}` in column `{column}` is no number")]
    Word {
        /// Of the file.
        name: String,
        /// Counted from 1.
        line: u64,
        /// As in its header.
        column: String,
        /// What stands there.
        word: String,
    },
}

/// Reads a CSV file with a line of names and lines of numbers.
///
/// # Errors
/// What is wrong with it, with the line.
pub fn read_numbers(name: &str, bytes: &[u8]) -> Result<NumberFile, NumbersError> {
    let wrong = |error| NumbersError::Csv { name: name.into(), error };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes);
    let names: Vec<String> = reader.headers().map_err(wrong)?.iter().map(str::to_string).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for record in reader.records() {
        let record = record.map_err(wrong)?;
        for ((word, column), known) in record.iter().zip(&mut columns).zip(&names) {
            let number = word.parse().map_err(|_| NumbersError::Word {
                name: name.into(),
                line: record.position().map_or(0, csv::Position::line),
                column: known.clone(),
                word: word.into(),
            })?;
            column.push(number);
        }
    }
    Ok(NumberFile { names, columns })
}
