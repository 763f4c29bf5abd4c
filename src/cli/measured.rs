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
        let depth = self.depth.as_ref().map(|text| {
            let depth = quantity(text, "m").map_err(|e| e.message);
            let depth = depth.and_then(|d| match d > 0.0 {
                true => Ok(d),
                false => Err(format!("`{text}` must be above zero")),
            });
            depth.map_err(|why| Failure::Usage(format!("--depth: {why}")))
        });
        let columns = MeasuredColumns::parse(&self.columns, depth.transpose()?);
        let columns = columns.map_err(Failure::Usage)?;
        read_measured(&self.measured, &columns).map_err(Failure::Usage)
    }
}

/// Says which pictures were drawn.
pub fn pictures(written: &Written) {
    for path in &written.pictures {
        inform(&format!("{}: with measured curves", path.display()));
    }
}
