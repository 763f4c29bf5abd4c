//! Table of statistics: one row every few steps, in `statistics.csv` and `results.h5`.

use super::quantity::Unit;
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: Unit,
    /// Description in one line.
    pub doc: &'static str,
}

impl Column {
    /// Creates a column with a unit: one that depends on the dimension, or a symbol such as `m/s`,
    /// empty for a pure number.
    pub fn new(name: impl Into<String>, unit: impl Into<Unit>, doc: &'static str) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            doc,
        }
    }
}

/// Columns that a chart of any column shows first, the first of them that a run has: friction, then
/// damage, then wear.
pub const UP_FIRST: [&str; 4] = ["mu", "sin_phi", "damage_ratio", "worn_first"];

/// Columns that it shows beside another one.
pub const BESIDE_FIRST: [&str; 2] = ["worn_first", "damage_ratio"];

/// A table that is written row by row and read back at the end, so that memory does not grow with
/// the length of the run.
#[derive(Debug, Default)]
pub struct Table {
    /// Columns.
    pub columns: Vec<Column>,
    /// Dimension of the run, which determines the units.
    dimension: usize,
    /// Values, row by row, after [`Self::recall`].
    pub rows: Vec<f64>,
    /// The file and its writer; `None` before it is opened.
    file: Option<(PathBuf, csv::Writer<BufWriter<File>>)>,
}

impl Table {
    /// Creates a table of a run in a dimension, with its file and header: `name [unit]`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, columns: Vec<Column>, dimension: usize) -> Result<Self, csv::Error> {
        let mut table = Self::new(columns, dimension);
        table.open(path)?;
        Ok(table)
    }

    /// An empty table of a run in a dimension, without a file.
    pub fn new(columns: Vec<Column>, dimension: usize) -> Self {
        Self {
            columns,
            dimension,
            rows: Vec::new(),
            file: None,
        }
    }

    /// Returns the unit of a column for headings and axes; empty for a pure number.
    pub fn heading(&self, column: &Column) -> &'static str {
        column.unit.heading(self.dimension)
    }

    /// Opens the file and writes its header: `name [unit]`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn open(&mut self, path: &Path) -> Result<(), csv::Error> {
        let mut writer = csv::Writer::from_writer(BufWriter::new(File::create(path)?));
        writer.write_record(self.columns.iter().map(|c| match self.heading(c) {
            "" => c.name.clone(),
            unit => format!("{} [{unit}]", c.name),
        }))?;
        self.file = Some((path.to_owned(), writer));
        Ok(())
    }

    /// Appends rows of an earlier part of the run, given by columns.
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

    /// Appends a row, one value per column.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, row: &[f64]) -> Result<(), csv::Error> {
        debug_assert_eq!(row.len(), self.columns.len());
        match &mut self.file {
            Some((_, writer)) => writer.write_record(row.iter().map(|x| format!("{x:e}"))),
            None => Ok(()),
        }
    }

    /// Flushes buffered rows to the file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), csv::Error> {
        Ok(self.file.as_mut().map_or(Ok(()), |f| f.1.flush())?)
    }

    /// Reads the rows back; the written digits reproduce the same bits. An incomplete last row is
    /// dropped.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn recall(&mut self) -> Result<(), csv::Error> {
        // A write error is reported by the caller's last flush.
        let _ = self.flush();
        self.rows.clear();
        let Some((path, _)) = &self.file else {
            return Ok(());
        };
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path)?;
        let mut record = csv::StringRecord::new();
        let mut counted = 0;
        while reader.read_record(&mut record)? {
            let row: Vec<f64> = record.iter().map_while(|x| x.parse().ok()).collect();
            counted = if row.len() == self.columns.len() {
                row.len()
            } else {
                0
            };
            self.rows.extend(&row[..counted]);
        }
        let mut file = File::open(path)?;
        let mut last = [0];
        if file.seek(SeekFrom::End(-1)).is_ok() {
            file.read_exact(&mut last)?;
        }
        if last != *b"\n" {
            self.rows.truncate(self.rows.len() - counted);
        }
        Ok(())
    }

    /// Returns the values of a recalled column; empty if there is no such column.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let width = self.columns.len();
        match self.columns.iter().position(|c| c.name == name) {
            Some(k) => self.rows.chunks_exact(width).map(|r| r[k]).collect(),
            None => Vec::new(),
        }
    }

    /// Returns number and start (s) of the last cycle that is as long as the one before it, from
    /// the columns `cycle` and `time`; `None` if there are not two cycles.
    pub fn last_cycle(&self) -> Option<(u32, f64)> {
        let (cycles, times) = (self.column("cycle"), self.column("time"));
        // The row before the first row of a cycle is the last one of the previous cycle.
        let turns = (1..cycles.len()).filter(|k| cycles[*k] > cycles[k - 1]);
        let begins: Vec<(u32, f64)> = turns.map(|k| (cycles[k] as u32, times[k - 1])).collect();
        let [.., (_, before), last] = begins[..] else {
            return None;
        };
        let (length, reached) = (last.1 - before, times.last()? - last.1);
        // A row may be written a step late.
        if reached >= 0.9 * length {
            Some(last)
        } else {
            begins.get(begins.len() - 2).copied()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_with_their_bits_and_a_cut_one_does_not() {
        let path = std::env::temp_dir().join(format!("fretwork-table-{}.csv", std::process::id()));
        let columns = ["a", "b"].map(|name| Column::new(name, "m", "")).to_vec();
        let mut table = Table::create(&path, columns, 3).unwrap();
        let rows = [
            [0.1 + 0.2, -0.0],
            [f64::MIN_POSITIVE / 3.0, f64::MAX],
            [f64::INFINITY, 1.0 / 3.0],
        ];
        rows.iter().for_each(|row| table.push(row).unwrap());
        assert!(table.rows.is_empty());
        table.recall().unwrap();
        let bits = |rows: &[f64]| rows.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&table.rows), bits(rows.as_flattened()));
        assert_eq!(table.column("b").len(), 3);
        let text = std::fs::read_to_string(&path).unwrap();
        // The text is cut within the last number so that it is still a number, so that it is not a
        // number, and at its start.
        for (cut, left) in [(text.len() - 4, 2), (text.len() - 3, 2), (0, 0)] {
            std::fs::write(&path, &text[..cut]).unwrap();
            table.recall().unwrap();
            assert_eq!(table.rows.len(), 2 * left);
        }
        std::fs::remove_file(&path).unwrap();
        assert!(table.recall().is_err());
    }
}
