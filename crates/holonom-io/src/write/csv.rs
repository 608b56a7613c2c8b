//! Comma-separated values.

use std::io::{self, Write};

use holonom::record::Recording;

/// Writes a header and one line a row. Numbers are the shortest that read back to the same bits.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(recording.columns().iter().map(|column| &column.name))?;
    for row in 0..recording.rows() {
        table.write_record(recording.columns().iter().map(|column| column.values[row].to_string()))?;
    }
    table.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let mut recording = Recording::new(["t".to_string(), "a,b".to_string()]);
        let values = [0.1, -1.0 / 3.0, 5e-324, 1.7976931348623157e308, 0.0];
        for (k, value) in values.iter().enumerate() {
            recording.push(&[k as f64, *value]);
        }
        let mut text = Vec::new();
        write(&recording, &mut text).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_slice());
        assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), ["t", "a,b"]);
        let read: Vec<f64> = reader.records().map(|record| record.unwrap()[1].parse().unwrap()).collect();
        assert!(read.iter().zip(&values).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}
