//! Figures of a page: the charts that observers and other programs describe, in the form that the
//! page's scripts read. Their numbers are packed separately.

use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;
use crate::html::statistics::Statistics;
use fretwork_observe::chart::{
    Axis, AxisRange, Chart, Colours, DARK_PALETTE, FieldMap, Figure, GRADIENT, PALETTE, Series,
    Style,
};
use fretwork_observe::statistics::{BESIDE_FIRST, UP_FIRST};
use serde_json::{Value, json};

/// Limit on the cells of a chart in a page.
const MAX_CELLS: usize = 20_000;

/// Returns the figures that the observers of a run described, with numbers from its statistics.
pub(crate) fn of_run(run: &RunFolder, rows: &Statistics, gaps: &mut Vec<String>) -> Vec<Figure> {
    let text = std::fs::read_to_string(run.path.join(Figure::FILE));
    let parsed = text
        .map_err(|e| e.to_string())
        .and_then(|t| serde_json::from_str::<Vec<Figure>>(&t).map_err(|e| e.to_string()));
    let mut figures = parsed.unwrap_or_else(|reason| {
        gaps.push(format!(
            "Figures are missing, but for that of any column: {} cannot be read ({reason}). Runs of older versions have none.",
            Figure::FILE
        ));
        Vec::new()
    });
    // Main results come first.
    figures.sort_by_key(|f| !f.leads);
    for figure in &mut figures {
        *figure = figure.resolve(rows);
        let small = |c: &Chart| c.field.as_ref().is_none_or(|f| f.cells.len() <= MAX_CELLS);
        let all = figure.charts.len();
        figure.charts.retain(small);
        if figure.charts.len() < all {
            let name = &figure.name;
            gaps.push(format!(
                "A map of more than {MAX_CELLS} cells is in {name}.png alone."
            ));
        }
    }
    figures
}

/// The charts of a run for the page.
pub(crate) fn json(figures: &[Figure], numbers: &mut Arrays) -> Vec<Value> {
    let charts = figures
        .iter()
        .flat_map(|f| f.charts.iter().map(|c| (f.name.as_str(), c)));
    charts.map(|(name, c)| chart(name, c, numbers)).collect()
}

/// Returns the figures of several runs drawn over each other. If a chart has more than one curve,
/// the legend gives run and curve; of a chart over cycles only the last cycle is drawn.
pub(crate) fn overlaid(runs: &[(&str, Vec<Figure>)]) -> Vec<Figure> {
    let mut all: Vec<Figure> = Vec::new();
    for (run, figure) in runs
        .iter()
        .flat_map(|(n, figures)| figures.iter().map(move |f| (n, f)))
    {
        let at = all.iter().position(|f| f.name == figure.name);
        let at = at.unwrap_or_else(|| {
            all.push(Figure {
                charts: Vec::new(),
                heading: String::new(),
                ..figure.clone()
            });
            all.len() - 1
        });
        let charts = &mut all[at].charts;
        for own in figure.charts.iter().filter(|c| c.field.is_none()) {
            let at = charts.iter().position(|c| c.title == own.title);
            let at = at.unwrap_or_else(|| {
                let mut empty = own.clone();
                empty.series.clear();
                (empty.subtitle, empty.colour_by_order) = (None, false);
                (empty.x_range, empty.y_range) = (None, None);
                charts.push(empty);
                charts.len() - 1
            });
            let skipped = if own.colour_by_order {
                own.series.len() - 1
            } else {
                0
            };
            let shown = &own.series[skipped..];
            for series in shown {
                let label = match shown.len() {
                    1 => (*run).to_owned(),
                    _ => format!("{run}: {}", series.label),
                };
                let series_of_all = &mut charts[at].series;
                series_of_all.push(Series {
                    label,
                    colour: None,
                    place: series_of_all.len(),
                    ..series.clone()
                });
            }
        }
    }
    all
}

/// A chart for the page.
pub(crate) fn chart(name: &str, chart: &Chart, numbers: &mut Arrays) -> Value {
    let chart = &chart.with_lines();
    let curves = chart.series.iter().enumerate();
    let [x, y] = chart.ranges();
    json!({
        "figure": name,
        "title": chart.title,
        "note": note(chart),
        "x": axis(&chart.x, &x, chart.x_range.is_some()),
        "y": axis(&chart.y, &y, chart.y_range.is_some()),
        "gradient": chart.colour_by_order,
        "series": curves.map(|(k, s)| series(chart.place_in_palette(k), s, numbers)).collect::<Vec<_>>(),
        "field": chart.field.as_ref().map(|f| field(f, numbers)),
    })
}

