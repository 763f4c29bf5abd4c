//! Figure of error against cost, one panel per output.

use super::combination::Combination;
use super::compare::{Comparison, OutputError, Row};
use super::output::{ErrorTarget, Output};
use super::plan::Trade;
use super::varied::{ParameterEffect, Varied};
use crate::factor::Level;
use fretwork_view::{Axis, Chart, DrawError, Series, Style, draw_panels, quantity};
use std::path::Path;

const GREY: (u8, u8, u8) = (120, 120, 120);
const RED: (u8, u8, u8) = (190, 30, 45);
/// Largest number of settings with their own legend entry; if there are more, they are grouped by
/// what they change.
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
pub fn draw(trade: &Trade, found: &Comparison, path: &Path) -> Result<bool, DrawError> {
    let known = |r: &Row| {
        let mut errors = r.errors.iter().flatten();
        r.failed.is_none() && errors.any(|e| e.at_most.is_finite())
    };
    if !found.rows.iter().any(known) {
        return Ok(false);
    }
    let charts: Vec<Chart> = (0..trade.outputs.len())
        .map(|o| panel(trade, found, o))
        .collect();
    draw_panels(&charts, charts.len().min(2), path)?;
    Ok(true)
}

/// Settings that ran, with their errors of the output of a panel.
type SettingErrors<'a> = Vec<(&'a Row, &'a OutputError)>;

/// A panel with the errors of one output.
struct Panel<'a> {
    trade: &'a Trade,
    output: &'a Output,
    reference: Combination,
    /// All settings with a finite error.
    good: SettingErrors<'a>,
    /// Settings whose error is relative to the reference or the exact value.
    others: SettingErrors<'a>,
    /// Factor of errors, 100 for those in per cent.
    factor: f64,
    /// Smallest error that is drawn; smaller ones are drawn at it, since the axis is logarithmic.
    floor: f64,
}

fn panel(trade: &Trade, found: &Comparison, o: usize) -> Chart {
    let output = &trade.outputs[o];
    let (ErrorTarget::Relative(wanted) | ErrorTarget::Absolute(wanted)) = output.wanted;
    let factor = match output.wanted {
        ErrorTarget::Relative(_) => 100.0,
        ErrorTarget::Absolute(_) => 1.0,
    };
    let name = output.name().replace('_', " ");
    let y = Axis::new(format!("error of {name}"), output.error_unit()).log();
    let x = Axis::new("processor time of a run", "s").log();
    let mut chart = Chart::new(format!("{}: {name}", trade.title), x, y);
    chart.subtitle = Some(subtitle(trade, output, found, o));
    let reference = Combination::reference(&trade.parameters);
    let ran = found.rows.iter().filter(|r| r.failed.is_none());
    let errors = ran.filter_map(|r| Some((r, r.errors[o].as_ref()?)));
    let good: SettingErrors<'_> = errors.filter(|(_, e)| e.at_most.is_finite()).collect();
    let compared = |p: &&(&Row, &OutputError)| p.0.setting != reference || output.exact.is_some();
    let others: SettingErrors<'_> = good.iter().filter(compared).copied().collect();
    let sizes = others
        .iter()
        .flat_map(|(_, e)| [e.error.mean.abs(), e.at_most])
        .chain([wanted]);
    let floor = sizes.filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min) / 3.0;
    let panel = Panel {
        trade,
        output,
        reference,
        good,
        others,
        factor,
        floor,
    };
    let each = found.rows.len() <= NAMED;
    let (r, g, b) = RED;
    let line = Series::level("wanted", factor * wanted).coloured(r, g, b);
    let series = [line].into_iter();
    let series = series.chain([panel.frontier()]).chain(panel.settings(each));
    series
        .chain(panel.own_error())
        .fold(chart, |chart, series| chart.with(series))
}

