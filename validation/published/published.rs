//! Published numbers: `validation/NAME.csv` with the columns `name`, `value`, `low`, `high`,
//! `source`; `#` begins a comment.

use crate::comparison::Failure;
use crate::row::Reference;
use std::path::Path;

pub struct Published {
    rows: Vec<(String, f64, f64)>,
}

impl Published {
    /// Without a file there are no numbers.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let mut rows = Vec::new();
        if path.exists() {
            let mut reader = csv::ReaderBuilder::new()
                .comment(Some(b'#'))
                .from_path(path)?;
            for record in reader.records() {
                let record = record?;
                let number = |k: usize| record.get(k).and_then(|t| t.trim().parse::<f64>().ok());
                let name = record.get(0).unwrap_or_default().to_owned();
                let row = match (number(1), number(2), number(3)) {
                    (Some(value), None, None) => (name, value, 0.0),
                    (None, Some(low), Some(high)) => (name, 0.5 * (low + high), 0.5 * (high - low)),
                    _ => {
                        return Err(format!(
                            "{}: `{name}` needs a `value`, or `low` and `high`",
                            path.display()
                        )
                        .into());
                    }
                };
                rows.push(row);
            }
        }
        Ok(Self { rows })
    }

    /// A number, the middle of a range.
    pub fn value(&self, name: &str) -> Result<f64, Failure> {
        Ok(self.reference(name, 0)?.value)
    }

    /// A number with half of its range.
    pub fn reference(&self, name: &str, digits: usize) -> Result<Reference, Failure> {
        let row = self.rows.iter().find(|r| r.0 == name);
        let (_, value, range) =
            row.ok_or_else(|| format!("`{name}` is not among the published numbers"))?;
        Ok(Reference {
            value: *value,
            range: *range,
            digits,
        })
    }
}
