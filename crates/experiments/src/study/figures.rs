//! The charts of a study: in the picture `study.png`, and on its page.

use super::analysis::{Analysis, OutputAnalysis, Regimes, Response, logarithmic_axis};
use super::page::title_of;
use super::plan::Plan;
use fretwork_view::{Axis, Chart, DrawError, Series, Style, draw_panels};
use std::path::Path;

/// Largest number of panels of a picture.
const PANELS: usize = 12;

/// Draws responses and maps of regimes; returns whether there is anything to draw.
///
/// # Errors
/// The file cannot be written.
pub fn draw(plan: &Plan, analysis: &Analysis, path: &Path) -> Result<bool, DrawError> {
    let maps = analysis.regimes.iter();
    let mut charts: Vec<Chart> = maps.filter_map(|r| regime_chart(plan, r)).collect();
    // All outputs are drawn over the first factor, then over the next.
    for factor in 0..plan.factors.len() {
        for output in &analysis.outputs {
            let own = output.responses.iter().find(|r| r.factor == factor);
            charts.extend(own.map(|r| response_chart(plan, output, r)));
        }
    }
    charts.retain(Chart::has_data);
    charts.truncate(PANELS);
    if charts.is_empty() {
        return Ok(false);
    }
    draw_panels(&charts, charts.len().min(2), path)?;
    Ok(true)
}

/// Returns a chart of an output over a factor, with its intervals.
pub(super) fn response_chart(plan: &Plan, output: &OutputAnalysis, response: &Response) -> Chart {
    let name = title_of(&output.name);
    let mut chart = Chart::new(
        format!("{name} over {}", plan.factors[response.factor].name),
        axis(plan, response.factor),
        Axis::new(&name, &output.unit),
    );
    chart.subtitle = Some(response.note.clone());
    for curve in &response.curves {
        let points = curve.points.iter().map(|(x, m)| (*x, m.mean)).collect();
        let ends = curve.points.iter().map(|(_, m)| match m.half_width {
            Some(h) => (m.mean - h, m.mean + h),
            None => (f64::NAN, f64::NAN),
        });
        let style = if response.scattered {
            Style::Markers
        } else {
            Style::LineMarkers
        };
        let series = Series::new(curve.label.clone(), points).style(style);
        chart = chart.with(series.intervals(ends.collect()));
    }
    chart
}

fn axis(plan: &Plan, factor: usize) -> Axis {
    let axis = Axis::new(&plan.factors[factor].name, plan.unit_of(factor));
    match logarithmic_axis(plan, factor) {
        true => axis.log(),
        false => axis,
    }
}

/// Returns a chart of the regimes in the plane of two factors.
pub(super) fn regime_chart(plan: &Plan, regimes: &Regimes) -> Option<Chart> {
    let map = regimes.map.as_ref()?;
    let (first, second) = map.axes;
    let y = second.map_or(Axis::new("", ""), |f| axis(plan, f));
    let mut chart = Chart::new(
        format!("Regimes by {}", title_of(&regimes.name)),
        axis(plan, first),
        y,
    );
    chart.subtitle = Some("Shown by at least half of the runs of a setting.".to_owned());
    chart.note = "The regime that at least half of the runs of a setting show; a setting without a mark shows several.".to_owned();
    for (regime, places) in &map.places {
        chart = chart.with(Series::new(regime.clone(), places.clone()).style(Style::Markers));
    }
    Some(chart)
}
