//! The page.

use crate::comparison::{Comparison, Failure, Found, Shown, folder, markdown};
use crate::published::Published;
use crate::row::{CLOSE, WIDE};
use crate::table::Table;
use fretwork::report::{Chart, DrawChart};
use std::collections::BTreeMap;
use std::path::Path;

/// Pixels of a figure: under 120 kB as a file.
const SIZE: (u32, u32) = (660, 440);

/// A comparison with what was found of it.
pub struct Section {
    name: &'static str,
    title: &'static str,
    /// `validation/NAME.md`.
    text: String,
    shown: Option<Shown>,
    /// Why it is not shown, or what of it is missing.
    missing: Vec<String>,
    /// Runs and processor time (s) of its studies.
    cost: Vec<(String, usize, f64)>,
}

impl Section {
    pub fn of(root: &Path, comparison: &Comparison) -> Result<Self, Failure> {
        let at = |ending: &str| root.join(format!("validation/{}.{ending}", comparison.name));
        let mut section = Self {
            name: comparison.name,
            title: comparison.title,
            text: std::fs::read_to_string(at("md"))?,
            shown: None,
            missing: Vec::new(),
            cost: Vec::new(),
        };
        let mut found = Found {
            tables: BTreeMap::new(),
            published: Published::read(&at("csv"))?,
        };
        for study in comparison.studies {
            let path = folder(root, study).join("table.csv");
            if !path.exists() {
                section.missing.push(format!("`{study}` was not run"));
                continue;
            }
            let table = Table::read(&path)?;
            let done = table.runs.len();
            if done < table.wanted {
                section.missing.push(format!(
                    "{done} of the {} runs of `{study}` are done",
                    table.wanted
                ));
            }
            section
                .cost
                .push(((*study).to_owned(), done, table.seconds));
            found.tables.insert((*study).to_owned(), table);
        }
        if !comparison.studies.is_empty() {
            match (comparison.show)(&found) {
                Ok(shown) => section.shown = Some(shown),
                Err(e) => section.missing.push(e.to_string()),
            }
        }
        Ok(section)
    }

    /// Draws each chart to a file of its own.
    pub fn draw(&self, root: &Path) -> Result<(), Failure> {
        for (chart, file) in self.figures() {
            let chart = Chart {
                size_px: SIZE,
                ..chart.clone()
            };
            chart.draw(&root.join("docs/figures").join(file))?;
        }
        Ok(())
    }

    fn figures(&self) -> impl Iterator<Item = (&Chart, String)> {
        let charts = self.shown.iter().flat_map(|s| &s.charts);
        charts.enumerate().map(|(k, chart)| {
            let number = if k > 0 {
                format!("_{}", k + 1)
            } else {
                String::new()
            };
            (chart, format!("validation_{}{number}.png", self.name))
        })
    }

    fn markdown(&self) -> String {
        let mut text = format!("## {}\n\n{}\n", self.title, self.text.trim());
        for (study, runs, seconds) in &self.cost {
            text += &format!(
                "\n`validation/{study}.ron`: {runs} runs, {:.0} minutes of one processor.\n",
                seconds / 60.0
            );
        }
        for line in &self.missing {
            text += &format!("\nNot complete: {line}.\n");
        }
        if let Some(shown) = &self.shown {
            for (chart, file) in self.figures() {
                text += &format!("\n![{}](figures/{file})\n", chart.title);
            }
            text += &format!("\n{}", shown.points);
        }
        text
    }
}

/// The whole page.
pub fn page(sections: &[Section]) -> String {
    let mut text = include_str!("head.md")
        .replace("CLOSE", &format!("{:.0} %", 100.0 * CLOSE))
        .replace("WIDE", &format!("{:.0} %", 100.0 * WIDE));
    let mut rows = Vec::new();
    for section in sections {
        let link = format!(
            "[{}](#{})",
            section.title,
            section.title.to_lowercase().replace(' ', "-")
        );
        match &section.shown {
            Some(shown) => {
                for (k, row) in shown.rows.iter().enumerate() {
                    let mut cells = row.cells();
                    cells.insert(0, if k == 0 { link.clone() } else { String::new() });
                    rows.push(cells);
                }
            }
            None => {
                let mut cells = vec![link];
                cells.extend(std::iter::repeat_n("-".to_owned(), 5));
                cells.push("not run".to_owned());
                rows.push(cells);
            }
        }
    }
    text += "\n";
    text += &markdown(
        &[
            "comparison",
            "quantity",
            "ours",
            "with finer step and tolerance",
            "published",
            "difference",
            "verdict",
        ],
        &rows,
    );
    for section in sections {
        text += &format!("\n{}", section.markdown());
    }
    text
}