impl Panel<'_> {
    /// An error on the axis.
    fn on_axis(&self, error: f64) -> f64 {
        self.factor * error.max(self.floor)
    }

    /// The frontier joins the error bounds as a staircase that falls with increasing cost: between
    /// two settings the cheaper one is the best available.
    fn frontier(&self) -> Series {
        let mut stairs: Vec<(f64, f64)> = Vec::new();
        for (r, e) in self.others.iter().filter(|(_, e)| e.on_frontier) {
            let next = (r.seconds, self.on_axis(e.at_most));
            if let Some(&(_, before)) = stairs.last() {
                stairs.push((next.0, before));
            }
            stairs.push(next);
        }
        let mut line = Series::new("frontier, error at most", stairs);
        line.colour = Some(GREY);
        line
    }

    /// Returns errors with their intervals, a series for each setting or for each group of them.
    fn settings(&self, each: bool) -> Vec<Series> {
        let mut groups: Vec<(String, SettingErrors<'_>)> = Vec::new();
        for &(row, e) in &self.others {
            let name = if each {
                named(&self.trade.parameters, &row.setting)
            } else {
                group(self.trade, row)
            };
            match groups.iter_mut().find(|g| g.0 == name) {
                Some(g) => g.1.push((row, e)),
                None => groups.push((name, vec![(row, e)])),
            }
        }
        let series = groups.iter().enumerate().map(|(k, (name, rows))| {
            let points = rows
                .iter()
                .map(|(r, e)| (r.seconds, self.on_axis(e.error.mean.abs())));
            let bars = rows.iter().map(|(_, e)| {
                let half = e.error.half_width.unwrap_or(0.0);
                if half > 0.0 {
                    let low = self.on_axis((e.error.mean.abs() - half).max(0.0));
                    (low, self.on_axis(e.at_most))
                } else {
                    (f64::NAN, f64::NAN)
                }
            });
            let mut marks = Series::new(name.clone(), points.collect())
                .style(Style::Markers)
                .intervals(bars.collect());
            marks.colour = Some(COLOURS[k % COLOURS.len()]);
            marks
        });
        series.collect()
    }

    /// Returns the reference's own error, where it is known and there is no exact value.
    fn own_error(&self) -> Option<Series> {
        let (r, e) = self.good.iter().find(|(r, e)| {
            r.setting == self.reference && self.output.exact.is_none() && e.bound.is_finite()
        })?;
        let name = format!(
            "own error of the reference: {}",
            named(&self.trade.parameters, &r.setting)
        );
        let point = vec![(r.seconds, self.on_axis(e.bound))];
        let mut mark = Series::new(name, point).style(Style::Markers);
        mark.colour = Some((0, 0, 0));
        Some(mark)
    }
}

fn subtitle(trade: &Trade, output: &Output, found: &Comparison, o: usize) -> String {
    let seeds = if trade.random {
        format!("intervals of 95 % over {} seeds", trade.seeds.len())
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

/// Formats with four significant digits or decimals.
fn shown(x: f64) -> String {
    if (1e-3..1e6).contains(&x.abs()) {
        format!("{x:.4}")
    } else {
        format!("{x:.3e}")
    }
}

/// Names a setting by the values of all parameters that vary: the case may change, while a figure
/// must show what was run.
fn named(parameters: &[Varied], setting: &Combination) -> String {
    let varied = parameters
        .iter()
        .zip(&setting.0)
        .filter(|(k, _)| k.levels.len() > 1);
    let parts: Vec<String> = varied
        .map(|(parameter, level)| {
            let name = parameter.name.rsplit('.').next().unwrap_or_default();
            format!(
                "{} {}",
                name.replace('_', " "),
                value(parameter, &parameter.levels[*level])
            )
        })
        .collect();
    parts.join(", ")
}

fn value(parameter: &Varied, level: &Level) -> String {
    match (parameter.effect, level.number) {
        (ParameterEffect::Step, Some(x)) => quantity(x, "s", 2),
        (ParameterEffect::Tolerance, Some(x)) => quantity(x, "", 1),
        _ => level.label.clone(),
    }
}

/// Returns the group of a setting among many: for the case's own by its values, for others by the
/// parameter they change.
fn group(trade: &Trade, row: &Row) -> String {
    match row.setting.changed(&trade.parameters).as_slice() {
        [] => format!("as in the case: {}", named(&trade.parameters, &row.setting)),
        [k] => format!("other {}", trade.parameters[*k].name),
        _ => "several changed".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_named_by_their_values_whatever_the_case_has() {
        let level = |x: f64| Level::of(&[], &format!("{x:e}"));
        let parameter = |name: &str, effect, own| {
            Varied::new(name, effect, vec![level(5e-5), level(1e-4)], Some(own))
        };
        for own in [0, 1] {
            let parameters = [
                parameter("time.step", ParameterEffect::Step, own),
                parameter("solver.tolerance", ParameterEffect::Tolerance, own),
            ];
            let name = named(&parameters, &Combination(vec![0, 1]));
            assert_eq!(name, "step 50 µs, tolerance 1×10⁻⁴");
        }
    }
}
