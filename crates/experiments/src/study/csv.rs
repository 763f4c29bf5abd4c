//! CSV files: the table of a study, and points of a design.

use super::StudyError;
use super::table::{Cell, Table};
use crate::runs::RunsError;
use crate::runs::cells::{guarded, unguarded};
use std::path::Path;

/// Writes a table; headings have units, `wear.Qs [kg/s]`, and what is not known is empty.
///
/// # Errors
/// The file cannot be written.
pub fn write(table: &Table, path: &Path) -> Result<(), RunsError> {
    let fail = |e: &dyn std::fmt::Display| RunsError::write(path, e);
    let mut out = ::csv::Writer::from_path(path).map_err(|e| fail(&e))?;
    let headings = table.columns.iter().map(|c| match c.unit.as_str() {
        "" => guarded(&c.name),
        unit => guarded(&format!("{} [{unit}]", c.name)),
    });
    out.write_record(headings).map_err(|e| fail(&e))?;
    for k in 0..table.rows() {
        let row = table.columns.iter().map(|c| match &c.cells[k] {
            Cell::Number(x) => format!("{x}"),
            Cell::Text(text) => guarded(text),
            Cell::Unknown => String::new(),
        });
        out.write_record(row).map_err(|e| fail(&e))?;
    }
    out.flush().map_err(|e| fail(&e))
}

/// Reads the points of a design: names of columns, and rows of texts.
///
/// # Errors
/// The file cannot be read, has no rows, or rows of different lengths.
pub fn read_points(path: &Path) -> Result<(Vec<String>, Vec<Vec<String>>), StudyError> {
    let fail = |why: String| StudyError::Usage(format!("{}: {why}", path.display()));
    let mut reader = ::csv::ReaderBuilder::new()
        .trim(::csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(|e| fail(e.to_string()))?;
    let headings = reader.headers().map_err(|e| fail(e.to_string()))?;
    let names: Vec<String> = headings.iter().map(|h| unguarded(h).to_owned()).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fail(e.to_string()))?;
        rows.push(
            record
                .iter()
                .map(|cell| unguarded(cell).to_owned())
                .collect(),
        );
    }
    if rows.is_empty() {
        return Err(fail(
            "it has no points; expected a heading and one row for each point".to_owned(),
        ));
    }
    Ok((names, rows))
}
