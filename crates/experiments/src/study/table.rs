//! One table of all runs of a study: what was asked, what came out, and how each run ended. Failed runs are rows too.

use super::analysis::{Analysis, numeric};
use super::factor::Value;
use super::plan::Plan;
use crate::runs::quantity::Quantity;
use crate::runs::stored::{Finished, Status, summary};
use crate::runs::unit::unit_of;
use fretwork_study::interval::Mean;
use serde_json::Value as Json;

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// Nothing: not run, or the run has no such value.
    Unknown,
}

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// Numbers.
    Real,
    /// Whole numbers.
    Whole,
    /// Texts.
    Text,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// SI unit; empty for pure numbers and texts.
    pub unit: String,
    /// What its cells are.
    pub kind: Type,
    /// One cell for each run.
    pub cells: Vec<Cell>,
}

/// The table of a study, a row for each run in the order of their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
}

/// How many runs ended in which way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Runs.
    pub all: usize,
    /// Done and trusted.
    pub done: usize,
    /// Refused, failed, or beyond the limits of the study.
    pub failed: usize,
    /// Not made yet.
    pub missing: usize,
}

/// A run of the study as it is on disk.
struct Row {
    run: Option<Finished>,
    summary: Json,
    place: std::path::PathBuf,
}

impl Table {
    /// Gathers the runs of a study that are there.
    pub fn of(plan: &Plan) -> Self {
        let points: Vec<_> = plan.points().collect();
        let rows: Vec<Row> = points
            .iter()
            .map(|p| {
                let place = plan.place(p);
                let run = plan.launcher.ended_in(&place);
                let summary = if run.is_some() {
                    summary(&place)
                } else {
                    Json::Null
                };
                Row {
                    run,
                    summary,
                    place,
                }
            })
            .collect();
        let mut columns = Vec::new();
        let whole = |name: &str, cells: Vec<Cell>| Column {
            name: name.to_owned(),
            unit: String::new(),
            kind: Type::Whole,
            cells,
        };
        let number = |x: usize| Cell::Number(x as f64);
        columns.push(whole(
            "point",
            points.iter().map(|p| number(p.number)).collect(),
        ));
        columns.push(whole(
            "setting",
            points.iter().map(|p| number(p.setting)).collect(),
        ));
        columns.push(whole(
            "seed",
            points.iter().map(|p| Cell::Number(p.seed as f64)).collect(),
        ));
        for (k, factor) in plan.factors.iter().enumerate() {
            let values = points.iter().map(|p| &plan.settings[p.setting - 1][k]);
            let numbers = numeric(plan, k);
            let cell = |v: &Value| factor_cell(v, numbers);
            columns.push(Column {
                name: factor.name.clone(),
                unit: plan.unit_of(k),
                kind: if numbers { Type::Real } else { Type::Text },
                cells: values.map(cell).collect(),
            });
        }
        for output in &plan.outputs {
            let value = |r: &Row| output.read(&r.summary, &r.place);
            let cells: Vec<Cell> = rows
                .iter()
                .map(|r| real(r.run.as_ref().and_then(|_| value(r))))
                .collect();
            let ended = rows.iter().find(|r| r.run.is_some());
            let unit = ended
                .map(|r| unit_of(output, &r.summary, &r.place))
                .unwrap_or_default();
            let errors: Vec<Cell> = rows
                .iter()
                .map(|r| real(own_error(output, &r.summary)))
                .collect();
            let column = |name: String, cells| Column {
                name,
                unit: unit.clone(),
                kind: Type::Real,
                cells,
            };
            columns.push(column(output.name.clone(), cells));
            if errors.iter().any(|c| *c != Cell::Unknown) {
                columns.push(column(format!("{}_numerical_error", output.name), errors));
            }
        }
        let text = |name: &str, f: &dyn Fn(&Row) -> String| Column {
            name: name.to_owned(),
            unit: String::new(),
            kind: Type::Text,
            cells: rows
                .iter()
                .map(|r| match f(r) {
                    text if text.is_empty() => Cell::Unknown,
                    text => Cell::Text(text),
                })
                .collect(),
        };
        let seconds = |name: &str, f: &dyn Fn(&Finished) -> f64| Column {
            name: name.to_owned(),
            unit: "s".to_owned(),
            kind: Type::Real,
            cells: rows.iter().map(|r| real(r.run.as_ref().map(f))).collect(),
        };
        for regime in &plan.regimes {
            columns.push(text(regime, &|r| regime_of(&r.summary, regime)));
        }
        columns.push(text("status", &|r| status(r.run.as_ref()).0.to_owned()));
        columns.push(text("reason", &|r| status(r.run.as_ref()).1));
        columns.push(text("not_trustworthy", &|r| {
            r.run
                .as_ref()
                .map_or(String::new(), |run| run.doubts.join("; "))
        }));
        let steps = rows.iter().map(|r| real(r.summary["steps"].as_f64()));
        columns.push(whole("steps", steps.collect()));
        columns.push(seconds("cpu_seconds", &|run| run.seconds));
        columns.push(seconds("wall_seconds", &|run| run.wall));
        columns.push(text("identity", &|r| {
            r.summary["identity"]
                .as_str()
                .unwrap_or_default()
                .to_owned()
        }));
        columns.push(text("folder", &|r| {
            let name = r.place.file_name().unwrap_or_default();
            name.to_string_lossy().into_owned()
        }));
        Self { columns }
    }

