//! Stored results of a run, and their assessment by given limits.

use super::launcher::Run;
use super::output::column;
use fretwork_observe::quantity::Catalogue;
use fretwork_observe::summary::Course;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The run finished, and can be compared.
    Done,
    /// The case was refused, for this reason.
    Refused(String),
    /// The run failed, for this reason.
    Failed(String),
    /// The run finished beyond the limits, for this reason.
    Rejected(String),
    /// The run was stopped after this many seconds, at its time limit.
    Slow(f64),
}

impl Status {
    /// Returns the reason why there is nothing to compare, unless the run is done or was too slow.
    pub fn failure(&self) -> Option<String> {
        match self {
            Self::Refused(why) => Some(format!("refused: {why}")),
            Self::Failed(why) => Some(format!("failed: {why}")),
            Self::Rejected(why) => Some(why.clone()),
            Self::Done | Self::Slow(_) => None,
        }
    }
}

/// Limits beyond which a run is not trusted.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Fraction of steps that may miss the tolerance.
    pub unconverged: f64,
    /// Energy residual over the largest energy.
    pub residual: f64,
}

/// Contents of `run.json` for a run that ended or was stopped: numbers only, assessed whenever they
/// are read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct StoredRun {
    sets: Vec<String>,
    seed: u64,
    /// Exit code.
    exit: i32,
    /// First line of its output on stderr.
    said: String,
    steps: Option<f64>,
    unconverged: f64,
    uncoupled: f64,
    /// `None` if the energy is not finite.
    residual: Option<f64>,
    seconds: f64,
    wall: f64,
    visits: f64,
    /// Keywords of the reasons why the run reports that it is not trustworthy.
    #[serde(default)]
    doubts: Vec<String>,
    /// Seconds after which it was stopped at its time limit.
    #[serde(default)]
    slow: Option<f64>,
}

/// A run that ended.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedRun {
    /// Outcome.
    pub status: Status,
    /// Whether a failure may be temporary: the next study tries again.
    pub temporary: bool,
    /// The run.
    pub run: Run,
    /// Processor time of the steps (s).
    pub seconds: f64,
    /// Wall time of the whole run (s).
    pub wall: f64,
    /// Contacts times iterations, summed over the steps: a machine-independent measure of cost.
    pub visits: f64,
    /// Keywords of the reasons why the run reports that it is not trustworthy, such as `NOT SMALL
    /// STRAIN`; empty for a trustworthy run.
    pub doubts: Vec<String>,
}

impl FinishedRun {
    /// Returns whether the outcome depends on the case: also if it is refused, or takes too long.
    /// Otherwise the run was ended by a signal, could not write, or left nothing.
    pub fn is_result(&self) -> bool {
        !self.temporary || matches!(self.status, Status::Slow(_) | Status::Refused(_))
    }
}

impl StoredRun {
    /// Reads the files that a run left in its folder; `exit` is `None` if it did not end by itself.
    pub fn read(place: &Path, run: &Run, exit: Option<i32>, elapsed: f64) -> Self {
        let summary = summary(place);
        let course = Course::of(&summary);
        let said = std::fs::read_to_string(place.join("stderr.txt")).unwrap_or_default();
        let doubts = course.reasons.iter().map(|r| words(r)).collect();
        let first = said.lines().next().unwrap_or("no reason was given");
        Self {
            sets: run.sets.clone(),
            seed: run.seed,
            exit: exit.unwrap_or(-1),
            said: first.trim_start_matches("error: ").to_owned(),
            steps: course.steps,
            unconverged: course.unconverged,
            uncoupled: course.uncoupled,
            residual: course.residual,
            seconds: course.cpu_seconds.unwrap_or(elapsed),
            wall: elapsed,
            visits: visits(place, course.steps.unwrap_or(0.0)),
            doubts,
            slow: None,
        }
    }

    /// Marks the run as stopped after this many seconds.
    pub fn stopped(self, seconds: f64) -> Self {
        Self {
            slow: Some(seconds),
            ..self
        }
    }

    /// Returns whether a repetition may end differently: the run was refused (files may have
    /// changed), stopped, ended by a signal, could not write, or left nothing.
    pub fn temporary(&self) -> bool {
        match self.exit {
            _ if self.slow.is_some() => true,
            0 => self.steps.is_none(),
            1 => self.said.contains("cannot write") || self.said.contains("No space left"),
            _ => true,
        }
    }

