//! Several runs side by side on one page.

use crate::html::arrays::Arrays;
use crate::html::folder::RunFolder;
use crate::html::page::{Page, difference_table, escape, footer, item, section, table, value};
use crate::html::results::{self, ResultRow};
use crate::html::statistics::Statistics;
use crate::html::{ReportError, Written, figures, pictures, write};
use crate::measured::{self, MeasuredCurve};
use fretwork_observe::chart::Figure;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Number of rows of the statistics of a run in the page.
const ROWS: usize = 3000;

/// Makes a page of several runs side by side, with measured curves in the figures of their kind,
/// and these figures as PNG files beside it, `PAGE_NAME.png`.
///
/// # Errors
/// A folder holds no run, a measured curve does not fit to them, or a file cannot be written.
pub fn compare(
    folders: &[PathBuf],
    to: &Path,
    measured: &[MeasuredCurve],
) -> Result<Written, ReportError> {
    let runs: Vec<RunFolder> = folders
        .iter()
        .map(|f| RunFolder::open(f))
        .collect::<Result<_, _>>()?;
    let (html, figures) = page(&runs, &names(&runs), measured)?;
    write(to, &html)?;
    let stem = to
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    Ok(Written {
        page: to.to_owned(),
        bytes: html.len(),
        pictures: pictures(&figures, |name| {
            to.with_file_name(format!("{stem}_{name}.png"))
        })?,
    })
}

/// Returns the names of the folders, or their full paths if two have the same name.
fn names(runs: &[RunFolder]) -> Vec<String> {
    let short: Vec<String> = runs.iter().map(RunFolder::name).collect();
    let name = |k: usize| {
        let alone = short.iter().filter(|n| **n == short[k]).count() == 1;
        if alone {
            short[k].clone()
        } else {
            runs[k].path.display().to_string()
        }
    };
    (0..runs.len()).map(name).collect()
}

/// Returns the page, and the figures of all runs drawn over each other.
fn page(
    runs: &[RunFolder],
    names: &[String],
    curves: &[MeasuredCurve],
) -> Result<(String, Vec<Figure>), ReportError> {
    let mut gaps: Vec<Vec<String>> = runs.iter().map(|r| r.gaps.clone()).collect();
    let series: Vec<Statistics> = runs
        .iter()
        .zip(&mut gaps)
        .map(|(run, gaps)| Statistics::read(run, ROWS, gaps))
        .collect();
    let described = runs.iter().zip(&series).zip(&mut gaps);
    let described: Vec<Vec<Figure>> = described
        .map(|((run, series), gaps)| figures::of_run(run, series, gaps))
        .collect();
    let mut body = String::from(
        "<a class=\"skip\" href=\"#results\">Skip to the results</a>\n<header>\n<h1>Runs side by side</h1>\n",
    );
    let titles: Vec<&str> = runs.iter().map(|r| r.title.as_str()).collect();
    let same = titles.windows(2).all(|w| w[0] == w[1]);
    if let Some(title) = titles.first().filter(|_| same) {
        body += &format!("<p class=\"doc\">{}</p>\n", escape(title));
    }
    body += "</header>\n<nav aria-label=\"Sections\"><a href=\"#verdicts\">Verdicts</a><a href=\"#inputs\">Inputs that differ</a>\
             <a href=\"#results\">Results</a><a href=\"#figures\">Figures</a></nav>\n<main>\n";
    body += &section("verdicts", "Verdicts", &verdicts(runs, names, &gaps));
    body += &section(
        "inputs",
        "Inputs that differ",
        &difference_table(runs, names),
    );
    body += &section("results", "Results", &result_table(runs, names));
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mut numbers = Arrays::default();
    let columns = series.iter().zip(&names).enumerate();
    let columns: Vec<Value> = columns
        .map(|(k, (s, name))| figures::columns(name, &format!("{k}:"), s, &mut numbers))
        .collect();
    let drawn: Vec<(&str, Vec<Figure>)> = names.into_iter().zip(described).collect();
    let mut overlaid = figures::overlaid(&drawn);
    measured::add(&mut overlaid, curves).map_err(|reason| ReportError::Measured { reason })?;
    let mut figures = figures::json(&overlaid, &mut numbers);
    figures.push(json!({"any": true}));
    let frames: String = (0..figures.len())
        .map(|k| format!("<figure class=\"chart\" id=\"figure-{k}\"></figure>\n"))
        .collect();
    let lead = "<p class=\"lead\">Drag to zoom, double-click to see all; figures over time are linked.</p>\n";
    body += &section(
        "figures",
        "Figures",
        &format!("{lead}<div class=\"figures\">\n{frames}</div>\n"),
    );
    body += "</main>\n";
    body += &footer("fretwork compare");
    let page = Page {
        title: "Runs side by side - Fretwork".to_owned(),
        body,
        data: json!({"runs": columns, "figures": figures, "palette": figures::palette()}),
        blobs: vec![("numbers".to_owned(), numbers.packed())],
        viewer: false,
    };
    Ok((page.html(), overlaid))
}