/// Explains how to read a chart, and under which conditions it holds.
fn note(chart: &Chart) -> String {
    match (chart.note.as_str(), chart.subtitle.as_deref()) {
        ("", said) => said.unwrap_or_default().to_owned(),
        (note, None | Some("")) => note.to_owned(),
        (note, Some(said)) => format!("{}; {said}", note.trim_end_matches('.')),
    }
}

/// An axis with its range; a `fixed` one keeps it whichever series are shown.
fn axis(axis: &Axis, range: &AxisRange, fixed: bool) -> Value {
    json!({
        "name": axis.name, "unit": axis.unit, "label": range.label,
        "factor": 10f64.powi(-range.exponent), "log": axis.log, "whole": axis.whole,
        "range": range.ends, "fixed": fixed,
    })
}

/// Returns the colours of series for the scripts: on light and dark pages, and from first to last.
pub(crate) fn palette() -> Value {
    json!({"light": PALETTE, "dark": DARK_PALETTE, "order": GRADIENT})
}

fn series(place: usize, series: &Series, numbers: &mut Arrays) -> Value {
    let mut array = |of: fn(&(f64, f64)) -> f64, list: &[(f64, f64)]| match list.is_empty() {
        true => Value::Null,
        false => json!(numbers.number(&list.iter().map(of).collect::<Vec<_>>())),
    };
    json!({
        "label": series.label,
        "x": array(|p| p.0, &series.points),
        "y": array(|p| p.1, &series.points),
        "low": array(|p| p.0, &series.intervals),
        "high": array(|p| p.1, &series.intervals),
        "line": series.style != Style::Markers,
        "dashed": series.style == Style::Dashed,
        "markers": matches!(series.style, Style::Markers | Style::LineMarkers),
        "colour": series.colour,
        "place": place,
    })
}

fn field(field: &FieldMap, numbers: &mut Arrays) -> Value {
    let corners = || field.cells.iter().flatten();
    let mut starts = vec![0.0];
    starts.extend(field.cells.iter().scan(0, |sum, cell| {
        *sum += cell.len();
        Some(*sum as f64)
    }));
    let part = |numbers: &mut Arrays, of: fn(&[f32; 2]) -> f64| {
        numbers.number(&corners().map(of).collect::<Vec<_>>())
    };
    let (x, y) = (
        part(numbers, |p| p[0].into()),
        part(numbers, |p| p[1].into()),
    );
    let (values, scale) = match &field.colours {
        Colours::Classes { of, .. } => (of.iter().map(|k| *k as f64).collect(), Value::Null),
        Colours::Values { values, scale } => {
            let top = field.top();
            let range = scale.range([top].into_iter(), Some((0.0, top)));
            (values.clone(), axis(scale, &range, true))
        }
    };
    let classes = match &field.colours {
        Colours::Classes { classes, .. } => classes.as_slice(),
        Colours::Values { .. } => &[],
    };
    json!({
        "starts": numbers.number(&starts), "x": x, "y": y, "values": numbers.number(&values),
        "classes": classes, "scale": scale,
        "arrows": field.arrows, "arrow_label": field.arrow_label,
    })
}

/// Double precision is used where rows are closer than single precision resolves, such as the times
/// of long runs.
fn kind(values: &[f64]) -> NumberType {
    let merges = |pair: &[f64]| pair[0] != pair[1] && pair[0] as f32 == pair[1] as f32;
    match values.windows(2).any(merges) {
        true => NumberType::F64,
        false => NumberType::F32,
    }
}

/// Returns the columns of the statistics of a run, any of which can be drawn over any other. The
/// names of their arrays begin with `prefix`.
pub(crate) fn columns(
    name: &str,
    prefix: &str,
    statistics: &Statistics,
    numbers: &mut Arrays,
) -> Value {
    let columns: Vec<Value> = statistics
        .columns
        .iter()
        .map(|c| {
            let id = format!("{prefix}{}", c.name);
            numbers.push_known(&id, kind(&c.values), &c.values);
            json!({"name": c.name, "unit": c.unit, "doc": c.doc, "values": id})
        })
        .collect();
    json!({"name": name, "rows": statistics.rows, "every": statistics.every, "columns": columns})
}

/// Returns the figure of any column for the scripts: friction, damage or a force over time, with
/// wear beside it, where a run has them.
pub(crate) fn of_any_column() -> Value {
    json!({"any": {
        "across": ["time"],
        "up": UP_FIRST,
        "units": ["N", "N/m"],
        "right": BESIDE_FIRST,
    }})
}
