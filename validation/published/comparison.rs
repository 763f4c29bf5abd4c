//! A comparison: its studies, and the results drawn from their tables.

use crate::published::Published;
use crate::row::Row;
use crate::table::Table;
use fretwork::view::Chart;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// One page. `validation/NAME.csv` has the published numbers, `validation/NAME.md`
/// the text.
pub struct Comparison {
    pub name: &'static str,
    pub title: &'static str,
    /// `validation/STUDY.ron`.
    pub studies: &'static [&'static str],
    /// Whether the reference is published. Otherwise it is from an independent program.
    pub published: bool,
    pub show: fn(&Inputs) -> Result<Results, Failure>,
}

/// Inputs of a comparison: tables of its studies, and the published numbers.
pub struct Inputs {
    pub tables: BTreeMap<String, Table>,
    pub published: Published,
}

impl Inputs {
    /// Returns the table of a study, whose runs have numbers in these columns.
    pub fn table(&self, study: &str, columns: &[&str]) -> Result<&Table, Failure> {
        let table = self
            .tables
            .get(study)
            .ok_or_else(|| format!("`{study}` has no table"))?;
        table
            .require(columns)
            .map_err(|e| format!("`{study}`: {e}"))?;
        Ok(table)
    }
}

/// Rows of the summary, a Markdown table of the single points, and charts of the figure.
#[derive(Default)]
pub struct Results {
    pub rows: Vec<Row>,
    pub points: String,
    pub charts: Vec<Chart>,
}

/// Returns the folder in which a study keeps its runs.
pub fn folder(root: &Path, study: &str) -> PathBuf {
    root.join("target/validation").join(study)
}

/// A table in Markdown.
pub fn markdown(heading: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(heading.iter().map(|h| (*h).to_owned()).collect());
    text += &format!("|{}\n", "---|".repeat(heading.len()));
    for row in rows {
        text += &line(row.clone());
    }
    text
}
