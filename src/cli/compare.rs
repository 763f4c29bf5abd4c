//! `fretwork compare`.

use super::Failure;
use super::measured::{MeasuredArgs, pictures};
use super::output::inform;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub struct CompareArgs {
    /// Folders of runs, finished or not
    #[arg(value_name = "DIR", required = true, num_args = 2..)]
    dirs: Vec<PathBuf>,
    /// The page that is written
    #[arg(long, value_name = "FILE", default_value = "compare.html")]
    out: PathBuf,
    #[command(flatten)]
    measured: MeasuredArgs,
}

pub fn compare(args: &CompareArgs) -> Result<(), Failure> {
    let written = fretwork_view::compare(&args.dirs, &args.out, &args.measured.read()?)?;
    for line in fretwork_view::differences(&args.dirs)? {
        inform(&line);
    }
    let (path, runs) = (args.out.display(), args.dirs.len());
    inform(&format!(
        "{path} ({:.1} MB): {runs} runs side by side; open it in a browser",
        written.bytes as f64 / 1e6
    ));
    pictures(&written);
    Ok(())
}
