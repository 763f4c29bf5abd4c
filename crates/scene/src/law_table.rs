//! Tables of laws: friction or wear over slip, slip velocity, pressure and temperature.
//!
//! A table is a text file of columns with headings and units, see [`measured`](crate::measured):
//! `slip`, `slip_rate`, `pressure`, `temperature`, as many of them as the law depends on, and the
//! value, `friction` or `k`, with the ends of its interval in `friction_low` and `friction_high`.
//! Its rows are all combinations of the points of its axes, in any order. Several rows of one
//! point, as runs of several seeds give them, count with their mean, and with their lowest and
//! highest value as the interval. Other columns are ignored.

use super::case::InterfaceSpec;
use super::case::slots::BySlot;
use super::measured::MeasuredTable;
use super::source::{InputError, Source, ValidationError};
use super::units;
use fretwork_abi::FLAG_TABLE;
use fretwork_core::laws::{Kind, Plugin};
use std::path::Path;

/// Axes with their units, in the order of the plugin interface.
pub const AXES: [(&str, &str); 4] = [
    ("slip", "m"),
    ("slip_rate", "m/s"),
    ("pressure", "Pa"),
    ("temperature", "K"),
];

/// Returns the names that the value may have in a table of a kind, and its unit.
fn value_of(kind: Kind) -> Option<(&'static [&'static str], &'static str)> {
    if kind == Kind::CONTACT {
        Some((&["friction", "friction_coefficient"], ""))
    } else if kind == Kind::WEAR {
        Some((&["k", "wear_coefficient"], "1/Pa"))
    } else {
        None
    }
}

/// Numbers of tables by slot, in the order of the plugin interface.
pub(super) type Tables = BySlot<Vec<f64>>;

/// Reads the tables of an interface, whose files are relative to that of the case.
///
/// # Errors
/// A table cannot be read, is no complete grid, or belongs to a kind without tables; located in it,
/// or at its name in the case.
pub(super) fn of_interface(
    spec: &InterfaceSpec,
    source: &Source,
    here: &str,
) -> Result<Tables, InputError> {
    let folder = source.path().parent().unwrap_or(Path::new(""));
    let mut out = Tables::default();
    for (kind, name) in spec.tables.iter() {
        let at = format!("{here}.tables.{kind}");
        if spec.law(kind).is_none() {
            let why = format!("there is no {kind} law that reads the table");
            return Err(source.error_at(&at, why));
        }
        let read = MeasuredTable::read(&folder.join(name));
        let table = read.map_err(|e| source.named_at(&at, e))?;
        let numbers = numbers(&table, kind).map_err(|e| match e {
            Fault::Table(e) => source.named_at(&at, e),
            Fault::Whole(why) => source.error_at(&at, format!("{name}: {why}")),
        })?;
        out.set(kind, numbers);
    }
    Ok(out)
}

/// Checks that a law has a table if it reads one, and none otherwise.
pub(super) fn check(plugin: &Plugin, given: bool) -> Result<(), ValidationError> {
    let slot = plugin.kind.word();
    match (plugin.flags & FLAG_TABLE != 0, given) {
        (true, false) => Err(ValidationError::new(
            slot,
            format!(
                "the {slot} law `{}` reads a table, and the interface names none",
                plugin.name
            ),
        )
        .expected(format!("`tables: ({slot}: \"FILE.csv\")` in the interface"))),
        (false, true) => Err(ValidationError::new(
            format!("tables.{slot}"),
            format!("the {slot} law `{}` reads no table", plugin.name),
        )
        .expected(format!("`{slot}: \"tabulated\"`, or no table"))),
        _ => Ok(()),
    }
}

/// What is wrong with a table: a place in it, or all of it.
enum Fault {
    Table(InputError),
    Whole(String),
}

impl From<InputError> for Fault {
    fn from(e: InputError) -> Self {
        Self::Table(e)
    }
}

/// Returns the values of a column in a unit.
fn column(table: &MeasuredTable, column: usize, unit: &str) -> Result<Vec<f64>, Fault> {
    let heading = &table.headings[column];
    let values = table.values(column)?.into_iter();
    let converted = values.map(|v| units::convert(v, &heading.unit, unit));
    let converted: Result<Vec<f64>, _> = converted.collect();
    converted.map_err(|e| Fault::Whole(format!("column `{}`: {}", heading.name, e.message)))
}

