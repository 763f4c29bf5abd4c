//! Files of a patch: `patch.json`, `adhesion.csv` or `loop_N.csv`, the fields in `patch.h5`, those
//! of passages, and the page `patch.html`.

use super::answer::Motion;
use super::rolling::passages_shown;
use super::{Outcome, PatchFile, page};
use crate::Error;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_store::maps::{MapField, Maps};
use std::path::Path;

/// Returns the answer as JSON.
///
/// # Errors
/// It cannot be written as JSON.
pub fn json(outcome: &Outcome) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(&outcome.answer);
    text.map_err(|e| Error::Failed(e.to_string()))
}

/// Writes all files of a patch into a folder; returns the answer as JSON.
///
/// # Errors
/// A file cannot be written.
pub fn write(file: &PatchFile, outcome: &Outcome, out: &Path) -> Result<String, Error> {
    let json = json(outcome)?;
    let save = |name: &str, text: &str| {
        let path = out.join(name);
        std::fs::write(&path, text).map_err(|e| Error::write(&path, &e))
    };
    save("patch.ron", file.source.text())?;
    save("patch.json", &json)?;
    if !outcome.rolled.is_empty() {
        csv::write(
            &curve(outcome),
            &out.join("adhesion.csv"),
            NumberFormat::Plain,
        )?;
    }
    for (k, stroke) in outcome.strokes.iter().enumerate() {
        let curve = stroke.curve();
        let column = |at: usize| curve.iter().map(move |row| Some(row[at]));
        let table = Table {
            columns: vec![
                Column::real("displacement", "m", column(0)),
                Column::real("force", "N", column(1)),
            ],
        };
        let path = out.join(format!("loop_{}.csv", k + 1));
        csv::write(&table, &path, NumberFormat::Plain)?;
    }
    passages_shown::write(outcome, out)?;
    for (k, history) in outcome.answer.cycles.iter().enumerate() {
        history.write(outcome.answer.load, out, k + 1)?;
    }
    if let Some(map) = &outcome.answer.map {
        map.write(out)?;
    }
    fields(outcome, &out.join("patch.h5"))?;
    page::write(file, outcome, &out.join("patch.html"))?;
    Ok(json)
}

/// The curve of adhesion.
fn curve(outcome: &Outcome) -> Table {
    let points = || outcome.answer.points.iter();
    let creepage = |of: fn(&fretwork_rolling::Creepage) -> f64| {
        points().map(move |p| match &p.motion {
            Motion::Rolling(c) => Some(of(c)),
            Motion::Fretting(_) => None,
        })
    };
    let mut columns = vec![
        Column::real("creepage_along", "1", creepage(|c| c.along)),
        Column::real("creepage_across", "1", creepage(|c| c.across)),
        Column::real("spin", "1/m", creepage(|c| c.spin)),
        Column::real("adhesion", "1", points().map(|p| Some(p.adhesion))),
        Column::real(
            "adhesion_error_of_grid",
            "1",
            points().map(|p| Some(p.adhesion_error)),
        ),
    ];
    if points().any(|p| p.adhesion_band.is_some()) {
        let low = points().map(|p| p.adhesion_band.map(|b| b.low));
        columns.push(Column::real("adhesion_low", "1", low));
        let high = points().map(|p| p.adhesion_band.map(|b| b.high));
        columns.push(Column::real("adhesion_high", "1", high));
    }
    for (k, axis) in ["x", "y"].into_iter().enumerate() {
        columns.push(Column::real(
            format!("force_{axis}"),
            "N",
            points().map(|p| Some(p.force[k])),
        ));
    }
    columns.push(Column::real(
        "moment",
        "N m",
        points().map(|p| Some(p.moment)),
    ));
    columns.push(Column::real(
        "t_gamma",
        "N",
        points().map(|p| Some(p.t_gamma)),
    ));
    columns.push(Column::real(
        "resistance",
        "N",
        points().map(|p| Some(p.resistance)),
    ));
    columns.push(Column::real("stuck", "1", points().map(|p| Some(p.stuck))));
    columns.push(Column::real(
        "slip_speed",
        "m/s",
        points().map(|p| p.slip_speed),
    ));
    columns.push(Column::real(
        "temperature",
        "K",
        points().map(|p| p.temperature),
    ));
    let bodies = points().next().map_or(0, |p| p.wear.len());
    for k in 0..bodies {
        let name = points().next().map_or("", |p| p.wear[k].body.as_str());
        let of = points().map(|p| p.wear.get(k).map(|w| w.volume));
        columns.push(Column::real(format!("wear_volume_{name}"), "m^2", of));
        let of = points().map(|p| p.wear.get(k).map(|w| w.depth));
        columns.push(Column::real(format!("wear_depth_{name}"), "m", of));
    }
    Table { columns }
}

