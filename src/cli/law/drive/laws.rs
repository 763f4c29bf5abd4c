//! The interface law on the test bench: composed of named laws, or taken from a case.

use super::super::super::{Failure, PluginArgs};
use super::super::{all_used, named, values};
use super::DriveArgs;
use crate::laws::bench::Bench;
use crate::laws::{Interface, Kind, LoadedLaw, Plugin};
use crate::scene::bond_sites::BondSites;
use crate::scene::load;
use crate::scene::source::nearest;
use std::path::Path;

/// Default reduced radius of the contact (m).
const RADIUS: f64 = 1e-5;

/// The bench with the laws to drive, and their title.
pub(super) fn bench(args: &DriveArgs) -> Result<(Bench, String), Failure> {
    match &args.case {
        Some(case) => of_case(case, args),
        None => {
            let law = compose(args, &args.plugins)?;
            let bench = Bench::new(law, 3, args.radius.unwrap_or(RADIUS));
            Ok((bench, args.laws.join(" + ")))
        }
    }
}

/// The laws of an interface as composed in a case, with the contacts of its scene.
fn of_case(case: &Path, args: &DriveArgs) -> Result<(Bench, String), Failure> {
    let loaded = load(case, &args.sets)?;
    let names = || loaded.case.interfaces.iter().map(|i| i.name.as_str());
    let all = names().collect::<Vec<_>>().join(", ");
    let name = match (&args.interface, names().count()) {
        (Some(name), _) => name.as_str(),
        (None, 1) => names().next().unwrap_or_default(),
        (None, 0) => {
            return Err(Failure::Usage(format!(
                "{} has no interface",
                case.display()
            )));
        }
        (None, _) => {
            return Err(Failure::Usage(format!(
                "{} has several interfaces; name one with --interface: {all}",
                case.display()
            )));
        }
    };
    let Some(place) = names().position(|n| n == name) else {
        let near =
            nearest(name, names()).map_or(".".to_owned(), |n| format!("; did you mean `{n}`?"));
        return Err(Failure::Usage(format!(
            "--interface {name}: {} has no interface of this name{near} It has {all}",
            case.display()
        )));
    };
    let simulation = loaded.build(&args.plugins.search()?)?.simulation;
    // Median reduced radius of the contacts of the interface (m).
    let radius = BondSites::of(simulation.view(), place).map(|b| b.radius);
    let law = simulation.laws()[place].clone();
    let laws: Vec<String> = law
        .loaded()
        .map(|l| format!("{} {}", l.plugin.kind, l.plugin.name))
        .collect();
    let title = format!("{name}: {}", laws.join(", "));
    let radius = args.radius.or(radius).unwrap_or(RADIUS);
    let bench = Bench::new(law, loaded.case.dimension, radius);
    Ok((bench, title))
}

fn compose(args: &DriveArgs, plugins: &PluginArgs) -> Result<Interface, Failure> {
    let path = plugins.search()?;
    let mut plugins: Vec<Plugin> = Vec::new();
    for name in &args.laws {
        for plugin in named(&path, name)? {
            if let Some(other) = plugins.iter().find(|p| p.kind == plugin.kind) {
                return Err(Failure::Usage(format!(
                    "`{}` and `{}` are both {} laws; an interface has one of each kind",
                    other.name, plugin.name, plugin.kind
                )));
            }
            plugins.push(plugin);
        }
    }
    if !plugins.iter().any(|p| p.kind == Kind::CONTACT) {
        plugins.push(path.find(Kind::CONTACT, "frictionless")?);
    }
    plugins.sort_by_key(|p| p.kind);
    let mut used = vec![false; args.sets.len()];
    let mut loaded = Vec::new();
    for plugin in plugins {
        let parameters = values(&plugin, &args.sets, &mut used)?;
        loaded.push(LoadedLaw::new(plugin, parameters));
    }
    let laws: Vec<&Plugin> = loaded.iter().map(|l| &*l.plugin).collect();
    all_used(&args.sets, &used, &laws)?;
    Ok(Interface::new("bench", loaded)?)
}
