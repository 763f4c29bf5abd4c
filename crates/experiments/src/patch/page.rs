//! The page of a patch: its answer, the curve of adhesion or the loops, and maps over the patch.

use super::answer::Motion;
use super::fretting::map::FrettingMap;
use super::profiles::Profiles;
use super::rolling::comparison::Comparison;
use super::rolling::passages_shown;
use super::{Outcome, PatchFile};
use crate::Error;
use crate::page::section;
use fretwork_elastic::half_space::CellGrid;
use fretwork_observe::chart::{Colours, FieldMap};
use fretwork_observe::quantity::quantity;
use fretwork_rolling::fields::length;
use fretwork_view::{Axis, Block, Chart, Section, Series, Sheet, Style};
use std::path::Path;

/// Largest number of points whose maps are shown: the first, the last and some between.
const MAPS: usize = 4;

/// Writes the page.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &PatchFile, outcome: &Outcome, to: &Path) -> Result<(), Error> {
    let mut sections = vec![section("Answer", vec![Block::Code(outcome.answer.text())])];
    let profiles = outcome.setup.bodies.profiles.as_ref();
    sections.extend(profiles.map(Profiles::section));
    sections.extend(curve(outcome));
    sections.extend(passages_shown::page(outcome));
    sections.extend(loops(outcome));
    sections.extend(maps(outcome));
    let histories = outcome.answer.cycles.iter().enumerate();
    let load = outcome.answer.load;
    sections.extend(histories.map(|(k, history)| history.section(load, k + 1)));
    sections.extend(outcome.answer.map.iter().flat_map(FrettingMap::sections));
    sections.push(section(
        "The file",
        vec![Block::Code(file.source.text().to_owned())],
    ));
    let sheet = Sheet {
        title: file.spec.name.clone(),
        lead: file.spec.doc.clone(),
        sections,
        command: "fretwork patch".to_owned(),
    };
    sheet.write(to).map(drop).map_err(|e| Error::write(to, &e))
}

fn figure(chart: Chart) -> Block {
    Block::Figure(Box::new(chart))
}

/// The curve of adhesion over the creepage that varies.
fn curve(outcome: &Outcome) -> Option<Section> {
    let points = || outcome.answer.points.iter();
    let creepages: Vec<_> = points()
        .filter_map(|p| match p.motion {
            Motion::Rolling(c) => Some(c),
            Motion::Fretting(_) => None,
        })
        .collect();
    if creepages.is_empty() || creepages.len() < 2 && outcome.answer.comparisons.is_empty() {
        return None;
    }
    let all = |k: usize| {
        let c = creepages[k];
        [100.0 * c.along, 100.0 * c.across, c.spin]
    };
    let varies = |axis: &usize| (1..creepages.len()).any(|k| all(k)[*axis] != all(0)[*axis]);
    let axis = (0..3).find(varies).unwrap_or(0);
    let of = |k: usize| all(k)[axis];
    let (name, unit) = [
        ("creepage along the rolling", "%"),
        ("creepage across the rolling", "%"),
        ("spin", "1/m"),
    ][axis];
    let mut order: Vec<usize> = (0..creepages.len()).collect();
    order.sort_by(|a, b| of(*a).total_cmp(&of(*b)));
    let list: Vec<_> = points().collect();
    let line = order.iter().map(|k| (of(*k), list[*k].adhesion)).collect();
    let bands = order.iter().map(|k| match list[*k].adhesion_band {
        Some(band) => (band.low, band.high),
        None => {
            let p = list[*k];
            (p.adhesion - p.adhesion_error, p.adhesion + p.adhesion_error)
        }
    });
    let bars = match list[0].adhesion_band {
        Some(_) if outcome.answer.third_body.is_some() => "range over the seeds",
        Some(_) => "range over the members",
        None => &format!("error {}", outcome.answer.errors),
    };
    let note = format!("Bars are the {bars}.");
    let label = match outcome.answer.comparisons.is_empty() {
        true => "",
        false => "this patch",
    };
    let series = Series::new(label, line)
        .style(Style::LineMarkers)
        .intervals(bands.collect());
    let chart = Chart::new(
        "adhesion",
        Axis::new(name, unit),
        Axis::new("force over load", ""),
    );
    let chart = chart.note(note).with(series);
    Some(section(
        "Adhesion",
        vec![figure(chart.with_all(others(outcome)))],
    ))
}

/// Other curves, and measured points with their ranges.
fn others(outcome: &Outcome) -> Vec<Series> {
    let of = |other: &Comparison| {
        let middle = |ends: [f64; 2]| 0.5 * (ends[0] + ends[1]);
        let points = other.points.iter();
        let line = points.map(|p| (100.0 * middle(p.creepage), middle(p.adhesion)));
        let series = Series::new(&other.name, line.collect());
        if other.curve {
            return series;
        }
        let ranges = other.points.iter().map(|p| (p.adhesion[0], p.adhesion[1]));
        series.style(Style::Markers).intervals(ranges.collect())
    };
    outcome.answer.comparisons.iter().map(of).collect()
}

