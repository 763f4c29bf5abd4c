//! `fretwork report`, and the report at the end of a run.

use super::Failure;
use super::measured::{MeasuredArgs, pictures};
use super::output::{inform, report as complain};
use crate::laws::{Kind, SearchPath};
use crate::shipped::built_in;
use crate::shipped::search_path;
use clap::Args;
use fretwork_view::{
    DEFAULT_BYTES, LawInfo, LawParameter, MeasuredCurve, Options, ReportError, Written,
};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct ReportArgs {
    /// Folder of a run, finished or not
    dir: PathBuf,
    /// Put all recorded states and rows into the page, however large it gets
    #[arg(long, conflicts_with = "size")]
    full: bool,
    /// Largest size of the page (MB); states, fields and rows are left out to stay below it, which
    /// the page says
    #[arg(long, value_name = "MB", default_value_t = 5.0)]
    size: f64,
    #[command(flatten)]
    measured: MeasuredArgs,
}

impl From<ReportError> for Failure {
    fn from(e: ReportError) -> Self {
        if e.is_input() {
            Self::Usage(e.to_string())
        } else {
            Self::Failed(e.to_string())
        }
    }
}

pub fn report(args: &ReportArgs) -> Result<(), Failure> {
    if !(args.size.is_finite() && (0.5..=2000.0).contains(&args.size)) {
        return Err(Failure::Usage(format!(
            "--size {}: give a size from 0.5 to 2000 MB, or --full",
            args.size
        )));
    }
    let bytes = (!args.full).then_some((args.size * 1e6) as usize);
    let written = make(&args.dir, bytes, &args.measured.read()?)?;
    inform(&format!(
        "{} ({:.1} MB): open it in a browser",
        written.page.display(),
        written.bytes as f64 / 1e6
    ));
    pictures(&written);
    Ok(())
}

/// Makes the report of a folder with at most this number of bytes, and with measured curves.
///
/// # Errors
/// The folder has no run, a curve does not fit to it, or files cannot be read or written.
pub fn make(
    folder: &Path,
    bytes: Option<usize>,
    measured: &[MeasuredCurve],
) -> Result<Written, ReportError> {
    let law = |kind: &str, name: &str| law(&search_path(), kind, name);
    let options = Options {
        bytes,
        law: &law,
        measured,
    };
    let make = || fretwork_view::report(folder, &options);
    // A defect in making the page must not fail the run.
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(make)).unwrap_or_else(|_| {
        Err(ReportError::Unwritable {
            path: folder.join(fretwork_view::FILE),
            reason: "the program failed by an error of its own; please report it".to_owned(),
        })
    })
}

/// Makes the report of a run that has just ended; returns whether there is one. A failure is
/// reported, and does not change how the run ended.
pub fn of_run(folder: &Path) -> bool {
    let made = make(folder, Some(DEFAULT_BYTES), &[]);
    if let Err(e) = &made {
        complain(&format!("warning: there is no report: {e}"));
    }
    made.is_ok()
}

/// Looks up a law of the program itself: a report never opens other libraries.
fn law(path: &SearchPath, kind: &str, name: &str) -> Option<LawInfo> {
    let kind = Kind::from_word(kind)?;
    if !built_in().names().any(|own| own == (kind, name)) {
        return None;
    }
    let plugin = path
        .find(kind, name)
        .ok()
        .filter(|p| path.belongs_to_program(p))?;
    let parameter = |f: &crate::laws::LawField| LawParameter {
        name: f.name.clone(),
        unit: f.unit.clone(),
        default: f.default,
        doc: f.doc.clone(),
    };
    Some(LawInfo {
        doc: plugin.doc.clone(),
        reference: plugin.reference.clone(),
        parameters: plugin.parameters.iter().map(parameter).collect(),
    })
}
