//! Profiles over passages: lines of text, tables, fields, and figures of the page.

use crate::Error;
use crate::page::section;
use crate::patch::Outcome;
use crate::patch::answer::Answer;
use crate::patch::rolling::passages::Worn;
use crate::table::csv::{self, NumberFormat};
use crate::table::{Column, Table};
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::fields::length;
use fretwork_rolling::passages::{Course, Jump, Moment};
use fretwork_store::maps::{MapField, Maps};
use fretwork_view::{Axis, Block, Chart, Section, Series};
use std::path::Path;

/// Returns the passages as lines of text: label and text.
pub(in crate::patch) fn lines(answer: &Answer, worn: &Worn) -> Vec<(String, String)> {
    let (about, start, end) = (&worn.about, &worn.start, &worn.end);
    let mut out = Vec::new();
    let mut add = |label: &str, text: String| out.push((label.to_owned(), text));
    let names = body_names(answer);
    for (k, name) in names.into_iter().enumerate() {
        add(
            &format!("wear of {name}"),
            format!(
                "{} +- {} by the jumps +- {} by the cells deep, {} mm2 of its section, in {} passages of its points",
                quantity(end.depth[k], "m"),
                quantity(part_of_error(worn, k), "m"),
                quantity(worn.error_of_grid[k], "m"),
                number(1e6 * end.volume[k], 4),
                number(about.passages[k], 4),
            ),
        );
    }
    add("", about.why[0].clone());
    add("", about.why[1].clone());
    add(
        "largest pressure",
        format!(
            "{} +- {} by the cells, then {} +- {}",
            quantity(start.pressure, "Pa"),
            quantity(worn.start_error, "Pa"),
            quantity(end.pressure, "Pa"),
            quantity(worn.pressure_error, "Pa"),
        ),
    );
    add(
        "width",
        format!(
            "{}, then {}",
            quantity(start.width, "m"),
            quantity(end.width, "m")
        ),
    );
    let size = |jump: &Jump| number(length(jump.adhesion), 4);
    add("adhesion", format!("{}, then {}", size(start), size(end)));
    if start.creepage != end.creepage {
        let percent = |x: f64| format!("{} %", number(100.0 * x, 4));
        add(
            "creepage",
            format!(
                "{}, then {}",
                percent(start.creepage),
                percent(end.creepage)
            ),
        );
    }
    add(
        "jumps",
        format!(
            "{}, {} more made again; the volumes of law and profiles differ by {} of them",
            worn.jumps[0],
            worn.jumps[1],
            number(worn.ledger, 1)
        ),
    );
    for note in &worn.notes {
        add("", note.clone());
    }
    out
}

/// Names of both bodies, apart from each other.
pub(in crate::patch) fn body_names(answer: &Answer) -> [String; 2] {
    let [one, other] = &answer.names;
    match one == other {
        true => ["the first body".into(), "the second body".into()],
        false => [one.clone(), other.clone()],
    }
}

/// The part of a body in the error of the jumps, which is that of both.
fn part_of_error(worn: &Worn, body: usize) -> f64 {
    let all: f64 = worn.end.depth.iter().sum();
    match all > 0.0 {
        true => worn.end.error * worn.end.depth[body] / all,
        false => 0.0,
    }
}

/// Writes `passages.csv`, `profiles.csv` and `profiles.h5` into a folder.
///
/// # Errors
/// A file cannot be written.
pub(in crate::patch) fn write(outcome: &Outcome, out: &Path) -> Result<(), Error> {
    let Some(course) = &outcome.course else {
        return Ok(());
    };
    let over = |table: &Table, name: &str| csv::write(table, &out.join(name), NumberFormat::Plain);
    over(&jumps(course, outcome.answer.load), "passages.csv")?;
    over(&profiles(course), "profiles.csv")?;
    fields(course, &out.join("profiles.h5"))
}

/// The bodies after each jump, under a load (N). As in `adhesion.csv`, adhesion is the size of the
/// force over the load, and forces are those on the first body.
fn jumps(course: &Course, load: f64) -> Table {
    let column = |name: &str, unit: &str, of: &dyn Fn(&Jump) -> f64| {
        let values: Vec<_> = course.jumps.iter().map(|j| Some(of(j))).collect();
        Column::real(name, unit, values)
    };
    Table {
        columns: vec![
            column("passages", "1", &|j| j.passages),
            column("depth_first", "m", &|j| j.depth[0]),
            column("depth_second", "m", &|j| j.depth[1]),
            column("area_first", "m^2", &|j| j.volume[0]),
            column("area_second", "m^2", &|j| j.volume[1]),
            column("error_of_jumps", "m", &|j| j.error),
            column("pressure", "Pa", &|j| j.pressure),
            column("width", "m", &|j| j.width),
            column("creepage_along", "1", &|j| j.creepage),
            column("adhesion", "1", &|j| length(j.adhesion)),
            column("force_x", "N", &|j| load * j.adhesion[0]),
            column("force_y", "N", &|j| load * j.adhesion[1]),
        ],
    }
}

/// Returns the values of all moments over the rows of the last one, which hold those before.
fn rows(course: &Course) -> Vec<[Vec<f64>; 4]> {
    let Some(last) = course.moments.last() else {
        return Vec::new();
    };
    let of = |moment: &Moment| {
        let over = |values: &[f64]| moment.profile.over(values, &last.profile);
        let [one, other] = &moment.profile.depth;
        [
            over(one),
            over(other),
            over(&moment.pressure),
            over(&moment.friction),
        ]
    };
    course.moments.iter().map(of).collect()
}

