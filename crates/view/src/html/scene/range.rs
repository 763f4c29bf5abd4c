//! Fields of a scene, and their ranges over all states that are shown, for the colour scales.

use crate::html::folder::RunFolder;
use serde_json::{Value, json};
use std::collections::HashMap;

/// Attributes of a field of a view.
pub(super) struct FieldInfo {
    /// Name.
    pub name: String,
    /// SI unit, empty for a pure number.
    pub unit: String,
    /// Description.
    pub doc: String,
}

impl FieldInfo {
    /// Returns the field with a name in a group of `results.h5`.
    pub fn read(run: &RunFolder, group: &str, name: &str) -> Self {
        let (unit, doc) = run.reader.described(&format!("{group}/{name}"));
        let name = name.to_owned();
        Self { name, unit, doc }
    }

    /// Returns the numeric fields of a group; each component of a vector is a field.
    pub fn numbers(run: &RunFolder, group: &str) -> Vec<Self> {
        let names = run.reader.datasets_in(group);
        let numbers = names.filter(|n| run.reader.width(&format!("{group}/{n}")) == Ok(1));
        numbers.map(|name| Self::read(run, group, name)).collect()
    }
}

/// The range of a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Smallest and largest value.
    pub all: [f64; 2],
    /// Range without the lowest and the highest hundredth of the values of each state.
    pub most: [f64; 2],
}

/// Ranges by group and name.
#[derive(Debug, Default)]
pub(super) struct Ranges(HashMap<(String, String), Range>);

impl Ranges {
    /// Extends the range by the values of a field in a state.
    pub fn note(&mut self, group: &str, name: &str, values: &[f64]) {
        let mut values: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        if values.is_empty() {
            return;
        }
        values.sort_unstable_by(f64::total_cmp);
        let (last, edge) = (values.len() - 1, values.len() / 100);
        let new = Range {
            all: [values[0], values[last]],
            most: [values[edge], values[last - edge]],
        };
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.0
            .entry((group.to_owned(), name.to_owned()))
            .and_modify(|old| {
                old.all = join(old.all, new.all);
                old.most = join(old.most, new.most);
            })
            .or_insert(new);
    }

    /// Describes a field for the page under a name, if the field has values.
    pub fn head(&self, group: &str, name: &str, field: &FieldInfo) -> Option<Value> {
        let range = self.0.get(&(group.to_owned(), name.to_owned()))?;
        Some(json!({
            "name": name, "unit": field.unit, "doc": field.doc,
            "all": range.all, "most": range.most,
        }))
    }
}
