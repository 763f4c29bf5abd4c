//! The report of one run.

use super::{Page, cite, escape, footer, inputs, laws, results, section, verdict};
use crate::html::arrays::Arrays;
use crate::html::folder::RunFolder;
use crate::html::materials::Files;
use crate::html::scene::Scene;
use crate::html::statistics::Statistics;
use crate::html::{Options, ReportError, figures};
use crate::html::{laws as law_data, results::quantity};
use crate::measured::{self, MeasuredCurve};
use fretwork_observe::chart::Figure;
use fretwork_scene::Case;
use serde_json::{Value, json};

/// Number of rows of the statistics in a page of the usual size.
const ROWS: usize = 4000;
/// Number of rows in a page without a limit.
const ALL_ROWS: usize = 200_000;
/// The statistics may take 1/`SHARE` of a page.
const SHARE: usize = 3;

/// The page.
pub(crate) fn page(run: &RunFolder, options: &Options<'_>) -> String {
    let mut gaps = run.gaps.clone();
    let mut most = if options.bytes.is_some() {
        ROWS
    } else {
        ALL_ROWS
    };
    let measured = options.measured;
    let (mut statistics, mut data, mut packed) = numbers(run, measured, most, &mut gaps);
    while let Some(bytes) = options
        .bytes
        .filter(|b| packed.len() > b / SHARE && most > 200)
    {
        most = (most * (bytes / SHARE) / packed.len()).max(200);
        gaps.clone_from(&run.gaps);
        (statistics, data, packed) = numbers(run, measured, most, &mut gaps);
    }
    let files = Files::read(run);
    let mut page = Page {
        title: format!("{} - Fretwork", run.title),
        data,
        viewer: true,
        ..Page::default()
    };
    let after = rest(run, &files, options);
    page.body.clone_from(&after);
    let taken = page.html().len() + packed.len() + 20_000;
    let room = options.bytes.map(|b| b.saturating_sub(taken).max(100_000));
    let scene = Scene::read(run, room, &mut gaps);
    page.viewer = scene.is_some();
    page.body = head(run, &gaps);
    if let Some(scene) = &scene {
        page.body += &section("scene", "Scene", &viewer(scene));
        page.data["scene"] = scene.head.clone();
    } else {
        page.body += &section(
            "scene",
            "Scene",
            "<p>There are no states to show: <code>output.views</code> of the case is 0, the run ended before the first, or they cannot be read, which a note at the top says.</p>\n",
        );
    }
    page.body += &section(
        "figures",
        "Figures",
        &figure_frames(&page.data["figures"], &statistics),
    );
    page.body += &section("results", "Results", &results::html(run, &statistics));
    page.body += &after;
    page.blobs.push(("numbers".to_owned(), packed));
    let frames = scene.into_iter().flat_map(|s| s.frames).enumerate();
    page.blobs
        .extend(frames.map(|(k, text)| (format!("frame-{k}"), text)));
    page.html()
}

/// Returns the statistics with about `rows` rows at most, and the figures: the data that scripts
/// read, and the packed numbers.
fn numbers(
    run: &RunFolder,
    measured: &[MeasuredCurve],
    most: usize,
    gaps: &mut Vec<String>,
) -> (Statistics, Value, String) {
    let statistics = Statistics::read(run, most, gaps);
    let mut numbers = Arrays::default();
    let columns = figures::columns("", "", &statistics, &mut numbers);
    let mut drawn = figures::of_run(run, &statistics, gaps);
    if let Err(reason) = measured::add(&mut drawn, measured) {
        gaps.push(format!("A measured curve is missing: {reason}."));
    }
    let mut list = figures::json(&drawn, &mut numbers);
    list.extend((statistics.columns.len() > 1).then(figures::of_any_column));
    let data = json!({"runs": [columns], "figures": list, "palette": figures::palette()});
    (statistics, data, numbers.packed())
}

