//! The table of a study: a row for each run, including failed ones, with its factors, its outputs
//! and how it ended.

use super::plan::Plan;
use crate::factor::Level;
use crate::runs::stored::{FinishedRun, Status, numerical_error, summary};
use crate::runs::unit::unit_of;
use crate::table::{Cell, Column, ColumnType, Table};
use fretwork_observe::quantity::Catalogue;
use serde_json::Value as Json;

/// Status of a run that is done and trusted.
pub const DONE: &str = "done";

/// Status of a run that was not made.
pub const NOT_RUN: &str = "not run";

/// The table of the runs of a study, in the order of their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// The table.
    pub table: Table,
    statuses: Vec<&'static str>,
}

/// Numbers of runs by their end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All runs.
    pub all: usize,
    /// Runs that are done and trusted.
    pub done: usize,
    /// Runs that were refused, failed, or are beyond the limits of the study.
    pub failed: usize,
    /// Runs that are not made yet.
    pub missing: usize,
}

/// A run of the study as stored.
struct RunRow {
    run: Option<FinishedRun>,
    summary: Json,
    /// Descriptions of the numbers of the summary.
    catalogue: Catalogue,
    place: std::path::PathBuf,
}

impl Rows {
    /// Reads the stored runs of a study.
    pub fn of(plan: &Plan) -> Self {
        let points: Vec<_> = plan.points().collect();
        let row = |p: &super::plan::Point| {
            let place = plan.launcher.place(&p.run);
            let run = plan.launcher.ended_in(&place);
            let summary = run.as_ref().map_or(Json::Null, |_| summary(&place));
            RunRow {
                run,
                catalogue: Catalogue::of(&summary),
                summary,
                place,
            }
        };
        let rows: Vec<RunRow> = points.iter().map(row).collect();
        let mut columns = vec![
            Column::whole("point", points.iter().map(|p| Some(p.number as f64))),
            Column::whole("setting", points.iter().map(|p| Some(p.setting as f64))),
            Column::whole("seed", points.iter().map(|p| Some(p.run.seed as f64))),
        ];
        for k in 0..plan.factors.len() {
            let levels = points.iter().map(|p| &plan.settings[p.setting - 1][k]);
            columns.push(factor_column(plan, k, levels));
        }
        for (output, declared) in plan.outputs.iter().zip(&plan.output_units) {
            // Some units are known at the end of a run only, and a run that failed has none.
            let units = rows.iter().map(|r| unit_of(output, &r.catalogue, &r.place));
            let unit = units.into_iter().find(|u| !u.is_empty());
            let unit = unit.unwrap_or_else(|| declared.clone());
            let value = |r: &RunRow| r.run.as_ref().and(output.read(&r.summary, &r.place));
            columns.push(Column::real(&output.name, &unit, rows.iter().map(value)));
            let errors = rows
                .iter()
                .map(|r| numerical_error(&r.catalogue, &output.name));
            let errors = Column::real(format!("{}_numerical_error", output.name), unit, errors);
            if errors.cells.iter().any(|c| *c != Cell::Unknown) {
                columns.push(errors);
            }
        }
        let text =
            |name: &str, f: &dyn Fn(&RunRow) -> String| Column::text(name, rows.iter().map(f));
        let of_run = |f: fn(&FinishedRun) -> f64| rows.iter().map(move |r| r.run.as_ref().map(f));
        for regime in &plan.regimes {
            columns.push(text(regime, &|r| regime_of(&r.summary, regime)));
        }
        columns.extend([
            text("status", &|r| status(r.run.as_ref()).0.to_owned()),
            text("reason", &|r| status(r.run.as_ref()).1),
            text("not_trustworthy", &|r| {
                let doubts = r.run.as_ref().map(|run| run.doubts.join("; "));
                doubts.unwrap_or_default()
            }),
            Column::whole("steps", rows.iter().map(|r| r.summary["steps"].as_f64())),
            Column::real("cpu_seconds", "s", of_run(|run| run.seconds)),
            Column::real("wall_seconds", "s", of_run(|run| run.wall)),
            text("identity", &|r| {
                let identity = r.summary["identity"].as_str();
                identity.unwrap_or_default().to_owned()
            }),
            text("folder", &|r| {
                let name = r.place.file_name().unwrap_or_default();
                name.to_string_lossy().into_owned()
            }),
        ]);
        Self {
            table: Table { columns },
            statuses: rows.iter().map(|r| status(r.run.as_ref()).0).collect(),
        }
    }

