//! The command line: `run`, `report`, `compare`, `check`, `contact-patch`, `patch`, `case`,
//! `cases`, `new`, `law`, `material`, `solve`, `study`, `fit`, `trade`, `lsp`, `completions`,
//! `man`.
//!
//! Exit codes: 0 success; 1 the run failed, but what was computed is on disk; 2 invalid input.

mod again;
mod case;
mod cases;
mod check;
mod compare;
mod contact_patch;
mod ending;
mod experiment;
mod fit;
mod law;
mod lsp;
mod material;
mod measured;
mod new;
mod number;
mod observers;
mod output;
mod patch;
mod progress;
mod report;
mod run;
mod shells;
mod solve;
mod study;
mod trade;

pub use self::check::{CheckLine, lines as check_lines, run_time as check_run_time};
pub use self::measured::measured_depth;
pub use self::observers::{Added, add as add_observers};
pub use self::report::make as make_report;
pub use self::run::{default_folder, place as place_of};
pub use fretwork_view::{
    MeasuredColumns, MeasuredCurve, ReportError, compare as compare_runs, read_measured,
};

use crate::certify::{CERTIFY_IN_CHILD, certify_requested};
use crate::experiments::RunSetup;
use crate::laws::watch::{RescueOutcome, watch};
use crate::laws::{LawError, SearchPath, child, library, loading};
use crate::record::{RunError, check_names};
use crate::scene::InputError;
use crate::shipped::built_in;
use crate::shipped::inputs::InputKind;
use clap::{Args, Parser, Subcommand};
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

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
        allow_negative_numbers = true,
        after_help = "Example:\n  fretwork run cases/wheel_rail_fretting.ron --out results/a --set interfaces.third_body.damage=mohr-coulomb-brittle"
    )]
    Run(run::RunArgs),
    /// Make one HTML page of a run: results, warnings, figures, the scene over time, all inputs
    #[command(
        after_help = "Exit code: 0 done, 1 the page cannot be written, 2 the folder holds no run.\n\nExample:\n  fretwork report results/wheel_rail_fretting --size 20"
    )]
    Report(report::ReportArgs),
    /// Make one HTML page of several runs side by side: inputs that differ, results, figures
    #[command(
        after_help = "Exit code: 0 done, 1 the page cannot be written, 2 a folder holds no run.\n\nExample:\n  fretwork compare results/a results/b --out a_b.html"
    )]
    Compare(compare::CompareArgs),
    /// Print what a case uses and what it will cost, without running it or writing files
    Check(check::CheckArgs),
    /// From load, radii and moduli to a contact patch: pressure, size, slip, friction and wear
    /// against creepage
    #[command(after_help = contact_patch::EXAMPLES)]
    ContactPatch(contact_patch::ContactPatchArgs),
    /// Solve a contact patch that rolls or frets with the laws of an interface: adhesion, wear,
    /// temperature, fields over the patch
    #[command(after_help = patch::EXAMPLES)]
    Patch(patch::PatchArgs),
    /// Shipped cases, studies, fits and patches: list them, copy one to change it
    #[command(subcommand)]
    Cases(cases::CasesCommand),
    /// The format of cases: conversion to JSON, YAML and RON, the JSON Schema
    #[command(subcommand, after_help = case::EXAMPLES)]
    Case(case::CaseCommand),
    /// Make a case from what is known about a test
    #[command(subcommand)]
    New(new::NewCommand),
    /// Interface laws: list, show, make, drive and certify them
    #[command(subcommand)]
    Law(law::LawCommand),
    /// Materials: list them, show all numbers of one with their sources, check own files
    #[command(subcommand, after_help = material::EXAMPLES)]
    Material(material::MaterialCommand),
    /// Solve contact problems in FCLIB files, the format of the shared benchmark collection
    #[command(
        allow_negative_numbers = true,
        after_help = "Exit code: 0 solved, 1 not solved within the limits, 2 wrong input.\n\nExample:\n  fretwork solve tests/fclib/gfc3d_OneContact.hdf5 --tolerance 1e-10 --out solution.hdf5"
    )]
    Solve(solve::SolveArgs),
    /// Run a case at many points of its factors, here or by another engine, and gather one table
    #[command(
        subcommand,
        after_help = "Exit code: 0 done, also where runs failed (the table says which), 1 interrupted, or a run left no result, 2 wrong input.\n\nExample:\n  fretwork study run studies/friction_against_grain_friction.ron --jobs 2\n\ndocs/study.md says what a study is made of and how to run it on a cluster."
    )]
    Study(study::StudyCommand),
    /// Find parameters of a case for which its runs give measured curves, with intervals
    #[command(
        after_help = "Exit code: 0 done, also where the measurements do not determine a parameter (it says so), 1 interrupted, or nothing was found, 2 wrong input.\n\nExample:\n  fretwork fit fits/bond_opening.ron --jobs 2\n\ndocs/fit.md says what a fit is made of and what its intervals mean."
    )]
    Fit(fit::FitArgs),
    /// What accuracy costs: vary step, tolerance, solver and more, and compare with the finest over
    /// seeds
    #[command(
        allow_negative_numbers = true,
        after_help = "Exit code: 0 done, also where the budget ended it early (it says so), 1 no reference could be run, 2 wrong input.\n\nExample:\n  fretwork trade cases/shear_cell_3d.ron --output friction_coefficient=5% --setting step --setting tolerance --budget 30m\n\ndocs/trade.md says how errors are tested and what the search does not explore."
    )]
    Trade(trade::TradeArgs),
    /// Serve an editor that edits cases: errors, completion, documentation (language server)
    #[command(after_help = "Editors start it, see docs/editors.md.")]
    Lsp(lsp::LspArgs),
    /// Print the completions of a shell for this program
    #[command(
        after_help = "Example, in ~/.bashrc:\n  source <(fretwork completions bash)\n\ndocs/editors.md has the other shells."
    )]
    Completions(shells::CompletionsArgs),
    /// Write the manual pages of this program
    #[command(after_help = "Example:\n  fretwork man ~/.local/share/man/man1 && man fretwork-run")]
    Man(shells::ManArgs),
    /// Internal: opens libraries in a separate process
    #[command(name = loading::TRY_LIBRARIES, hide = true)]
    TryLibraries(ChildArgs),
    /// Internal: certifies a law in a separate process
    #[command(name = CERTIFY_IN_CHILD, hide = true)]
    CertifyInChild(ChildArgs),
}

