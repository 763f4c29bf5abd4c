//! `fretwork case`: the format of cases: conversion to another format, and its schema.

use super::output::{answer, answer_json};
use super::{Failure, PluginArgs, cases};
use crate::scene::Case;
use crate::scene::source::Format;
use crate::shipped::inputs::InputKind;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Examples of the help.
pub const EXAMPLES: &str = "Examples:
  fretwork case convert plane_shear --to yaml > plane_shear.yaml
  fretwork case schema > case.schema.json";

/// Commands about the format of cases.
#[derive(Subcommand, Debug)]
pub enum CaseCommand {
    /// Print a case in another format, with its names, expressions and units
    Convert(ConvertArgs),
    /// Print the JSON Schema of cases, with the laws on the search path
    Schema {
        #[command(flatten)]
        plugins: PluginArgs,
    },
}

#[derive(Args, Debug)]
pub struct ConvertArgs {
    /// The case file (RON, JSON or YAML), or the name of a shipped case
    #[arg(value_parser = cases::input(InputKind::Case))]
    case: PathBuf,
    /// Format of the text
    #[arg(long, value_name = "FORMAT")]
    to: CaseFormat,
}

/// A format of cases on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum CaseFormat {
    Ron,
    Json,
    Yaml,
}

pub fn run(command: &CaseCommand) -> Result<(), Failure> {
    match command {
        CaseCommand::Convert(args) => convert(args),
        CaseCommand::Schema { plugins } => {
            let path = plugins.search()?;
            let schema = crate::scene::schema::case(&super::law::usable(&path));
            answer_json(&format!("{schema:#}"))
        }
    }
}

fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let source = Case::source(&args.case)?;
    // What is no case has errors at their places, not a strange translation.
    Case::read(&source)?;
    let format = match args.to {
        CaseFormat::Ron => Format::Ron,
        CaseFormat::Json => Format::Json,
        CaseFormat::Yaml => Format::Yaml,
    };
    answer(source.in_format(format)?.trim_end())
}