    /// Assesses the run by limits.
    pub fn assess(self, limits: &Limits) -> FinishedRun {
        let temporary = self.temporary();
        let status = match self.exit {
            _ if self.slow.is_some() => Status::Slow(self.slow.unwrap_or_default()),
            0 => self
                .rejection(limits)
                .map_or(Status::Done, Status::Rejected),
            2 => Status::Refused(self.said),
            -1 => Status::Failed("ended by a signal".into()),
            _ => Status::Failed(self.said),
        };
        FinishedRun {
            status,
            temporary,
            run: Run {
                sets: self.sets,
                seed: self.seed,
            },
            seconds: self.seconds,
            wall: self.wall,
            visits: self.visits,
            doubts: self.doubts,
        }
    }

    /// Returns the reason why a finished run is not trusted.
    fn rejection(&self, limits: &Limits) -> Option<String> {
        let Some(steps) = self.steps else {
            return Some("it wrote no summary".into());
        };
        let most = limits.unconverged * steps.max(1.0);
        if self.unconverged > most {
            let missed = self.unconverged;
            return Some(format!("{missed} of {steps} steps did not converge"));
        }
        if self.uncoupled > most {
            return Some(format!(
                "{} of {steps} steps did not converge in the damage coupling",
                self.uncoupled
            ));
        }
        match self.residual {
            Some(r) if r.abs() <= limits.residual => None,
            Some(r) => Some(format!(
                "its energy residual is {:.1} % of the largest energy",
                100.0 * r.abs()
            )),
            None => Some("its energy is not finite".into()),
        }
    }
}

/// Returns whether a run reports that a signal ended it.
pub(super) fn interrupted(place: &Path) -> bool {
    summary(place)["interrupted"] == Value::Bool(true)
}

/// Returns the words in capitals with which a reason begins; the reason itself if there are none.
fn words(reason: &str) -> String {
    let first = reason.split(':').next().unwrap_or(reason);
    first.trim().to_owned()
}

/// Returns the summary of a run; null if there is none.
pub fn summary(place: &Path) -> Value {
    std::fs::read_to_string(place.join("summary.json"))
        .ok()
        .and_then(|text| serde_json::from_str(&text).ok())
        .unwrap_or(Value::Null)
}

/// Returns the half-width of the error of step, tolerance and coupling that a run estimates for an
/// output, as far as it does.
pub fn numerical_error(catalogue: &Catalogue, output: &str) -> Option<f64> {
    let estimate = catalogue.entry(output)?.estimate.as_ref()?;
    let known: Vec<f64> = estimate.settings().map(|(_, half)| half).collect();
    (!known.is_empty()).then(|| known.iter().sum())
}

/// Returns contacts times iterations over all steps, estimated from the rows of the statistics.
fn visits(place: &Path, steps: f64) -> f64 {
    let path = place.join("statistics.csv");
    let both = column(&path, "contacts").zip(column(&path, "iterations"));
    both.map_or(0.0, |(c, i)| {
        let sum: f64 = c.iter().zip(&i).map(|(c, i)| c * i).sum();
        steps * sum / c.len() as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stored run is assessed by the current limits; a run with a possibly temporary failure is
    /// made again.
    #[test]
    fn a_stored_run_is_assessed_by_todays_limits() {
        let run = |exit, said: &str| StoredRun {
            sets: Vec::new(),
            seed: 1,
            exit,
            said: said.into(),
            steps: Some(100.0),
            unconverged: 3.0,
            uncoupled: 0.0,
            residual: Some(1e-4),
            seconds: 1.0,
            wall: 1.0,
            visits: 1.0,
            doubts: Vec::new(),
            slow: None,
        };
        let status = |unconverged| {
            let limits = Limits {
                unconverged,
                residual: 0.01,
            };
            run(0, "").assess(&limits).status
        };
        assert!(matches!(status(0.01), Status::Rejected(why) if why.contains("3 of 100 steps")));
        assert_eq!(status(0.05), Status::Done);
        assert!(run(1, "cannot write x: full").temporary() && run(2, "no such mesh").temporary());
        assert!(run(0, "").stopped(9.0).temporary());
        assert!(!run(1, "a body left the domain").temporary() && !run(0, "").temporary());
    }
}
