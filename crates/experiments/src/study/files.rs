//! The files of a study: tables of runs and settings, the page and the picture.

use super::analysis::Analysis;
use super::figures::draw;
use super::page::sheet;
use super::plan::Plan;
use super::rows::Rows;
use super::settings::settings;
use crate::Error;
use crate::table::csv;
use std::collections::BTreeSet;

/// The table as a Parquet file, where the crate has the feature `parquet`.
pub(super) const PARQUET: &str = "table.parquet";

/// What was written beside the tables and the page.
#[derive(Debug, Default)]
pub struct Written {
    /// Whether there is a picture.
    pub picture: bool,
    /// A line for each table of a law: its file, or why there is none.
    pub law_tables: Vec<String>,
}

/// Writes the results of a study into its folder.
///
/// # Errors
/// A file cannot be written, or all runs in the folder belong to something else: tables are then
/// not changed.
pub fn write(plan: &Plan, rows: &Rows) -> Result<Written, Error> {
    let others = other_runs(plan, rows);
    if rows.counts().missing == plan.count() && others > 0 {
        return Err(Error::Failed(format!(
            "none of the {others} runs in {} is of this study by this program: its build, its laws, the case or a file that it names is another since; \
             tables are left as they are, `fretwork study run` makes the runs again",
            plan.launcher.folder.display()
        )));
    }
    let path = |name: &str| plan.out.join(name);
    csv::write(&rows.table, &path("table.csv"), csv::NumberFormat::Plain)?;
    #[cfg(feature = "parquet")]
    crate::table::parquet::write(&rows.table, &path(PARQUET))?;
    let analysis = Analysis::of(plan, &plan.design, rows);
    let settings = settings(plan, &analysis);
    csv::write(&settings, &path("settings.csv"), csv::NumberFormat::Plain)?;
    let page = sheet(plan, rows, &analysis).write(&path("study.html"));
    page.map_err(|e| Error::Failed(e.to_string()))?;
    let picture = path("study.png");
    let drawn = draw(plan, &analysis, &picture)?;
    if !drawn {
        // A picture of an earlier state would be mistaken for one of the present state.
        let _ = std::fs::remove_file(&picture);
    }
    let law_tables = plan.law_table.as_ref().map(|t| t.write(plan, rows));
    Ok(Written {
        picture: drawn,
        law_tables: law_tables.transpose()?.unwrap_or_default(),
    })
}

/// Returns the number of runs in the folder that are not points of the study by this program.
fn other_runs(plan: &Plan, rows: &Rows) -> usize {
    let count = rows.table.rows();
    let own: BTreeSet<&str> = (0..count).map(|k| rows.table.text("folder", k)).collect();
    let folders = std::fs::read_dir(&plan.launcher.folder);
    let runs = folders.into_iter().flatten().flatten();
    runs.filter(|f| f.path().join("run.json").is_file())
        .filter(|f| !own.contains(f.file_name().to_string_lossy().as_ref()))
        .count()
}
