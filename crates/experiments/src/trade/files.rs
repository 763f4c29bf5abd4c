//! Output files `trade.json` and `trade.csv`.

use super::TradeError;
use super::compare::Comparison;
use super::interval::CONFIDENCE;
use super::output::Wanted;
use super::setting::Setting;
use super::study::Study;
use super::verdict::Verdict;
use crate::runs::cells::guarded;
use serde_json::{Value, json};

/// The whole study as JSON.
pub fn json(study: &Study, found: &Comparison, verdicts: &[Verdict], complete: bool) -> Value {
    let reference = Setting::reference(&study.parameters);
    let number = |x: f64| if x.is_finite() { json!(x) } else { Value::Null };
    let outputs: Vec<Value> = study
        .outputs
        .iter()
        .zip(&found.own)
        .map(|(o, own)| {
            let (kind, wanted) = match o.wanted {
                Wanted::Relative(w) => ("relative", w),
                Wanted::Absolute(w) => ("absolute", w),
            };
            json!({
                "name": o.name(), "wanted": wanted, "error": kind, "exact": o.exact,
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
            let errors: serde_json::Map<String, Value> = study
                .outputs
                .iter()
                .zip(&r.errors)
                .map(|(o, e)| {
                    let told = e.as_ref().map(|e| {
                        json!({
                            "value": e.value, "error": e.error, "at_most": number(e.at_most),
                            "at_most_with_reference": number(e.bound),
                            "distinguishable_from_zero": !e.error.may_be_zero(), "frontier": e.on_frontier,
                        })
                    });
                    (o.name().to_owned(), json!(told))
                })
                .collect();
            json!({
                "setting": r.name, "sets": r.setting.sets(&study.parameters), "reference": r.setting == reference,
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
                "sets": v.row.map(|k| found.rows[k].setting.sets(&study.parameters)),
                "faster": v.row.and_then(|k| found.rows[k].faster).map(|f| f.0),
            })
        })
        .collect();
    json!({
        "case": study.launcher.case, "confidence": CONFIDENCE, "complete": complete, "seeds": study.seeds,
        "random": study.random, "nudged": study.random && study.launcher.perturbation.is_some(), "outputs": outputs, "settings": settings, "cheapest": cheapest,
        "forecast": study.forecast, "runs": {"fresh": study.fresh, "reused": study.reused},
        "left_out": study.left_out.iter().map(|s| s.name(&study.parameters)).chain(study.dropped()).collect::<Vec<_>>(),
        "wall_seconds": study.started.elapsed().as_secs_f64(), "notes": study.notes,
    })
}

/// Writes one line per setting; errors are fractions of the reference's value or in the output's unit, as requested.
///
/// # Errors
/// The file cannot be written.
pub fn csv(study: &Study, found: &Comparison, path: &std::path::Path) -> Result<(), TradeError> {
    let fail = |e: csv::Error| TradeError::write(path, &e);
    let mut table = csv::Writer::from_path(path).map_err(fail)?;
    let mut header: Vec<String> = [
        "setting",
        "reference",
        "seeds",
        "failed",
        "not_trustworthy",
        "seconds",
        "visits",
        "faster",
        "faster_low",
        "faster_high",
    ]
    .map(str::to_owned)
    .into();
    header.extend(study.parameters.iter().map(|k| k.name.clone()));
    for o in &study.outputs {
        let columns = [
            "",
            "_scatter",
            "_error",
            "_half_width",
            "_at_most",
            "_at_most_with_reference",
            "_frontier",
        ];
        header.extend(columns.map(|c| format!("{}{c}", o.name())));
    }
    let header = header.iter().map(|heading| guarded(heading));
    table.write_record(header).map_err(fail)?;
    let reference = Setting::reference(&study.parameters);
    let maybe = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:e}"));
    for r in &found.rows {
        let ends = r.faster.and_then(|f| f.1);
        let mut row = vec![
            guarded(&r.name),
            u8::from(r.setting == reference).to_string(),
            r.seeds.to_string(),
            guarded(&r.failed.clone().unwrap_or_default()),
            guarded(&r.doubt().unwrap_or_default()),
            format!("{:e}", r.seconds),
            format!("{:e}", r.visits),
            maybe(r.faster.map(|f| f.0)),
            maybe(ends.map(|e| e.0)),
            maybe(ends.map(|e| e.1)),
        ];
        row.extend(
            study
                .parameters
                .iter()
                .zip(&r.setting.0)
                .map(|(k, l)| guarded(&k.levels[*l].label)),
        );
        for e in &r.errors {
            let e = e.as_ref();
            row.extend([
                maybe(e.map(|e| e.value.mean)),
                maybe(e.and_then(|e| e.value.scatter)),
                maybe(e.map(|e| e.error.mean)),
                maybe(e.and_then(|e| e.error.half_width)),
                maybe(e.map(|e| e.at_most)),
                maybe(e.map(|e| e.bound)),
                e.map_or(String::new(), |e| u8::from(e.on_frontier).to_string()),
            ]);
        }
        table.write_record(&row).map_err(fail)?;
    }
    table.flush().map_err(|e| TradeError::write(path, &e))
}
