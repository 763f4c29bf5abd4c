//! What `fretwork study` says: what a study consists of, and what its runs left.

use crate::runs::duration::seconds;
use crate::study::forecast::Forecast;
use crate::study::plan::Plan;
use crate::study::table::{Cell, Table};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What a study consists of, and the forecast for runs that are to be made with parallel jobs.
pub fn consists_of(plan: &Plan, open: usize, forecast: &Forecast, jobs: usize) -> String {
    let mut out = format!("{}: {}\n", plan.file.display(), plan.title);
    for factor in &plan.factors {
        let mut labels: Vec<&str> = Vec::new();
        let place = plan
            .factors
            .iter()
            .position(|f| f.name == factor.name)
            .unwrap_or(0);
        for setting in &plan.settings {
            let label = setting[place].label.as_str();
            if !labels.contains(&label) {
                labels.push(label);
            }
        }
        let values = match labels.as_slice() {
            few if few.len() <= 8 => few.join(", "),
            many => format!(
                "{}, {}, ... {} ({} values)",
                many[0],
                many[1],
                many[many.len() - 1],
                many.len()
            ),
        };
        let _ = writeln!(out, "  {}: {values}", factor.name);
    }
    let outputs: Vec<&str> = plan.outputs.iter().map(|o| o.name.as_str()).collect();
    let _ = writeln!(out, "  outputs: {}", outputs.join(", "));
    let seeds = plan.seeds.len();
    let _ = writeln!(
        out,
        "  {} settings x {seeds} seed{} = {} runs, of which {} {} to be made",
        plan.settings.len(),
        if seeds == 1 { "" } else { "s" },
        plan.count(),
        open,
        if open == 1 { "is" } else { "are" },
    );
    if !plan.random && seeds > 1 {
        let _ = writeln!(
            out,
            "  nothing in the case is drawn from its seed: runs with steps longer by multiples of 1e-10 of themselves take the place of seeds"
        );
    }
    if open == 0 {
        return out.trim_end().to_owned();
    }
    let jobs = jobs as f64;
    let source = if forecast.measured {
        "from the runs that ended"
    } else {
        "from a few steps of up to three of them"
    };
    let _ = match forecast.about {
        Some(about) => writeln!(
            out,
            "  forecast: {}, between {} and {}, {source}",
            seconds(about / jobs),
            seconds(forecast.least / jobs),
            seconds(forecast.most / jobs)
        ),
        None => writeln!(
            out,
            "  forecast: more than {}",
            seconds(forecast.least / jobs)
        ),
    };
    out.trim_end().to_owned()
}

/// What a table holds and where it is.
pub fn collected(plan: &Plan, table: &Table) -> String {
    let counts = table.counts();
    let mut out = format!("{} of {} runs done", counts.done, counts.all);
    if counts.failed > 0 {
        let _ = write!(
            out,
            ", {} failed (their reasons are in the table)",
            counts.failed
        );
    }
    if counts.missing > 0 {
        let _ = write!(out, ", {} not run", counts.missing);
    }
    let _ = write!(
        out,
        "\n{0}/study.html, {0}/study.png, {0}/table.csv, {0}/table.parquet, {0}/settings.csv",
        plan.out.display()
    );
    out
}

/// The table as JSON: columns with units, rows, and counts.
pub fn json(plan: &Plan, table: &Table) -> String {
    let counts = table.counts();
    let columns: Map<String, Value> = table
        .columns
        .iter()
        .map(|c| {
            let cells: Vec<Value> = c.cells.iter().map(cell).collect();
            (c.name.clone(), json!({"unit": c.unit, "values": cells}))
        })
        .collect();
    let factors: Vec<&str> = plan.factors.iter().map(|f| f.name.as_str()).collect();
    let outputs: Vec<&str> = plan.outputs.iter().map(|o| o.name.as_str()).collect();
    let whole = json!({
        "title": plan.title, "case": plan.launcher.case, "factors": factors, "outputs": outputs,
        "runs": {"all": counts.all, "done": counts.done, "failed": counts.failed, "not_run": counts.missing},
        "columns": columns,
    });
    serde_json::to_string_pretty(&whole).unwrap_or_default()
}

fn cell(cell: &Cell) -> Value {
    match cell {
        Cell::Number(x) => json!(x),
        Cell::Text(text) => json!(text),
        Cell::Unknown => Value::Null,
    }
}
