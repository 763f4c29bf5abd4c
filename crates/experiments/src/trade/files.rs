//! Output files: `trade.json`, `trade.csv` and `trade.png`.

use super::combination::Combination;
use super::compare::{Comparison, OutputError, Row};
use super::figure::draw;
use super::output::ErrorTarget;
use super::plan::Findings;
use super::plan::Trade;
use super::verdict::Verdict;
use crate::Error;
use crate::table::{Column, ColumnType, Table, csv};
use fretwork_math::statistics::interval::CONFIDENCE;
use serde_json::{Value, json};
use std::path::Path;

/// Writes the files of a trade into its folder; returns its JSON, and whether there is a picture.
///
/// # Errors
/// A file cannot be written.
pub fn write(trade: &Trade, answer: &Findings, out: &Path) -> Result<(String, bool), Error> {
    let found = &answer.found;
    let json = json(trade, found, &answer.verdicts, answer.complete);
    let json = serde_json::to_string_pretty(&json).unwrap_or_default();
    let path = out.join("trade.json");
    std::fs::write(&path, format!("{json}\n")).map_err(|e| Error::write(&path, &e))?;
    csv::write(
        &settings(trade, found),
        &out.join("trade.csv"),
        csv::NumberFormat::Exponents,
    )?;
    let picture = out.join("trade.png");
    let drawn = draw(trade, found, &picture)?;
    if !drawn {
        // A picture of an earlier trade would be mistaken for one of this trade.
        let _ = std::fs::remove_file(&picture);
    }
    Ok((json, drawn))
}

fn json(trade: &Trade, found: &Comparison, verdicts: &[Verdict], complete: bool) -> Value {
    let reference = Combination::reference(&trade.parameters);
    let number = |x: f64| if x.is_finite() { json!(x) } else { Value::Null };
    let outputs: Vec<Value> = trade
        .outputs
        .iter()
        .zip(&found.own)
        .map(|(o, own)| {
            let (kind, wanted) = match o.wanted {
                ErrorTarget::Relative(w) => ("relative", w),
                ErrorTarget::Absolute(w) => ("absolute", w),
            };
            json!({
                "name": o.name(), "unit": o.unit, "wanted": wanted, "error": kind, "exact": o.exact,
                "reference": own.as_ref().map(|x| x.value),
                "reference_error_at_most": own.as_ref().map(|x| number(x.at_most)),
                "reference_error_from": own.as_ref().map(|x| x.why.clone()),
            })
        })
        .collect();
    let settings: Vec<Value> = found
        .rows
        .iter()
        .map(|r| {
            let errors: serde_json::Map<String, Value> = trade
                .outputs
                .iter()
                .zip(&r.errors)
                .map(|(o, e)| {
                    let known = e.as_ref().map(|e| {
                        json!({
                            "value": e.value, "error": e.error, "at_most": number(e.at_most),
                            "at_most_with_reference": number(e.bound),
                            "distinguishable_from_zero": !e.error.may_be_zero(), "frontier": e.on_frontier,
                        })
                    });
                    (o.name().to_owned(), json!(known))
                })
                .collect();
            json!({
                "setting": r.name, "sets": r.setting.sets(&trade.parameters), "reference": r.setting == reference,
                "seeds": r.seeds, "failed": r.failed, "not_trustworthy": r.doubted, "reasons": r.doubts, "seconds": r.seconds, "visits": r.visits,
                "faster": r.faster.map(|f| f.0), "faster_interval": r.faster.and_then(|f| f.1), "outputs": errors,
            })
        })
        .collect();
    let cheapest: Vec<Value> = verdicts
        .iter()
        .map(|v| {
            json!({
                "wanted": v.wanted, "holds": v.holds, "text": v.text,
                "setting": v.row.map(|k| found.rows[k].name.clone()),
                "sets": v.row.map(|k| found.rows[k].setting.sets(&trade.parameters)),
                "faster": v.row.and_then(|k| found.rows[k].faster).map(|f| f.0),
            })
        })
        .collect();
    json!({
        "case": trade.launcher.case, "confidence": CONFIDENCE, "complete": complete, "seeds": trade.seeds,
        "random": trade.random, "nudged": trade.random && trade.launcher.perturbation.is_some(), "outputs": outputs, "settings": settings, "cheapest": cheapest,
        "forecast": trade.cost, "runs": {"fresh": trade.fresh, "reused": trade.reused},
        "left_out": trade.left_out.iter().map(|s| s.name(&trade.parameters)).chain(trade.dropped()).collect::<Vec<_>>(),
        "wall_seconds": trade.started.elapsed().as_secs_f64(), "notes": trade.notes,
    })
}

/// Returns one row per setting; errors are fractions of the reference's value or in the output's
/// unit, as requested.
fn settings(trade: &Trade, found: &Comparison) -> Table {
    let rows = &found.rows;
    let reference = Combination::reference(&trade.parameters);
    let flag = |flag: bool| Some(f64::from(u8::from(flag)));
    let of = |f: &dyn Fn(&Row) -> Option<f64>| rows.iter().map(f).collect::<Vec<_>>();
    let text = |f: &dyn Fn(&Row) -> String| rows.iter().map(f).collect::<Vec<_>>();
    let ends = |r: &Row| r.faster.and_then(|f| f.1);
    let mut columns = vec![
        Column::text("setting", text(&|r| r.name.clone())),
        Column::whole("reference", of(&|r| flag(r.setting == reference))),
        Column::whole("seeds", of(&|r| Some(r.seeds as f64))),
        Column::text("failed", text(&|r| r.failed.clone().unwrap_or_default())),
        Column::text(
            "not_trustworthy",
            text(&|r| r.not_trustworthy().unwrap_or_default()),
        ),
        Column::real("seconds", "s", of(&|r| Some(r.seconds))),
        Column::real("visits", "1", of(&|r| Some(r.visits))),
        Column::real("faster", "1", of(&|r| r.faster.map(|f| f.0))),
        Column::real("faster_low", "1", of(&|r| ends(r).map(|e| e.0))),
        Column::real("faster_high", "1", of(&|r| ends(r).map(|e| e.1))),
    ];
    for (k, parameter) in trade.parameters.iter().enumerate() {
        let label = |r: &Row| parameter.levels[r.setting.0[k]].label.clone();
        columns.push(Column::text(&parameter.name, text(&label)));
    }
    for (o, output) in trade.outputs.iter().enumerate() {
        let of = |name: &str, unit: &str, f: &dyn Fn(&OutputError) -> Option<f64>| {
            let name = format!("{}{name}", output.name());
            Column::real(name, unit, of(&|r| r.errors[o].as_ref().and_then(f)))
        };
        let own = output.unit.as_str();
        let error = match output.wanted {
            ErrorTarget::Relative(_) => "1",
            ErrorTarget::Absolute(_) => own,
        };
        columns.extend([
            of("", own, &|e| Some(e.value.mean)),
            of("_scatter", own, &|e| e.value.scatter),
            of("_error", error, &|e| Some(e.error.mean)),
            of("_half_width", error, &|e| e.error.half_width),
            of("_at_most", error, &|e| Some(e.at_most)),
            of("_at_most_with_reference", error, &|e| Some(e.bound)),
            Column {
                kind: ColumnType::Whole,
                ..of("_frontier", "1", &|e| flag(e.on_frontier))
            },
        ]);
    }
    Table { columns }
}
