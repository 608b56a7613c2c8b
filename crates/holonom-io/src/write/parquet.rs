//! Parquet: columns one after another with their types, for data frames. Values are stored plainly, so that every bit of a
//! number is kept, and uncompressed.

use std::io::{self, Write};
use std::sync::Arc;

use holonom::record::Recording;
use parquet::basic::{ConvertedType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;

use super::json::headings;
use super::{Cells, Table};

/// Writes the columns of a recording, all of doubles.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    let fields = recording.columns().iter().map(|column| (column.heading.name.as_str(), Physical::DOUBLE, Repetition::REQUIRED));
    let headings = KeyValue::new("columns".to_string(), serde_json::to_string(&headings(recording.columns()))?);
    write_columns(fields, vec![headings], out, |group| {
        recording.columns().iter().try_for_each(|column| write_column::<DoubleType>(group, &column.values, None))
    })
}

/// Writes a table with words; cells where there is nothing are null.
pub(super) fn write_table(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    let physical = |cells: &Cells| match cells {
        Cells::Whole(_) => Physical::INT64,
        Cells::Numbers(_) => Physical::DOUBLE,
        Cells::Words(_) => Physical::BYTE_ARRAY,
    };
    let fields = table.columns.iter().map(|(name, cells)| (name.as_str(), physical(cells), Repetition::OPTIONAL));
    write_columns(fields, Vec::new(), out, |group| table.columns.iter().try_for_each(|(_, cells)| write_cells(group, cells)))
}

/// Writes a file with one group of rows.
fn write_columns<'a>(
    fields: impl Iterator<Item = (&'a str, Physical, Repetition)>,
    metadata: Vec<KeyValue>,
    out: &mut dyn Write,
    write: impl FnOnce(&mut SerializedRowGroupWriter<'_, Vec<u8>>) -> Result<(), ParquetError>,
) -> io::Result<()> {
    let bytes = || {
        let fields = fields.map(|(name, physical, repetition)| field(name, physical, repetition)).collect::<Result<_, _>>()?;
        let schema = Type::group_type_builder("holonom").with_fields(fields).build()?;
        let properties = WriterProperties::builder().set_dictionary_enabled(false).set_key_value_metadata(Some(metadata)).build();
        let mut file = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
        let mut group = file.next_row_group()?;
        write(&mut group)?;
        group.close()?;
        file.into_inner()
    };
    out.write_all(&bytes().map_err(|error: ParquetError| io::Error::other(error))?)
}

fn field(name: &str, physical: Physical, repetition: Repetition) -> Result<Arc<Type>, ParquetError> {
    let is_text = physical == Physical::BYTE_ARRAY;
    let converted = if is_text { ConvertedType::UTF8 } else { ConvertedType::NONE };
    Type::primitive_type_builder(name, physical).with_repetition(repetition).with_converted_type(converted).build().map(Arc::new)
}

fn write_cells(group: &mut SerializedRowGroupWriter<'_, Vec<u8>>, cells: &Cells) -> Result<(), ParquetError> {
    fn split<A, B>(cells: &[Option<A>], convert: impl Fn(&A) -> B) -> (Vec<B>, Vec<i16>) {
        (cells.iter().flatten().map(convert).collect(), cells.iter().map(|cell| i16::from(cell.is_some())).collect())
    }
    match cells {
        Cells::Whole(cells) => {
            let (values, levels) = split(cells, |cell| *cell);
            write_column::<Int64Type>(group, &values, Some(&levels))
        }
        Cells::Numbers(cells) => {
            let (values, levels) = split(cells, |cell| *cell);
            write_column::<DoubleType>(group, &values, Some(&levels))
        }
        Cells::Words(cells) => {
            let (values, levels) = split(cells, |cell| ByteArray::from(cell.as_str()));
            write_column::<ByteArrayType>(group, &values, Some(&levels))
        }
    }
}

/// Writes the next column; `levels` are 1 where there is a value and 0 where there is none.
fn write_column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("there is a field for each column");
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    const VALUES: [f64; 7] = [0.1, -1.0 / 3.0, 5e-324, f64::MAX, 0.0, -0.0, f64::NEG_INFINITY];

    #[test]
    fn recordings_read_back_to_the_same_bits() {
        let mut recording = Recording::new(["t", "m.1.x"].map(String::from));
        VALUES.iter().enumerate().for_each(|(k, value)| recording.push(&[k as f64, *value]));
        let mut bytes = Vec::new();
        write(&recording, &mut bytes).unwrap();
        let file = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let schema = file.metadata().file_metadata().schema();
        assert_eq!(schema.get_fields().iter().map(|field| field.name()).collect::<Vec<_>>(), ["t", "m.1.x"]);
        let rows: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(rows.len(), VALUES.len());
        for (k, row) in rows.iter().enumerate() {
            assert_eq!((row.get_double(0).unwrap(), row.get_double(1).unwrap().to_bits()), (k as f64, VALUES[k].to_bits()));
        }
    }

    #[test]
    fn tables_keep_words_and_what_is_missing() {
        let table = Table {
            columns: vec![
                ("run".into(), Cells::Whole(vec![Some(1), Some(2)])),
                ("energy".into(), Cells::Numbers(vec![None, Some(1.0 / 3.0)])),
                ("reason".into(), Cells::Words(vec![Some("größer, \"viel\"".into()), None])),
            ],
        };
        let mut bytes = Vec::new();
        write_table(&table, &mut bytes).unwrap();
        let file = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let rows: Vec<_> = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!((rows[0].get_long(0).unwrap(), rows[1].get_long(0).unwrap()), (1, 2));
        assert!(rows[0].get_double(1).is_err() && rows[1].get_string(2).is_err(), "nothing is null");
        assert_eq!(rows[1].get_double(1).unwrap(), 1.0 / 3.0);
        assert_eq!(rows[0].get_string(2).unwrap(), "größer, \"viel\"");
    }
}
