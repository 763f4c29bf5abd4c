//! A patch under several loads: a folder for each, one table and one page of all.

use super::answer::{Answer, Motion, Point};
use super::{Outcome, PatchFile, files};
use crate::Error;
use crate::page::section;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_observe::quantity::quantity;
use fretwork_view::{Axis, Block, Chart, Series, Sheet, Style};
use serde::Serialize;
use std::path::Path;

/// The answers under all loads.
#[derive(Serialize)]
struct Answers<'a> {
    name: &'a str,
    loads: Vec<&'a Answer>,
}

/// Returns the answer under one load, or the answers under several as `loads`, as JSON.
///
/// # Errors
/// They cannot be written as JSON.
pub fn json(file: &PatchFile, outcomes: &[Outcome]) -> Result<String, Error> {
    if let [one] = outcomes {
        return files::json(one);
    }
    let answers = Answers {
        name: &file.spec.name,
        loads: outcomes.iter().map(|o| &o.answer).collect(),
    };
    let text = serde_json::to_string_pretty(&answers);
    text.map_err(|e| Error::Failed(e.to_string()))
}

/// Writes all files into a folder: those of one load, or for several `loads.csv`, `loads.html` and
/// the files of each load in a folder of it. Returns the JSON.
///
/// # Errors
/// A file cannot be written.
pub fn write(file: &PatchFile, outcomes: &[Outcome], out: &Path) -> Result<String, Error> {
    if let [one] = outcomes {
        return files::write(file, one, out);
    }
    for (k, outcome) in outcomes.iter().enumerate() {
        let folder = out.join(format!("load_{}", k + 1));
        std::fs::create_dir_all(&folder).map_err(|e| Error::write(&folder, &e))?;
        files::write(file, outcome, &folder)?;
    }
    csv::write(
        &table(outcomes),
        &out.join("loads.csv"),
        NumberFormat::Plain,
    )?;
    let page = out.join("loads.html");
    let written = sheet(file, outcomes).write(&page);
    written.map_err(|e| Error::write(&page, &e))?;
    let json = json(file, outcomes)?;
    let path = out.join("patch.json");
    std::fs::write(&path, &json).map_err(|e| Error::write(&path, &e))?;
    Ok(json)
}

/// All points, with their loads.
fn points(outcomes: &[Outcome]) -> impl Iterator<Item = (&Answer, &Point)> {
    let answers = outcomes.iter().map(|o| &o.answer);
    answers.flat_map(|answer| answer.points.iter().map(move |point| (answer, point)))
}

/// The numbers of all points, one row each.
fn table(outcomes: &[Outcome]) -> Table {
    let mut columns = Vec::new();
    let mut add = |name: &str, unit: &str, of: &dyn Fn(&Answer, &Point) -> Option<f64>| {
        let cells: Vec<Option<f64>> = points(outcomes).map(|(a, p)| of(a, p)).collect();
        if cells.iter().any(Option::is_some) {
            columns.push(Column::real(name, unit, cells));
        }
    };
    let rolls = |p: &Point| match p.motion {
        Motion::Rolling(creepage) => Some(creepage),
        Motion::Fretting(_) => None,
    };
    add("load", "N", &|a, _| Some(a.load));
    add("pressure", "Pa", &|a, _| Some(a.pressure));
    add("area", "m^2", &|a, _| Some(a.area));
    add("creepage_along", "1", &|_, p| rolls(p).map(|c| c.along));
    add("creepage_across", "1", &|_, p| rolls(p).map(|c| c.across));
    add("spin", "1/m", &|_, p| rolls(p).map(|c| c.spin));
    add("amplitude", "m", &|_, p| match p.motion {
        Motion::Rolling(_) => None,
        Motion::Fretting(amplitude) => Some(amplitude),
    });
    add("adhesion", "1", &|_, p| Some(p.adhesion));
    add("adhesion_error", "1", &|_, p| Some(p.adhesion_error));
    add("t_gamma", "N", &|_, p| rolls(p).map(|_| p.t_gamma));
    add("energy", "J", &|_, p| p.stroke.map(|s| s.energy.value));
    add("stuck", "1", &|_, p| p.stuck);
    add("slip_speed", "m/s", &|_, p| p.slip_speed);
    add("temperature", "K", &|_, p| p.temperature);
    let bodies = points(outcomes).next().map_or(&[][..], |(_, p)| &p.wear);
    for (k, wear) in bodies.iter().enumerate() {
        let unit = if points(outcomes).any(|(_, p)| p.stroke.is_some()) {
            "m^3"
        } else {
            "m^2"
        };
        add(&format!("wear_volume_{}", wear.body), unit, &|_, p| {
            p.wear.get(k).map(|w| w.volume)
        });
        add(&format!("wear_depth_{}", wear.body), "m", &|_, p| {
            p.wear.get(k).map(|w| w.depth)
        });
    }
    Table { columns }
}

/// The page: adhesion over creepage or amplitude, a curve for each load.
fn sheet(file: &PatchFile, outcomes: &[Outcome]) -> Sheet {
    let frets = points(outcomes).any(|(_, p)| p.stroke.is_some());
    let (across, force) = match frets {
        true => (Axis::new("amplitude", "um"), "Q/P"),
        false => (
            Axis::new("creepage along the rolling", "%"),
            "force over load",
        ),
    };
    let place = |p: &Point| match p.motion {
        Motion::Rolling(creepage) => 100.0 * creepage.along,
        Motion::Fretting(amplitude) => 1e6 * amplitude,
    };
    let mut chart = Chart::new("adhesion", across, Axis::new(force, ""));
    for outcome in outcomes {
        let answer = &outcome.answer;
        let mut line: Vec<(f64, f64)> = answer
            .points
            .iter()
            .map(|p| (place(p), p.adhesion))
            .collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        let series = Series::new(quantity(answer.load, "N"), line);
        chart = chart.with(series.style(Style::LineMarkers));
    }
    let texts = outcomes.iter().enumerate().map(|(k, outcome)| {
        let title = format!(
            "{}: load_{}/patch.html",
            quantity(outcome.answer.load, "N"),
            k + 1
        );
        section(title, vec![Block::Code(outcome.answer.text())])
    });
    let mut sections = vec![section("Loads", vec![Block::Figure(Box::new(chart))])];
    sections.extend(texts);
    sections.push(section(
        "The file",
        vec![Block::Code(file.source.text().to_owned())],
    ));
    Sheet {
        title: file.spec.name.clone(),
        lead: file.spec.doc.clone(),
        sections,
        command: "fretwork patch".to_owned(),
    }
}