    /// Returns the numbers of runs by their end.
    pub fn counts(&self) -> Counts {
        let count = |word: &str| self.statuses.iter().filter(|s| **s == word).count();
        let (all, done, missing) = (self.statuses.len(), count(DONE), count(NOT_RUN));
        Counts {
            all,
            done,
            failed: all - done - missing,
            missing,
        }
    }

    /// Whether a run is done and trusted.
    pub fn is_done(&self, run: usize) -> bool {
        self.statuses.get(run) == Some(&DONE)
    }

    /// Iterates over the indices of the runs that are done and trusted.
    pub fn done(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.statuses.len()).filter(|k| self.is_done(*k))
    }

    /// Returns the number of completed runs that are not trustworthy.
    pub fn doubted(&self) -> usize {
        let doubted = |k: &usize| !self.table.text("not_trustworthy", *k).is_empty();
        self.done().filter(doubted).count()
    }

    /// Returns the columns among `names` that are empty in all completed runs.
    pub fn without_text<'a>(&self, names: &'a [String]) -> Vec<&'a str> {
        let empty = |name: &&str| self.done().all(|run| self.table.text(name, run).is_empty());
        match self.counts().done {
            0 => Vec::new(),
            _ => names.iter().map(String::as_str).filter(empty).collect(),
        }
    }

    /// Describes how the runs of a setting ended, which replaces the mean if none is done.
    pub fn without_result(&self, setting: usize, seeds: usize) -> String {
        let mut words: Vec<&str> = Vec::new();
        for word in &self.statuses[setting * seeds..(setting + 1) * seeds] {
            if !words.contains(word) {
                words.push(word);
            }
        }
        words.join(", ")
    }

    /// Returns the values of an output by run; `None` where there is no run that is done and
    /// trusted.
    pub fn trusted(&self, name: &str) -> Vec<Option<f64>> {
        let cells = self.table.column(name).map_or(&[][..], |c| &c.cells);
        let value = |(k, cell): (usize, &Cell)| match cell {
            Cell::Number(x) if self.is_done(k) => Some(*x),
            _ => None,
        };
        cells.iter().enumerate().map(value).collect()
    }
}

/// Returns the values of a factor as numbers, if all are, otherwise as texts.
pub(super) fn factor_column<'a>(
    plan: &Plan,
    factor: usize,
    levels: impl Iterator<Item = &'a Level>,
) -> Column {
    let name = &plan.factors[factor].name;
    match plan.is_numeric(factor) {
        true => Column::real(name, plan.unit_of(factor), levels.map(|l| l.number)),
        false => Column {
            name: name.clone(),
            unit: plan.unit_of(factor),
            kind: ColumnType::Text,
            cells: levels.map(|l| Cell::Text(l.label.clone())).collect(),
        },
    }
}

/// Returns a text of a summary, up to the first character that ends a name.
fn regime_of(summary: &Json, name: &str) -> String {
    let found = name.split('.').try_fold(summary, |v, part| v.get(part));
    let text = found.and_then(Json::as_str).unwrap_or_default();
    let end = text.find([':', ',', ';', '(']).unwrap_or(text.len());
    text[..end].trim().to_owned()
}

/// Returns the status of a run and its reason.
pub fn status(run: Option<&FinishedRun>) -> (&'static str, String) {
    let Some(run) = run else {
        return (NOT_RUN, String::new());
    };
    match &run.status {
        Status::Done => (DONE, String::new()),
        Status::Slow(s) => ("stopped", format!("it took more than {s:.0} s")),
        Status::Refused(why) => ("refused", why.clone()),
        Status::Failed(why) => ("failed", why.clone()),
        Status::Rejected(why) => ("rejected", why.clone()),
    }
}
