//! Catalogue of a run: the meaning of each path of its `summary.json`. It is written under the key
//! `quantities`, and read by all code that shows runs later.

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

/// Present and earlier names of groups of a summary.
const RENAMED: [[&str; 2]; 1] = [["step_size", "haste"]];

/// Returns the present path for a path that earlier versions of the program wrote.
pub fn renamed(path: &str) -> Option<String> {
    let (group, rest) = path.split_once('.').unwrap_or((path, ""));
    let [now, _] = RENAMED.iter().find(|[_, before]| *before == group)?;
    let dot = if rest.is_empty() { "" } else { "." };
    Some(format!("{now}{dot}{rest}"))
}

/// Returns a value of a summary by its path, also in summaries of versions with another name of its
/// group.
pub fn find<'a>(summary: &'a Value, path: &str) -> Option<&'a Value> {
    let before = RENAMED.iter().find_map(|[now, before]| {
        let rest = path.strip_prefix(now)?;
        (rest.is_empty() || rest.starts_with('.')).then(|| format!("{before}{rest}"))
    });
    at_path(summary, path).or_else(|| at_path(summary, &before?))
}

fn at_path<'a>(summary: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(summary, |at, part| match at {
        Value::Array(list) => list.get(part.parse::<usize>().ok()?),
        _ => at.get(part),
    })
}

/// Whether a path is of a pattern, in which `*` stands for every place of a list.
pub(super) fn matches(pattern: &str, path: &str) -> bool {
    let (mut a, mut b) = (pattern.split('.'), path.split('.'));
    loop {
        match (a.next(), b.next()) {
            (None, None) => return true,
            (Some(x), Some(y)) if x == y || (x == "*" && y.parse::<usize>().is_ok()) => {}
            _ => return false,
        }
    }
}
