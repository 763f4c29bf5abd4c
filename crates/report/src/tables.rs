//! Tables that measures and scars leave in the folder of a run, as `NAME.csv`: profiles across the layer, scars.

use crate::folder::RunFolder;
use serde_json::{Value, json};
use std::path::Path;

/// Rows of a table that is read; larger ones are left to other programs.
const MOST_ROWS: usize = 20_000;
/// Bytes of a table that is read.
const MOST_BYTES: u64 = 8 << 20;

/// A table: each column with its name and unit.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Name of the file without its ending.
    pub name: String,
    /// Name, unit, values.
    pub columns: Vec<(String, String, Vec<f64>)>,
}

/// The tables of numbers in the folder of a run, by name; tables of other programs that look alike are taken too.
pub(crate) fn read(run: &RunFolder) -> Vec<Table> {
    let entries = std::fs::read_dir(&run.path).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|e| e.file_name().into_string().ok())
        .filter(|n| n.ends_with(".csv") && n != "statistics.csv")
        .collect();
    names.sort();
    let table = |name: &String| table(&run.path.join(name), name.trim_end_matches(".csv"));
    names.iter().filter_map(table).collect()
}

fn table(path: &Path, name: &str) -> Option<Table> {
    let small = std::fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() <= MOST_BYTES);
    if !small {
        return None;
    }
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .ok()?;
    let mut columns: Vec<(String, String, Vec<f64>)> = reader
        .headers()
        .ok()?
        .iter()
        .map(|head| {
            let (name, unit) = head
                .strip_suffix(']')
                .and_then(|h| h.rsplit_once('['))
                .unwrap_or((head, ""));
            (name.trim().to_owned(), unit.trim().to_owned(), Vec::new())
        })
        .collect();
    for row in reader.records().take(MOST_ROWS) {
        let row = row.ok()?;
        for (column, text) in columns.iter_mut().zip(&row) {
            column.2.push(text.parse().unwrap_or(f64::NAN));
        }
    }
    // A table by name, and not by number, is no figure.
    let numbers = columns
        .iter()
        .all(|c| !c.1.is_empty() || c.2.iter().any(|v| v.is_finite()));
    columns.retain(|c| c.2.iter().any(|v| v.is_finite()));
    (columns.len() > 1 && numbers).then(|| Table {
        name: name.to_owned(),
        columns,
    })
}

impl Table {
    /// The table for the page; what is not a number is null.
    pub fn json(&self) -> Value {
        let number = |v: &f64| {
            if v.is_finite() {
                json!(*v as f32)
            } else {
                Value::Null
            }
        };
        let column = |(name, unit, values): &(String, String, Vec<f64>)| {
            let values: Vec<Value> = values.iter().map(number).collect();
            json!({"name": name, "unit": unit, "values": values})
        };
        json!({"name": self.name, "columns": self.columns.iter().map(column).collect::<Vec<_>>()})
    }
}
