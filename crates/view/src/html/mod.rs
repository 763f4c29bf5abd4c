//! Pages as HTML: reports of runs, comparisons of several runs, and pages of studies and fits.
//!
//! ```text
//! folder of a run ─► folder (results.h5, summary.json) ─► statistics, figures, scene, materials ─► page ─► report.html
//! ```
//! Data are in the page as gzip in base64 and are unpacked by the browser. Names, units and
//! descriptions of columns and fields are those of the attributes in `results.h5`. A page loads
//! nothing from a network; its content security policy forbids it.

mod arrays;
mod compare;
pub(crate) mod figures;
mod folder;
mod laws;
mod materials;
mod page;
mod results;
mod scene;
mod sheet;
mod statistics;

pub use compare::compare;
pub use laws::{LawInfo, LawParameter};
pub use sheet::{Block, Section, Sheet, SheetTable};

use folder::RunFolder;
use std::path::{Path, PathBuf};

pub use fretwork_observe::output::REPORT as FILE;

/// Default size of a page in bytes.
pub const DEFAULT_BYTES: usize = 5_000_000;

/// Options of a report.
pub struct Options<'a> {
    /// Largest size of the page in bytes, `None` for no limit. States, fields and rows are omitted
    /// to keep within it, and the page states what was omitted.
    pub bytes: Option<usize>,
    /// Looks up a law by kind and name, for its parameters and reference.
    pub law: &'a dyn Fn(&str, &str) -> Option<LawInfo>,
}

impl std::fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options")
            .field("bytes", &self.bytes)
            .finish_non_exhaustive()
    }
}

/// Reason why there is no report.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReportError {
    /// The folder contains no readable run.
    #[error("{}: {reason}", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
        /// Reason, and what to do.
        reason: String,
    },
    /// The page cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

impl ReportError {
    /// Whether the input is wrong, and not the place where the page goes.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::NoRun { .. })
    }
}

/// Writes the report of the run in a folder as `report.html` in that folder; returns its path and
/// its size in bytes.
///
/// # Errors
/// The folder holds no run, or the page cannot be written.
pub fn report(folder: &Path, options: &Options<'_>) -> Result<(PathBuf, usize), ReportError> {
    let run = RunFolder::open(folder)?;
    let html = page::report::page(&run, options);
    let path = folder.join(FILE);
    write(&path, &html)?;
    Ok((path, html.len()))
}

/// Writes a page under another name and renames it, so that it is never incomplete.
fn write(path: &Path, html: &str) -> Result<(), ReportError> {
    let unwritable = |e: std::io::Error| ReportError::Unwritable {
        path: path.to_owned(),
        reason: e.to_string(),
    };
    let part = path.with_extension("html.part");
    let written = std::fs::write(&part, html).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|e| {
        // An incomplete page is of no use.
        let _ = std::fs::remove_file(&part);
        unwritable(e)
    })
}
