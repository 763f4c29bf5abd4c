//! The table of a study as a Parquet file. Units are in the metadata of the file, under `units` as
//! JSON.

use super::{Cell, Column, ColumnType, Table};
use crate::Error;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Writes a table; unknown values are null.
///
/// # Errors
/// The file cannot be written.
pub fn write(table: &Table, path: &Path) -> Result<(), Error> {
    let fail = |e: &dyn std::fmt::Display| Error::write(path, e);
    let file = File::create(path).map_err(|e| fail(&e))?;
    write_to(table, file).map_err(|e| fail(&e))
}

fn write_to(table: &Table, file: File) -> Result<(), ParquetError> {
    let fields = table.columns.iter().map(field);
    let schema = Type::group_type_builder("study")
        .with_fields(fields.collect::<Result<_, _>>()?)
        .build()?;
    let units: BTreeMap<&str, &str> = table
        .columns
        .iter()
        .filter(|c| !c.unit.is_empty())
        .map(|c| (c.name.as_str(), c.unit.as_str()))
        .collect();
    let units = serde_json::to_string(&units).unwrap_or_default();
    let properties = WriterProperties::builder()
        .set_created_by(format!("fretwork {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(vec![KeyValue::new("units".to_owned(), units)]))
        .build();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut rows = writer.next_row_group()?;
    for column in &table.columns {
        write_column(&mut rows, column)?;
    }
    rows.close()?;
    writer.close()?;
    Ok(())
}

/// Returns the type of a column, which may have nulls.
fn field(column: &Column) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match column.kind {
        ColumnType::Real => (Physical::DOUBLE, None),
        ColumnType::Whole => (Physical::INT64, None),
        ColumnType::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical)
        .build()?;
    Ok(Arc::new(field))
}

fn write_column(
    rows: &mut SerializedRowGroupWriter<'_, File>,
    column: &Column,
) -> Result<(), ParquetError> {
    let Some(mut to) = rows.next_column()? else {
        return Ok(());
    };
    let known: Vec<i16> = column
        .cells
        .iter()
        .map(|c| i16::from(*c != Cell::Unknown))
        .collect();
    let numbers = || {
        column.cells.iter().filter_map(|c| match c {
            Cell::Number(x) => Some(*x),
            _ => None,
        })
    };
    match column.kind {
        ColumnType::Real => {
            let values: Vec<f64> = numbers().collect();
            to.typed::<DoubleType>()
                .write_batch(&values, Some(&known), None)?;
        }
        ColumnType::Whole => {
            let values: Vec<i64> = numbers().map(|x| x as i64).collect();
            to.typed::<Int64Type>()
                .write_batch(&values, Some(&known), None)?;
        }
        ColumnType::Text => {
            let texts = column.cells.iter().filter_map(|c| match c {
                Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                _ => None,
            });
            let values: Vec<ByteArray> = texts.collect();
            to.typed::<ByteArrayType>()
                .write_batch(&values, Some(&known), None)?;
        }
    }
    to.close()
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    /// This test reads the file with the same library; tests/program/study uses another reader.
    #[test]
    fn a_table_comes_back_with_nulls_and_units() {
        let table = Table {
            columns: vec![
                Column::whole("point", [Some(1.0), Some(2.0)]),
                Column::real("wear.Qs", "kg/s", [Some(0.1), None]),
                Column::text("law", [String::new(), "µ".into()]),
            ],
        };
        let path = std::env::temp_dir().join(format!("fretwork-parquet-{}", std::process::id()));
        write(&table, &path).unwrap();
        let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
        let metadata = reader
            .metadata()
            .file_metadata()
            .key_value_metadata()
            .unwrap();
        let units = r#"{"point":"1","wear.Qs":"kg/s"}"#;
        assert_eq!(metadata[0].value.as_deref(), Some(units));
        let rows: Vec<Vec<(String, Field)>> = reader
            .get_row_iter(None)
            .unwrap()
            .map(|row| row.unwrap().into_columns())
            .collect();
        let cell = |row: usize, column: usize| rows[row][column].1.clone();
        assert_eq!([cell(0, 0), cell(1, 0)], [Field::Long(1), Field::Long(2)]);
        assert_eq!([cell(0, 1), cell(1, 1)], [Field::Double(0.1), Field::Null]);
        assert_eq!(
            [cell(0, 2), cell(1, 2)],
            [Field::Null, Field::Str("µ".into())]
        );
        assert_eq!(rows[0][1].0, "wear.Qs");
        std::fs::remove_file(&path).unwrap();
    }
}
