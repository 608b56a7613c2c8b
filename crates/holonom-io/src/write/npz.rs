//! NumPy's archive: a zip of one-dimensional `.npy` arrays, stored without compression.

use std::io::{self, Cursor, Write};

use holonom::record::Recording;
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

/// Writes one array a column, under the column's name.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for column in recording.columns() {
        archive.start_file(format!("{}.npy", column.heading.name), options)?;
        archive.write_all(&header(column.values.len()))?;
        for value in &column.values {
            archive.write_all(&value.to_le_bytes())?;
        }
    }
    out.write_all(archive.finish()?.get_ref())
}

/// Header of version 1.0 for little-endian doubles, padded so that the data start at a multiple of 64 bytes.
fn header(length: usize) -> Vec<u8> {
    const BEFORE: usize = 10;
    let mut words = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({length},), }}");
    let padding = 63 - (BEFORE + words.len()) % 64;
    words.extend(std::iter::repeat_n(' ', padding));
    words.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend_from_slice(&(words.len() as u16).to_le_bytes());
    header.extend_from_slice(words.as_bytes());
    header
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn columns_read_back() {
        let mut recording = Recording::new(["t", "m1.x"].map(String::from));
        recording.push(&[0.0, 1.5]);
        recording.push(&[0.1, -2.5]);
        let mut bytes = Vec::new();
        write(&recording, &mut bytes).unwrap();
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut array = Vec::new();
        archive.by_name("m1.x.npy").unwrap().read_to_end(&mut array).unwrap();
        let start = array.len() - 16;
        assert_eq!(start % 64, 0);
        assert!(array.starts_with(b"\x93NUMPY"));
        assert_eq!(array[start..start + 8], 1.5_f64.to_le_bytes());
        assert_eq!(array[start + 8..], (-2.5_f64).to_le_bytes());
    }
}
