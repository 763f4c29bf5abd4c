//! The figures of a study as a picture, `study.png`.

use super::analysis::{Analysis, RegimeMap, logarithmic};
use super::page::title_of;
use super::plan::Plan;
use crate::report::{Axis, Chart, ReportError, Series, Style, draw_panels};
use std::path::Path;

/// Panels of a picture.
const PANELS: usize = 12;

/// Draws responses and maps of regimes; returns whether there is anything to draw.
///
/// # Errors
/// The file cannot be written.
pub fn draw(plan: &Plan, analysis: &Analysis, path: &Path) -> Result<bool, ReportError> {
    let mut charts: Vec<Chart> = analysis
        .regimes
        .iter()
        .map(|m| regime_chart(plan, m))
        .collect();
    for output in &analysis.outputs {
        for response in &output.responses {
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
            charts.push(chart);
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

fn axis(plan: &Plan, factor: usize) -> Axis {
    let axis = Axis::new(&plan.factors[factor].name, plan.unit_of(factor));
    // Ratios over a decade and more read on a logarithmic axis.
    let numbers: Vec<f64> = plan
        .settings
        .iter()
        .filter_map(|s| s[factor].number)
        .collect();
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(0.0, f64::max);
    match logarithmic(&plan.factors[factor]) || low > 0.0 && high > 20.0 * low {
        true => axis.log(),
        false => axis,
    }
}

fn regime_chart(plan: &Plan, map: &RegimeMap) -> Chart {
    let (first, second) = map.axes;
    let y = second.map_or(Axis::new("", ""), |f| axis(plan, f));
    let mut chart = Chart::new(
        format!("Regimes by {}", title_of(&map.name)),
        axis(plan, first),
        y,
    );
    chart.subtitle = Some("The regime of at least half of the runs of a setting".to_owned());
    for (regime, points) in &map.regimes {
        let shown = points.iter().filter(|p| p.share >= 0.5).map(|p| (p.x, p.y));
        chart = chart.with(Series::new(regime.clone(), shown.collect()).style(Style::Markers));
    }
    chart
}
