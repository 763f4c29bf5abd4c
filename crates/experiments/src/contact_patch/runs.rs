//! Results of runs of a window, from their summaries: friction, and the wear of its first bodies.

use super::range::Range;
use crate::runs::stored::numerical_error;
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::unit::{VOLUME, WEAR_RATE};
use fretwork_observe::quantity::{Catalogue, Entry, Role, Topic, find};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A run of a window.
pub(super) struct WindowRun {
    /// Friction coefficient.
    pub friction: f64,
    /// Half-width of its interval within the run.
    pub scatter: Option<f64>,
    /// Half-width of its error by step, tolerance and coupling.
    pub numerical: Option<f64>,
    /// First bodies with their specific wear rates (m³/(N m)).
    wear: Vec<(String, f64)>,
    /// Relative half-width of the error of wear by step, tolerance and coupling.
    wear_error: Option<f64>,
}

/// Reads the runs in these folders.
///
/// # Errors
/// Returns a sentence on the first folder without the summary of a complete run with a friction
/// test.
pub(super) fn read(folders: &[PathBuf]) -> Result<Vec<WindowRun>, String> {
    folders.iter().map(|f| of(f)).collect()
}

fn of(folder: &Path) -> Result<WindowRun, String> {
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| {
        format!(
            "friction of a run: cannot read {}: {e}; give the folder of a finished run",
            path.display()
        )
    })?;
    let summary: Value = serde_json::from_str(&text)
        .map_err(|e| format!("friction of a run: {} is damaged: {e}", path.display()))?;
    if !summary["stopped"].is_null() || summary["interrupted"] == true {
        return Err(format!(
            "friction of a run: {} did not reach its end; run it again",
            folder.display()
        ));
    }
    WindowRun::of(&summary).ok_or_else(|| {
        format!(
            "friction of a run: {} has no friction coefficient; its case needs `friction`",
            folder.display()
        )
    })
}

impl WindowRun {
    /// Reads the main result of friction, the specific wear rates in the list of bodies, and the
    /// error of the worn volume. `None` without friction.
    fn of(summary: &Value) -> Option<Self> {
        let catalogue = Catalogue::of(summary);
        let shown = catalogue.shown(summary, Role::Secondary);
        let headline = |e: &Entry| e.role == Role::Headline && e.topic == Topic::Friction;
        let (friction, value) = shown.iter().find(|(entry, _)| headline(entry))?;
        let wear = || shown.iter().filter(|(entry, _)| entry.topic == Topic::Wear);
        let rate = |(entry, value): &(&Entry, &Value)| {
            let (body, _) = entry
                .path
                .rsplit_once('.')
                .filter(|_| entry.is_in(WEAR_RATE))?;
            let name = find(summary, &format!("{body}.body"))?.as_str()?;
            Some((name.to_owned(), value.as_f64()?))
        };
        let volume = wear().find(|(entry, _)| entry.is_in(VOLUME) && entry.estimate.is_some());
        let worn = volume.and_then(|(entry, _)| entry.estimate.as_ref()?.value);
        let error = volume.and_then(|(entry, _)| numerical_error(&catalogue, &entry.path));
        Some(Self {
            friction: value.as_f64()?.abs(),
            scatter: friction.estimate.as_ref().and_then(|e| e.scatter),
            numerical: numerical_error(&catalogue, &friction.path),
            wear: wear().filter_map(rate).collect(),
            wear_error: error.zip(worn.filter(|v| *v > 0.0)).map(|(e, v)| e / v),
        })
    }
}

/// Returns the largest of a number that all runs have.
pub(super) fn largest(runs: &[WindowRun], of: impl Fn(&WindowRun) -> Option<f64>) -> Option<f64> {
    runs.iter().map(of).try_fold(0.0f64, |a, b| Some(a.max(b?)))
}

/// Returns the specific wear rate (m³/(N m)) of each first body, and of all together: the mean over
/// the runs, with Student's 95 % interval and the numerical error; for a single run with the latter
/// only. Which body wears may differ from sample to sample while the sum does not.
pub(super) fn wear_rates(runs: &[WindowRun]) -> Vec<(String, Range)> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    let error = largest(runs, |r| r.wear_error).unwrap_or(0.0);
    let of = |name: &str, rate: &dyn Fn(&WindowRun) -> Option<f64>| {
        let values: Option<Vec<f64>> = runs.iter().map(rate).collect();
        let mean = Mean::of(&values?)?;
        let half = mean.half_width.unwrap_or(0.0) + error * mean.mean;
        let range = Range {
            low: (mean.mean - half).max(0.0),
            value: mean.mean,
            high: mean.mean + half,
        };
        Some((name.to_owned(), range))
    };
    let names: Vec<&str> = first.wear.iter().map(|w| w.0.as_str()).collect();
    let own = |name: &&str| of(name, &|r| r.wear.iter().find(|w| w.0 == *name).map(|w| w.1));
    let all = of(&names.join(" and "), &|r| {
        Some(r.wear.iter().map(|w| w.1).sum())
    });
    let mut out: Vec<_> = names.iter().filter_map(own).collect();
    if out.len() > 1 {
        out.extend(all);
    }
    out
}
