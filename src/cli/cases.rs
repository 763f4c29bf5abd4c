//! `fretwork cases`: the shipped cases, studies, fits and patches.

use super::Failure;
use super::output::answer;
use crate::shipped::inputs::{self, InputKind, ShippedInput};
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Commands about shipped inputs.
#[derive(Subcommand, Debug)]
pub enum CasesCommand {
    /// List the shipped cases, studies, fits and patches with the commands that run them
    List(ListArgs),
    /// Copy one, with the files that it names, to change it
    #[command(after_help = "Example:\n  fretwork cases copy wheel_rail_fretting")]
    Copy(CopyArgs),
}

#[derive(Args, Debug)]
pub struct ListArgs {
    /// Only those with all of these words in their names or titles
    words: Vec<String>,
}

#[derive(Args, Debug)]
pub struct CopyArgs {
    /// Name, as `fretwork cases list` prints it
    name: String,
    /// Folder into which it is copied, in a folder `cases`, `studies`, `fits` or `patches`
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
}

/// Reads the path of an input of a kind, or the name of a shipped one.
pub fn input(kind: InputKind) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |given| inputs::find(kind, &given))
}

pub fn run(command: &CasesCommand) -> Result<(), Failure> {
    match command {
        CasesCommand::List(args) => list(args),
        CasesCommand::Copy(args) => copy(args),
    }
}

fn list(args: &ListArgs) -> Result<(), Failure> {
    let words: Vec<String> = args.words.iter().map(|w| w.to_lowercase()).collect();
    let found: Vec<ShippedInput> = ShippedInput::all()
        .filter(|input| {
            let text = format!("{} {}", input.name(), input.title()).to_lowercase();
            words.iter().all(|word| text.contains(word))
        })
        .collect();
    if found.is_empty() {
        return Err(Failure::Usage(format!(
            "nothing that is shipped has `{}` in its name or title",
            args.words.join(" ")
        )));
    }
    let width = found
        .iter()
        .map(|i| i.name().len())
        .max()
        .unwrap_or_default();
    let mut lines = Vec::new();
    for kind in InputKind::ALL {
        let mut of_kind = found.iter().filter(|input| input.kind == kind).peekable();
        if of_kind.peek().is_some() {
            lines.push(format!("fretwork {} ...", kind.command()));
        }
        lines.extend(of_kind.map(|i| format!("  {:width$}  {}", i.name(), i.title())));
    }
    answer(&lines.join("\n"))
}

fn copy(args: &CopyArgs) -> Result<(), Failure> {
    let found = inputs::named(&args.name).map_err(Failure::Usage)?;
    for input in found {
        let written = input.copy(&args.out);
        let written = written.map_err(|e| Failure::Failed(e.to_string()))?;
        for path in &written {
            answer(&format!("{}", path.display()))?;
        }
        let first = written.first().map(|p| p.display().to_string());
        answer(&format!(
            "to run it:\n  fretwork {} {}",
            input.kind.command(),
            first.unwrap_or_default()
        ))?;
    }
    Ok(())
}