/// Arguments of internal subcommands.
#[derive(Args, Debug)]
struct ChildArgs {
    #[arg(long, default_value_t = LAW_TIMEOUT)]
    law_timeout: f64,
}

impl ChildArgs {
    fn help(&self, task: impl FnOnce() -> Result<(), String>) -> Result<(), Failure> {
        watch_laws(law_limit(self.law_timeout)?)?;
        task().map_err(Failure::Failed)
    }
}

/// The case and changes to it.
#[derive(Args, Debug)]
struct CaseArgs {
    /// The case file (RON, JSON or YAML), or the name of a shipped case
    #[arg(value_parser = cases::input(InputKind::Case))]
    case: PathBuf,
    /// Change a value of the case, e.g. time.step=1e-6 or interfaces.third_body.damage=mac
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    plugins: PluginArgs,
}

/// Default limit on the duration of a call of a law (s).
const LAW_TIMEOUT: f64 = 60.0;

/// Largest accepted limit on a call of a law (s), about thirty years.
const LONGEST: f64 = 1e9;

/// Search path of plugins.
#[derive(Args, Debug)]
struct PluginArgs {
    /// Additional folder with plugins; FRETWORK_PLUGIN_PATH lists further ones
    #[arg(long = "plugin-path", value_name = "DIR")]
    plugin_path: Vec<PathBuf>,
    /// Open plugins even from folders that any user may write to
    #[arg(long)]
    trust_plugins: bool,
    /// Stop if a law does not return from a call within this time; 0 for no limit
    #[arg(long, value_name = "SECONDS", default_value_t = LAW_TIMEOUT, allow_negative_numbers = true)]
    law_timeout: f64,
}

impl PluginArgs {
    /// Returns these arguments as words, for another call of the program.
    fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        for folder in &self.plugin_path {
            // The other call may be made from another folder.
            let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
            words.extend(["--plugin-path".to_owned(), folder.display().to_string()]);
        }
        words.extend(self.trust_plugins.then(|| "--trust-plugins".to_owned()));
        if self.law_timeout != LAW_TIMEOUT {
            words.extend(["--law-timeout".to_owned(), self.law_timeout.to_string()]);
        }
        words
    }

    /// Returns laws, plugins and observers of the runs of experiments.
    fn run_setup(&self) -> Result<RunSetup, Failure> {
        Ok(RunSetup {
            search: self.search()?,
            plugins: self.words(),
            observers: observers::all,
            check_names,
        })
    }

    fn search(&self) -> Result<SearchPath, Failure> {
        if let Some(missing) = self.plugin_path.iter().find(|p| !p.is_dir()) {
            return Err(Failure::Usage(format!(
                "--plugin-path {}: there is no such folder",
                missing.display()
            )));
        }
        let limit = law_limit(self.law_timeout)?;
        child::enable(limit);
        watch_laws(limit)?;
        output::keep_from_laws();
        let path = SearchPath::new(&self.plugin_path).with_built_in(built_in());
        Ok(if self.trust_plugins {
            path.trusting()
        } else {
            path
        })
    }
}

