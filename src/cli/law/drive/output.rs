//! Output of a driven path: text, CSV and pictures.

use super::super::super::Failure;
use super::table::Row;
use crate::view::{Axis, Chart, Series, draw_panels};
use std::path::Path;

pub(super) fn write_csv(file: &Path, rows: &[Row]) -> Result<(), Failure> {
    let fail = |e: csv::Error| Failure::Failed(format!("cannot write {}: {e}", file.display()));
    let mut writer = csv::Writer::from_path(file).map_err(fail)?;
    for row in rows {
        writer.serialize(row).map_err(fail)?;
    }
    writer.flush().map_err(|e| fail(e.into()))
}

pub(super) fn draw(file: &Path, rows: &[Row], title: String) -> Result<(), Failure> {
    let draw = |file: &Path, chart: Chart| {
        draw_panels(&[chart], 1, file).map_err(|e| Failure::Failed(e.to_string()))
    };
    let points = |x: &dyn Fn(&Row) -> f64, y: &dyn Fn(&Row) -> f64| {
        rows.iter().map(|r| (x(r), y(r))).collect::<Vec<_>>()
    };
    let carries = rows
        .iter()
        .any(|r| r.traction_n != 0.0 || r.traction_t1 != 0.0);
    if let Some(chart) = thermal_chart(rows, &title) {
        return draw(file, chart);
    }
    if !carries && rows.iter().any(|r| r.tension_strength > 0.0) {
        let chart = Chart::new(
            title,
            Axis::new("gap g", "m"),
            Axis::new("attraction / area", "Pa"),
        )
        .with(Series::new(
            "attraction",
            points(&|r| r.opening_n, &|r| r.tension_strength),
        ));
        return draw(file, chart);
    }
    if !carries {
        let chart = Chart::new(
            title,
            Axis::new("sliding distance s", "m"),
            Axis::new("friction coefficient µ", ""),
        )
        .with(Series::new("", points(&Row::opening, &|r| r.friction)));
        return draw(file, chart);
    }
    // Signed along the first opening direction, so that cycles plot as loops.
    let sign = |r: &Row| if r.opening_t1 < 0.0 { -1.0 } else { 1.0 };
    let signed = |r: &Row| sign(r) * r.opening();
    let traction = Chart::new(
        title.clone(),
        Axis::new("opening δ", "m"),
        Axis::new("traction T", "Pa"),
    )
    .with(Series::new(
        "traction along the opening",
        points(&signed, &|r| sign(r) * r.along()),
    ));
    draw(file, traction)?;
    let mut name = file.file_stem().unwrap_or_default().to_os_string();
    name.push("_damage.png");
    let damage = Chart::new(
        title,
        Axis::new("opening δ", "m"),
        Axis::new("damage D", ""),
    );
    let damage = damage.with(Series::new("", points(&signed, &|r| r.damage)));
    draw(&file.with_file_name(name), damage)
}

/// Draws conductance, or friction, against the increased quantity: pressure or temperature.
fn thermal_chart(rows: &[Row], title: &str) -> Option<Chart> {
    let rows = rows.get(1..)?;
    let (first, last) = (rows.first()?, rows.last()?);
    let (x, axis): (fn(&Row) -> f64, _) = if first.temperature != last.temperature {
        (|r| r.temperature, Axis::new("temperature T", "K"))
    } else if first.pressure != last.pressure {
        (|r| r.pressure, Axis::new("pressure p", "Pa"))
    } else {
        return None;
    };
    let points =
        |y: fn(&Row) -> f64| -> Vec<(f64, f64)> { rows.iter().map(|r| (x(r), y(r))).collect() };
    let has = |y: fn(&Row) -> f64| rows.iter().any(|r| y(r) > 0.0);
    let (y, name): (fn(&Row) -> f64, _) = if has(|r| r.conductance) {
        (|r| r.conductance, Axis::new("thermal conductance G", "W/K"))
    } else if has(|r| r.electric_conductance) {
        (
            |r| r.electric_conductance,
            Axis::new("electrical conductance g", "S"),
        )
    } else {
        (|r| r.friction, Axis::new("friction coefficient µ", ""))
    };
    Some(Chart::new(title.to_owned(), axis, name).with(Series::new("", points(y))))
}

/// Prints about twenty rows of laws that use temperatures or conduct heat.
pub(super) fn thermal_text(rows: &[Row]) -> String {
    let mut out = format!(
        "{:>11} {:>12} {:>12} {:>11} {:>9} {:>8} {:>15} {:>12} {:>12}\n",
        "time s",
        "slip m",
        "pressure Pa",
        "temp. K",
        "damage",
        "mu",
        "conductance W/K",
        "electric S",
        "worn m3"
    );
    let every = rows.len().div_ceil(20).max(1);
    // The first row is the contact before anything was asked.
    for (k, r) in rows.iter().enumerate().skip(1) {
        if k % every != 0 && k + 1 != rows.len() {
            continue;
        }
        out += &format!(
            "{:>11.4e} {:>12.4e} {:>12.4e} {:>11.2} {:>9.6} {:>8.5} {:>15.6e} {:>12.6e} {:>12.4e}\n",
            r.time,
            r.opening_t1,
            r.pressure,
            r.temperature,
            r.damage,
            r.friction,
            r.conductance,
            r.electric_conductance,
            r.worn
        );
    }
    out
}

/// Prints about twenty rows, and the totals of the path.
pub(super) fn text(rows: &[Row]) -> String {
    let mut out = format!(
        "{:>11} {:>12} {:>12} {:>13} {:>13} {:>9} {:>12} {:>12} {:>8} {:>13}\n",
        "time s",
        "opening_n m",
        "opening_t m",
        "traction_n Pa",
        "traction_t Pa",
        "damage",
        "work J/m2",
        "stored J/m2",
        "mu",
        "attraction Pa"
    );
    let every = rows.len().div_ceil(20).max(1);
    for (k, r) in rows.iter().enumerate() {
        if k % every != 0 && k + 1 != rows.len() {
            continue;
        }
        out += &format!(
            "{:>11.4e} {:>12.4e} {:>12.4e} {:>13.6e} {:>13.6e} {:>9.6} {:>12.6e} {:>12.6e} {:>8.5} {:>13.6e}\n",
            r.time,
            r.opening_n,
            r.opening_t1,
            r.traction_n,
            r.traction_t1,
            r.damage,
            r.work,
            r.stored,
            r.friction,
            r.tension_strength
        );
    }
    let peak = rows.iter().map(|r| r.along().abs()).fold(0.0, f64::max);
    let Some(last) = rows.last() else {
        return out;
    };
    let strongest = rows.iter().map(|r| r.tension_strength).fold(0.0, f64::max);
    if peak > 0.0 {
        out += &format!(
            "peak traction {:.6e} Pa, area under the curve {:.6e} J/m2, dissipated {:.6e} J/m2, damage {:.6}",
            peak,
            last.work,
            last.work - last.stored,
            last.damage
        );
    } else {
        out += &format!("friction at the end {:.6}", last.friction);
    }
    if strongest > 0.0 {
        out += &format!(", attraction at most {strongest:.6e} Pa");
    }
    if last.worn > 0.0 {
        out += &format!(", worn {:.6e} m3", last.worn);
    }
    out
}