fn places(course: &Course) -> Vec<f64> {
    let last = course.moments.last();
    last.map_or_else(Vec::new, |m| {
        (0..m.profile.rows()).map(|k| m.profile.middle(k)).collect()
    })
}

fn profiles(course: &Course) -> Table {
    let (rows, places) = (rows(course), places(course));
    let count = places.len();
    let passages = course
        .moments
        .iter()
        .flat_map(|m| vec![Some(m.passages); count]);
    let across = rows.iter().flat_map(|_| places.iter().map(|y| Some(*y)));
    let field = |k: usize| rows.iter().flat_map(move |r| r[k].iter().map(|v| Some(*v)));
    Table {
        columns: vec![
            Column::real("passages", "1", passages),
            Column::real("y", "m", across),
            Column::real("depth_first", "m", field(0)),
            Column::real("depth_second", "m", field(1)),
            Column::real("pressure", "Pa", field(2)),
            Column::real("friction", "1", field(3)),
        ],
    }
}

fn fields(course: &Course, path: &Path) -> Result<(), Error> {
    let fail = |e: fretwork_store::results::ResultsError| Error::Failed(e.to_string());
    let rows = rows(course);
    let passages: Vec<f64> = course.moments.iter().map(|m| m.passages).collect();
    let axes = [
        (
            "y",
            places(course),
            "m",
            "middles of the rows across the motion",
        ),
        ("passages", passages, "1", "passages of the counted body"),
    ];
    let mut maps = Maps::over(path, &axes).map_err(fail)?;
    let about = [
        ("depth_first", "m", "depth worn of the first body"),
        ("depth_second", "m", "depth worn of the second body"),
        ("pressure", "Pa", "largest pressure of a row"),
        ("friction", "1", "traction over pressure of a row"),
    ];
    let list = about
        .into_iter()
        .enumerate()
        .map(|(k, (name, unit, doc))| MapField {
            name,
            unit,
            doc,
            values: rows.iter().flat_map(|r| r[k].iter().copied()).collect(),
        });
    let list: Vec<MapField> = list.collect();
    maps.group("profiles", &list).map_err(fail)?;
    maps.finish().map_err(fail)
}

/// The figures of the page.
pub(in crate::patch) fn page(outcome: &Outcome) -> Option<Section> {
    let course = outcome.course.as_ref()?;
    let (rows, places) = (rows(course), places(course));
    let names = body_names(&outcome.answer);
    let across = |title: String, y: Axis, k: usize, scale: f64, all: bool| {
        let mut chart = Chart::new(title, Axis::new("across", "mm"), y);
        for (moment, values) in course.moments.iter().zip(&rows) {
            let pairs = places.iter().zip(&values[k]);
            let shown = pairs.filter(|(_, v)| all || **v > 0.0);
            let points = shown.map(|(y, v)| (1e3 * y, scale * v)).collect();
            chart = chart.with(Series::new(number(moment.passages, 3), points));
        }
        Block::Figure(Box::new(chart))
    };
    let over = |title: &str, y: Axis, series: Vec<(String, Vec<f64>)>| {
        let mut chart = Chart::new(title, Axis::new("passages", ""), y);
        for (name, values) in series {
            let pairs = course.jumps.iter().zip(values);
            let points = pairs.map(|(j, v)| (j.passages, v)).collect();
            chart = chart.with(Series::new(name, points));
        }
        Block::Figure(Box::new(chart))
    };
    let each = |of: fn(&Jump) -> f64| course.jumps.iter().map(of).collect::<Vec<f64>>();
    let mut blocks = Vec::new();
    for (k, name) in names.iter().enumerate() {
        if outcome
            .answer
            .passages
            .as_ref()
            .is_some_and(|w| w.end.depth[k] > 0.0)
        {
            let title = format!("depth worn of {name}, by passages");
            blocks.push(across(title, Axis::new("depth", "um"), k, 1e6, true));
        }
    }
    blocks.push(across(
        "largest pressure across the motion, by passages".into(),
        Axis::new("pressure", "MPa"),
        2,
        1e-6,
        false,
    ));
    blocks.push(across(
        "traction over pressure across the motion, by passages".into(),
        Axis::new("traction over pressure", ""),
        3,
        1.0,
        false,
    ));
    let [one, other] = names;
    blocks.push(over(
        "depth over passages",
        Axis::new("largest depth", "um"),
        vec![
            (one, each(|j| 1e6 * j.depth[0])),
            (other, each(|j| 1e6 * j.depth[1])),
        ],
    ));
    blocks.push(over(
        "pressure over passages",
        Axis::new("largest pressure", "MPa"),
        vec![(String::new(), each(|j| 1e-6 * j.pressure))],
    ));
    blocks.push(over(
        "friction over passages",
        Axis::new("force over load", ""),
        vec![(String::new(), each(|j| length(j.adhesion)))],
    ));
    if course
        .jumps
        .iter()
        .any(|j| j.creepage != course.jumps[0].creepage)
    {
        blocks.push(over(
            "creepage over passages",
            Axis::new("creepage", "%"),
            vec![(String::new(), each(|j| 100.0 * j.creepage))],
        ));
    }
    Some(section("Profiles over passages", blocks))
}
