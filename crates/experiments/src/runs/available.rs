//! Outputs of a case, determined before anything runs.

use super::output::{OutputName, listed};
use crate::RunSetup;
use fretwork_observe::quantity::{Catalogue, Findings, Quantity, Role, renamed, unit};
use fretwork_observe::standard;
use fretwork_observe::statistics::Column;
use fretwork_scene::{Built, LoadedCase};
use std::collections::HashSet;

/// The outputs of a case.
#[derive(Clone, Debug)]
pub struct AvailableQuantities {
    /// Reports of its runs, as known at the start.
    found: Findings,
    /// Columns of the statistics.
    columns: Vec<Column>,
}

impl AvailableQuantities {
    /// Determines the outputs of a case and its scene, by the observers of the program's runs.
    pub fn of(loaded: &LoadedCase, built: &Built, setup: &RunSetup) -> Self {
        let run = built.simulation.view();
        let observers = (setup.observers)(loaded, run);
        Self {
            found: standard::declared_by(&observers, run),
            columns: observers.columns(),
        }
    }

    /// Returns the names of the default outputs: the main results that the case has.
    pub fn usual(&self) -> Vec<String> {
        let all = self.found.all().iter();
        let main = all.filter(|q| q.role == Role::Headline && q.lacks.is_none());
        let mut main: Vec<_> = main.collect();
        main.sort_by_key(|q| q.topic);
        main.into_iter().map(|q| q.name()).collect()
    }

    /// Returns what the case lacks for an output: for itself, the group that contains it, or
    /// everything in it.
    fn lack(&self, name: &str) -> Option<&'static str> {
        let mut at_or_below = false;
        let mut why = None;
        for q in self.found.all() {
            let own = q.name();
            if within(name, &own) && q.lacks.is_some() {
                return q.lacks;
            }
            if within(&own, name) {
                let first = !std::mem::replace(&mut at_or_below, true);
                why = if first || why.is_some() {
                    q.lacks
                } else {
                    None
                };
            }
        }
        why
    }

    /// Returns the SI unit of an output, `1` for pure numbers; empty if only a run gives it.
    pub fn unit(&self, output: &OutputName) -> String {
        let unit = match output.column_name() {
            Some(name) => {
                let column = self.columns.iter().find(|c| c.name == name);
                column.map(|c| c.unit.symbol(self.found.dimension()))
            }
            None => self.found.unit_of(&output.name),
        };
        unit.unwrap_or_default().to_owned()
    }

    /// Returns the names of the outputs in the summary.
    fn names(&self) -> Vec<String> {
        let mut names = Catalogue::new(&self.found).comparable();
        let later = self.found.expected().iter();
        let later = later.filter(|e| e.role < Role::Diagnostic && e.unit != unit::WORD);
        names.extend(later.map(|e| e.path.clone()));
        let mut seen = HashSet::new();
        names.retain(|n| !n.contains('*') && self.lack(n).is_none() && seen.insert(n.clone()));
        names
    }

    /// Returns the first output of each kind in a list.
    fn names_in_lists(&self) -> Vec<String> {
        let now = self.found.all().iter().map(|q| (q.pattern(), q.unit));
        let later = self.found.expected().iter();
        let later = later.map(|e| (e.path.clone(), e.unit));
        let numbers = now.chain(later).filter(|(_, unit)| *unit != unit::WORD);
        let lists = numbers.filter(|(path, _)| path.contains('*') && self.lack(path).is_none());
        lists.map(|(path, _)| path.replace('*', "0")).collect()
    }

    /// Checks that runs of the case have an output.
    ///
    /// # Errors
    /// Returns a sentence on what the case lacks, with the nearest name and the existing ones.
    pub fn check(&self, output: &OutputName) -> Result<(), String> {
        if let Some(column) = output.column_name() {
            let names: Vec<String> = self.columns.iter().map(|c| c.name.clone()).collect();
            return if names.iter().any(|c| c == column) {
                Ok(())
            } else {
                Err(output.unknown(&names, &[], "statistics.", column))
            };
        }
        let name = output.name.as_str();
        if let Some(now) = renamed(name) {
            return Err(format!("`{name}` is called `{now}` now"));
        }
        if let Some(why) = self.lack(name) {
            return Err(format!(
                "{why}, so there is nothing to compare; {}",
                listed(&self.names(), "")
            ));
        }
        // The value is known after a run only; its schema is declared.
        if self.found.expects(name) {
            return Ok(());
        }
        let own = self.found.quantity(name);
        let is_group = |q: &Quantity| q.value.is_array() || q.value.is_object();
        let is_below = |q: &Quantity| q.name() != name && within(&q.name(), name);
        if own.is_some_and(is_group)
            || self.found.all().iter().any(is_below)
            || self.found.expects_below(name)
        {
            return Err(output.is_group());
        }
        if own.is_some_and(|q| q.unit != unit::WORD) {
            return Ok(());
        }
        Err(output.unknown(&self.names(), &self.names_in_lists(), "", name))
    }
}

/// Whether a path is in a group, or is the group.
fn within(path: &str, group: &str) -> bool {
    let rest = path.strip_prefix(group);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
