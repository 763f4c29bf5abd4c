//! Columns of the statistics of a run, with fewer rows in time if there are many.

use crate::html::folder::RunFolder;
use fretwork_observe::chart::Columns;
use std::rc::Rc;

/// Number of rows that are read at a time.
const BLOCK: usize = 1 << 16;

/// A column of the statistics.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    /// Name.
    pub name: String,
    /// SI unit, empty for a pure number.
    pub unit: String,
    /// Description.
    pub doc: String,
    /// Values of the rows that are kept.
    pub values: Rc<[f64]>,
}

/// The statistics of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Statistics {
    /// Rows in the file.
    pub rows: usize,
    /// Distance, in rows of the file, from one kept row to the next.
    pub every: usize,
    /// Columns that are not constant or are otherwise informative, in the order of the file.
    pub columns: Vec<Column>,
}

impl Statistics {
    /// Reads the statistics of a run, at most about `most` rows of each column.
    pub fn read(run: &RunFolder, most: usize, gaps: &mut Vec<String>) -> Self {
        let reader = &run.reader;
        let names: Vec<&str> = reader.datasets_in("statistics").collect();
        let path = |name: &str| format!("statistics/{name}");
        let counts = names.iter().filter_map(|n| reader.rows(&path(n)).ok());
        // In the file of a killed run, columns may differ in length by the last rows.
        let rows = counts.min().unwrap_or(0);
        let every = rows.div_ceil(most.max(2)).max(1);
        let mut columns = Vec::new();
        for name in names {
            match sampled(run, &path(name), rows, every) {
                Ok(values) => {
                    let (unit, doc) = reader.described(&path(name));
                    let name = name.to_owned();
                    columns.push(Column {
                        name,
                        unit,
                        doc,
                        values: values.into(),
                    });
                }
                Err(reason) => gaps.push(format!("A column is missing: {reason}.")),
            }
        }
        Self {
            rows,
            every,
            columns,
        }
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }
}

impl Columns for Statistics {
    fn column(&self, name: &str) -> Option<(&str, Rc<[f64]>)> {
        let column = Self::column(self, name)?;
        Some((&column.unit, column.values.clone()))
    }
}

/// Returns every `every`-th row of a column, and the last row.
fn sampled(run: &RunFolder, name: &str, rows: usize, every: usize) -> Result<Vec<f64>, String> {
    let mut out = Vec::with_capacity(rows / every + 2);
    for first in (0..rows).step_by(BLOCK) {
        let count = BLOCK.min(rows - first);
        let block = run.reader.values(name, (first, count), 1)?;
        let kept = |k: &usize| (first + k).is_multiple_of(every) || first + k == rows - 1;
        out.extend((0..count).filter(kept).map(|k| block[k]));
    }
    Ok(out)
}