fn verdicts(runs: &[RunFolder], names: &[String], gaps: &[Vec<String>]) -> String {
    let mut rows = String::new();
    for ((run, name), gaps) in runs.iter().zip(names).zip(gaps) {
        let verdict = crate::html::page::Verdict::of(run);
        let warnings = run.summary["warnings"].as_array();
        let warnings = warnings.into_iter().flatten().filter_map(Value::as_str);
        let all: Vec<String> = warnings
            .map(item)
            .chain(gaps.iter().map(|g| item(g)))
            .collect();
        rows += &format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td><span class=\"badge {}\">{}</span></td><td class=\"meaning\">{}</td></tr>\n",
            escape(name),
            escape(&run.title),
            verdict.class(),
            verdict.words(),
            all.join("<br>")
        );
    }
    table(
        "",
        "Verdicts",
        &["Run", "Case", "Verdict", "Reasons and notes"],
        &rows,
    )
}

/// Returns the table of results, one column per run.
fn result_table(runs: &[RunFolder], names: &[String]) -> String {
    let all: Vec<Vec<(&'static str, ResultRow)>> = runs
        .iter()
        .map(|run| {
            let groups = results::groups(run).into_iter();
            groups
                .flat_map(|(title, rows)| rows.into_iter().map(move |r| (title, r)))
                .collect()
        })
        .collect();
    let mut keys: Vec<(&'static str, String)> = Vec::new();
    for (title, row) in all.iter().flatten() {
        let key = (*title, row.label.clone());
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    if keys.is_empty() {
        return "<p>No run has a summary of results.</p>\n".to_owned();
    }
    let mut rows = String::new();
    let mut group = "";
    for (title, label) in &keys {
        if *title != group {
            group = title;
            rows += &format!(
                "<tr class=\"group\"><th scope=\"colgroup\" colspan=\"{}\">{title}</th></tr>\n",
                runs.len() + 1
            );
        }
        rows += &format!("<tr><th scope=\"row\">{}</th>", escape(label));
        for run in &all {
            let found = run.iter().find(|(t, r)| t == title && r.label == *label);
            rows += &match found {
                Some((_, r)) => format!(
                    "<td>{} <span class=\"interval\">{}</span></td>",
                    value(&r.value),
                    escape(&r.interval)
                ),
                None => "<td>none</td>".to_owned(),
            };
        }
        rows += "</tr>\n";
    }
    let heads = std::iter::once("Result").chain(names.iter().map(String::as_str));
    let heads: Vec<&str> = heads.collect();
    let table = table(" id=\"side-by-side\"", "Results", &heads, &rows);
    format!("<p class=\"lead\">Half-widths are of 95 % intervals, by cause.</p>\n{table}")
}