/// Returns the figures of a run with measured curves in them; none without measured curves.
///
/// # Errors
/// A curve does not fit to the figures.
pub(crate) fn with_measured(
    run: &RunFolder,
    curves: &[MeasuredCurve],
) -> Result<Vec<Figure>, ReportError> {
    if curves.is_empty() {
        return Ok(Vec::new());
    }
    let mut gaps = Vec::new();
    let statistics = Statistics::read(run, ALL_ROWS, &mut gaps);
    let mut drawn = figures::of_run(run, &statistics, &mut gaps);
    measured::add(&mut drawn, curves).map_err(|reason| ReportError::Measured { reason })?;
    Ok(drawn)
}

/// Returns title, verdict and links.
fn head(run: &RunFolder, gaps: &[String]) -> String {
    let doc = fretwork_scene::source::Source::from_text("case", run.case_text.as_str());
    let doc = Case::read(&doc).map(|c| c.doc).unwrap_or_default();
    let mut out =
        String::from("<a class=\"skip\" href=\"#results\">Skip to the results</a>\n<header>\n");
    out += &format!("<h1>{}</h1>\n", escape(&run.title));
    if !doc.is_empty() {
        out += &format!("<p class=\"doc\">{}</p>\n", escape(&doc));
    }
    let facts: Vec<String> = [
        run.summary["bodies"]
            .as_u64()
            .map(|n| format!("{n} bodies")),
        run.summary["contacts"]
            .as_u64()
            .map(|n| format!("{n} contacts")),
        run.summary["steps"].as_u64().map(|n| format!("{n} steps")),
        run.summary["time"]
            .as_f64()
            .map(|t| format!("to t = {}", quantity(t, "s"))),
        Some(format!("{}D", run.dimension())),
        Some(format!("fretwork {}", run.version)),
    ]
    .into_iter()
    .flatten()
    .collect();
    out += &format!(
        "<p class=\"facts-line\">{}</p>\n</header>\n",
        escape(&facts.join(" · "))
    );
    out += "<nav aria-label=\"Sections\">";
    for (id, name) in [
        ("scene", "Scene"),
        ("figures", "Figures"),
        ("results", "Results"),
        ("laws", "Materials and laws"),
        ("inputs", "Inputs"),
        ("provenance", "Provenance"),
        ("cite", "Cite"),
    ] {
        out += &format!("<a href=\"#{id}\">{name}</a>");
    }
    out + "</nav>\n<main>\n" + &verdict::html(run, gaps) + &results::headline(run)
}

/// The parts after the figures.
fn rest(run: &RunFolder, files: &Files, options: &Options<'_>) -> String {
    let loaded = law_data::loaded(run);
    let interfaces = law_data::interfaces(run, files, options.law);
    let used = laws::libraries(&loaded) + &laws::interfaces(&interfaces) + &laws::materials(files);
    let mut out = section("laws", "Materials and laws", &used);
    out += &section("inputs", "Inputs", &inputs::html(run));
    out += &section("provenance", "Provenance", &cite::provenance(run));
    out += &section(
        "cite",
        "How to cite",
        &cite::cite(run, &loaded, options.law),
    );
    out + "</main>\n" + &footer("fretwork report")
}

/// Returns the container of the viewer; its controls are made by the script.
fn viewer(scene: &Scene) -> String {
    format!(
        "<noscript><p>The viewer and the figures need JavaScript; all numbers are in the tables.</p></noscript>\n\
         <div id=\"viewer\"></div>\n<p class=\"sampled\">In this page {}. All is in results.h5, and in the page of \
         <code>fretwork report DIR --full</code>.</p>\n",
        escape(&scene.said.join("; "))
    )
}

fn figure_frames(figures: &Value, statistics: &Statistics) -> String {
    let sampled = match statistics.every {
        0 | 1 => String::new(),
        n => format!(
            " One of {n} rows of the statistics is in this page, {} in all.",
            statistics.rows
        ),
    };
    let mut out = format!(
        "<p class=\"lead\">Drag to zoom, double-click to see all; figures over time are linked.{sampled}</p>\n<div class=\"figures\">\n"
    );
    for k in 0..figures.as_array().map_or(0, Vec::len) {
        out += &format!("<figure class=\"chart\" id=\"figure-{k}\"></figure>\n");
    }
    out + "</div>\n"
}
