//! Regular polygons, and disks with the rolling resistance that should be equivalent to them.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Reference, Row};
use crate::sample::difference;
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "polygons",
    title: "Polygons and rolling resistance",
    studies: &["polygons_6", "polygons_12"],
    published: true,
    show,
};

const MU: &str = "measures.bulk_mu";
const I: &str = "measures.bulk_I";
const PRESSURE: &str = "measures.bulk_p";

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let mut results = Results::default();
    let mut cells = Vec::new();
    let (mut polygons, mut disks) = ((Vec::new(), Vec::new()), (Vec::new(), Vec::new()));
    // The sides are in the order of increasing resistance.
    for sides in [12, 6] {
        let study = format!("polygons_{sides}");
        if !inputs.tables.contains_key(&study) {
            continue;
        }
        let table = inputs.table(&study, &[MU, I, PRESSURE])?;
        let named = |name: &str| {
            table
                .named("shape", name)
                .ok_or(format!("no run of `{name}` is done"))
        };
        let (shape, rolling) = (named("polygons")?, named("rolling")?);
        let rolling_resistance = 0.25 * (std::f64::consts::PI / (2.0 * f64::from(sides))).tan();
        let (a, b) = (rolling.mean(MU), shape.mean(MU));
        let reference = Reference {
            value: b.mean,
            range: 0.0,
            digits: 3,
        };
        let mut row = Row::number(
            format!("friction of disks with rolling resistance {rolling_resistance:.4}"),
            a,
            difference(a, b),
            None,
            &reference,
        );
        row.reference = format!("equal to polygons of {sides} sides; ours {}", b.text(3));
        results.rows.push(row);
        for (e, drawn) in [(b, &mut polygons), (a, &mut disks)] {
            drawn.0.push((rolling_resistance, e.mean));
            drawn.1.push((e.low(), e.high()));
        }
        for (s, what) in [
            (&shape, format!("polygons of {sides} sides")),
            (&rolling, format!("disks, µ_r = {rolling_resistance:.4}")),
        ] {
            cells.push(vec![
                what,
                s.mean(MU).text(3),
                s.mean(I).text(4),
                s.mean(PRESSURE).text(0),
            ]);
        }
        if let Some(plain) = table.named("shape", "disks") {
            let e = plain.mean(MU);
            cells.push(vec![
                "disks, µ_r = 0".to_owned(),
                e.text(3),
                plain.mean(I).text(4),
                plain.mean(PRESSURE).text(0),
            ]);
            disks.0.insert(0, (0.0, e.mean));
            disks.1.insert(0, (e.low(), e.high()));
        }
    }
    if cells.is_empty() {
        return Err("no run is done".into());
    }
    results.points = markdown(&["grains", "friction", "I", "pressure, Pa"], &cells);
    results.charts = vec![
        Chart::new(
            "Polygons and disks with rolling resistance",
            Axis::new("rolling resistance tan(π/2n)/4", ""),
            Axis::new("friction coefficient τ/p", ""),
        )
        .with(
            Series::new("ours, regular polygons of 12 and 6 sides", polygons.0)
                .style(Style::Markers)
                .intervals(polygons.1),
        )
        .with(
            Series::new(
                "ours, disks with rolling resistance (Estrada et al. 2011: equal)",
                disks.0,
            )
            .style(Style::LineMarkers)
            .intervals(disks.1),
        ),
    ];
    Ok(results)
}
