//! Text at the end of a run: in brief, or with all details: warnings, then the results of the
//! observers, by topic.

use super::Summary;
use crate::quantity::{Findings, Quantity, Role, Topic, Wording, half_width, quantity};
use std::fmt::Write as _;

/// Where the inputs are told.
const INPUTS: (&str, &str) = (
    "inputs",
    "each parameter of the laws with its origin: fretwork check CASE --inputs",
);

impl Summary {
    /// The text: a few lines, or warnings and results with all details if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        if !verbose {
            return self.brief().join("\n") + "\n";
        }
        let mut out = String::new();
        let _ = writeln!(out, "{}", self.run.verdict);
        if self.run.trustworthy {
            let _ = writeln!(out, "  {}", self.run.grade_sentence);
        }
        for warning in &self.run.warnings {
            let _ = writeln!(out, "  {warning}");
        }
        let _ = writeln!(out, "{}", self.run.case);
        let (label, text) = INPUTS;
        let _ = writeln!(out, "  {label:<22} {text}");
        for (label, text) in lines(&self.quantities()) {
            let _ = writeln!(out, "  {label:<22} {text}");
        }
        out
    }
}

/// Returns labels and texts, by topic; details of all topics come before the course of the run.
fn lines(all: &Findings) -> Vec<(String, String)> {
    let shown = all.all().iter();
    let mut list: Vec<&Quantity> = shown.filter(|q| q.wording != Wording::Silent).collect();
    list.sort_by_key(|q| (q.role >= Role::Detail, q.topic));
    // The line of the whole run is the last.
    let last = |q: &&Quantity| q.topic == Topic::Run && q.role == Role::Secondary;
    let (ends, list): (Vec<&Quantity>, Vec<&Quantity>) = list.into_iter().partition(last);
    let dimension = all.dimension();
    let list = list.into_iter().chain(ends);
    list.filter_map(|q| line(q, dimension)).collect()
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
    let of = estimate.value.or(q.value.as_f64()).unwrap_or(0.0);
    let half = |h: f64| half_width(h, of, unit);
    let settings = estimate.from_settings(half);
    let open = match estimate.is_determined() {
        Some(false) => "not determined: ",
        _ => "",
    };
    Some(match (estimate.value, estimate.scatter) {
        (Some(mean), Some(scatter)) => {
            let scope = [&estimate.scope, &estimate.method].into_iter().flatten();
            let scope: Vec<&str> = scope.map(String::as_str).collect();
            let method = match scope.is_empty() {
                true => String::new(),
                false => format!(" ({})", scope.join("; ")),
            };
            let own = match Some(mean) == q.value.as_f64() {
                true => remark,
                false => format!("; {value}{remark}"),
            };
            format!(
                "{open}{} +- {}{method}{settings}{own}",
                quantity(mean, unit),
                half(scatter)
            )
        }
        _ => format!("{open}{value}{settings}{remark}"),
    })
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
