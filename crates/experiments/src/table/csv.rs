//! CSV files: writing tables, reading points and measured curves.

use super::cells::{guarded, unguarded};
use super::{Cell, ColumnType, Table};
use crate::Error;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

/// Format of numbers that are not whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    /// The fewest digits that read back to an equal number: `0.001`.
    Plain,
    /// Scientific notation: `1e-3`.
    Exponents,
}

/// Writes a table; headings have units, `wear.Qs [kg/s]`, and unknown values are empty.
///
/// # Errors
/// The file cannot be written.
pub fn write(table: &Table, path: &Path, numbers: NumberFormat) -> Result<(), Error> {
    write_below(&[], table, path, numbers)
}

/// Writes a table below lines of comments.
///
/// # Errors
/// The file cannot be written.
pub fn write_below(
    comments: &[String],
    table: &Table,
    path: &Path,
    numbers: NumberFormat,
) -> Result<(), Error> {
    let text = || -> csv::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        for line in comments {
            writeln!(file, "# {line}")?;
        }
        let mut out = csv::Writer::from_writer(file);
        out.write_record(table.columns.iter().map(|c| match c.unit.as_str() {
            "" | "1" => guarded(&c.name),
            unit => guarded(&format!("{} [{unit}]", c.name)),
        }))?;
        for k in 0..table.rows() {
            out.write_record(table.columns.iter().map(|c| match &c.cells[k] {
                Cell::Number(x)
                    if numbers == NumberFormat::Exponents && c.kind == ColumnType::Real =>
                {
                    format!("{x:e}")
                }
                Cell::Number(x) => format!("{x}"),
                Cell::Text(text) => guarded(text),
                Cell::Unknown => String::new(),
            }))?;
        }
        Ok(out.flush()?)
    };
    text().map_err(|e| Error::write(path, &e))
}

/// Content of a file.
#[derive(Debug)]
pub struct Texts {
    /// Headings as in the file, `stress [MPa]`.
    pub headings: Vec<String>,
    /// Rows, with a text for each column.
    pub rows: Vec<Vec<String>>,
}

/// Returns a heading without its unit.
pub fn without_unit(heading: &str) -> &str {
    heading.split(" [").next().unwrap_or(heading).trim()
}

/// Reads a file with headings, in which lines that begin with `#` are comments.
///
/// # Errors
/// The file cannot be read, or has rows of different lengths.
pub fn read(path: &Path) -> Result<Texts, Error> {
    let row = |record: &csv::StringRecord| -> Vec<String> {
        let cells = record.iter().map(unguarded);
        cells.map(str::to_owned).collect()
    };
    let texts = || -> csv::Result<Texts> {
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_path(path)?;
        let headings = row(reader.headers()?);
        let rows = reader.records().map(|record| Ok(row(&record?)));
        Ok(Texts {
            headings,
            rows: rows.collect::<csv::Result<_>>()?,
        })
    };
    texts().map_err(|e| Error::Usage(format!("{}: {e}", path.display())))
}
