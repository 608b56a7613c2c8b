//! Tables of columns over time: what a run left, and what was measured.

use holonom::record::{Heading, Recording};

use super::columns::{Columns, TableError};

/// Name of the column of time.
const TIME: &str = "t";

/// Whether a column is that of time: it is called so, or else the first.
fn is_time(names: &[String], k: usize) -> bool {
    if k == 0 { names[0] == TIME || !names.iter().any(|name| name == TIME) } else { names[k] == TIME }
}

/// Reads CSV: names in the first line, then a line for each time. The time is the column `t`, or else the first. Cells may be empty, and lines with a `#` at
/// their start are left out. What is known of a column beside its name, `heading` tells.
///
/// # Errors
/// When the bytes are no such table.
pub fn read_recording(bytes: &[u8], heading: impl Fn(&str) -> Heading) -> Result<Recording, TableError> {
    let read = Columns::read(bytes, |names, k, text| match text {
        "" if !is_time(names, k) => Some(f64::NAN),
        text => text.parse().ok().filter(|number: &f64| number.is_finite() || !is_time(names, k)),
    })?;
    if read.names.len() < 2 {
        return Err(TableError::NoColumns);
    }
    let time = (0..read.names.len()).position(|k| is_time(&read.names, k)).unwrap_or(0);
    let times = &read.columns[time];
    if let Some(row) = (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
        return Err(TableError::Backwards { line: read.line(row) });
    }
    if times.len() < 2 {
        return Err(TableError::FewRows { rows: times.len() });
    }
    let order = || std::iter::once(time).chain((0..read.names.len()).filter(move |k| *k != time));
    let mut recording = Recording::new(order().map(|k| heading(if k == time { TIME } else { &read.names[k] })));
    let mut values = Vec::with_capacity(read.names.len());
    for row in 0..read.rows() {
        values.clear();
        values.extend(order().map(|k| read.columns[k][row]));
        recording.push(&values);
    }
    Ok(recording)
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
            ("t;a\n0;1\n", TableError::NoCommas),
            ("t\ta\n0\t1\n", TableError::NoCommas),
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
