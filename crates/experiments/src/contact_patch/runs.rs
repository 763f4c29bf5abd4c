//! Results of runs of a window, from their summaries: friction, and the wear of its first bodies.

use super::setup::{Motion, Setup};
use crate::amounts::Range;
use crate::runs::stored::numerical_error;
use crate::runs::window::normal_force;
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::unit::{VOLUME, WEAR_RATE};
use fretwork_observe::quantity::{Catalogue, Entry, Role, Topic, find};
use fretwork_observe::summary::{Course, SlidingTest};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A run of a window.
pub(super) struct WindowRun {
    /// Its folder, as the question gives it.
    pub folder: PathBuf,
    /// SHA-256 of its inputs; `None` for runs that recorded none.
    identity: Option<String>,
    /// Coefficient of sliding.
    pub friction: f64,
    /// Half-width of its interval within the run.
    pub scatter: Option<f64>,
    /// Half-width of its error by step, tolerance and coupling.
    pub numerical: Option<f64>,
    /// Reasons why the run is not trustworthy; `None` for a trustworthy run.
    pub doubts: Option<Vec<String>>,
    /// What a run whose error is not known to be small says of it.
    pub unsure: Option<String>,
    /// Case of the run; an error says why it is not known.
    pub setup: Result<Setup, String>,
    /// Mean normal force (N; 2D N/m).
    pub normal_force: Option<f64>,
    /// Motion of the moved body.
    pub motion: Option<Motion>,
    /// First bodies with their specific wear rates (m³/(N m)).
    wear: Vec<(String, f64)>,
    /// Relative half-width of the error of wear by step, tolerance and coupling.
    wear_error: Option<f64>,
}

/// Runs that differ from each other, and notes on those that were left out.
#[derive(Default)]
pub(super) struct Runs {
    /// The runs.
    pub list: Vec<WindowRun>,
    /// Warnings.
    pub notes: Vec<String>,
}

/// Reads the runs in these folders. A run that is given twice, and a run whose coefficient equals
/// that of another to the last digit, which no seed can have changed, is counted once.
///
/// # Errors
/// Returns a sentence on the first folder without the summary of a complete run with a coefficient
/// of sliding.
pub(super) fn read(folders: &[PathBuf]) -> Result<Runs, String> {
    let mut out = Runs::default();
    for folder in folders {
        let run = of(folder)?;
        let place = folder.canonicalize().ok();
        let same = |other: &&WindowRun| match (&run.identity, &other.identity) {
            (Some(one), Some(other)) => one == other,
            _ => place.is_some() && place == other.folder.canonicalize().ok(),
        };
        let shown = folder.display();
        if let Some(other) = out.list.iter().find(same) {
            let what = match *folder == other.folder {
                true => "is given twice".to_owned(),
                false => format!(
                    "is the run of {}, with all its inputs",
                    other.folder.display()
                ),
            };
            out.notes.push(format!(
                "COUNTED ONCE: {shown} {what}; scatter needs runs with other seeds"
            ));
            continue;
        }
        let equal = |other: &&WindowRun| other.friction.to_bits() == run.friction.to_bits();
        if let Some(other) = out.list.iter().find(equal) {
            out.notes.push(format!(
                "COUNTED ONCE: {shown} has the coefficient of {} to the last digit; their seed changes nothing in this case, and gives no scatter",
                other.folder.display()
            ));
            continue;
        }
        out.list.push(run);
    }
    Ok(out)
}

fn of(folder: &Path) -> Result<WindowRun, String> {
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| {
        format!(
            "friction of a run: cannot read {}: {e}; give the folder of a finished run",
            path.display()
        )
    })?;
    let summary: Value = serde_json::from_str(&text).map_err(|e| {
        format!(
            "friction of a run: {} is damaged: {e}; make the run again",
            path.display()
        )
    })?;
    if !summary["stopped"].is_null() || summary["interrupted"] == true {
        return Err(format!(
            "friction of a run: {} did not reach its end; resume it, or make it again",
            folder.display()
        ));
    }
    WindowRun::of(folder, &summary)
        .map_err(|why| format!("friction of a run: {}: {why}", folder.display()))
}

impl WindowRun {
    /// Reads the coefficient of sliding, the specific wear rates in the list of bodies, and the
    /// error of the worn volume.
    fn of(folder: &Path, summary: &Value) -> Result<Self, String> {
        let test = SlidingTest::of(summary)?;
        let catalogue = Catalogue::of(summary);
        let shown = catalogue.shown(summary, Role::Secondary);
        let friction = catalogue.entry(SlidingTest::COEFFICIENT);
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
        let trusted = summary["trustworthy"] != false;
        let setup = Setup::read(folder);
        let start = setup.as_ref().map_or(0.0, |s| s.start);
        Ok(Self {
            folder: folder.to_owned(),
            identity: summary["identity"].as_str().map(str::to_owned),
            friction: test.coefficient.abs(),
            scatter: friction
                .and_then(|f| f.estimate.as_ref())
                .and_then(|e| e.scatter),
            numerical: numerical_error(&catalogue, SlidingTest::COEFFICIENT),
            doubts: (!trusted).then(|| Course::of(summary).reasons),
            unsure: summary["grade_sentence"]
                .as_str()
                .filter(|_| summary["grade"] == "consistent")
                .map(str::to_owned),
            normal_force: test.normal_force.or_else(|| normal_force(folder, start)),
            motion: Motion::read(folder, test.reciprocates, start),
            setup,
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
