//! Figure of error against cost, one panel per output.

use super::compare::{Comparison, OutputError, Row};
use super::knobs::{Level, Sense, StudyParameter};
use super::output::{Output, Wanted};
use super::setting::Setting;
use super::study::Study;
use crate::report::{Axis, Chart, ReportError, Series, Style, draw_panels, quantity};
use std::path::Path;

const GREY: (u8, u8, u8) = (120, 120, 120);
const RED: (u8, u8, u8) = (190, 30, 45);
/// Largest number of settings with their own legend entry; more are grouped by what they change.
const NAMED: usize = 8;
/// One colour per group of settings, in the order of their first appearance.
const COLOURS: [(u8, u8, u8); 8] = [
    (0, 114, 178),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (86, 160, 215),
    (200, 140, 0),
    (110, 80, 40),
    (60, 60, 60),
];

/// Draws the figure; returns whether any setting that ran has a finite error.
///
/// # Errors
/// The file cannot be written.
pub fn draw(
    study: &Study,
    found: &Comparison,
    title: &str,
    path: &Path,
) -> Result<bool, ReportError> {
    let known = |r: &Row| {
        let mut errors = r.errors.iter().flatten();
        r.failed.is_none() && errors.any(|e| e.at_most.is_finite())
    };
    if !found.rows.iter().any(known) {
        return Ok(false);
    }
    let charts: Vec<Chart> = (0..study.outputs.len())
        .map(|o| panel(study, found, title, o))
        .collect();
    draw_panels(&charts, charts.len().min(2), path)?;
    Ok(true)
}

fn panel(study: &Study, found: &Comparison, title: &str, o: usize) -> Chart {
    let output = &study.outputs[o];
    let relative = matches!(output.wanted, Wanted::Relative(_));
    let (Wanted::Relative(w) | Wanted::Absolute(w)) = output.wanted;
    let factor = if relative { 100.0 } else { 1.0 };
    let unit = if relative { "%" } else { "" };
    let name = output.name.replace('_', " ");
    let y = Axis::new(format!("error of {name}"), unit).log();
    let x = Axis::new("processor time of a run", "s").log();
    let mut chart = Chart::new(format!("{title}: {name}"), x, y);
    let reference = Setting::reference(&study.knobs);
    let good: Vec<(&Row, &OutputError)> = found
        .rows
        .iter()
        .filter(|r| r.failed.is_none())
        .filter_map(|r| Some((r, r.errors[o].as_ref()?)))
        .filter(|(_, e)| e.at_most.is_finite())
        .collect();
    let others = || {
        good.iter()
            .filter(|(r, _)| r.setting != reference || output.exact.is_some())
    };
    let sizes = others()
        .flat_map(|(_, e)| [e.error.mean.abs(), e.at_most])
        .chain([w]);
    let floor = sizes.filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min) / 3.0;
    let lifted = |s: f64| factor * s.max(floor);
    chart.subtitle = Some(subtitle(study, output, found, o));
    let costs = || good.iter().map(|(r, _)| r.seconds);
    let (low, high) = costs().fold((f64::INFINITY, 0.0f64), |(a, b), c| (a.min(c), b.max(c)));
    if low < high {
        let line = vec![(low, factor * w), (high, factor * w)];
        let mut wanted = Series::new("wanted", line).style(Style::Dashed);
        wanted.colour = Some(RED);
        chart = chart.with(wanted);
    }
    // The frontier joins the error bounds as a staircase that falls with increasing cost: between two
    // settings the cheaper one is the best available.
    let mut stairs: Vec<(f64, f64)> = Vec::new();
    for (r, e) in others().filter(|(_, e)| e.on_frontier) {
        let next = (r.seconds, lifted(e.at_most));
        if let Some(&(_, before)) = stairs.last() {
            stairs.push((next.0, before));
        }
        stairs.push(next);
    }
    let mut line = Series::new("frontier, error at most", stairs);
    line.colour = Some(GREY);
    chart = chart.with(line);
    let mut groups: Vec<(String, Vec<(&Row, &OutputError)>)> = Vec::new();
    let each = found.rows.len() <= NAMED;
    for &(row, e) in others() {
        let name = if each {
            named(&study.knobs, &row.setting)
        } else {
            group(study, row)
        };
        match groups.iter_mut().find(|g| g.0 == name) {
            Some(g) => g.1.push((row, e)),
            None => groups.push((name, vec![(row, e)])),
        }
    }
    for (k, (name, rows)) in groups.iter().enumerate() {
        let colour = Some(COLOURS[k % COLOURS.len()]);
        let points = rows
            .iter()
            .map(|(r, e)| (r.seconds, lifted(e.error.mean.abs())));
        let bars = rows.iter().map(|(_, e)| {
            let half = e.error.half_width.unwrap_or(0.0);
            if half > 0.0 {
                let low = lifted((e.error.mean.abs() - half).max(0.0));
                (low, lifted(e.at_most))
            } else {
                (f64::NAN, f64::NAN)
            }
        });
        let mut marks = Series::new(name.clone(), points.collect())
            .style(Style::Markers)
            .intervals(bars.collect());
        marks.colour = colour;
        chart = chart.with(marks);
    }
    let mine = good
        .iter()
        .find(|(r, e)| r.setting == reference && output.exact.is_none() && e.bound.is_finite());
    if let Some((r, e)) = mine {
        let mut mark = Series::new(
            format!(
                "own error of the reference: {}",
                named(&study.knobs, &r.setting)
            ),
            vec![(r.seconds, lifted(e.bound))],
        )
        .style(Style::Markers);
        mark.colour = Some((0, 0, 0));
        chart = chart.with(mark);
    }
    chart
}

