//! Texts of `fretwork study`: the parts of a study, and the results of its runs.

use super::files::{PARQUET, Written};
use super::forecast::Forecast;
use super::plan::{Plan, Point};
use super::rows::Rows;
use super::spec::DesignSpec;
use crate::duration::seconds;
use crate::factor::Level;
use crate::runs::stored::summary;
use crate::table::Cell;
use fretwork_math::sensitivity::ranks::rank_correlations;
use fretwork_math::statistics::interval::Mean;
use fretwork_observe::quantity::{DETERMINED, number, quantity, with_half_width};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// Describes the parts of a study, and the forecast for the remaining runs with parallel jobs.
pub fn consists_of(plan: &Plan, open: usize, forecast: Option<&Forecast>, jobs: usize) -> String {
    let mut out = format!("{}: {}\n", plan.file.display(), plan.title);
    for (k, factor) in plan.factors.iter().enumerate() {
        let values = match plan.labels(k).as_slice() {
            few if few.len() <= 8 => few.join(", "),
            all => match ends(plan, k) {
                Some((low, high)) => format!("{low} to {high} ({} values)", all.len()),
                None => format!(
                    "{}, {}, ... {} ({} values)",
                    all[0],
                    all[1],
                    all[all.len() - 1],
                    all.len()
                ),
            },
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
    let Some(forecast) = forecast.filter(|_| open > 0) else {
        return out.trim_end().to_owned();
    };
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

/// The smallest and the largest value of a factor of numbers.
fn ends(plan: &Plan, factor: usize) -> Option<(String, String)> {
    if !plan.is_numeric(factor) {
        return None;
    }
    let given = |v: &&Level| v.number.is_some();
    let values = || plan.settings.iter().map(|s| &s[factor]).filter(given);
    let number = |v: &&Level| v.number.unwrap_or(f64::NAN);
    let low = values().min_by(|a, b| number(a).total_cmp(&number(b)))?;
    let high = values().max_by(|a, b| number(a).total_cmp(&number(b)))?;
    Some((low.short(), high.short()))
}

/// Lists each run with its changes of the case.
pub fn points(plan: &Plan) -> String {
    let line = |p: Point| {
        let sets: Vec<String> = p.run.sets.iter().map(|s| format!("--set '{s}'")).collect();
        format!("{:>6}  {}  {}", p.number, plan.words(&p), sets.join(" "))
    };
    plan.points().map(line).collect::<Vec<_>>().join("\n")
}

/// Returns the output of `study check` as JSON; times are in seconds on one worker, null where
/// unknown.
pub fn check_json(plan: &Plan, open: usize, forecast: Option<&Forecast>, points: bool) -> String {
    let factors: Vec<Value> = plan.factors.iter().enumerate().map(|(k, factor)| {
        json!({"name": factor.name, "keys": factor.keys, "unit": plan.unit_of(k), "values": plan.labels(k)})
    }).collect();
    let outputs: Vec<&str> = plan.outputs.iter().map(|o| o.name.as_str()).collect();
    let point = |p: Point| json!({"point": p.number, "setting": p.setting, "seed": p.run.seed, "set": p.run.sets});
    let mut whole = json!({
        "title": plan.title, "case": plan.launcher.case, "factors": factors, "outputs": outputs, "regimes": plan.regimes,
        "settings": plan.settings.len(), "seeds": plan.seeds, "seed_matters": plan.random,
        "runs": {"all": plan.count(), "to_be_made": open},
        // JSON has no number for infinity.
        "forecast": forecast.map(|f| json!({
            "seconds": f.about, "least": f.least, "most": Some(f.most).filter(|s| s.is_finite()), "from_runs": f.measured,
        })),
    });
    if points {
        whole["points"] = plan.points().map(point).collect();
    }
    serde_json::to_string_pretty(&whole).unwrap_or_default()
}

/// Describes the content of a table and the files that were written.
pub fn collected(plan: &Plan, rows: &Rows, written: &Written) -> String {
    let counts = rows.counts();
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
    let picture = written.picture.then_some("study.png");
    let pages = ["study.html"].into_iter().chain(picture);
    let parquet = cfg!(feature = "parquet").then_some(PARQUET);
    let names = pages
        .chain(["table.csv"])
        .chain(parquet)
        .chain(["settings.csv"]);
    let folder = plan.out.display();
    let files: Vec<String> = names.map(|name| format!("{folder}/{name}")).collect();
    let _ = write!(out, "\n{}", files.join(", "));
    let of_laws = written.law_tables.iter().cloned();
    for line in of_laws.chain(intervals(plan, rows)) {
        let _ = write!(out, "\n{line}");
    }
    for name in rows.without_text(&plan.regimes) {
        let texts = match first_texts(plan, rows).join("`, `") {
            none if none.is_empty() => String::new(),
            texts => format!("; name one of `{texts}`"),
        };
        let _ = write!(
            out,
            "\n`regimes` names `{name}`, which is no text in the summary of any run{texts}"
        );
    }
    out
}

/// Probability below which a rank correlation is not by chance.
const BY_CHANCE: f64 = 0.05;

/// Returns the interval of each output of a study whose runs are one sample: seeds of one setting,
/// or points drawn over ranges, with the input that it follows most.
fn intervals(plan: &Plan, rows: &Rows) -> Vec<String> {
    let drawn = matches!(
        plan.design,
        DesignSpec::LatinHypercube { .. } | DesignSpec::Sobol { .. }
    );
    let line = |(name, unit): (&String, &String)| {
        let all = rows.trusted(name);
        let values: Vec<f64> = all.iter().copied().flatten().collect();
        let mean = Mean::of(&values)?;
        if plan.settings.len() == 1 {
            return Some(format!("{name}: {}", over_seeds(&mean, unit)?));
        }
        let shown = |x: f64| quantity(x, unit);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let follows = followed(plan, &all);
        (drawn && values.len() > 1).then(|| {
            format!(
                "{name}: {} to {} over {} runs within the ranges of the inputs, mean {}{follows}",
                shown(low),
                shown(high),
                values.len(),
                shown(mean.mean)
            )
        })
    };
    let names: Vec<String> = plan.outputs.iter().map(|o| o.name.clone()).collect();
    let mut out: Vec<String> = names
        .iter()
        .zip(&plan.output_units)
        .filter_map(line)
        .collect();
    let doubted = rows.doubted();
    if doubted > 0 {
        out.push(format!(
            "{doubted} of the runs are not trustworthy (`not_trustworthy` in the table says why)"
        ));
    }
    out
}

/// Returns a mean over seeds with its half-width, and whether that determines it; `None` for one
/// seed.
fn over_seeds(mean: &Mean, unit: &str) -> Option<String> {
    let half = mean.half_width?;
    let text = with_half_width(mean.mean, half, unit);
    let text = format!("{text} over {} seeds (95 %)", mean.count);
    let share = half / mean.mean.abs();
    Some(match share <= DETERMINED {
        true => text,
        false => format!("not determined: {text}; more seeds narrow it"),
    })
}

/// Names the input whose ranks an output follows most, with the correlation; empty where that may
/// be by chance.
fn followed(plan: &Plan, outputs: &[Option<f64>]) -> String {
    let points = plan.points().map(|p| numbers(plan, &p));
    let Some(points) = points.collect::<Option<Vec<Vec<f64>>>>() else {
        return String::new();
    };
    let ranks = rank_correlations(&points, outputs).unwrap_or_default();
    let ranks = ranks.iter().zip(&plan.factors);
    let real = ranks.filter(|(rank, _)| rank.p.is_some_and(|p| p < BY_CHANCE));
    let most = real.max_by(|a, b| a.0.value.abs().total_cmp(&b.0.value.abs()));
    most.map_or(String::new(), |(rank, factor)| {
        format!(
            "; it follows {} most (rank correlation {})",
            factor.name,
            number(rank.value, 2)
        )
    })
}

/// Returns the numbers of the factors at a point; `None` where one is no number.
fn numbers(plan: &Plan, point: &Point) -> Option<Vec<f64>> {
    let levels = plan.settings[point.setting - 1].iter();
    levels.map(|level| level.number).collect()
}

/// Returns the names of the texts in the summary of the first completed run, which `regimes` may
/// name.
fn first_texts(plan: &Plan, rows: &Rows) -> Vec<String> {
    let Some(run) = rows.done().next() else {
        return Vec::new();
    };
    let summary = summary(&plan.launcher.folder.join(rows.table.text("folder", run)));
    let mut names = Vec::new();
    for (key, value) in summary.as_object().into_iter().flatten() {
        match value {
            Value::String(_) => names.push(key.clone()),
            Value::Object(parts) => {
                let texts = parts.iter().filter(|(_, v)| v.is_string());
                names.extend(texts.map(|(part, _)| format!("{key}.{part}")));
            }
            _ => {}
        }
    }
    names
}

/// The table as JSON: columns with units, rows, and counts.
pub fn json(plan: &Plan, rows: &Rows) -> String {
    let counts = rows.counts();
    let columns: Map<String, Value> = rows
        .table
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