/// Returns the numbers of a table.
fn numbers(table: &MeasuredTable, kind: Kind) -> Result<Vec<f64>, Fault> {
    let Some((names, unit)) = value_of(kind) else {
        return Err(Fault::Whole(format!("{kind} laws have no tables")));
    };
    let found = names.iter().find_map(|n| Some((*n, table.column(n)?)));
    let Some((name, value)) = found else {
        let there: Vec<&str> = table.headings.iter().map(|h| h.name.as_str()).collect();
        return Err(Fault::Whole(format!(
            "there is no column `{}`; there are {}",
            names[0],
            there.join(", ")
        )));
    };
    let end = |suffix: &str| -> Result<Option<Vec<f64>>, Fault> {
        let place = table.column(&format!("{name}_{suffix}"));
        place.map(|k| column(table, k, unit)).transpose()
    };
    let values = column(table, value, unit)?;
    let (low, high) = (end("low")?, end("high")?);
    for row in 0..values.len() {
        let [low, high] = [&low, &high].map(|e| e.as_ref().map_or(values[row], |e| e[row]));
        if !(0.0 <= low && low <= values[row] && values[row] <= high) {
            return Err(Fault::Whole(format!(
                "row {}: `{name}` is {}, with an interval of {low} to {high}; a value is not negative and lies in its interval",
                row + 1,
                values[row]
            )));
        }
    }
    let mut coordinates = Vec::new();
    let mut axes: Vec<Vec<f64>> = Vec::new();
    for (axis, unit) in AXES {
        let own = match table.column(axis) {
            Some(k) => column(table, k, unit)?,
            None => vec![0.0; values.len()],
        };
        let mut points = own.clone();
        points.sort_by(f64::total_cmp);
        points.dedup();
        coordinates.push(own);
        axes.push(points);
    }
    if axes.iter().all(|a| a.len() == 1) {
        let names = AXES.map(|a| a.0).join(", ");
        return Err(Fault::Whole(format!(
            "no axis has two points or more; the axes are {names}"
        )));
    }
    let size = axes.iter().map(Vec::len).product();
    let mut cells: Vec<Vec<usize>> = vec![Vec::new(); size];
    for row in 0..values.len() {
        let place = axes
            .iter()
            .zip(&coordinates)
            .fold(0, |place, (points, own)| {
                place * points.len() + points.partition_point(|p| *p < own[row])
            });
        cells[place].push(row);
    }
    if let Some(missing) = cells.iter().position(Vec::is_empty) {
        return Err(Fault::Whole(format!(
            "no row is at {}; the rows are all combinations of the points of the axes",
            point(&axes, missing)
        )));
    }
    let mean = |rows: &Vec<usize>| rows.iter().map(|r| values[*r]).sum::<f64>() / rows.len() as f64;
    let lowest = |rows: &Vec<usize>| {
        let own = rows
            .iter()
            .map(|r| low.as_ref().map_or(values[*r], |l| l[*r]));
        own.fold(f64::INFINITY, f64::min)
    };
    let highest = |rows: &Vec<usize>| {
        let own = rows
            .iter()
            .map(|r| high.as_ref().map_or(values[*r], |h| h[*r]));
        own.fold(f64::NEG_INFINITY, f64::max)
    };
    let mut out: Vec<f64> = axes.iter().map(|a| a.len() as f64).collect();
    out.extend(axes.iter().flatten());
    out.extend(cells.iter().map(mean));
    out.extend(cells.iter().map(lowest));
    out.extend(cells.iter().map(highest));
    Ok(out)
}

/// Describes a point of the grid.
fn point(axes: &[Vec<f64>], mut place: usize) -> String {
    let mut parts = Vec::new();
    for ((name, unit), points) in AXES.into_iter().zip(axes).rev() {
        let own = points[place % points.len()];
        place /= points.len();
        if points.len() > 1 {
            parts.push(format!("{name} {own:e} {unit}"));
        }
    }
    parts.reverse();
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, kind: Kind) -> Result<Vec<f64>, String> {
        let table = MeasuredTable::parse("table", text.to_owned()).map_err(|e| e.to_string())?;
        numbers(&table, kind).map_err(|e| match e {
            Fault::Table(e) => e.to_string(),
            Fault::Whole(why) => why,
        })
    }

    #[test]
    fn rows_in_any_order_are_a_grid_in_si_units() {
        let text = "pressure [MPa],slip_rate [mm/s],friction,friction_low,friction_high\n\
            300,10,0.3,0.25,0.35\n100,1,0.5,0.4,0.6\n300,1,0.4,0.3,0.5\n100,10,0.45,0.4,0.5\n";
        let got = read(text, Kind::CONTACT).unwrap();
        let expected = [
            1.0, 2.0, 2.0, 1.0, // Points of the axes.
            0.0, 1e-3, 1e-2, 1e8, 3e8, 0.0, //
            0.5, 0.4, 0.45, 0.3, //
            0.4, 0.3, 0.4, 0.25, //
            0.6, 0.5, 0.5, 0.35,
        ];
        assert_eq!(got.len(), expected.len());
        for (a, b) in got.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-12 * b, "{got:?}");
        }
    }

    #[test]
    fn seeds_of_a_point_give_its_interval() {
        let text =
            "temperature [K],seed,k [1/Pa]\n300,1,1e-14\n300,2,3e-14\n600,1,5e-14\n600,2,5e-14\n";
        let got = read(text, Kind::WEAR).unwrap();
        let close = |k: usize, x: f64| assert!((got[k] / x - 1.0).abs() < 1e-12, "{got:?}");
        for (k, x) in [
            (9, 2e-14),
            (10, 5e-14),
            (11, 1e-14),
            (12, 5e-14),
            (13, 3e-14),
        ] {
            close(k, x);
        }
    }

    #[test]
    fn what_is_no_grid_is_refused_with_a_sentence() {
        let of = |text: &str| read(text, Kind::CONTACT).unwrap_err();
        let missing = of("pressure [Pa],slip [m],friction\n1,0,0.3\n1,1,0.3\n2,0,0.3\n");
        assert!(missing.contains("slip 1e0 m, pressure 2e0 Pa"), "{missing}");
        assert!(of("pressure [Pa],mu\n1,0.3\n2,0.3\n").contains("no column `friction`"));
        assert!(of("pressure [Pa],friction\n1,0.3\n").contains("no axis"));
        assert!(of("pressure [Pa],friction\n1,0.3\n2,-0.3\n").contains("not negative"));
        assert!(of("pressure [m],friction\n1,0.3\n2,0.3\n").contains("column `pressure`"));
    }
}
