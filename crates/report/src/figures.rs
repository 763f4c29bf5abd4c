//! Which figures a page has: columns of the statistics by their meaning, cycles, tables across the layer.

use crate::folder::RunFolder;
use crate::series::Series;
use crate::tables::Table;
use serde::Serialize;
use serde_json::{Value, json};

/// Share of the largest energy below which an entry of the ledger is not drawn.
const NEGLIGIBLE: f64 = 1e-3;

/// A figure, to be drawn by the page.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    /// Identity in the page.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What to see in it.
    pub note: &'static str,
    /// `time` (columns over time, linked), `loops` (a column over another, by cycle), `cycles`, `table`, `any` (with choosers).
    pub kind: &'static str,
    /// Column of the horizontal axis.
    pub x: String,
    /// Columns of the vertical axis.
    pub y: Vec<String>,
    /// Numbers that are not in the statistics.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub data: Value,
}

fn figure(
    id: &'static str,
    title: &'static str,
    note: &'static str,
    kind: &'static str,
    x: &str,
    y: Vec<String>,
) -> Figure {
    Figure {
        id,
        title,
        note,
        kind,
        x: x.to_owned(),
        y,
        data: Value::Null,
    }
}

/// The figures of a run; one with nothing to show is left out.
pub(crate) fn of(run: &RunFolder, series: &Series, tables: &[Table]) -> Vec<Figure> {
    let varying = |names: &[&str]| -> Vec<String> {
        let names = names.iter().filter(|n| series.varies(n));
        names.map(|n| (*n).to_owned()).collect()
    };
    let mut out = Vec::new();
    if series.varies("delta") && series.varies("Q") {
        out.push(figure(
            "loops",
            "Force against displacement",
            "The area of a loop is the energy of its cycle; rounded corners after a reversal are elastic shear.",
            "loops",
            "delta",
            vec!["Q".to_owned()],
        ));
    }
    let time = |id, title, note, y: Vec<String>| figure(id, title, note, "time", "time", y);
    out.push(time(
        "friction",
        "Friction over time",
        "Ratio of tangential to normal force, row by row.",
        varying(&["mu"]),
    ));
    out.push(time(
        "forces",
        "Forces on the tested body",
        "Tangential force Q and normal force P.",
        varying(&["Q", "P"]),
    ));
    if let Some(data) = by_cycle(&run.summary) {
        out.push(Figure {
            data,
            ..figure(
                "cycles",
                "Friction by cycle",
                "From forces, over each cycle; the plateau leaves the elastic travel out.",
                "cycles",
                "cycle",
                vec![],
            )
        });
    }
    out.push(time(
        "damage",
        "Damage over time",
        "Broken bonds over bonds made, and the mean damage of all bonds.",
        varying(&["damage_ratio", "mean_damage"]),
    ));
    out.push(time(
        "energy",
        "Energies",
        "Entries of the energy ledger above a thousandth of the largest.",
        energies(series),
    ));
    let worn = |c: &&str| c.ends_with("_worn") || matches!(*c, "worn_first" | "worn_third");
    let worn: Vec<&str> = series
        .columns
        .iter()
        .map(|c| c.name.as_str())
        .filter(worn)
        .collect();
    out.push(time(
        "wear",
        "Worn volume",
        "What the wear laws removed since the start.",
        varying(&worn),
    ));
    out.push(time(
        "circuit",
        "Masses of the tribological circuit",
        "Source, attached, ejected, recirculated and lost since the start of the account; M is in the contact now.",
        varying(&["M", "source", "attached", "ejected", "recirculated", "lost"]),
    ));
    out.push(time(
        "biaxial",
        "Biaxial test",
        "Stress ratio and strains of the sample.",
        varying(&["q_over_p", "sin_phi", "axial_strain", "volumetric_strain"]),
    ));
    out.retain(|f| f.kind != "time" || !f.y.is_empty());
    for table in tables {
        out.push(Figure {
            data: table.json(),
            ..figure("table", "Table", "", "table", "", vec![])
        });
    }
    if series.columns.len() > 1 {
        let first = ["mu", "kinetic", "contacts"]
            .iter()
            .find(|n| series.varies(n));
        out.push(figure(
            "any",
            "Any column of the statistics",
            "Choose what is drawn over what.",
            "any",
            "time",
            first.map(|n| (*n).to_owned()).into_iter().collect(),
        ));
    }
    out
}

/// Entries of the ledger, which stand together in the statistics, as far as they matter.
pub(crate) fn energies(series: &Series) -> Vec<String> {
    let at = |name: &str| series.columns.iter().position(|c| c.name == name);
    let (Some(first), Some(last)) = (at("kinetic"), at("residual")) else {
        return Vec::new();
    };
    let Some(ledger) = series.columns.get(first..last) else {
        return Vec::new();
    };
    let size = |values: &[f64]| {
        values
            .iter()
            .filter(|v| v.is_finite())
            .fold(0.0, |m: f64, v| m.max(v.abs()))
    };
    let most = ledger.iter().map(|c| size(&c.values)).fold(0.0, f64::max);
    let matters = ledger
        .iter()
        .filter(|c| size(&c.values) > NEGLIGIBLE * most);
    matters
        .map(|c| c.name.clone())
        .filter(|n| series.varies(n))
        .collect()
}

/// Results by cycle; none with fewer than two.
fn by_cycle(summary: &Value) -> Option<Value> {
    let cycles: Vec<&Value> = summary["cycles"]
        .as_array()?
        .iter()
        .filter(|c| c["complete"] == true)
        .collect();
    if cycles.len() < 2 {
        return None;
    }
    let column = |key: &str, label: &str| {
        let values: Vec<&Value> = cycles.iter().map(|c| &c[key]).collect();
        json!({"name": label, "values": values})
    };
    Some(json!({
        "x": cycles.iter().map(|c| &c["cycle"]).collect::<Vec<_>>(),
        "columns": [
            column("friction_coefficient", "friction coefficient"),
            column("plateau_ratio", "plateau Q/P"),
            column("reversal_ratio", "peak at reversal Q/P"),
        ],
    }))
}
