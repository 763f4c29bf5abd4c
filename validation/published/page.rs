//! The pages: one for each comparison, and an overview.

use crate::comparison::{Comparison, Failure, Inputs, Results, folder, markdown};
use crate::published::Published;
use crate::row::{CLOSE, Row, WIDE};
use crate::table::Table;
use fretwork::view::{Chart, draw_panels};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Pixels of a figure: under 120 kB as a file.
const SIZE: (u32, u32) = (660, 440);

/// A comparison with its results.
pub struct Section {
    name: &'static str,
    title: &'static str,
    /// `validation/NAME.md`.
    text: String,
    results: Option<Results>,
    /// Reasons why the results are missing or incomplete.
    missing: Vec<String>,
    /// Whether the reference is published.
    published: bool,
    /// Tables of its studies, by name.
    studies: Vec<(String, Table)>,
}

impl Section {
    pub fn of(root: &Path, comparison: &Comparison) -> Result<Self, Failure> {
        let at = |ending: &str| root.join(format!("validation/{}.{ending}", comparison.name));
        let mut section = Self {
            name: comparison.name,
            title: comparison.title,
            text: std::fs::read_to_string(at("md"))?,
            results: None,
            missing: Vec::new(),
            published: comparison.published,
            studies: Vec::new(),
        };
        let mut inputs = Inputs {
            tables: BTreeMap::new(),
            published: Published::read(&at("csv"))?,
        };
        for study in comparison.studies {
            let path = folder(root, study).join("table.csv");
            if !path.exists() {
                section.missing.push(format!("`{study}` was not run"));
                continue;
            }
            let mut table = Table::read(&path)?;
            table.programs = programs(&folder(root, study), &table)?;
            let done = table.runs.len();
            if done < table.wanted {
                section.missing.push(format!(
                    "{done} of the {} runs of `{study}` are done",
                    table.wanted
                ));
            }
            section.studies.push(((*study).to_owned(), table.clone()));
            inputs.tables.insert((*study).to_owned(), table);
        }
        match (comparison.show)(&inputs) {
            Ok(results) => section.results = Some(results),
            Err(e) => section.missing.push(e.to_string()),
        }
        Ok(section)
    }

    /// Draws each chart to a separate file.
    pub fn draw(&self, root: &Path) -> Result<(), Failure> {
        for (chart, file) in self.figures() {
            let chart = Chart {
                size_px: SIZE,
                ..chart.clone()
            };
            let path = root.join("docs/figures").join(file);
            draw_panels(&[chart], 1, &path)?;
        }
        Ok(())
    }

    fn figures(&self) -> impl Iterator<Item = (&Chart, String)> {
        let charts = self.results.iter().flat_map(|s| &s.charts);
        charts.enumerate().map(|(k, chart)| {
            let number = if k > 0 {
                format!("_{}", k + 1)
            } else {
                String::new()
            };
            (chart, format!("validation_{}{number}.png", self.name))
        })
    }

    /// Name of the comparison, and of its page.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// The page of the comparison, in `docs/validation`.
    pub fn page(&self) -> String {
        let mut text = format!("# {}\n\n{}\n", self.title, self.text.trim());
        for (study, table) in &self.studies {
            let measured = |version: &String| {
                format!("\nMeasured with version {version}: `validation/{study}.ron`.")
            };
            text += &table.programs.iter().map(measured).collect::<String>();
            text += &format!(
                "\n{} runs, {:.0} minutes of one processor.\n",
                table.runs.len(),
                table.seconds / 60.0
            );
        }
        for line in &self.missing {
            text += &format!("\nNot complete: {line}.\n");
        }
        if let Some(results) = &self.results {
            for (chart, file) in self.figures() {
                text += &format!("\n![{}](../figures/{file})\n", chart.title);
            }
            text += &format!("\n{}", results.points);
        }
        text
    }
}

/// Versions of the program that made the runs.
fn programs(folder: &Path, table: &Table) -> Result<Vec<String>, Failure> {
    let mut versions = BTreeSet::new();
    for run in &table.runs {
        let path = folder
            .join("runs")
            .join(run.text("folder"))
            .join("summary.json");
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let summary: serde_json::Value = serde_json::from_str(&text)?;
        let version = summary["version"].as_str().ok_or_else(|| {
            let path = path.display();
            format!("{path} does not say the `version` of the program; make the run again")
        })?;
        versions.insert(version.to_owned());
    }
    Ok(versions.into_iter().collect())
}

impl Section {
    /// Returns the rows of the summary. A verdict from an incomplete study says so.
    fn rows(&self) -> Vec<Vec<String>> {
        let link = format!("[{}](validation/{}.md)", self.title, self.name);
        let Some(results) = &self.results else {
            let mut cells = vec![link];
            cells.extend(std::iter::repeat_n("-".to_owned(), 5));
            let ran = self.studies.iter().any(|s| !s.1.runs.is_empty());
            cells.push(
                if ran {
                    "not decided: see its page"
                } else {
                    "not run"
                }
                .to_owned(),
            );
            return vec![cells];
        };
        let incomplete: Vec<String> = self
            .studies
            .iter()
            .filter(|(_, t)| t.runs.len() < t.wanted)
            .map(|(_, t)| format!("incomplete: {} of {} runs", t.runs.len(), t.wanted))
            .collect();
        let cells = |(k, row): (usize, &Row)| {
            let mut cells = row.cells();
            cells.insert(0, if k == 0 { link.clone() } else { String::new() });
            let judged = |v: &&mut String| *v != "-" && !incomplete.is_empty();
            if let Some(verdict) = cells.last_mut().filter(judged) {
                *verdict += &format!(" ({})", incomplete.join("; "));
            }
            cells
        };
        results.rows.iter().enumerate().map(cells).collect()
    }
}

/// The overview, `docs/validation.md`.
pub fn overview(sections: &[Section]) -> String {
    let mut text = include_str!("head.md")
        .replace("CLOSE", &format!("{:.0} %", 100.0 * CLOSE))
        .replace("WIDE", &format!("{:.0} %", 100.0 * WIDE));
    for (published, heading, column) in [
        (true, "Beside publications:", "published"),
        (
            false,
            "Beside an independent program of soft disks (DEM), whose numbers are not published:",
            "independent DEM",
        ),
    ] {
        let of = sections.iter().filter(|s| s.published == published);
        let rows: Vec<Vec<String>> = of.flat_map(Section::rows).collect();
        let columns = [
            "comparison",
            "quantity",
            "ours",
            "change with finer step and tolerance",
            column,
            "difference",
            "verdict",
        ];
        text += &format!("\n{heading}\n\n{}", markdown(&columns, &rows));
    }
    let tables = sections.iter().flat_map(|s| &s.studies);
    let versions: BTreeSet<&String> = tables.flat_map(|(_, table)| &table.programs).collect();
    for version in versions {
        text += &format!(
            "\nMeasured with version {version}: `cargo run --release --example validation`.\n"
        );
    }
    text
}
