//! Figure of a third body: profiles with the depth upwards. Panels of one quantity show it for each
//! time slice; panels of several quantities show time averages.

use super::cells::{Block, Cell, MECHANISMS};
use super::tables::powers;
use crate::chart::{Axis, Chart, Series, Style, quantity};
use crate::figures::history;

/// Content of the figure.
pub(super) struct LayerFigure<'a> {
    /// The whole time.
    pub whole: &'a Block,
    /// Time slices of the measure.
    pub slices: &'a [Block],
    /// The first bodies.
    pub between: &'a (String, String),
    /// Returns the name of a column of the statistics from that of its quantity.
    pub column: &'a dyn Fn(&str) -> String,
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Whether grains have temperatures.
    pub heated: bool,
}

/// Headings of the panels that have a legend of the time slices.
const VELOCITY: &str = "Velocity profile";
const SOLID: &str = "Solid fraction";

/// Colours from early to late.
const TIMES: [(u8, u8, u8); 4] = [(250, 176, 80), (226, 92, 70), (160, 30, 100), (50, 16, 96)];

fn shade(k: usize, count: usize) -> (u8, u8, u8) {
    let place = k as f64 / (count.max(2) - 1) as f64 * (TIMES.len() - 1) as f64;
    let i = (place as usize).min(TIMES.len() - 2);
    let (a, b, t) = (TIMES[i], TIMES[i + 1], place - i as f64);
    let mix = |a: u8, b: u8| (f64::from(a) + t * (f64::from(b) - f64::from(a))).round() as u8;
    (mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// Formats a time interval, with the unit once if it is the same.
fn span(times: [f64; 2]) -> String {
    let [from, to] = times.map(|t| quantity(t, "s", 3));
    match (from.split_once(' '), to.split_once(' ')) {
        (Some((number, unit)), Some((_, other))) if unit == other => format!("{number} to {to}"),
        _ => format!("{from} to {to}"),
    }
}

impl LayerFigure<'_> {
    fn chart(&self, heading: &str, name: &str, unit: &str) -> Chart {
        let upwards = format!("y/e, {} to {}", self.between.0, self.between.1);
        let mut chart = Chart::new(heading, Axis::new(name, unit), Axis::new(upwards, ""));
        chart.y_range = Some((0.0, 1.0));
        chart
    }

    fn points(block: &Block, value: impl Fn(&Cell) -> f64) -> Vec<(f64, f64)> {
        let n = block.bins().len() as f64;
        let bins = block.bins().iter().enumerate();
        bins.map(|(k, c)| (value(c), (k as f64 + 0.5) / n))
            .collect()
    }

    /// Whether a panel has the legend of the time slices; the first two do.
    fn labelled(chart: &Chart) -> bool {
        [VELOCITY, SOLID].contains(&chart.title.as_str())
    }

    /// Adds a line for each time slice to a panel of one quantity.
    fn in_time(&self, mut chart: Chart, value: impl Fn(&Cell) -> f64 + Copy) -> Chart {
        for (k, block) in self.slices.iter().enumerate() {
            let label = if Self::labelled(&chart) {
                span(block.time)
            } else {
                String::new()
            };
            let mut series =
                Series::new(label, Self::points(block, value)).style(Style::LineMarkers);
            series.colour = Some(shade(k, self.slices.len()));
            chart = chart.with(series);
        }
        chart
    }

    /// A panel of several quantities, averaged over the whole time.
    fn beside<'a>(
        &self,
        mut chart: Chart,
        values: impl Iterator<Item = (&'a str, Vec<(f64, f64)>)>,
    ) -> Chart {
        for (label, points) in values {
            chart = chart.with(Series::new(label, points).style(Style::LineMarkers));
        }
        chart
    }

    fn velocity(&self) -> Chart {
        let name = format!("velocity v/V, V of the {}", self.between.1);
        let chart = self.chart(VELOCITY, &name, "");
        // The mean velocity of a bin belongs at the mean depth of its mass.
        let mut chart = self.in_time(chart, Cell::carried);
        for (series, block) in chart.series.iter_mut().zip(self.slices) {
            series.points = block.profile().into_iter().map(|(y, w)| (w, y)).collect();
        }
        if chart.has_data() {
            let straight = Series::new("Couette flow", vec![(0.0, 0.0), (1.0, 1.0)]);
            chart = chart.with(straight.coloured(150, 154, 160).style(Style::Dashed));
        }
        chart
    }

    fn stress(&self) -> Chart {
        let names = [
            "σ_yy, across",
            "σ_xx, along",
            "τ_xy, shear",
            "σ_zz, lateral",
        ];
        let shown = if self.dimension == 3 { 4 } else { 3 };
        let lines = names.iter().enumerate().take(shown);
        let lines = lines.map(|(k, name)| (*name, Self::points(self.whole, |c| c.stress()[k])));
        let name = "stress, compression positive";
        let chart = self.chart("Stress, mean over time", name, "Pa");
        self.beside(chart, lines)
    }

    fn power(&self) -> Chart {
        let all = MECHANISMS.iter().enumerate();
        let lines = all.map(|(k, name)| {
            (
                *name,
                Self::points(self.whole, |c| powers(c, self.whole)[k]),
            )
        });
        let name = "dissipated power by volume";
        let chart = self.chart("Dissipated power, mean over time", name, "W/m^3");
        let peak = |points: &[(f64, f64)]| points.iter().map(|p| p.0.abs()).fold(0.0, f64::max);
        let lines: Vec<(&str, Vec<(f64, f64)>)> = lines.collect();
        let top = lines.iter().map(|l| peak(&l.1)).fold(0.0, f64::max);
        // Lines that would coincide with the axis are omitted; the table has them.
        let lines = lines.into_iter().filter(|l| peak(&l.1) > 5e-3 * top);
        self.beside(chart, lines)
    }

    /// The panels of the figure.
    pub fn charts(&self) -> Vec<Chart> {
        let mut charts = vec![
            self.velocity(),
            self.in_time(self.chart(SOLID, "solid fraction φ", ""), Cell::solid),
            self.stress(),
            self.in_time(
                self.chart("Granular temperature", "granular temperature T", "m^2/s^2"),
                Cell::granular_temperature,
            ),
            self.in_time(
                self.chart("Coordination", "coordination number Z", ""),
                |c| c.contacts / c.grains,
            ),
            self.power(),
        ];
        let tied = self.whole.bins().iter().any(|c| c.bonds + c.broken > 0.0);
        if tied {
            let chart = self.chart("Damage", "broken bonds / bonds made", "");
            charts.push(self.in_time(chart, Cell::damage));
        }
        if self.heated {
            let chart = self.chart("Temperature", "mean temperature T", "K");
            charts.push(self.in_time(chart, Cell::temperature));
        }
        let mut add = |heading: &str, y: Axis, series: &[(&str, &str)]| {
            let columns: Vec<(&str, String)> = series
                .iter()
                .map(|(label, part)| (*label, (self.column)(part)))
                .collect();
            charts.push(history(heading, y, &columns));
        };
        let thickness = Axis::of_rows("thickness e");
        add(
            "Thickness of the third body",
            thickness,
            &[("", "thickness")],
        );
        if tied {
            add(
                "Clusters of bonded grains",
                Axis::new("grains in a cluster", ""),
                &[
                    ("mean by mass", "cluster_mean"),
                    ("largest", "cluster_largest"),
                ],
            );
        } else {
            add(
                "Force chains",
                Axis::new("share in force chains", ""),
                &[("of the grains", "chains"), ("of the force", "chain_force")],
            );
            let y = Axis::new("shear of the interior / sliding", "");
            add("Interior, 10 % to 90 % of e", y, &[("", "interior_shear")]);
        }
        charts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_of_time_name_their_unit_once() {
        assert_eq!(span([0.05, 0.0644]), "50.0 to 64.4 ms");
        assert_eq!(span([0.5, 1.25]), "500 ms to 1.25 s");
    }
}
