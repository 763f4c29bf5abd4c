//! `fretwork law`: list, show, new, drive, certify.

mod certify;
mod drive;
mod new;

use super::output::answer;
use super::{Failure, PluginArgs};
use crate::laws::{Kind, Plugin, SearchPath};
use clap::Subcommand;
use std::fmt::Write as _;

#[derive(Subcommand, Debug)]
pub enum LawCommand {
    /// All laws on the search path
    List {
        #[command(flatten)]
        plugins: PluginArgs,
    },
    /// Parameters, variables, units, ranges and reference of a law
    Show {
        /// Name, or kind/name if laws of several kinds have this name (damage/mac)
        name: String,
        #[command(flatten)]
        plugins: PluginArgs,
    },
    /// Make a law to fill in, in Rust, C or Fortran
    #[command(after_help = new::EXAMPLES)]
    New(new::NewArgs),
    /// Drive one contact along a path and print the response of the laws
    #[command(after_help = drive::EXAMPLES)]
    Drive(Box<drive::DriveArgs>),
    /// Test a law: energy, dissipation, frame indifference, step size, reproducible bits, invalid
    /// numbers
    #[command(after_help = certify::EXAMPLES)]
    Certify(certify::CertifyArgs),
}

pub fn law(command: &LawCommand) -> Result<(), Failure> {
    match command {
        LawCommand::List { plugins } => {
            let path = plugins.search()?;
            let mut out = String::new();
            let laws = path.laws();
            path.test_loading(
                laws.iter()
                    .map(|(kind, name, _)| (*kind, name.as_str(), None)),
            );
            for (kind, name, place) in laws {
                match path.open_law(kind, &name, &place) {
                    Ok(p) => {
                        let built_in = if p.built_in { " (built in)" } else { "" };
                        let _ = writeln!(out, "{kind:<9} {name:<22} {}{built_in}", p.doc);
                    }
                    Err(e) => {
                        let _ = writeln!(out, "{kind:<9} {name:<22} unusable: {e}");
                    }
                }
            }
            answer(out.trim_end())
        }
        LawCommand::Show { name, plugins } => {
            for plugin in named(&plugins.search()?, name)? {
                answer(&describe(&plugin))?;
            }
            Ok(())
        }
        LawCommand::New(args) => new::new(args),
        LawCommand::Drive(args) => drive::drive(args),
        LawCommand::Certify(args) => certify::certify(args),
    }
}

/// The laws on the search path that can be opened.
pub fn usable(path: &SearchPath) -> Vec<Plugin> {
    let laws = path.laws();
    path.test_loading(
        laws.iter()
            .map(|(kind, name, _)| (*kind, name.as_str(), None)),
    );
    let opened = laws
        .iter()
        .map(|(kind, name, place)| path.open_law(*kind, name, place));
    opened.flatten().collect()
}

/// The laws with a name, or with kind/name.
fn named(path: &SearchPath, name: &str) -> Result<Vec<Plugin>, Failure> {
    let (kind, name) = match name.split_once('/') {
        Some((kind, name)) => {
            let found = Kind::from_word(kind);
            let kind = found.ok_or_else(|| {
                Failure::Usage(format!("there is no kind `{kind}`; use {}", Kind::words()))
            })?;
            (Some(kind), name)
        }
        None => (None, name),
    };
    let laws = path.laws();
    let found: Vec<_> = laws
        .iter()
        .filter(|(k, n, _)| n == name && kind.is_none_or(|kind| kind == *k))
        .collect();
    if found.is_empty() {
        let near = crate::scene::source::nearest(name, laws.iter().map(|l| l.1.as_str()));
        let proposal = near.map_or_else(
            || "; `fretwork law list` shows the available ones".to_owned(),
            |n| format!("; did you mean `{n}`?"),
        );
        return Err(Failure::Usage(format!(
            "there is no law named `{name}` in {}{proposal}",
            path.searched()
        )));
    }
    let opened = found
        .into_iter()
        .map(|(kind, name, place)| path.open_law(*kind, name, place));
    Ok(opened.collect::<Result<_, _>>()?)
}

/// Parameter values of a law: defaults, overridden by `kind.name=value` or `name=value`.
fn values(plugin: &Plugin, sets: &[String], used: &mut [bool]) -> Result<Vec<f64>, Failure> {
    let mut values: Vec<f64> = plugin.parameters.iter().map(|p| p.default).collect();
    for (set, used) in sets.iter().zip(used) {
        let Some((key, value)) = set.split_once('=') else {
            return Err(Failure::Usage(format!(
                "--set {set}: expected NAME=VALUE or KIND.NAME=VALUE"
            )));
        };
        let name = match key.split_once('.') {
            Some((kind, name)) if kind == plugin.kind.word() => name,
            Some(_) => continue,
            None => key,
        };
        let Some(k) = plugin.parameters.iter().position(|p| p.name == name) else {
            continue;
        };
        *used = true;
        values[k] = value
            .parse()
            .map_err(|_| Failure::Usage(format!("--set {set}: `{value}` is not a number")))?;
    }
    plugin.validate(&values)?;
    Ok(values)
}

/// Checks that every `--set` was used by a law.
fn all_used(sets: &[String], used: &[bool], laws: &[&Plugin]) -> Result<(), Failure> {
    let Some(k) = used.iter().position(|u| !u) else {
        return Ok(());
    };
    let names: Vec<String> = laws
        .iter()
        .flat_map(|l| {
            l.parameters
                .iter()
                .map(|p| format!("{}.{}", l.kind, p.name))
        })
        .collect();
    Err(Failure::Usage(format!(
        "--set {}: no law here has this parameter; expected one of {}",
        sets[k],
        names.join(", ")
    )))
}

/// Describes the origin of a law's library.
fn library(p: &Plugin) -> String {
    match p.built_in {
        true => format!(
            "built into {} (the SHA-256 is the program's)",
            p.path.display()
        ),
        false => p.path.display().to_string(),
    }
}

fn describe(p: &Plugin) -> String {
    let mut out = format!(
        "{} law {} {}\n  {}\n  reference  {}\n  library    {}\n  sha256     {}\n",
        p.kind,
        p.name,
        p.version,
        p.doc,
        p.reference,
        library(p),
        p.sha256
    );
    for (path, sum) in &p.links {
        let _ = writeln!(out, "  links to   {}\n             {sum}", path.display());
    }
    for (title, fields) in [("parameters", &p.parameters), ("variables", &p.variables)] {
        if fields.is_empty() {
            continue;
        }
        let _ = writeln!(out, "  {title}");
        for f in fields {
            let range = if title == "parameters" {
                format!(" in [{:e}, {:e}]", f.minimum, f.maximum)
            } else {
                String::new()
            };
            let unit = if f.unit.is_empty() { "-" } else { &f.unit };
            let _ = writeln!(
                out,
                "    {:<18} {:>10e} {unit:<9}{range}  {}",
                f.name, f.default, f.doc
            );
        }
    }
    out.trim_end().to_owned()
}
