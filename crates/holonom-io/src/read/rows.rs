//! Rows of a recording that were written as CSV.

use holonom::record::Recording;

use crate::write::csv_cells;

/// Reads the first `rows` rows of a table into a recording that has its columns and no rows yet. Returns how many bytes they take, the
/// header included; what comes after is not looked at.
///
/// # Errors
/// Why these are not the rows of this recording.
pub fn read_csv(text: &[u8], rows: usize, recording: &mut Recording) -> Result<usize, String> {
    let mut rest = text;
    let mut line = |what: &str| -> Result<&str, String> {
        let end = rest.iter().position(|&byte| byte == b'\n').ok_or_else(|| format!("{what} is missing"))?;
        let (line, after) = rest.split_at(end + 1);
        rest = after;
        std::str::from_utf8(line).map_err(|_| format!("{what} is no text"))
    };
    let names = csv_cells(line("the header")?);
    let expected: Vec<&str> = recording.columns().iter().map(|column| column.heading.name.as_str()).collect();
    if names != expected {
        return Err("it has other columns".into());
    }
    let mut values = Vec::with_capacity(names.len());
    for row in 1..=rows {
        let line = line(&format!("row {row}"))?;
        values.clear();
        for cell in line.trim_end().split(',') {
            values.push(cell.parse().map_err(|_| format!("`{cell}` in row {row} is no number"))?);
        }
        if values.len() != names.len() {
            return Err(format!("row {row} has {} numbers and the header {} names", values.len(), names.len()));
        }
        recording.push(&values);
    }
    Ok(text.len() - rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::append_csv;

    const VALUES: [f64; 8] = [0.1, -1.0 / 3.0, 5e-324, f64::MAX, -0.0, f64::NEG_INFINITY, f64::NAN, 1e300];

    fn empty() -> Recording {
        Recording::new(["t", "a, \"b\""].map(String::from))
    }

    #[test]
    fn rows_read_back_to_the_same_bits_and_what_is_appended_follows_them() {
        let mut whole = empty();
        VALUES.iter().enumerate().for_each(|(k, value)| whole.push(&[k as f64, *value]));
        let mut text = Vec::new();
        append_csv(&whole, 0, &mut text).unwrap();
        for rows in 0..=VALUES.len() {
            let mut torn = text.clone();
            torn.extend(b"9,0.");
            let mut read = empty();
            let bytes = read_csv(&torn, rows, &mut read).unwrap();
            assert_eq!(read.rows(), rows);
            for (a, b) in read.columns()[1].values.iter().zip(VALUES) {
                assert_eq!((a.to_bits(), a.is_nan()), (b.to_bits(), b.is_nan()));
            }
            torn.truncate(bytes);
            if rows > 0 {
                append_csv(&whole, rows, &mut torn).unwrap();
                assert_eq!(torn, text, "from row {rows}");
            }
        }
    }

    #[test]
    fn what_is_missing_or_of_another_table_is_said() {
        for (text, told) in [
            ("", "the header is missing"),
            ("t,\"a, \"\"b\"\"\"\n1,2\n3", "row 2 is missing"),
            ("t,x\n1,2\n3,4\n", "other columns"),
            ("t,\"a, \"\"b\"\"\"\n1,2\n3,x\n", "`x` in row 2"),
            ("t,\"a, \"\"b\"\"\"\n1,2,3\n", "row 1 has 3 numbers and the header 2 names"),
            ("t,\"a, \"\"b\"\"\"\n\n", "`` in row 1"),
        ] {
            let message = read_csv(text.as_bytes(), 2, &mut empty()).unwrap_err();
            assert!(message.contains(told), "{text}: {message}");
        }
    }
}
