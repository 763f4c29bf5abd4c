//! Catalogue of a run: the meaning of each path of its `summary.json`. It is written under the key
//! `quantities`, and read by all code that shows runs later.

use super::path::{find, matches};
use super::{Estimate, Findings, Role, Topic, Unit};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::HashSet;

/// Description of a path, in which `*` represents any index of a list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The path.
    pub path: String,
    /// SI unit, `1` for pure numbers; `None` for texts and flags.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// One line of explanation.
    pub doc: String,
    /// Prominence.
    pub role: Role,
    /// Topic.
    pub topic: Topic,
    /// Short name for tables.
    pub label: String,
    /// Half-widths by cause, with the value to which they belong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
}

impl Entry {
    /// Returns whether its unit is this one, in space or per metre of depth.
    pub fn is_in(&self, unit: Unit) -> bool {
        let symbols = [2, 3].map(|dimension| unit.symbol(dimension));
        self.unit
            .as_deref()
            .is_some_and(|own| symbols.contains(&own))
    }
}

/// Descriptions of the paths of a summary.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Catalogue {
    /// Entries in the order of their quantities.
    pub entries: Vec<Entry>,
}

impl Catalogue {
    /// Key of the catalogue in `summary.json`.
    pub const KEY: &'static str = "quantities";

    /// Creates the catalogue of the results. Details in lists share an entry; other quantities have
    /// their own.
    pub fn new(found: &Findings) -> Self {
        let mut seen = HashSet::new();
        let mut entries = Vec::new();
        for q in found.all() {
            let shared = q.role >= Role::Detail && q.label.is_empty();
            let path = if shared { q.pattern() } else { q.name() };
            if !seen.insert(path.clone()) {
                continue;
            }
            let unit = q.unit.symbol(found.dimension());
            entries.push(Entry {
                path,
                unit: (!unit.is_empty()).then(|| unit.to_owned()),
                doc: q.doc.clone(),
                role: q.role,
                topic: q.topic,
                label: q.label(),
                estimate: q.estimate.clone(),
            });
        }
        Self { entries }
    }

    /// Reads the catalogue of a run; empty for runs of versions that wrote none.
    pub fn of(summary: &Value) -> Self {
        let entries = summary.get(Self::KEY).cloned().unwrap_or_default();
        serde_json::from_value(entries).unwrap_or_default()
    }

    /// Returns the entry of a path: its own, or that of the list that contains it.
    pub fn entry(&self, path: &str) -> Option<&Entry> {
        let own = self.entries.iter().find(|e| e.path == path);
        own.or_else(|| self.entries.iter().find(|e| matches(&e.path, path)))
    }

    /// Returns the quantities of a role or a more prominent one that have a value, in their order.
    pub fn shown<'a>(&'a self, summary: &'a Value, role: Role) -> Vec<(&'a Entry, &'a Value)> {
        let entries = self.entries.iter().filter(|e| e.role <= role);
        let with_value = entries.filter_map(|e| Some((e, find(summary, &e.path)?)));
        with_value.filter(|(_, v)| !v.is_null()).collect()
    }

    /// Returns the paths of the results that can be compared between runs: numbers that are not in
    /// lists.
    pub fn comparable(&self) -> Vec<String> {
        let results = self.entries.iter().filter(|e| e.role < Role::Diagnostic);
        let numbers = results.filter(|e| e.unit.is_some() && !e.path.contains('*'));
        numbers.map(|e| e.path.clone()).collect()
    }
}
