//! Several runs side by side on one page.

use crate::html::arrays::Arrays;
use crate::html::folder::RunFolder;
use crate::html::page::{
    Page, difference_table, differing, escape, footer, item, section, table, value,
};
use crate::html::results::{self, ResultRow};
use crate::html::statistics::Statistics;
use crate::html::{ReportError, Written, figures, pictures, write};
use crate::measured::{self, MeasuredCurve};
use fretwork_observe::chart::Figure;
use fretwork_observe::quantity::Role;
use fretwork_observe::summary::{COLUMNS, SlidingTest, fitted};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Number of rows of the statistics of a run in the page.
const ROWS: usize = 3000;

/// Number of inputs that differ that the terminal names.
const NAMED: usize = 6;

/// Returns what the terminal says of runs: the verdict on each, the inputs that differ, and the
/// main results, with the difference of each run from the first and its significance.
///
/// # Errors
/// A folder holds no run.
pub fn differences(folders: &[PathBuf]) -> Result<Vec<String>, ReportError> {
    let runs: Vec<RunFolder> = folders
        .iter()
        .map(|f| RunFolder::open(f))
        .collect::<Result<_, _>>()?;
    let names = names(&runs);
    let width = names.iter().map(|name| name.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut lines = Vec::new();
    for (run, name) in runs.iter().zip(&names) {
        let verdict = crate::html::page::Verdict::of(run).words();
        let text = match run.summary["reasons"][0].as_str() {
            Some(reason) => format!("{verdict}: {reason}"),
            None => format!("{verdict}, {}", run.title),
        };
        lines.push(fitted(&format!("{name:<width$}  {text}"), COLUMNS));
    }
    lines.extend(inputs_that_differ(&runs));
    for line in lines_of(&runs) {
        if line.rows.iter().flatten().all(|r| r.role != Role::Headline) {
            continue;
        }
        lines.push(format!("{}:", line.label));
        for ((k, name), run) in names.iter().enumerate().zip(&runs) {
            let row = line.rows[k].as_ref();
            let value = row.map_or_else(|| line.none(run), |row| row.short.clone());
            lines.push(format!("  {name:<width$}  {value}"));
            let base = line.rows[0].as_ref().filter(|_| k > 0);
            if let Some(less) = base.and_then(|base| row?.less(base)) {
                lines.push(format!("  {:<width$}  less {}: {less}", "", names[0]));
            }
        }
    }
    Ok(lines)
}

/// Says which inputs of runs differ, and what follows from another dimension.
fn inputs_that_differ(runs: &[RunFolder]) -> Vec<String> {
    let paths = differing(runs);
    let named: Vec<&str> = paths.iter().take(NAMED).map(String::as_str).collect();
    let more = match paths.len().saturating_sub(NAMED) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    let text = match paths.is_empty() {
        true => "all inputs are the same".to_owned(),
        false => format!("inputs that differ: {}{more}", named.join(", ")),
    };
    let mut out = vec![fitted(&text, COLUMNS)];
    out.extend(in_two_dimensions(runs));
    out
}

/// Says what runs in 2D and 3D have in common.
fn in_two_dimensions(runs: &[RunFolder]) -> Option<String> {
    let of = |run: &RunFolder| run.summary["dimension"].as_u64();
    let other = runs.iter().any(|run| of(run) != of(&runs[0]));
    other.then(|| "2D and 3D: what 2D runs give per metre of depth has no difference".to_owned())
}

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
    figures.push(figures::of_any_column());
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

/// A result of several runs.
struct ResultLine {
    /// Heading of its group.
    title: &'static str,
    label: String,
    /// The result of each run, where it has one.
    rows: Vec<Option<ResultRow>>,
}

impl ResultLine {
    /// Says that a run has no such result, and why if it is known.
    fn none(&self, run: &RunFolder) -> String {
        let paths = self.rows.iter().flatten().map(|row| row.path.as_str());
        let mut paths = paths.filter(|path| *path == SlidingTest::COEFFICIENT);
        let why = paths
            .next()
            .and_then(|_| SlidingTest::of(&run.summary).err());
        why.map_or("none".to_owned(), |why| {
            let why = why.split(';').next().unwrap_or_default();
            format!("none: {why}")
        })
    }
}

/// Returns the results of all runs, each once.
fn lines_of(runs: &[RunFolder]) -> Vec<ResultLine> {
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
    let line = |(title, label): (&'static str, String)| {
        let own = |run: &Vec<(&str, ResultRow)>| {
            let found = run.iter().find(|(t, r)| *t == title && r.label == label);
            found.map(|(_, row)| row.clone())
        };
        ResultLine {
            title,
            rows: all.iter().map(own).collect(),
            label,
        }
    };
    keys.into_iter().map(line).collect()
}

/// Returns the table of results, with one column for each run, and one for the difference of each
/// from the first.
fn result_table(runs: &[RunFolder], names: &[String]) -> String {
    let lines = lines_of(runs);
    if lines.is_empty() {
        return "<p>No run has a summary of results.</p>\n".to_owned();
    }
    let mut rows = String::new();
    let mut group = "";
    for line in &lines {
        if line.title != group {
            group = line.title;
            rows += &format!(
                "<tr class=\"group\"><th scope=\"colgroup\" colspan=\"{}\">{group}</th></tr>\n",
                2 * runs.len()
            );
        }
        rows += &format!("<tr><th scope=\"row\">{}</th>", escape(&line.label));
        for (row, run) in line.rows.iter().zip(runs) {
            rows += &match row {
                Some(r) => format!(
                    "<td>{} <span class=\"interval\">{}</span></td>",
                    value(&r.value),
                    escape(&r.interval)
                ),
                None => format!("<td>{}</td>", escape(&line.none(run))),
            };
        }
        for row in &line.rows[1..] {
            let both = row.as_ref().zip(line.rows[0].as_ref());
            let less = both.and_then(|(row, base)| row.less(base));
            rows += &format!(
                "<td class=\"difference\">{}</td>",
                escape(&less.unwrap_or_default())
            );
        }
        rows += "</tr>\n";
    }
    let differences = names[1..].iter();
    let differences = differences.map(|name| format!("{name} less {}", names[0]));
    let heads = std::iter::once("Result".to_owned()).chain(names.iter().cloned());
    let heads: Vec<String> = heads.chain(differences).collect();
    let table = table(" id=\"side-by-side\"", "Results", &heads, &rows);
    let random = runs
        .iter()
        .any(|run| run.summary["sample"]["random"] == true);
    let seeds = match random {
        true => {
            " They are within one sample each: what other seeds would give is not in them, so that runs \
             of different samples may differ by chance; a study over seeds tells."
        }
        false => "",
    };
    let dimensions = in_two_dimensions(runs).map_or(String::new(), |text| format!(" {text}."));
    format!(
        "<p class=\"lead\">Half-widths are of 95 % intervals, by cause. A difference is significant \
         (<em>they differ</em>) where it exceeds the half-widths of both, as the root of the sum of their \
         squares, of the causes that at least one knows, also if what the other does not know is three times as large. Runs that are not trustworthy, and results that are not \
         determined, have no significant difference.{seeds}{dimensions}</p>\n{table}"
    )
}
