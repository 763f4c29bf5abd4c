//! Files of a patch: `patch.json`, `adhesion.csv` or `loop_N.csv`, the fields in `patch.h5`, those
//! of passages, and the page `patch.html`.

use super::answer::Motion;
use super::fretting::Stroke;
use super::method::Method;
use super::rolling::{Solved, passages_shown};
use super::{Outcome, PatchFile, page};
use crate::Error;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::fields::length;
use fretwork_store::maps::{ImageGrid, MapField, Maps, States};
use fretwork_store::results::ResultsError;
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
    if outcome.answer.points.iter().any(|p| p.stroke.is_none()) {
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
            match outcome.answer.method {
                Method::Exact => "adhesion_error_of_grid",
                _ => "adhesion_error",
            },
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
    columns.push(Column::real("moment", "N m", points().map(|p| p.moment)));
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
    columns.push(Column::real("stuck", "1", points().map(|p| p.stuck)));
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
        let of = points().map(|p| p.wear.get(k).map(|w| w.volume_error));
        let error = match outcome.answer.method {
            Method::Exact => format!("wear_volume_{name}_error_of_grid"),
            _ => format!("wear_volume_{name}_error"),
        };
        columns.push(Column::real(error, "m^2", of));
        let of = points().map(|p| p.wear.get(k).map(|w| w.depth));
        columns.push(Column::real(format!("wear_depth_{name}"), "m", of));
    }
    Table { columns }
}

/// Returns the cells of a grid as those of an image.
pub(super) fn image_grid(grid: &CellGrid) -> ImageGrid {
    ImageGrid {
        cells: grid.cells,
        from: grid.from,
        size: grid.size,
    }
}

/// The fields of a point.
#[derive(Default)]
struct Fields(Vec<MapField>);

impl Fields {
    fn add(&mut self, name: &'static str, unit: &'static str, doc: &'static str, values: Vec<f64>) {
        self.0.push(MapField {
            name,
            unit,
            doc,
            values,
        });
    }

    /// Adds a field that is empty where the laws do not have it.
    fn add_known(
        &mut self,
        name: &'static str,
        unit: &'static str,
        doc: &'static str,
        values: &[f64],
    ) {
        if !values.is_empty() {
            self.add(name, unit, doc, values.to_vec());
        }
    }

    fn rolled(solved: &Solved) -> Self {
        let (pressure, passage) = (&solved.rolling.pressure.pressure, &solved.passage);
        let tractions = &solved.rolling.tractions;
        let by_cell = "slip in the passage by a cell";
        let mut out = Self::default();
        out.add("pressure", "Pa", "pressure", pressure.clone());
        for (k, name) in ["traction_x", "traction_y"].into_iter().enumerate() {
            let values = component(&tractions.traction, k);
            out.add(name, "Pa", "traction on the first body", values);
        }
        for (k, name) in ["slip_x", "slip_y"].into_iter().enumerate() {
            out.add(name, "m", by_cell, component(&tractions.slip, k));
        }
        let sizes = tractions.slip.iter().map(|s| length(*s)).collect();
        out.add("slip", "m", by_cell, sizes);
        out.add("bound", "Pa", "largest traction", tractions.bound.clone());
        let doc = "0 no contact, 1 sticks, 2 slips";
        out.add("status", "1", doc, status(pressure, &tractions.sticks));
        let doc = "depth worn in the passage by the cell";
        out.add_known("worn", "m", doc, &passage.worn);
        let doc = "temperature of the surfaces";
        out.add_known("temperature", "K", doc, &passage.temperature);
        out
    }

    fn fretted(stroke: &Stroke) -> Self {
        let fine = &stroke.found.fine;
        let (pressure, cycle) = (&fine.pressure.pressure, &fine.cycle);
        let end = cycle.traction.last().map_or(&[][..], |t| &t[..]);
        let mut out = Self::default();
        out.add("pressure", "Pa", "pressure", pressure.clone());
        for (k, name) in ["traction_x", "traction_y"].into_iter().enumerate() {
            out.add(name, "Pa", "traction at the end", component(end, k));
        }
        let doc = "slip path in a cycle";
        out.add("slip_path", "m", doc, stroke.slip_path());
        let doc = "0 no contact, 1 sticks throughout, 2 slips";
        out.add("status", "1", doc, status(pressure, &cycle.sticks));
        let doc = "energy of slip in a cycle";
        out.add("dissipated", "J/m^2", doc, cycle.dissipated.clone());
        let doc = "depth worn off both bodies in a cycle";
        out.add_known("worn", "m", doc, &cycle.worn);
        out
    }
}

/// Returns 0 in cells without contact, 1 in those that stick, 2 in those that slip.
fn status(pressure: &[f64], sticks: &[bool]) -> Vec<f64> {
    let cells = pressure.iter().zip(sticks);
    let of = cells.map(|(p, sticks)| match (*p > 0.0, sticks) {
        (false, _) => 0.0,
        (true, true) => 1.0,
        (true, false) => 2.0,
    });
    of.collect()
}

fn component(list: &[[f64; 2]], k: usize) -> Vec<f64> {
    list.iter().map(|v| v[k]).collect()
}

/// Writes the fields of all points, as states of an image; no file where no point has any.
fn fields(outcome: &Outcome, path: &Path) -> Result<(), Error> {
    let rolled = outcome.rolled.iter().map(Fields::rolled);
    let points = rolled.chain(outcome.strokes.iter().map(Fields::fretted));
    let mut points = points.map(|f| f.0);
    let Some(mut all) = points.next() else {
        // Those of another method would be taken for the fields of this answer.
        for old in [path.to_owned(), path.with_extension("vtkhdf")] {
            let _ = std::fs::remove_file(old);
        }
        return Ok(());
    };
    let mut count = 1;
    for point in points {
        count += 1;
        for (field, more) in all.iter_mut().zip(point) {
            field.values.extend(more.values);
        }
    }
    let fail = |e: ResultsError| Error::Failed(e.to_string());
    let grid = image_grid(&outcome.setup.grid);
    let states = States {
        values: (1..=count).map(f64::from).collect(),
        unit: "1",
        doc: "number of the point",
    };
    let mut maps = Maps::over_cells(path, &grid).map_err(fail)?;
    maps.image(&grid, Some(&states), &all).map_err(fail)?;
    maps.finish().map_err(fail)
}
