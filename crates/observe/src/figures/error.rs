//! Uncertainty of a result, in its figure.

use crate::chart::{Chart, Series, Style, quantity};
use crate::friction::Cycles;
use crate::quantity::{below_digits, number};
use crate::summary::Estimate;

/// Adds a result with its half-widths to the line under the heading.
pub(super) fn estimated(chart: &mut Chart, name: &str, known: &Estimate, unit: &'static str) {
    let digits = |x: f64, digits: usize| {
        if unit.is_empty() {
            number(x, digits as i32)
        } else {
            quantity(x, unit, digits)
        }
    };
    let of = known.value.unwrap_or(0.0);
    let shown = |x: f64| below_digits(x, of).map_or_else(|| digits(x, 2), str::to_owned);
    let settings = known.from_settings(shown);
    let scatter = known
        .scatter
        .map(|half| format!(" +- {} (scatter)", shown(half)));
    let (Some(value), true) = (known.value, scatter.is_some() || !settings.is_empty()) else {
        return;
    };
    let text = format!(
        "{name} {}{}{settings}",
        digits(value, 4),
        scatter.unwrap_or_default()
    )
    .replace("+-", "±");
    chart.subtitle = Some(text);
}

/// Returns the friction coefficient at the last complete cycle, with an interval of all known
/// half-widths.
pub(super) fn error_bar(cycles: &Cycles, known: &Estimate) -> Series {
    let last = cycles.list.iter().rfind(|c| c.complete);
    let (Some(last), Some(value), true) = (last, known.value, cycles.oscillates()) else {
        return Series::default();
    };
    // The error of the coupling is part of that of the step.
    let parts = [known.scatter, known.step, known.tolerance];
    let half: f64 = parts
        .into_iter()
        .flatten()
        .filter(|h| *h < value.abs())
        .sum();
    if half <= 0.0 {
        return Series::default();
    }
    let at = (f64::from(last.cycle), value);
    Series::new("result ± sum of the known half-widths", vec![at])
        .style(Style::Markers)
        .coloured(28, 30, 34)
        .intervals(vec![(value - half, value + half)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Axis;
    use crate::cycle::Cycle;

    fn known() -> Estimate {
        Estimate {
            value: Some(0.31),
            scatter: Some(0.01),
            step: Some(0.004),
            tolerance: Some(0.5),
            ..Estimate::default()
        }
    }

    #[test]
    fn the_heading_has_the_half_widths_and_what_is_not_known() {
        let mut chart = Chart::new("", Axis::new("", ""), Axis::new("", ""));
        estimated(&mut chart, "friction coefficient", &known(), "");
        chart.head("case");
        assert_eq!(
            chart.subtitle.as_deref(),
            Some(
                "case; friction coefficient 0.3100 ± 0.010 (scatter) ± 0.0040 (step) (effect of tolerance not known)"
            )
        );
        chart.subtitle = None;
        estimated(&mut chart, "damage", &Estimate::default(), "");
        assert_eq!(chart.subtitle, None);
    }

    #[test]
    fn the_bar_has_the_sum_of_the_half_widths_that_are_known() {
        let mut cycles = Cycles::new(0.0, Some(1.0), 3.0);
        let list = (1..=3).map(|cycle| Cycle {
            cycle,
            complete: cycle < 3,
            ..Cycle::default()
        });
        cycles.list = list.collect();
        let bar = error_bar(&cycles, &known());
        assert_eq!(bar.points, [(2.0, 0.31)]);
        let (low, high) = bar.intervals[0];
        assert!((high - low - 0.028).abs() < 1e-12, "{low} {high}");
        assert!(error_bar(&cycles, &Estimate::default()).points.is_empty());
    }
}
