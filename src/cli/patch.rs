//! `fretwork patch`: a contact patch that rolls or frets, by the laws of an interface.

use super::experiment::results;
use super::output::{answer_json, inform, report};
use super::{Failure, PluginArgs};
use crate::experiments::patch::{OWNER, PatchFile, files, solve};
use clap::Args;
use std::io::IsTerminal;
use std::path::PathBuf;

/// Text below the options of the help.
pub const EXAMPLES: &str = "\
Exit code: 0 solved, 1 no solution, 2 wrong input.

Example:
  fretwork patch patches/wheel_on_rail.ron

docs/patch.md says what the file is made of and what the numbers mean.";

#[derive(Args, Debug)]
pub struct PatchArgs {
    /// The file of the patch (RON)
    patch: PathBuf,
    /// Folder of the results; results/patch/<patch> by default
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show no progress; print the result as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub fn patch(args: &PatchArgs) -> Result<(), Failure> {
    let out = results(args.out.as_deref(), "patch", &args.patch);
    let search = args.plugins.search()?;
    let file = PatchFile::read(&args.patch)?;
    let _lock = OWNER.take(&out)?;
    let shows = !args.json && std::io::stderr().is_terminal();
    let outcome = solve(&file, &search, &mut |done, all| {
        if shows {
            report(&format!("point {done} of {all}"));
        }
    })?;
    let json = files::write(&file, &outcome, &out)?;
    if args.json {
        return answer_json(&json);
    }
    inform(&outcome.answer.text());
    inform(&format!(
        "{0}/patch.html, {0}/patch.json, {0}/patch.h5",
        out.display()
    ));
    Ok(())
}