/// The loops of strokes.
fn loops(outcome: &Outcome) -> Option<Section> {
    let mut chart = Chart::new(
        "loops",
        Axis::new("displacement", "um"),
        Axis::new("force", "N"),
    );
    for stroke in &outcome.strokes {
        let Motion::Fretting(amplitude) = stroke.point.motion else {
            continue;
        };
        let points = stroke.curve().iter().map(|[d, q]| (1e6 * d, *q)).collect();
        chart = chart.with(Series::new(quantity(amplitude, "m"), points));
    }
    for measured in &outcome.answer.loops {
        let points = measured.points.iter().map(|[d, q]| (1e6 * d, *q)).collect();
        chart = chart.with(Series::new(&measured.name, points).style(Style::Markers));
    }
    let any = !outcome.strokes.is_empty();
    any.then(|| section("Loops", vec![figure(chart)]))
}

/// The maps of some points, curves for a line contact.
pub(super) fn maps(outcome: &Outcome) -> Vec<Section> {
    let grid = &outcome.setup.grid;
    let map = |title: &str, unit: &str, scale: f64, values: Vec<f64>, shown: &[f64]| {
        let touching = (0..grid.len()).filter(|c| shown[*c] > 0.0);
        let touching: Vec<usize> = touching.collect();
        // Cells of a line contact are as long as the line: drawn to scale they fill no page.
        if grid.cells[1] == 1 {
            let x = Axis::new("along the motion", "mm");
            let mut chart = Chart::new(title, x, Axis::new(title, unit));
            // A line for each of the patches that touch apart from each other.
            for cells in touching.chunk_by(|one, next| one + 1 == *next) {
                let points = cells.iter();
                let points = points.map(|c| (1e3 * grid.middle(*c)[0], scale * values[*c]));
                chart = chart.with(Series::new("", points.collect()));
            }
            return figure(chart);
        }
        let mut chart = Chart::new(
            title,
            Axis::new("along the motion", "mm"),
            Axis::new("across", "mm"),
        );
        chart.field = Some(FieldMap {
            cells: touching.iter().map(|c| corners(grid, *c)).collect(),
            colours: Colours::Values {
                values: touching.iter().map(|c| scale * values[*c]).collect(),
                scale: Axis::new(title, unit),
            },
            arrows: Vec::new(),
            arrow_label: String::new(),
        });
        figure(chart)
    };
    let sizes = |list: &[[f64; 2]]| list.iter().map(|v| length(*v)).collect::<Vec<f64>>();
    let mut out = Vec::new();
    for k in some(outcome.rolled.len()) {
        let solved = &outcome.rolled[k];
        let p = &solved.rolling.pressure.pressure;
        let tractions = &solved.rolling.tractions;
        let mut blocks = vec![
            map("pressure", "MPa", 1e-6, p.clone(), p),
            map("traction", "MPa", 1e-6, sizes(&tractions.traction), p),
        ];
        let per_step = outcome.setup.speed.map_or(1.0, |v| v / grid.size[0]);
        if outcome.setup.speed.is_some() {
            blocks.push(map(
                "slip velocity",
                "m/s",
                per_step,
                sizes(&tractions.slip),
                p,
            ));
        }
        if !solved.passage.temperature.is_empty() {
            let thermal = outcome.setup.bodies.thermal.as_ref();
            let coldest = thermal.map_or(0.0, |t| t.bulk[0].min(t.bulk[1]));
            let temperature = solved.passage.temperature.iter();
            let rise = temperature.map(|t| t - coldest).collect();
            blocks.push(map("temperature above the bodies", "K", 1.0, rise, p));
        }
        if let Some(wear) = solved.point.wear.first() {
            let rows = wear.profile.iter().enumerate();
            let place = |row: usize| 1e3 * grid.middle(grid.cell([0, row]))[1];
            let points = rows.map(|(row, depth)| (place(row), 1e9 * depth)).collect();
            let chart = Chart::new(
                format!("wear of {} in a passage", wear.body),
                Axis::new("across", "mm"),
                Axis::new("depth", "nm"),
            );
            blocks.push(figure(chart.with(Series::new("", points))));
        }
        out.push(section(format!("Point {}", k + 1), blocks));
    }
    for k in some(outcome.strokes.len()) {
        let stroke = &outcome.strokes[k];
        let fine = &stroke.found.fine;
        let p = &fine.pressure.pressure;
        let end = fine.cycle.traction.last().map_or(&[][..], |t| &t[..]);
        let mut blocks = vec![
            map("pressure", "MPa", 1e-6, p.clone(), p),
            map("traction at the end", "MPa", 1e-6, sizes(end), p),
            map("slip path in a cycle", "um", 1e6, stroke.slip_path(), p),
        ];
        if !fine.cycle.worn.is_empty() {
            let worn = fine.cycle.worn.clone();
            blocks.push(map("depth worn in a cycle", "nm", 1e9, worn, p));
        }
        out.push(section(format!("Point {}", k + 1), blocks));
    }
    out
}

/// Corners of a cell (mm).
fn corners(grid: &CellGrid, cell: usize) -> Vec<[f32; 2]> {
    let [x, y] = grid.middle(cell);
    let [dx, dy] = grid.size.map(|s| 0.5 * s);
    let corner = |a: f64, b: f64| [1e3 * (x + a * dx), 1e3 * (y + b * dy)].map(|v| v as f32);
    vec![
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ]
}

/// Returns some numbers below a count, evenly, with the first and the last.
fn some(count: usize) -> Vec<usize> {
    match count {
        0 => Vec::new(),
        n if n <= MAPS => (0..n).collect(),
        n => (0..MAPS).map(|k| k * (n - 1) / (MAPS - 1)).collect(),
    }
}
