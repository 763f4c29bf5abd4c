//! The command line: `run`, `check`, `law`, `solve`.
//!
//! Exit 0: done. 1: the run failed; what was computed is on disk. 2: the input is wrong.

mod check;
mod law;
mod progress;
mod run;
mod solve;

use crate::laws::{LawError, SearchPath};
use crate::record::RunError;
use crate::scene::InputError;
use clap::{Args, Parser, Subcommand};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

/// Tribology of dry contacts: third-body flow by non-smooth contact dynamics, with interface laws
/// loaded at run time.
#[derive(Parser, Debug)]
#[command(name = "fretwork", version, about, long_about = None, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Run a case to its end and record it
    #[command(
        after_help = "Example:\n  fretwork run cases/wheel_rail_fretting.ron --out results/a --set interfaces.third_body.damage=mohr-coulomb-brittle"
    )]
    Run(run::RunArgs),
    /// Say what a case activates and what it will cost, without running it
    Check(check::CheckArgs),
    /// Interface laws: list, show, make, drive and certify them
    #[command(subcommand)]
    Law(law::LawCommand),
    /// Solve contact problems of the field's shared collection (FCLIB files)
    #[command(
        after_help = "Exit code: 0 solved, 1 not solved within the limits, 2 wrong input.\n\nExample:\n  fretwork solve tests/fclib/gfc3d_OneContact.hdf5 --tolerance 1e-10 --out solution.hdf5"
    )]
    Solve(solve::SolveArgs),
}

/// The case and what is changed in it.
#[derive(Args, Debug)]
struct CaseArgs {
    /// The case file (RON)
    case: PathBuf,
    /// Change a value of the case, e.g. time.step=1e-6 or interfaces.third_body.damage=mac
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    plugins: PluginArgs,
}

/// Where plugins are looked for.
#[derive(Args, Debug)]
struct PluginArgs {
    /// Another folder with plugins; FRETWORK_PLUGIN_PATH holds further ones
    #[arg(long = "plugin-path", value_name = "DIR")]
    plugin_path: Vec<PathBuf>,
}

impl PluginArgs {
    fn search(&self) -> Result<SearchPath, Failure> {
        if let Some(missing) = self.plugin_path.iter().find(|p| !p.is_dir()) {
            return Err(Failure::Usage(format!(
                "--plugin-path {}: there is no such folder",
                missing.display()
            )));
        }
        Ok(SearchPath::new(&self.plugin_path))
    }
}

/// What ends the program early.
#[derive(Debug)]
enum Failure {
    Input(InputError),
    Usage(String),
    Run(RunError),
    /// What was asked ran, and failed.
    Failed(String),
}

impl From<InputError> for Failure {
    fn from(e: InputError) -> Self {
        Self::Input(e)
    }
}

impl From<RunError> for Failure {
    fn from(e: RunError) -> Self {
        Self::Run(e)
    }
}

impl From<LawError> for Failure {
    fn from(e: LawError) -> Self {
        Self::Usage(e.to_string())
    }
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match cli.command {
        Command::Run(args) => run::run(&args),
        Command::Check(args) => check::check(&args),
        Command::Law(command) => law::law(&command),
        Command::Solve(args) => solve::solve(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Input(e)) => {
            eprintln!("{}", e.render(std::io::stderr().is_terminal()));
            ExitCode::from(2)
        }
        Err(Failure::Usage(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Failed(message)) => {
            eprintln!("error: {message}");
            ExitCode::from(1)
        }
        Err(Failure::Run(e)) => {
            eprintln!("error: {e}");
            ExitCode::from(1)
        }
    }
}

/// Prints to standard output; a closed pipe ends the program quietly.
fn say(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stdout(), "{text}");
}
