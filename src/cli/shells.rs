//! `fretwork completions` and `fretwork man`: what shells know about the program.

use super::output::answer;
use super::{Cli, Failure};
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use std::path::PathBuf;

/// Arguments of `completions`.
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Arguments of `man`.
#[derive(Args, Debug)]
pub struct ManArgs {
    /// Folder of the pages, which is made if it is not there, for instance
    /// ~/.local/share/man/man1
    folder: PathBuf,
}

/// The command line without the commands that only the program calls, which completions would list.
fn shown() -> Command {
    let all = Cli::command();
    let commands = all.get_subcommands().filter(|c| !c.is_hide_set()).cloned();
    Command::new("fretwork")
        .version(env!("CARGO_PKG_VERSION"))
        .about(all.get_about().cloned().unwrap_or_default())
        .args(all.get_arguments().cloned())
        .subcommands(commands)
}

pub fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut shown(), "fretwork", &mut text);
    answer(String::from_utf8_lossy(&text).trim_end())
}

pub fn man(args: &ManArgs) -> Result<(), Failure> {
    let folder = args.folder.display();
    let failed = |e: std::io::Error| Failure::Failed(format!("{folder} cannot be written: {e}"));
    std::fs::create_dir_all(&args.folder).map_err(failed)?;
    clap_mangen::generate_to(shown(), &args.folder).map_err(failed)?;
    answer(&format!(
        "{folder}: pages of `man fretwork`, `man fretwork-run` and the others"
    ))
}
