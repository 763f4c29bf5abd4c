//! `fretwork law list` and `fretwork law show`.

use super::{Failure, PluginArgs, say};
use crate::laws::{Kind, Plugin};
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
        /// Name, or kind/name where several kinds have it (damage/mac)
        name: String,
        #[command(flatten)]
        plugins: PluginArgs,
    },
}

pub fn law(command: &LawCommand) -> Result<(), Failure> {
    match command {
        LawCommand::List { plugins } => {
            let path = plugins.search()?;
            let mut out = String::new();
            for (kind, name, file) in path.available() {
                match Plugin::open(&file) {
                    Ok(p) => {
                        let _ = writeln!(out, "{kind:<9} {name:<22} {}", p.doc);
                    }
                    Err(e) => {
                        let _ = writeln!(out, "{kind:<9} {name:<22} unusable: {e}");
                    }
                }
            }
            if out.is_empty() {
                out = "no laws found; looked in:\n".into();
                for folder in path.folders() {
                    let _ = writeln!(out, "  {}", folder.display());
                }
            }
            say(out.trim_end());
            Ok(())
        }
        LawCommand::Show { name, plugins } => {
            let path = plugins.search()?;
            let (kind, name) = match name.split_once('/') {
                Some((kind, name)) => {
                    let found = Kind::ALL.into_iter().find(|k| k.word() == kind);
                    let kind = found.ok_or_else(|| {
                        Failure::Usage(format!(
                            "there is no kind `{kind}`; use contact, cohesion, damage or wear"
                        ))
                    })?;
                    (Some(kind), name)
                }
                None => (None, name.as_str()),
            };
            let laws = path.available();
            let found: Vec<_> = laws
                .iter()
                .filter(|(k, n, _)| n == name && kind.is_none_or(|kind| kind == *k))
                .collect();
            if found.is_empty() {
                let near = crate::scene::source::nearest(name, laws.iter().map(|l| l.1.as_str()));
                let proposal = near.map_or(String::new(), |n| format!("; did you mean `{n}`?"));
                return Err(Failure::Usage(format!(
                    "there is no law named `{name}` on the search path{proposal}"
                )));
            }
            for (_, _, file) in found {
                say(&describe(&Plugin::open(file)?));
            }
            Ok(())
        }
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
        p.path.display(),
        p.sha256
    );
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