/// Writes the fields of all points.
fn fields(outcome: &Outcome, path: &Path) -> Result<(), Error> {
    let grid = &outcome.setup.grid;
    let places = |axis: usize| -> Vec<f64> {
        let cells = 0..grid.cells[axis];
        cells
            .map(|k| grid.from[axis] + (k as f64 + 0.5) * grid.size[axis])
            .collect()
    };
    let fail = |e: fretwork_store::results::ResultsError| Error::Failed(e.to_string());
    let mut maps = Maps::create(path, [&places(0), &places(1)]).map_err(fail)?;
    let field =
        |name: &'static str, unit: &'static str, doc: &'static str, values: Vec<f64>| MapField {
            name,
            unit,
            doc,
            values,
        };
    let of = |list: &[[f64; 2]], k: usize| list.iter().map(|v| v[k]).collect::<Vec<f64>>();
    for (k, solved) in outcome.rolled.iter().enumerate() {
        let (tractions, passage) = (&solved.rolling.tractions, &solved.passage);
        let mut list = vec![
            field(
                "pressure",
                "Pa",
                "pressure",
                solved.rolling.pressure.pressure.clone(),
            ),
            field(
                "traction_x",
                "Pa",
                "traction on the first body",
                of(&tractions.traction, 0),
            ),
            field(
                "traction_y",
                "Pa",
                "traction on the first body",
                of(&tractions.traction, 1),
            ),
            field(
                "slip_x",
                "m",
                "slip in the passage by a cell",
                of(&tractions.slip, 0),
            ),
            field(
                "slip_y",
                "m",
                "slip in the passage by a cell",
                of(&tractions.slip, 1),
            ),
            field("bound", "Pa", "largest traction", tractions.bound.clone()),
            field(
                "worn",
                "m",
                "depth worn in the passage by the cell",
                passage.worn.clone(),
            ),
        ];
        if !passage.temperature.is_empty() {
            let temperature = passage.temperature.clone();
            list.push(field(
                "temperature",
                "K",
                "temperature of the surfaces",
                temperature,
            ));
        }
        maps.point(&format!("point_{}", k + 1), &list)
            .map_err(fail)?;
    }
    for (k, stroke) in outcome.strokes.iter().enumerate() {
        let fine = &stroke.found.fine;
        let end = fine.cycle.traction.last().map_or(&[][..], |t| &t[..]);
        let mut list = vec![
            field("pressure", "Pa", "pressure", fine.pressure.pressure.clone()),
            field("traction_x", "Pa", "traction at the end", of(end, 0)),
            field("traction_y", "Pa", "traction at the end", of(end, 1)),
            field("slip_path", "m", "slip path in a cycle", stroke.slip_path()),
            field(
                "dissipated",
                "J/m^2",
                "energy of slip in a cycle",
                fine.cycle.dissipated.clone(),
            ),
        ];
        if !fine.cycle.worn.is_empty() {
            let worn = fine.cycle.worn.clone();
            list.push(field(
                "worn",
                "m",
                "depth worn off both bodies in a cycle",
                worn,
            ));
        }
        maps.point(&format!("point_{}", k + 1), &list)
            .map_err(fail)?;
    }
    maps.finish().map_err(fail)
}
