//! Measured curves of `fretwork report` and `fretwork compare`.

use super::Failure;
use super::output::inform;
use crate::scene::quantity::quantity;
use clap::Args;
use fretwork_view::{MeasuredColumns, MeasuredCurve, Written, read_measured};
use std::path::PathBuf;

#[derive(Args, Debug, Default)]
pub struct MeasuredArgs {
    /// Table of a measured loop (delta, Q or mu), of friction by cycle (cycle, mu), or of a scar
    /// (x, depth), drawn in the figure of its kind; with any delimiter, decimal points or commas,
    /// and units in the headings, `delta (um)`; repeat for more
    #[arg(long, value_name = "FILE")]
    measured: Vec<PathBuf>,
    /// Columns of these tables that are named otherwise: delta=Weg (um)
    #[arg(
        long,
        value_name = "NAME=COLUMN (UNIT)",
        value_delimiter = ',',
        requires = "measured"
    )]
    columns: Vec<String>,
    /// Length of the measured contact across the motion, by which its force is divided for a run in
    /// two dimensions
    #[arg(long, value_name = "LENGTH", requires = "measured")]
    depth: Option<String>,
}

impl MeasuredArgs {
    /// Reads the curves.
    pub fn read(&self) -> Result<Vec<MeasuredCurve>, Failure> {
        let depth = self.depth.as_deref().map(measured_depth).transpose();
        let columns = depth.and_then(|depth| MeasuredColumns::parse(&self.columns, depth));
        let curves = columns.and_then(|columns| read_measured(&self.measured, &columns));
        curves.map_err(Failure::Usage)
    }
}

/// Parses the length (m) of a contact across the motion.
///
/// # Errors
/// The text is no length above zero; in a sentence.
pub fn measured_depth(text: &str) -> Result<f64, String> {
    match quantity(text, "m") {
        Ok(depth) if depth > 0.0 => Ok(depth),
        Ok(_) => Err(format!("depth: `{text}` must be above zero")),
        Err(e) => Err(format!("depth: {}", e.message)),
    }
}

/// Says which pictures were drawn.
pub fn pictures(written: &Written) {
    for path in &written.pictures {
        inform(&format!("{}: with measured curves", path.display()));
    }
}
