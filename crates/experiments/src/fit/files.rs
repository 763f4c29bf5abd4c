//! Files of a fit: `fit.json`, `evaluations.csv`, `curves.csv`.

use super::evaluate::Tests;
use super::outcome::{HalfStep, Outcome, mean_of};
use super::search::Found;
use super::spec::ReadFit;
use crate::runs::RunsError;
use crate::runs::cells::guarded;
use serde_json::{Value, json};
use std::path::Path;

/// The fit as JSON.
pub fn json(read: &ReadFit, tests: &Tests, found: &Found, outcome: &Outcome) -> Value {
    let told = &outcome.identification;
    let number = |x: f64| if x.is_finite() { json!(x) } else { Value::Null };
    let names: Vec<&str> = read
        .spec
        .parameters
        .iter()
        .map(|p| p.name.as_str())
        .collect();
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
    let parameters: Vec<Value> = told
        .estimates
        .iter()
        .zip(&read.spec.parameters)
        .enumerate()
        .map(|(place, (e, spec))| {
            json!({
                "half_step": half(place), "name": e.name, "value": e.value, "unit": spec.unit, "low": e.interval.low, "high": e.interval.high,
                "simultaneous_low": e.simultaneous.low, "simultaneous_high": e.simultaneous.high,
                "determined": e.determined, "open_below": e.open_below, "open_above": e.open_above, "at": e.at,
            })
        })
        .collect();
    let directions: Vec<Value> = told
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
        "title": read.spec.title, "parameters": parameters, "correlation": told.correlation, "directions": directions,
        "chi_squared": best.chi_squared.map(number), "values": tests.target.measured().len(),
        "reduced": told.reduced.map(number), "p": told.p, "describes": told.describes, "widened": number(told.widened), "at_edge": told.at_edge, "settled": outcome.settled,
        "ended": found.ended, "evaluations": found.evaluations.len(),
        "failed": found.evaluations.iter().filter(|e| e.chi_squared.is_none()).count(),
        "step_not_small": step_not_small, "half_step_failed": half_step_failed, "random": tests.random, "tests": sets,
    })
}

/// All points that were run, with the reason where one failed.
///
/// # Errors
/// The file cannot be written.
pub fn evaluations(tests: &Tests, found: &Found, path: &Path) -> Result<(), RunsError> {
    let fail = |e: &dyn std::fmt::Display| RunsError::write(path, e);
    let mut out = csv::Writer::from_path(path).map_err(|e| fail(&e))?;
    let mut heads = vec!["evaluation".to_owned(), "stage".to_owned()];
    heads.extend(tests.bounds.parameters().iter().map(|p| p.name.clone()));
    heads.extend(["seeds", "chi_squared", "reason"].map(str::to_owned));
    let heads = heads.iter().map(|head| guarded(head));
    out.write_record(heads).map_err(|e| fail(&e))?;
    for (k, e) in found.evaluations.iter().enumerate() {
        let mut row = vec![(k + 1).to_string(), e.stage.word()];
        row.extend(e.values.iter().map(|v| format!("{v:e}")));
        row.push(e.samples.len().to_string());
        row.push(e.chi_squared.map_or(String::new(), |x| format!("{x:e}")));
        let reason = e.samples.iter().find_map(|s| s.as_ref().err());
        row.push(reason.map(|text| guarded(text)).unwrap_or_default());
        out.write_record(&row).map_err(|e| fail(&e))?;
    }
    out.flush().map_err(|e| fail(&e))
}

/// Measured and fitted values side by side.
///
/// # Errors
/// The file cannot be written.
pub fn curves(
    tests: &Tests,
    found: &Found,
    outcome: &Outcome,
    path: &Path,
) -> Result<(), RunsError> {
    let fail = |e: &dyn std::fmt::Display| RunsError::write(path, e);
    let mut out = csv::Writer::from_path(path).map_err(|e| fail(&e))?;
    let heads = ["test", "x", "measured", "sigma", "fitted", "scatter"];
    out.write_record(heads).map_err(|e| fail(&e))?;
    let (mean, deviation) = mean_of(&found.evaluations[outcome.best]).unwrap_or_default();
    let mut place = 0;
    for test in tests.target.tests() {
        for j in 0..test.x.len() {
            let fitted = mean.get(place).map_or(String::new(), |v| format!("{v:e}"));
            let scatter = deviation
                .as_ref()
                .and_then(|d| d.get(place))
                .map_or(String::new(), |v| format!("{v:e}"));
            let row = [
                guarded(&test.name),
                format!("{:e}", test.x[j]),
                format!("{:e}", test.y[j]),
                format!("{:e}", test.sigma[j]),
                fitted,
                scatter,
            ];
            out.write_record(&row).map_err(|e| fail(&e))?;
            place += 1;
        }
    }
    out.flush().map_err(|e| fail(&e))
}