    /// The table of settings: values of the factors, and means over the seeds with half-widths of 95 %, scatter and counts.
    pub fn of_settings(plan: &Plan, analysis: &Analysis) -> Self {
        let count = plan.settings.len();
        let column = |name: String, unit: &str, kind, cells| Column {
            name,
            unit: unit.to_owned(),
            kind,
            cells,
        };
        let numbers = (1..=count).map(|k| Cell::Number(k as f64)).collect();
        let mut columns = vec![column("setting".to_owned(), "", Type::Whole, numbers)];
        for (k, factor) in plan.factors.iter().enumerate() {
            let all = numeric(plan, k);
            let cells = plan.settings.iter().map(|s| factor_cell(&s[k], all));
            let kind = if all { Type::Real } else { Type::Text };
            columns.push(column(
                factor.name.clone(),
                &plan.unit_of(k),
                kind,
                cells.collect(),
            ));
        }
        for output in &analysis.outputs {
            let of = |f: &dyn Fn(&Mean) -> Option<f64>| -> Vec<Cell> {
                output
                    .means
                    .iter()
                    .map(|m| real(m.as_ref().and_then(f)))
                    .collect()
            };
            let (name, unit) = (&output.name, output.unit.as_str());
            columns.push(column(
                name.clone(),
                unit,
                Type::Real,
                of(&|m| Some(m.mean)),
            ));
            columns.push(column(
                format!("{name}_half_width"),
                unit,
                Type::Real,
                of(&|m| m.half_width),
            ));
            columns.push(column(
                format!("{name}_scatter"),
                unit,
                Type::Real,
                of(&|m| m.scatter),
            ));
            columns.push(column(
                format!("{name}_runs"),
                "",
                Type::Whole,
                of(&|m| Some(m.count as f64)),
            ));
        }
        for regimes in &analysis.regimes {
            let words = (0..count).map(|k| match regimes.words(k) {
                none if none.is_empty() => Cell::Unknown,
                words => Cell::Text(words),
            });
            columns.push(column(
                regimes.name.clone(),
                "",
                Type::Text,
                words.collect(),
            ));
        }
        Self { columns }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.cells.len())
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }

    /// How the runs ended.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts {
            all: self.rows(),
            ..Counts::default()
        };
        for cell in self.column("status").into_iter().flat_map(|c| &c.cells) {
            match cell {
                Cell::Text(text) if text == DONE => counts.done += 1,
                Cell::Text(text) if text == NOT_RUN => counts.missing += 1,
                _ => counts.failed += 1,
            }
        }
        counts
    }

    /// Those of some columns in which no run that is done has anything.
    pub fn without_text<'a>(&self, names: &'a [String]) -> Vec<&'a str> {
        let cells = |name: &str| self.column(name).map_or(&[][..], |c| &c.cells);
        let done = |status: &Cell| matches!(status, Cell::Text(text) if text == DONE);
        let empty = |name: &&str| {
            let mut runs = cells(name).iter().zip(cells("status"));
            !runs.any(|(cell, status)| done(status) && *cell != Cell::Unknown)
        };
        match self.counts().done {
            0 => Vec::new(),
            _ => names.iter().map(String::as_str).filter(empty).collect(),
        }
    }

    /// In place of a mean of a setting none of whose runs is done: how they ended.
    pub fn without_result(&self, setting: usize, seeds: usize) -> String {
        let cells = self.column("status").map(|c| c.cells.as_slice());
        let own = cells.and_then(|c| c.get(setting * seeds..(setting + 1) * seeds));
        let mut words: Vec<&str> = Vec::new();
        for cell in own.unwrap_or_default() {
            if let Cell::Text(word) = cell
                && !words.contains(&word.as_str())
            {
                words.push(word);
            }
        }
        words.join(", ")
    }

    /// The values of an output by run; `None` where there is no run that is done and trusted.
    pub fn trusted(&self, name: &str) -> Vec<Option<f64>> {
        let status = self
            .column("status")
            .map(|c| c.cells.as_slice())
            .unwrap_or_default();
        let values = self
            .column(name)
            .map(|c| c.cells.as_slice())
            .unwrap_or_default();
        let value = |(cell, status): (&Cell, &Cell)| match (cell, status) {
            (Cell::Number(x), Cell::Text(status)) if status == DONE => Some(*x),
            _ => None,
        };
        values.iter().zip(status).map(value).collect()
    }
}

/// A text of a summary, up to the first sign that ends a name.
fn regime_of(summary: &Json, name: &str) -> String {
    let found = name.split('.').try_fold(summary, |v, part| v.get(part));
    let text = found.and_then(Json::as_str).unwrap_or_default();
    let end = text.find([':', ',', ';', '(']).unwrap_or(text.len());
    text[..end].trim().to_owned()
}

/// Status of a run that is done and trusted.
pub const DONE: &str = "done";

/// Status of a run that was not made.
pub const NOT_RUN: &str = "not run";

/// Status of a run and its reason.
pub fn status(run: Option<&Finished>) -> (&'static str, String) {
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

/// The value of a factor in a column of numbers or of texts.
fn factor_cell(value: &Value, numbers: bool) -> Cell {
    match (value.number, numbers) {
        (Some(x), true) => Cell::Number(x),
        (None, true) => Cell::Unknown,
        (_, false) => Cell::Text(value.label.clone()),
    }
}

fn real(value: Option<f64>) -> Cell {
    value.map_or(Cell::Unknown, Cell::Number)
}

/// Half-width of the error of step, tolerance and coupling that a run estimates of an output.
fn own_error(output: &Quantity, summary: &Json) -> Option<f64> {
    let own = &summary["uncertainty"][output.name.as_str()];
    let parts = ["step", "tolerance", "coupling"].map(|key| own[key].as_f64());
    let known: Vec<f64> = parts.into_iter().flatten().collect();
    (!known.is_empty()).then(|| known.iter().sum())
}
