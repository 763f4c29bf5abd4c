//! `fretwork new case`: a first case from what is known about a test.

use super::Failure;
use super::output::{answer, report};
use crate::experiments::new_case::{Geometry, Input, Made, Question};
use crate::shipped::search_path;
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand};
use std::io::{BufRead, IsTerminal};
use std::path::PathBuf;

/// Commands that make files.
#[derive(Subcommand, Debug)]
pub enum NewCommand {
    /// Make a case from what is known about a test: geometry, load, motion, materials, debris
    #[command(after_help = EXAMPLES)]
    Case(NewCaseArgs),
}

/// Text below the options of the help.
const EXAMPLES: &str = "\
Numbers are written with their units: 20um, 200N/mm, '1.1 GPa'. What is missing is asked for on a terminal. Without --debris two elastic
bodies make the file of a patch (fretwork patch); everything else makes a case (fretwork run). Each number that is chosen is explained in it.

Examples:
  A cylinder that frets on a flat:
    fretwork new case mine.ron --geometry cylinder-on-flat --radius 10mm --length 10mm --load 200N/mm --amplitude 20um --material rail_steel_r260
  the debris between them:
    ... --debris magnetite --debris-size 2um
  A pin on a disc:
    fretwork new case pin.ron --geometry pin-on-disc --radius 3mm --track-radius 10mm --load 10N --speed 0.1m/s --material rail_steel_r260 --wear 1e-4
  Debris between wheel and rail:
    fretwork new case layer.ron --geometry wheel-on-rail --radius 0.46m --load 75kN --speed 100km/h --creepage 0.5% --material wheel_steel_er7,rail_steel_r260 --debris magnetite --debris-size 4um";

/// What is known; its options are the inputs of the geometries.
#[derive(Debug)]
pub struct NewCaseArgs {
    file: PathBuf,
    geometry: Option<Geometry>,
    values: Vec<(&'static str, String)>,
    force: bool,
}

impl Args for NewCaseArgs {
    fn augment_args(command: Command) -> Command {
        let names = Geometry::ALL.map(Geometry::name);
        let mut command = command
            .arg(
                Arg::new("file")
                    .value_name("FILE")
                    .default_value("case.ron")
                    .value_parser(clap::value_parser!(PathBuf))
                    .help("The file that is made"),
            )
            .arg(
                Arg::new("geometry")
                    .long("geometry")
                    .value_name("NAME")
                    .value_parser(PossibleValuesParser::new(names))
                    .help("The bodies, and how they move"),
            )
            .arg(
                Arg::new("force")
                    .long("force")
                    .action(clap::ArgAction::SetTrue)
                    .help("Replace the file if it is there"),
            );
        for input in Geometry::all_inputs() {
            let arg = Arg::new(input.key).long(input.key).value_name("VALUE");
            command = command.arg(arg.help(help(input)).allow_hyphen_values(true));
        }
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

fn help(input: &Input) -> String {
    let default = match input.default {
        Some(text) if !text.is_empty() => format!("; {text} by default"),
        _ => String::new(),
    };
    let mut asks = input.asks.to_owned();
    if let Some(first) = asks.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    format!("{asks}, such as {}{default}", input.example)
}

impl FromArgMatches for NewCaseArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let geometry = matches.get_one::<String>("geometry");
        let geometry = geometry.and_then(|name| Geometry::named(name).ok());
        let values = Geometry::all_inputs().filter_map(|input| {
            let value = matches.get_one::<String>(input.key)?;
            Some((input.key, value.clone()))
        });
        let file = matches.get_one::<PathBuf>("file");
        Ok(Self {
            file: file.cloned().unwrap_or_default(),
            geometry,
            values: values.collect(),
            force: matches.get_flag("force"),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

pub fn run(command: &NewCommand) -> Result<(), Failure> {
    let NewCommand::Case(args) = command;
    if args.file.exists() && !args.force {
        return Err(Failure::Usage(format!(
            "{} is there: name another file, or say --force",
            args.file.display()
        )));
    }
    let mut stdin = std::io::stdin().lock();
    let mut asks = stdin
        .is_terminal()
        .then_some(&mut stdin as &mut dyn BufRead);
    let geometry = match (args.geometry, &mut asks) {
        (Some(geometry), _) => geometry,
        (None, Some(from)) => ask_geometry(*from)?,
        (None, None) => {
            let names = Geometry::ALL.map(|g| format!("\n  {:<18} {}", g.name(), g.about()));
            return Err(Failure::Usage(format!(
                "give --geometry, one of{}",
                names.concat()
            )));
        }
    };
    let known = args.values.iter();
    let mut question = known.fold(Question::new(geometry), |q, (key, value)| {
        q.with(key, value)
    });
    if let Some(from) = &mut asks
        && question.missing().next().is_some()
    {
        question = ask(question, *from)?;
    }
    let made = question.make(&search_path());
    let made = made.map_err(Failure::of_options::<NewCaseArgs>)?;
    std::fs::write(&args.file, &made.text)
        .map_err(|e| Failure::Failed(format!("{}: {e}", args.file.display())))?;
    let file = args.file.display();
    let lines = match made.made {
        Made::Case => [
            format!("fretwork check {file}"),
            format!("fretwork run {file}"),
        ]
        .to_vec(),
        Made::Patch => vec![format!("fretwork patch {file}")],
    };
    answer(&format!(
        "{file} is made; to use it:\n  {}",
        lines.join("\n  ")
    ))
}

/// Asks for the geometry.
fn ask_geometry(from: &mut dyn BufRead) -> Result<Geometry, Failure> {
    report("Which bodies?");
    for geometry in Geometry::ALL {
        report(&format!("  {:<18} {}", geometry.name(), geometry.about()));
    }
    loop {
        match Geometry::named(line(from, "geometry")?.as_str()) {
            Ok(geometry) => return Ok(geometry),
            Err(why) => report(&why),
        }
    }
}

/// Asks for everything that was not said; an empty answer is the default.
fn ask(mut question: Question, from: &mut dyn BufRead) -> Result<Question, Failure> {
    let mut asked = Vec::new();
    loop {
        let next = question
            .inputs()
            .find(|input| !asked.contains(&input.key) && question.given(input.key).is_none());
        let Some(input) = next else {
            return Ok(question);
        };
        let default = match input.default {
            None => String::new(),
            Some("") => " [none]".to_owned(),
            Some(text) => format!(" [{text}]"),
        };
        report(&format!("{}, such as {}", input.asks, input.example));
        let text = line(from, &format!("{}{default}", input.key))?;
        if text.is_empty() && input.default.is_none() {
            continue;
        }
        let answered = question.clone().with(input.key, &text);
        if let Err(why) = answered.check(input.key) {
            report(&why);
            continue;
        }
        asked.push(input.key);
        if !text.is_empty() {
            question = answered;
        }
    }
}

/// Reads one answer.
fn line(from: &mut dyn BufRead, what: &str) -> Result<String, Failure> {
    report(&format!("{what}:"));
    let mut text = String::new();
    match from.read_line(&mut text) {
        Ok(0) | Err(_) => Err(Failure::Usage(
            "there are no more answers: nothing was made".to_owned(),
        )),
        Ok(_) => Ok(text.trim().to_owned()),
    }
}
