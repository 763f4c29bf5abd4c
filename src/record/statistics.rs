//! The table of statistics: one row every so many steps, as `statistics.csv` and in `results.h5`.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// One line.
    pub doc: &'static str,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: &'static str, doc: &'static str) -> Self {
        Self {
            name: name.into(),
            unit,
            doc,
        }
    }
}

/// Rows kept in memory for the figures, and written as they come.
#[derive(Debug, Default)]
pub struct Table {
    /// Columns.
    pub columns: Vec<Column>,
    /// Values, row after row.
    pub rows: Vec<f64>,
    /// None before the file is there.
    writer: Option<csv::Writer<BufWriter<File>>>,
}

impl Table {
    /// Opens the file and writes its header: `name [unit]`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, columns: Vec<Column>) -> Result<Self, csv::Error> {
        let mut table = Self::new(columns);
        table.open(path)?;
        Ok(table)
    }

    /// An empty table without a file.
    pub fn new(columns: Vec<Column>) -> Self {
        Self {
            columns,
            rows: Vec::new(),
            writer: None,
        }
    }

    /// Opens the file and writes its header: `name [unit]`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn open(&mut self, path: &Path) -> Result<(), csv::Error> {
        let mut writer = csv::Writer::from_writer(BufWriter::new(File::create(path)?));
        writer.write_record(self.columns.iter().map(|c| match c.unit {
            "" => c.name.clone(),
            unit => format!("{} [{unit}]", c.name),
        }))?;
        self.writer = Some(writer);
        Ok(())
    }

    /// Appends rows that another run wrote, given by their columns.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn extend(&mut self, columns: &[Vec<f64>]) -> Result<(), csv::Error> {
        for k in 0..columns.first().map_or(0, Vec::len) {
            let row: Vec<f64> = columns.iter().map(|c| c[k]).collect();
            self.push(&row)?;
        }
        Ok(())
    }

    /// Appends a row, one value a column.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, row: &[f64]) -> Result<(), csv::Error> {
        debug_assert_eq!(row.len(), self.columns.len());
        self.rows.extend_from_slice(row);
        match &mut self.writer {
            Some(writer) => writer.write_record(row.iter().map(|x| format!("{x:e}"))),
            None => Ok(()),
        }
    }

    /// Writes what is held back.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), csv::Error> {
        Ok(self.writer.as_mut().map_or(Ok(()), csv::Writer::flush)?)
    }

    /// The values of a column; empty if there is none of that name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let width = self.columns.len();
        match self.columns.iter().position(|c| c.name == name) {
            Some(k) => self.rows.chunks_exact(width).map(|r| r[k]).collect(),
            None => Vec::new(),
        }
    }
}
