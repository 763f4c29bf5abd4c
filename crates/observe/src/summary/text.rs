//! Text at the end of a run: warnings, then the results of the observers, by topic.

use super::Summary;
use crate::quantity::{Findings, Quantity, Role, Topic, Wording, number, quantity};
use std::fmt::Write as _;

/// Largest number of plain values of a topic that are printed without `--verbose`.
const MAX_PLAIN_VALUES: usize = 8;

impl Summary {
    /// The text: warnings first, then the results, with all details if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut out = String::new();
        if !self.run.trustworthy {
            out += "NOT TRUSTWORTHY\n";
        }
        for warning in &self.run.warnings {
            let _ = writeln!(out, "  {warning}");
        }
        let _ = writeln!(out, "{}", self.run.case);
        let all = self.quantities();
        for (label, text) in lines(&all, verbose) {
            let _ = writeln!(out, "  {label:<22} {text}");
        }
        out
    }
}

/// Returns labels and texts, by topic; details of all topics come before the course of the run.
fn lines(all: &Findings, verbose: bool) -> Vec<(String, String)> {
    let mut list: Vec<&Quantity> = all
        .all()
        .iter()
        .filter(|q| q.wording != Wording::Silent)
        .collect();
    list.retain(|q| verbose || q.role <= Role::Secondary);
    list.sort_by_key(|q| (q.role >= Role::Detail, q.topic));
    // The line of the whole run is the last.
    let last = |q: &&Quantity| q.topic == Topic::Run && q.role == Role::Secondary;
    let (ends, list): (Vec<&Quantity>, Vec<&Quantity>) = list.into_iter().partition(last);
    let dimension = all.dimension();
    let mut out = Vec::new();
    let plain = |q: &&&Quantity, topic| q.topic == topic && matches!(q.wording, Wording::Value(_));
    let mut folded = Vec::new();
    for q in &list {
        let count = list.iter().filter(|other| plain(other, q.topic)).count();
        if plain(&q, q.topic) && !verbose && count > MAX_PLAIN_VALUES {
            let group = q.name().split('.').next().unwrap_or_default().to_owned();
            if !folded.contains(&group) {
                let text = format!("{count} values: --verbose, or `{group}` in summary.json");
                out.push((group.clone(), text));
                folded.push(group);
            }
            continue;
        }
        out.extend(line(q, dimension));
    }
    out.extend(ends.iter().filter_map(|q| line(q, dimension)));
    out
}

fn line(q: &Quantity, dimension: usize) -> Option<(String, String)> {
    match &q.wording {
        Wording::Silent => None,
        Wording::Sentence(label, text) => Some((label.clone(), text.clone())),
        Wording::Value(remark) => Some((q.label(), with_remark(q, remark, dimension)?)),
    }
}

/// Returns a value with its half-widths: `0.4020 +- 0.0006 (how) +- 0.001 (step); 0.4010 in cycle
/// 50`.
fn with_remark(q: &Quantity, remark: &str, dimension: usize) -> Option<String> {
    let unit = q.unit.symbol(dimension);
    let value = match &q.value {
        serde_json::Value::Number(n) if n.is_f64() => quantity(n.as_f64()?, unit),
        serde_json::Value::Number(n) => n.to_string(),
        serde_json::Value::String(text) => text.clone(),
        serde_json::Value::Bool(flag) => flag.to_string(),
        _ => return None,
    };
    let remark = match remark {
        "" => String::new(),
        remark => format!(" {remark}"),
    };
    let Some(estimate) = &q.estimate else {
        return Some(value + &remark);
    };
    let half = |h: f64| match unit {
        "1" => number(h, 2),
        unit => quantity(h, unit),
    };
    let settings = estimate.from_settings(half);
    Some(match (estimate.value, estimate.scatter) {
        (Some(mean), Some(scatter)) => {
            let method = estimate.method.as_ref();
            let method = method.map_or(String::new(), |m| format!(" ({m})"));
            let own = match Some(mean) == q.value.as_f64() {
                true => remark,
                false => format!("; {value}{remark}"),
            };
            format!(
                "{} +- {}{method}{settings}{own}",
                quantity(mean, unit),
                half(scatter)
            )
        }
        _ => format!("{value}{settings}{remark}"),
    })
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