/// Limit on the duration of a call of a law; `None` for no limit.
fn law_limit(seconds: f64) -> Result<Option<Duration>, Failure> {
    if !(0.0..=LONGEST).contains(&seconds) {
        return Err(Failure::Usage(format!(
            "--law-timeout {seconds}: give a time in seconds from 0 to {LONGEST:e}, 0 for none"
        )));
    }
    let limit = Duration::from_secs_f64(seconds);
    if !limit.is_zero() && limit < Duration::from_millis(100) {
        return Err(Failure::Usage(format!(
            "--law-timeout {seconds}: a valid call may take that long; give at least 0.1 s, or 0 for none"
        )));
    }
    Ok((!limit.is_zero()).then_some(limit))
}

/// Ends the program if a law does not return.
fn watch_laws(limit: Option<Duration>) -> Result<(), Failure> {
    let Some(limit) = limit else {
        return Ok(());
    };
    watch(limit, |who, saved: RescueOutcome| {
        let left = saved.words();
        output::report(&format!(
            "error: {who}; the program ends here; {left} (a longer wait: --law-timeout)"
        ));
        ending::now(ending::FAILED);
    })
    .map_err(|e| {
        Failure::Failed(format!(
            "cannot start the watchdog threads for laws: {e}; allow more threads (ulimit -u), or disable the limit: --law-timeout 0"
        ))
    })
}

/// Reason for ending early, which determines the exit code.
#[derive(Debug)]
enum Failure {
    Input(InputError),
    Usage(String),
    Run(RunError),
    /// The command ran and failed.
    Failed(String),
}

impl From<InputError> for Failure {
    fn from(e: InputError) -> Self {
        Self::Input(e)
    }
}

impl From<RunError> for Failure {
    fn from(e: RunError) -> Self {
        match e {
            RunError::Input(e) => Self::Input(*e),
            e => Self::Run(e),
        }
    }
}

impl From<LawError> for Failure {
    fn from(e: LawError) -> Self {
        match e {
            LawError::Untested { .. } => Self::Failed(e.to_string()),
            e => Self::Usage(e.to_string()),
        }
    }
}

impl Failure {
    /// Invalid words, by a sentence that may begin with the names of options of a command and a
    /// colon, which are then written as on the command line.
    fn of_options<A: Args>(sentence: String) -> Self {
        let command = A::augment_args(clap::Command::new(""));
        let known: Vec<&str> = command.get_opts().filter_map(|o| o.get_long()).collect();
        let written = sentence.split_once(": ").and_then(|(names, rest)| {
            let names = names.split(", ").map(|name| {
                let name = name.replace('_', "-");
                known.contains(&name.as_str()).then(|| format!("--{name}"))
            });
            let names: Option<Vec<String>> = names.collect();
            Some(format!("{}: {rest}", names?.join(", ")))
        });
        Self::Usage(written.unwrap_or(sentence))
    }
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().collect();
    ExitCode::from(call(&words))
}

/// Runs the program with given words, of which the first is its name; returns the exit code. For
/// processes other than the program, such as a Python interpreter, see [`crate::program`]. It may
/// be called once per process, since it installs the program's signal handlers.
pub fn call(words: &[OsString]) -> u8 {
    again::keep(words);
    // The main thread uses a pool with one thread; only `run --threads` uses more.
    let here = rayon::ThreadPoolBuilder::new().num_threads(1);
    let _ = here.use_current_thread().build_global();
    let outcome = match Cli::try_parse_from(words) {
        Ok(cli) => {
            let _armed = ending::arm();
            run(cli.command)
        }
        // Help and version are answers; other errors are invalid input.
        Err(e) if !e.use_stderr() => output::delivered(e.print()),
        Err(e) => {
            let _ = e.print();
            return 2;
        }
    };
    let (message, code) = match outcome {
        Ok(()) => return 0,
        Err(Failure::Input(e)) => {
            output::report_rendered(&e.render(std::io::stderr().is_terminal()));
            return 2;
        }
        Err(Failure::Usage(message)) => (format!("error: {message}"), 2),
        Err(Failure::Failed(message)) => (format!("error: {message}"), 1),
        Err(Failure::Run(e)) => (format!("error: {e}"), if e.is_input() { 2 } else { 1 }),
    };
    output::report(&message);
    code
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(args) => run::run(&args),
        Command::Report(args) => report::report(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Check(args) => check::check(&args),
        Command::ContactPatch(args) => contact_patch::contact_patch(&args),
        Command::Patch(args) => patch::patch(&args),
        Command::Cases(command) => cases::run(&command),
        Command::Case(command) => case::run(&command),
        Command::New(command) => new::run(&command),
        Command::Law(command) => law::law(&command),
        Command::Material(command) => material::material(&command),
        Command::Solve(args) => solve::solve(&args),
        Command::Study(command) => study::study(&command),
        Command::Fit(args) => fit::fit(&args),
        Command::Trade(args) => trade::trade(&args),
        Command::Lsp(args) => lsp::serve(&args),
        Command::Completions(args) => shells::completions(&args),
        Command::Man(args) => shells::man(&args),
        Command::TryLibraries(args) => args.help(library::try_libraries),
        Command::CertifyInChild(args) => args.help(|| certify_requested(&built_in())),
    }
}
