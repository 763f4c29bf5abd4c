//! Results with their intervals, and the complete summary.

use super::escape;
use crate::html::folder::RunFolder;
use crate::html::results::{self, ResultGroup, ResultRow};
use crate::html::statistics::{Column, Statistics};
use fretwork_observe::quantity::{Catalogue, Role};
use fretwork_store::summary::NOT_REPRODUCIBLE;
use serde_json::Value;

/// Number of rows of a group that are shown; the rest is folded.
const MAX_UNFOLDED_ROWS: usize = 12;

/// The results of a run.
pub(crate) fn html(run: &RunFolder, series: &Statistics) -> String {
    if run.summary.is_null() {
        return last_row(series);
    }
    let groups = results::groups(run);
    if groups.is_empty() {
        // The summary was written by a version without a catalogue.
        return everything(&run.summary, &Catalogue::default());
    }
    let mut out = String::from(
        "<p class=\"lead\">Half-widths are of 95 % intervals, by cause: scatter within this sample, and what a finer time step or a \
         tighter tolerance would change, estimated from repeated steps. A result whose half-widths together exceed a quarter of it is \
         not determined.</p>\n",
    );
    for group in &groups {
        out += &table(group);
    }
    out + &everything(&run.summary, &Catalogue::of(&run.summary))
}

/// Returns the main results of a run, for the top of its page; empty where there are none.
pub(crate) fn headline(run: &RunFolder) -> String {
    let groups = results::groups(run).into_iter();
    let rows = groups.flat_map(|(_, rows)| rows);
    let main: String = rows
        .filter(|r| r.role == Role::Headline)
        .map(|r| {
            format!(
                "<tr><th scope=\"row\">{}</th><td>{} <span class=\"interval\">{}</span></td></tr>\n",
                escape(&r.label),
                value(&r.value),
                escape(&r.interval)
            )
        })
        .collect();
    if main.is_empty() {
        return main;
    }
    format!("<table class=\"results\" id=\"headline\"><tbody>\n{main}</tbody></table>\n")
}

/// Returns the last row of the statistics, for a run without results.
fn last_row(series: &Statistics) -> String {
    let row = |column: &Column| {
        let value = results::quantity(*column.values.last()?, &column.unit);
        Some(ResultRow {
            path: column.name.clone(),
            label: column.name.clone(),
            short: value.clone(),
            value,
            interval: String::new(),
            meaning: column.doc.clone(),
            role: Role::Detail,
            number: None,
        })
    };
    let rows: Vec<ResultRow> = series.columns.iter().filter_map(row).collect();
    if rows.is_empty() {
        return "<p>Neither results nor statistics were recorded.</p>\n".to_owned();
    }
    let lead = "<p class=\"lead\">The run has no summary. These are the values of the last row of its statistics.</p>\n";
    lead.to_owned() + &table(&("Last recorded row", rows))
}

fn table((title, rows): &ResultGroup) -> String {
    let body: String = rows
        .iter()
        .map(|r| {
            let interval = match r.interval.is_empty() {
                true => String::new(),
                false => format!(" <span class=\"interval\">{}</span>", escape(&r.interval)),
            };
            format!(
                "<tr><th scope=\"row\">{}</th><td>{}{interval}</td><td class=\"meaning\">{}</td></tr>\n",
                escape(&r.label),
                value(&r.value),
                escape(&r.meaning)
            )
        })
        .collect();
    let table = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{title}\"><table class=\"results\"><caption>{title}</caption>\n<tbody>\n{body}</tbody></table></div>\n"
    );
    if rows.len() > MAX_UNFOLDED_ROWS {
        return format!(
            "<details><summary>{title}: {} values</summary>\n{table}</details>\n",
            rows.len()
        );
    }
    table
}

/// Formats a value; a value of several words may be broken into lines.
pub(crate) fn value(text: &str) -> String {
    let class = if text.len() > 28 {
        "value long"
    } else {
        "value"
    };
    format!("<span class=\"{class}\">{}</span>", escape(text))
}

/// Returns the class of a row that differs between two runs of the same case, for a row of its own.
pub(crate) fn clock(differs: bool) -> &'static str {
    if differs { " class=\"clock\"" } else { "" }
}

/// Whether a number, given by its path, or its group is measured by the clock.
fn from_the_clock(path: &str) -> bool {
    NOT_REPRODUCIBLE.iter().any(|pointer| {
        let of = pointer[1..].replace('/', ".");
        let rest = path.strip_prefix(&of);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    })
}

/// Returns a table of all numbers of the summary by their paths.
fn everything(summary: &Value, catalogue: &Catalogue) -> String {
    let mut rows = Vec::new();
    flatten(summary, String::new(), &mut rows);
    // The catalogue itself is in the columns beside the values.
    rows.retain(|(path, _)| !path.starts_with(Catalogue::KEY));
    let body: String = rows
        .iter()
        .map(|(path, value)| {
            let entry = catalogue.entry(path);
            let unit = entry.and_then(|e| e.unit.as_deref()).filter(|u| *u != "1");
            let doc = entry.map_or("", |e| e.doc.as_str());
            format!(
                "<tr{}><td><code>{}</code></td><td>{} {}</td><td class=\"meaning\">{}</td></tr>\n",
                clock(from_the_clock(path)),
                escape(path),
                escape(value),
                escape(unit.unwrap_or_default()),
                escape(doc)
            )
        })
        .collect();
    format!(
        "<details><summary>All {} values of summary.json</summary>\n\
         <label class=\"search\">Search <input type=\"search\" data-filters=\"summary-table\"></label>\n\
         <div class=\"scroll\"><table id=\"summary-table\"><thead><tr><th scope=\"col\">Key</th><th scope=\"col\">Value</th><th scope=\"col\">Meaning</th></tr></thead>\n\
         <tbody>\n{body}</tbody></table></div></details>\n",
        rows.len()
    )
}

fn flatten(value: &Value, path: String, out: &mut Vec<(String, String)>) {
    let under = |key: &str| {
        if path.is_empty() {
            key.to_owned()
        } else {
            format!("{path}.{key}")
        }
    };
    match value {
        // The path of a library has no meaning on another machine.
        Value::Object(map) => map
            .iter()
            .filter(|(key, _)| *key != "path")
            .for_each(|(key, v)| flatten(v, under(key), out)),
        Value::Array(list) if list.len() <= 200 => list
            .iter()
            .enumerate()
            .for_each(|(k, v)| flatten(v, under(&k.to_string()), out)),
        Value::Array(list) => out.push((path, format!("list of {}", list.len()))),
        Value::String(text) => out.push((path, text.clone())),
        Value::Null => {}
        other => out.push((path, other.to_string())),
    }
}
