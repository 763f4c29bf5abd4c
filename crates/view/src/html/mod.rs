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

pub use compare::{compare, differences};
pub use laws::{LawInfo, LawParameter};
pub use sheet::{Block, Section, Sheet, SheetTable};

use crate::measured::{self, MeasuredCurve};
use crate::png::draw_panels;
use folder::RunFolder;
use fretwork_observe::chart::Figure;
use std::path::{Path, PathBuf};

pub use fretwork_observe::output::REPORT as FILE;
use fretwork_observe::output::{is_measured_picture, measured_picture};

/// Default size of a page in bytes.
pub const DEFAULT_BYTES: usize = 5_000_000;

/// Options of a report.
pub struct Options<'a> {
    /// Largest size of the page in bytes, `None` for no limit. States, fields and rows are omitted
    /// to keep within it, and the page states what was omitted.
    pub bytes: Option<usize>,
    /// Looks up a law by kind and name, for its parameters and reference.
    pub law: &'a dyn Fn(&str, &str) -> Option<LawInfo>,
    /// Measured curves, drawn in the figures of their kind.
    pub measured: &'a [MeasuredCurve],
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
    /// A measured curve does not fit to the figures.
    #[error("{reason}")]
    Measured {
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
        !matches!(self, Self::Unwritable { .. })
    }
}

/// Files that were written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// Size of the page (bytes).
    pub bytes: usize,
    /// Pictures of the figures with measured curves.
    pub pictures: Vec<PathBuf>,
}

/// Writes the report of the run in a folder as `report.html` in that folder, and figures with
/// measured curves as PNG files beside it, `NAME_measured.png`; those of an older report are
/// removed.
///
/// # Errors
/// The folder holds no run, a measured curve does not fit to it, or a file cannot be written.
pub fn report(folder: &Path, options: &Options<'_>) -> Result<Written, ReportError> {
    let run = RunFolder::open(folder)?;
    let figures = page::report::with_measured(&run, options.measured)?;
    let html = page::report::page(&run, options);
    let page = folder.join(FILE);
    write(&page, &html)?;
    let pictures = pictures(&figures, |figure| folder.join(measured_picture(figure)))?;
    remove_older(folder, &pictures)?;
    Ok(Written {
        page,
        bytes: html.len(),
        pictures,
    })
}

/// Removes pictures with measured curves from a folder, but for those just written.
fn remove_older(folder: &Path, written: &[PathBuf]) -> Result<(), ReportError> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let older = entries.filter(|e| e.file_name().to_str().is_some_and(is_measured_picture));
    for path in older.map(|e| e.path()).filter(|p| !written.contains(p)) {
        std::fs::remove_file(&path).map_err(|e| ReportError::Unwritable {
            reason: e.to_string(),
            path,
        })?;
    }
    Ok(())
}

/// Draws the figures with measured curves as PNG files of these names.
fn pictures(
    figures: &[Figure],
    name: impl Fn(&str) -> PathBuf,
) -> Result<Vec<PathBuf>, ReportError> {
    let mut out = Vec::new();
    for figure in figures.iter().filter(|f| measured::is_in(f)) {
        let path = name(&figure.name);
        draw_panels(&figure.headed(), figure.columns, &path).map_err(|e| {
            ReportError::Unwritable {
                path: path.clone(),
                reason: e.to_string(),
            }
        })?;
        out.push(path);
    }
    Ok(out)
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
