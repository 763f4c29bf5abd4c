//! Tables that measures and scars leave in the folder of a run, as `NAME.csv`: profiles across the layer, scars.

use crate::folder::RunFolder;
use serde_json::{Value, json};
use std::path::Path;

/// Bytes of a table that is read; larger ones are left to other programs.
const MOST_BYTES: u64 = 8 << 20;
/// Bytes of a number in the page, about.
const NUMBER_BYTES: usize = 12;
/// Fewest rows that are kept of a table.
const FEWEST_ROWS: usize = 50;

/// A table: each column with its name and unit.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Name of the file without its ending.
    pub name: String,
    /// Name, unit, values.
    pub columns: Vec<(String, String, Vec<f64>)>,
}

/// The tables of numbers in the folder of a run, by name; tables of other programs that look alike are taken too.
/// Rows are left out evenly where the tables would take more than so many bytes of the page, which a note says.
pub(crate) fn read(run: &RunFolder, bytes: Option<usize>, notes: &mut Vec<String>) -> Vec<Table> {
    let entries = std::fs::read_dir(&run.path).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|e| e.file_name().into_string().ok())
        .filter(|n| n.ends_with(".csv") && n != "statistics.csv")
        .collect();
    names.sort();
    let table = |name: &String| table(&run.path.join(name), name.trim_end_matches(".csv"));
    let mut tables: Vec<Table> = names.iter().filter_map(table).collect();
    if let Some(bytes) = bytes {
        let share = bytes / tables.len().max(1);
        for table in &mut tables {
            table.thin(share, notes);
        }
    }
    tables
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
    let mut words = false;
    for row in reader.records() {
        let row = row.ok()?;
        for (column, text) in columns.iter_mut().zip(&row) {
            let number = text.parse();
            words |= number.is_err() && !text.is_empty();
            column.2.push(number.unwrap_or(f64::NAN));
        }
    }
    // A table of names, and not of numbers alone, is no figure.
    columns.retain(|c| c.2.iter().any(|v| v.is_finite()));
    (columns.len() > 1 && !words).then(|| Table {
        name: name.to_owned(),
        columns,
    })
}

impl Table {
    /// Keeps every k-th row, so that the table takes no more than so many bytes.
    fn thin(&mut self, bytes: usize, notes: &mut Vec<String>) {
        let rows = self.columns.iter().map(|c| c.2.len()).max().unwrap_or(0);
        let most = (bytes / NUMBER_BYTES / self.columns.len().max(1)).max(FEWEST_ROWS);
        if rows <= most {
            return;
        }
        let every = rows.div_ceil(most);
        for (_, _, values) in &mut self.columns {
            *values = values.iter().copied().step_by(every).collect();
        }
        notes.push(format!(
            "{}.csv has {rows} rows; one in {every} is drawn",
            self.name
        ));
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Table> {
        let place = std::env::temp_dir().join(format!(
            "fretwork-table-{}-{:?}.csv",
            std::process::id(),
            std::thread::current().id()
        ));
        std::fs::write(&place, text).unwrap();
        let table = table(&place, "layer");
        std::fs::remove_file(&place).unwrap();
        table
    }

    /// A layer without bonds has no damage ratio in its profile, which is drawn all the same.
    #[test]
    fn columns_without_numbers_are_left_out_and_tables_of_names_are_none() {
        let table = read("height [m],speed [m/s],damage_ratio\n0.1,1,NaN\n0.2,2,NaN\n").unwrap();
        let names: Vec<&str> = table.columns.iter().map(|c| c.0.as_str()).collect();
        assert_eq!(names, ["height", "speed"]);
        assert!(read("name,speed [m/s],height [m]\ntop,1,2\n").is_none());
    }

    #[test]
    fn large_tables_are_thinned_evenly_with_a_note() {
        let rows = (0..10_000).map(|k| format!("{k},{}\n", 2 * k));
        let mut table = read(&format!("a,b\n{}", rows.collect::<String>())).unwrap();
        let mut notes = Vec::new();
        table.thin(24_000, &mut notes);
        assert_eq!(table.columns[1].2.len(), 1000);
        assert_eq!(table.columns[1].2[999], 2.0 * 9990.0);
        assert_eq!(notes, ["layer.csv has 10000 rows; one in 10 is drawn"]);
        assert!(table.json().to_string().len() < 24_000);
        table.thin(24_000, &mut notes);
        assert_eq!(notes.len(), 1);
    }
}
