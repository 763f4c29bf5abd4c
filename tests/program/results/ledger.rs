//! The ledger in the tables: every entry is a column, and the columns add up.

use super::{folder, run};
use std::collections::BTreeMap;
use std::path::Path;

/// The columns of a table, by name without unit.
pub fn table(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(|h| h.split(" [").next().unwrap().to_owned())
        .collect();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for record in reader.records() {
        for (name, value) in names.iter().zip(record.unwrap().iter()) {
            let column = columns.entry(name.clone()).or_default();
            column.push(value.parse().unwrap());
        }
    }
    columns
}

const STORED_AND_SPENT: [&str; 11] = [
    "kinetic",
    "potential",
    "elastic",
    "fracture",
    "friction",
    "impact",
    "adhesion",
    "viscous",
    "correction",
    "scheme",
    "carried",
];

/// Runs a case. Its columns must add up row by row, these entries must not be zero, and the last
/// row must be that of the summary.
fn adds_up(name: &str, case: &str, sets: &[&str], entries: &[&str]) {
    let out = folder(&format!("ledger-{name}"));
    let mut args = Vec::new();
    for set in sets {
        args.extend(["--set", *set]);
    }
    args.extend(["--set", "output.views=0", "--set", "output.frames=0"]);
    args.extend(["--set", "output.figures=false"]);
    let (output, summary) = run(&format!("cases/{case}.ron"), &out, &args);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let columns = table(&out.join("statistics.csv"));
    let rows = columns["time"].len();
    for (row, residual) in columns["residual"].iter().enumerate() {
        let at = |name: &str| columns[name][row];
        let held: f64 = STORED_AND_SPENT.iter().map(|name| at(name)).sum();
        let sum = held - at("expansion") - at("external_work") - at("initial_kinetic");
        let all = STORED_AND_SPENT
            .iter()
            .chain(&["expansion", "external_work", "initial_kinetic"]);
        let scale = all.map(|name| at(name).abs()).fold(0.0, f64::max);
        let off = (sum - residual).abs();
        assert!(
            off <= 1e-14 * scale,
            "{name}, row {row}: the columns give {sum:e}, the residual is {residual:e} (largest entry {scale:e})"
        );
    }
    for entry in entries {
        let largest = columns[*entry].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(largest > 0.0, "{name}: `{entry}` is zero throughout");
    }
    for name in STORED_AND_SPENT
        .iter()
        .chain(&["external_work", "residual"])
    {
        let last = summary["energy"][*name].as_f64().unwrap();
        // The JSON reader is exact to the last digit but one.
        let row = columns[*name][rows - 1];
        assert!(
            (last - row).abs() <= 1e-15 * row.abs(),
            "{name}: {last:e} {row:e}"
        );
    }
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn columns_add_up_with_cohesion_and_position_correction() {
    let sets = ["time.end=0.05", "output.every=1"];
    let entries = ["adhesion", "friction", "impact", "correction"];
    adds_up("cohesion", "cohesive_shear", &sets, &entries);
}

#[test]
fn columns_add_up_with_projection() {
    let sets = [
        "time.end=0.05",
        "output.every=1",
        "solver.correction=0",
        "solver.projection=1e-8",
    ];
    let entries = ["adhesion", "friction", "correction"];
    adds_up("projection", "cohesive_shear", &sets, &entries);
}

#[test]
fn columns_add_up_where_grains_are_taken_out() {
    adds_up(
        "removal",
        "verification/falling_debris",
        &[],
        &["carried", "fracture", "potential"],
    );
}

#[test]
fn columns_add_up_with_thermal_expansion() {
    adds_up(
        "expansion",
        "verification/thermal/expanding_column",
        &["time.end=0.3"],
        &["expansion", "external_work"],
    );
}

#[test]
fn columns_add_up_with_an_implicit_scheme() {
    adds_up(
        "theta",
        "verification/energy",
        &["time.theta=1", "time.end=0.02"],
        &["scheme", "external_work"],
    );
}

#[test]
fn columns_add_up_from_a_velocity_at_the_start() {
    adds_up(
        "thrown",
        "verification/slide_to_roll_sphere",
        &["time.end=0.02"],
        &["initial_kinetic", "friction"],
    );
}
