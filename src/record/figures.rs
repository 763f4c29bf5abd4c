//! The figures of a finished run, from its table of statistics.

use super::friction::Cycles;
use super::ledger::Energy;
use super::statistics::Table;
use crate::report::{Axis, Chart, ReportError, Series, Style};
use std::path::Path;

/// Entries of the ledger below this part of the largest are not drawn.
const NEGLIGIBLE: f64 = 1e-3;

/// Draws what the run has data for; gives the names of the files.
///
/// # Errors
/// A file cannot be written.
pub fn draw(
    dir: &Path,
    title: &str,
    table: &Table,
    cycles: Option<&Cycles>,
    dimension: usize,
) -> Result<Vec<String>, ReportError> {
    let mut files = Vec::new();
    let time = table.column("time");
    let mut save = |name: &str, chart: Chart| -> Result<(), ReportError> {
        chart.draw(&dir.join(name))?;
        files.push(name.to_owned());
        Ok(())
    };
    let against = |values: &[f64]| -> Vec<(f64, f64)> {
        time.iter().copied().zip(values.iter().copied()).collect()
    };
    let mut bonds = Chart::new(
        "damage ratio against time",
        Axis::new("time", "s"),
        Axis::new("damage", ""),
    );
    bonds.subtitle = Some(title.to_owned());
    let (ratio, mean) = (table.column("damage_ratio"), table.column("mean_damage"));
    if mean.iter().any(|d| *d > 0.0) {
        let bonds = bonds
            .with(Series::new("broken bonds / bonds", against(&ratio)))
            .with(Series::new("mean damage", against(&mean)).style(Style::Dashed));
        save("damage_ratio.png", bonds)?;
    }
    if let Some(cycles) = cycles {
        let newton = if dimension == 2 { "N/m" } else { "N" };
        let (delta, q, number) = (
            table.column("delta"),
            table.column("Q"),
            table.column("cycle"),
        );
        let mut loops = Chart::new(
            "fretting loops",
            Axis::new("displacement delta", "m"),
            Axis::new("tangential force Q", newton),
        );
        loops.subtitle = Some(title.to_owned());
        loops.colour_by_order = true;
        for c in 1..=cycles.list.len() as u32 {
            let points: Vec<(f64, f64)> = (0..number.len())
                .filter(|k| number[*k] == f64::from(c))
                .map(|k| (delta[k], q[k]))
                .collect();
            if points.len() > 1 {
                loops = loops.with(Series::new(format!("cycle {c}"), points));
            }
        }
        save("fretting_loops.png", loops)?;
        let list = |f: &dyn Fn(&super::friction::Cycle) -> f64| -> Vec<(f64, f64)> {
            cycles
                .list
                .iter()
                .filter(|c| c.complete)
                .map(|c| (f64::from(c.cycle), f(c)))
                .collect()
        };
        let mut friction = Chart::new(
            "friction coefficient against cycle",
            Axis::new("cycle", ""),
            Axis::new("friction coefficient", ""),
        )
        .with(
            Series::new("from forces", list(&|c| c.friction_coefficient)).style(Style::LineMarkers),
        )
        .with(
            Series::new("from dissipation", list(&|c| c.friction_from_dissipation))
                .style(Style::Markers),
        );
        friction.subtitle = Some(title.to_owned());
        let highest = cycles
            .list
            .iter()
            .map(|c| c.friction_coefficient)
            .fold(0.0, f64::max);
        if highest > 0.0 {
            friction.y_range = Some((0.0, 1.3 * highest));
        }
        save("friction_coefficient.png", friction)?;
    }
    let unit = if dimension == 2 { "J/m" } else { "J" };
    let mut energy = Chart::new(
        "energy ledger",
        Axis::new("time", "s"),
        Axis::new("energy", unit),
    );
    energy.subtitle = Some(title.to_owned());
    let entries = Energy::default().entries();
    let shown = entries.map(|(name, _, _)| (name, table.column(name)));
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let all = shown.iter().fold(0.0, |m: f64, (_, v)| m.max(largest(v)));
    for (name, values) in shown {
        // What is too small to be seen is left out; the residual is shown to be small.
        let least = if name == "residual" {
            0.0
        } else {
            NEGLIGIBLE * all
        };
        if name != "initial_kinetic" && largest(&values) > least {
            energy = energy.with(Series::new(name.replace('_', " "), against(&values)));
        }
    }
    save("energy.png", energy)?;
    Ok(files)
}