fn subtitle(study: &Study, output: &Output, found: &Comparison, o: usize) -> String {
    let seeds = if study.random {
        format!("intervals of 95 % over {} seeds", study.seeds.len())
    } else {
        "no randomness in the case".into()
    };
    let against = match (output.exact, &found.own[o]) {
        (Some(x), _) => format!("against the true value {x}"),
        (None, Some(own)) => format!("against {} in the reference", shown(own.value.mean)),
        _ => String::new(),
    };
    format!("{against}, {seeds}")
}

/// Four significant digits or decimals.
fn shown(x: f64) -> String {
    if (1e-3..1e6).contains(&x.abs()) {
        format!("{x:.4}")
    } else {
        format!("{x:.3e}")
    }
}

/// A setting by the values of all knobs that vary: what stands in the case may change, a figure says what was run.
fn named(knobs: &[StudyParameter], setting: &Setting) -> String {
    let varied = knobs
        .iter()
        .zip(&setting.0)
        .filter(|(k, _)| k.levels.len() > 1);
    let parts: Vec<String> = varied
        .map(|(knob, level)| {
            let name = knob.name.rsplit('.').next().unwrap_or_default();
            format!(
                "{} {}",
                name.replace('_', " "),
                value(knob, &knob.levels[*level])
            )
        })
        .collect();
    parts.join(", ")
}

fn value(knob: &StudyParameter, level: &Level) -> String {
    match (knob.sense, level.number) {
        (Sense::Step, Some(x)) => quantity(x, "s", 2),
        (Sense::Tolerance, Some(x)) => quantity(x, "", 1),
        _ => level.label.clone(),
    }
}

/// Group of a setting among many: the case's own by its values, others by the parameter they change.
fn group(study: &Study, row: &Row) -> String {
    match row.setting.changed(&study.knobs).as_slice() {
        [] => format!("as in the case: {}", named(&study.knobs, &row.setting)),
        [k] => format!("other {}", study.knobs[*k].name),
        _ => "several changed".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_named_by_their_values_whatever_the_case_has() {
        let level = |x: f64| Level {
            label: format!("{x:e}"),
            sets: Vec::new(),
            number: Some(x),
        };
        let knob = |name: &str, sense, own| StudyParameter {
            name: name.to_owned(),
            sense,
            levels: vec![level(5e-5), level(1e-4)],
            own,
            reference: 0,
        };
        for own in [0, 1] {
            let knobs = [
                knob("time.step", Sense::Step, own),
                knob("solver.tolerance", Sense::Tolerance, own),
            ];
            let name = named(&knobs, &Setting(vec![0, 1]));
            assert_eq!(name, "step 50 µs, tolerance 1×10⁻⁴");
        }
    }
}
