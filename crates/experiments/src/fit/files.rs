//! Files of a fit: `fit.json`, `evaluations.csv`, `curves.csv`.

use super::evaluate::Tests;
use super::outcome::{HalfStep, Outcome, mean_of};
use super::page::{draw, sheet};
use super::search::SearchResult;
use super::spec::FitFile;
use crate::Error;
use crate::table::{Column, Table, csv};
use serde_json::{Value, json};
use std::path::Path;

/// Writes all points that were run.
///
/// # Errors
/// The file cannot be written.
pub fn write_evaluations(tests: &Tests, found: &SearchResult, out: &Path) -> Result<(), Error> {
    let path = out.join("evaluations.csv");
    csv::write(
        &evaluations(tests, found),
        &path,
        csv::NumberFormat::Exponents,
    )
}

/// Writes the other files of a fit into its folder; returns its JSON.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    read: &FitFile,
    tests: &Tests,
    found: &SearchResult,
    outcome: &Outcome,
    out: &Path,
) -> Result<String, Error> {
    let json = json(read, tests, found, outcome);
    let json = serde_json::to_string_pretty(&json).unwrap_or_default();
    let path = out.join("fit.json");
    std::fs::write(&path, format!("{json}\n")).map_err(|e| Error::write(&path, &e))?;
    let curves = curves(tests, found, outcome);
    csv::write(
        &curves,
        &out.join("curves.csv"),
        csv::NumberFormat::Exponents,
    )?;
    let page = sheet(read, tests, found, outcome).write(&out.join("fit.html"));
    page.map_err(|e| Error::Failed(e.to_string()))?;
    draw(read, tests, found, outcome, &out.join("fit.png"))?;
    Ok(json)
}

fn json(read: &FitFile, tests: &Tests, found: &SearchResult, outcome: &Outcome) -> Value {
    let known = &outcome.identification;
    let number = |x: f64| if x.is_finite() { json!(x) } else { Value::Null };
    let names = read.spec.names();
    let half = |place: usize| match &outcome.half_step {
        Some(HalfStep::Moves { parameters, .. }) => json!(parameters[place]),
        _ => Value::Null,
    };
    let step_not_small: Vec<&str> = match &outcome.half_step {
        Some(HalfStep::Moves { beyond, .. }) => beyond.iter().map(|&i| names[i]).collect(),
        _ => Vec::new(),
    };
    let half_step_failed = match &outcome.half_step {
        Some(HalfStep::Failed(why)) => json!(why),
        _ => Value::Null,
    };
    let parameters: Vec<Value> = known
        .estimates
        .iter()
        .zip(&read.spec.parameters)
        .enumerate()
        .map(|(place, (e, spec))| {
            json!({
                "half_step": half(place), "name": e.name, "value": e.value, "unit": spec.shown_unit(), "low": e.interval.low, "high": e.interval.high,
                "simultaneous_low": e.simultaneous.low, "simultaneous_high": e.simultaneous.high,
                "determined": e.determined, "open_below": e.open_below, "open_above": e.open_above, "at": e.at,
            })
        })
        .collect();
    let directions: Vec<Value> = known
        .directions
        .iter()
        .map(|d| {
            json!({
                "words": d.words(&names), "determined": d.determined, "half_width": d.half_width, "singular_value": number(d.singular_value),
            })
        })
        .collect();
    let values = outcome.values();
    let sets: Vec<Value> = (0..tests.target.tests().len())
        .map(|t| json!({"test": tests.target.tests()[t].name, "case": tests.case(t), "sets": tests.sets(t, &values)}))
        .collect();
    let best = &found.evaluations[outcome.best];
    json!({
        "title": read.spec.title, "parameters": parameters, "correlation": known.correlation, "directions": directions,
        "chi_squared": best.chi_squared.map(number), "values": tests.target.measured().len(),
        "reduced": known.reduced.map(number), "p": known.p, "describes": known.describes, "widened": number(known.widened), "at_edge": known.at_edge, "settled": outcome.settled,
        "ended": found.ended, "evaluations": found.evaluations.len(),
        "failed": found.failed(),
        "step_not_small": step_not_small, "half_step_failed": half_step_failed, "random": tests.random, "tests": sets,
    })
}

/// Returns all points that were run, with the reason where one failed.
fn evaluations(tests: &Tests, found: &SearchResult) -> Table {
    let all = &found.evaluations;
    let mut columns = vec![
        Column::whole("evaluation", (1..=all.len()).map(|k| Some(k as f64))),
        Column::text("stage", all.iter().map(|e| e.stage.word())),
    ];
    for (k, p) in tests.bounds.parameters().iter().enumerate() {
        columns.push(Column::real(
            &p.name,
            tests.unit_of_parameter(k),
            all.iter().map(|e| Some(e.values[k])),
        ));
    }
    let seeds = all.iter().map(|e| Some(e.samples.len() as f64));
    let reasons = all.iter().map(|e| {
        let reason = e.samples.iter().find_map(|s| s.as_ref().err());
        reason.cloned().unwrap_or_default()
    });
    columns.extend([
        Column::whole("seeds", seeds),
        Column::real("chi_squared", "1", all.iter().map(|e| e.chi_squared)),
        Column::text("reason", reasons),
    ]);
    Table { columns }
}

/// Returns measured and fitted values in columns. The units of the tests differ, so those of each
/// row are in columns of their own.
fn curves(tests: &Tests, found: &SearchResult, outcome: &Outcome) -> Table {
    let (mean, deviation) = mean_of(&found.evaluations[outcome.best]).unwrap_or_default();
    let target = &tests.target;
    let count = target.measured().len();
    let of_rows = |of: &dyn Fn(usize) -> String| -> Vec<String> {
        let all = target.tests().iter().enumerate();
        all.flat_map(|(t, test)| vec![of(t); test.x.len()])
            .collect()
    };
    let x = target.tests().iter().flat_map(|t| &t.x);
    let known = |values: &[f64]| -> Vec<Option<f64>> {
        (0..count).map(|k| values.get(k).copied()).collect()
    };
    Table {
        columns: vec![
            Column::text("test", of_rows(&|t| target.tests()[t].name.clone())),
            Column::real("x", "", x.map(|x| Some(*x))),
            Column::real("measured", "", known(&target.measured())),
            Column::real("sigma", "", known(&target.sigma())),
            Column::real("fitted", "", known(&mean)),
            Column::real("scatter", "", known(&deviation.unwrap_or_default())),
            Column::text("x_unit", of_rows(&|t| tests.units[t].x.clone())),
            Column::text("unit", of_rows(&|t| tests.units[t].value.clone())),
        ],
    }
}
