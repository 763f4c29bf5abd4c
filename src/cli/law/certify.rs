//! `fretwork law certify`.

use super::super::output::{answer, answer_json};
use super::super::{Failure, PluginArgs};
use super::{all_used, named, values};
use crate::certify::{Certificate, CheckOutcome, certify_in_child as test};
use crate::laws::{Plugin, SearchPath};
use clap::Args;
use std::fmt::Write as _;
use std::path::Path;

pub const EXAMPLES: &str = "Examples:
  fretwork law certify ./libfretwork_damage_my_law.so
  fretwork law certify damage/mac --set w=0.2
  fretwork law certify --all";

#[derive(Args, Debug)]
pub struct CertifyArgs {
    /// A library, or the name of a law on the search path (kind/name if laws of several kinds have
    /// it)
    #[arg(required_unless_present = "all")]
    law: Option<String>,
    /// Every law on the search path
    #[arg(long, conflicts_with = "law")]
    all: bool,
    /// A parameter, e.g. w=0.2; the others keep their defaults
    #[arg(long = "set", value_name = "NAME=VALUE")]
    sets: Vec<String>,
    /// Print the certificates as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub fn certify(args: &CertifyArgs) -> Result<(), Failure> {
    let path = args.plugins.search()?;
    let laws = match &args.law {
        Some(law) if Path::new(law).is_file() => vec![path.open(Path::new(law))?],
        Some(law) if law.contains(['/', '\\']) && !law.split('/').next().is_some_and(is_kind) => {
            return Err(Failure::Usage(format!("{law}: there is no such file")));
        }
        Some(law) => named(&path, law)?,
        None => {
            let laws = path.laws();
            path.test_loading(
                laws.iter()
                    .map(|(kind, name, _)| (*kind, name.as_str(), None)),
            );
            let all = laws
                .iter()
                .map(|(kind, name, place)| path.open_law(*kind, name, place));
            all.collect::<Result<_, _>>()?
        }
    };
    let mut used = vec![false; args.sets.len()];
    let mut certificates = Vec::new();
    for law in &laws {
        certificates.push(one(law, &args.sets, &mut used, &path)?);
    }
    all_used(&args.sets, &used, &laws.iter().collect::<Vec<_>>())?;
    if args.json {
        answer_json(&serde_json::to_string_pretty(&certificates).unwrap_or_default())?;
    } else {
        for certificate in &certificates {
            answer(&table(certificate))?;
        }
    }
    let broken: Vec<String> = certificates
        .iter()
        .filter(|c| !c.certified())
        .map(|c| format!("{} law `{}`", c.kind, c.name))
        .collect();
    if broken.is_empty() {
        Ok(())
    } else {
        Err(Failure::Failed(format!(
            "not certified: {}",
            broken.join(", ")
        )))
    }
}

fn is_kind(word: &str) -> bool {
    crate::laws::Kind::from_word(word).is_some()
}

fn one(
    law: &Plugin,
    sets: &[String],
    used: &mut [bool],
    path: &SearchPath,
) -> Result<Certificate, Failure> {
    Ok(test(law, &values(law, sets, used)?, None, path)?)
}

fn table(c: &Certificate) -> String {
    let mut out = format!(
        "{} law {} {} ({})\n",
        c.kind,
        c.name,
        c.version,
        &c.sha256[..12]
    );
    for line in &c.lines {
        let word = match line.outcome {
            CheckOutcome::Pass => "pass",
            CheckOutcome::Fail => "FAIL",
            CheckOutcome::Skip => "-",
        };
        let _ = writeln!(
            out,
            "  {word:<5} {:<16} {:>10.2e}  {}",
            line.check, line.number, line.text
        );
    }
    out += if c.certified() {
        "  certified"
    } else {
        "  NOT certified"
    };
    out
}
