//! Friction of a soft third body against the cohesion of its grains.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Row, judge, rises};
use crate::sample::difference;
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "soft_third_body",
    title: "Cohesion of a soft third body",
    studies: &["soft_third_body"],
    published: true,
    show,
};

const MU: &str = "friction_coefficient";
const SHEAR: &str = "measures.layer_interior_shear";

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("soft_third_body", &["cohesion", MU, SHEAR])?;
    let settings = table.settings(|_| true);
    let at = |cohesion: f64| settings.iter().find(|s| s.factor("cohesion") == cohesion);
    let (Some(none), Some(four), Some(eight)) = (at(0.0), at(4.0), at(8.0)) else {
        return Err("the cohesions 0, 4 and 8 are not all done".into());
    };
    let mut results = Results::default();
    // The error is unknown if one run does not estimate it.
    let errors: Option<Vec<f64>> = settings
        .iter()
        .flat_map(|s| &s.runs)
        .map(|r| r.optional("friction_coefficient_numerical_error"))
        .collect();
    let numerical = Some(errors.map_or("not known".to_owned(), |e| {
        let largest = e.into_iter().fold(0.0, f64::max);
        format!("at most {largest:.3}, of the runs")
    }));
    let rise = difference(four.mean(MU), none.mean(MU));
    results.rows.push(Row::statement(
        "friction from C/P = 0 to 4",
        format!(
            "{} and {}: {}",
            none.mean(MU).text(2),
            four.mean(MU).text(2),
            rise.text(2)
        ),
        numerical.clone(),
        "rises with cohesion",
        Some(rises(rise)),
    ));
    let later = difference(eight.mean(MU), four.mean(MU));
    results.rows.push(Row::statement(
        "friction from C/P = 4 to 8",
        later.text(2),
        numerical,
        "levels off",
        // "Levels off" means no change, neither up nor down.
        Some(judge(later, 0.0, four.mean(MU).mean)),
    ));
    let cells: Vec<Vec<String>> = settings
        .iter()
        .map(|s| {
            vec![
                format!("{}", s.factor("cohesion")),
                s.mean(MU).text(3),
                s.mean(SHEAR).text(2),
                s.runs
                    .iter()
                    .map(|r| r.text("findings.layer_regime"))
                    .collect::<Vec<_>>()
                    .join(", "),
                s.runs
                    .iter()
                    .map(|r| r.text("not_trustworthy"))
                    .filter(|t| !t.is_empty())
                    .collect::<Vec<_>>()
                    .join(", "),
            ]
        })
        .collect();
    results.points = markdown(
        &[
            "C/P",
            "friction",
            "shear of the interior",
            "regime by seed",
            "not trustworthy",
        ],
        &cells,
    );
    let points = settings
        .iter()
        .map(|s| (s.factor("cohesion"), s.mean(MU).mean))
        .collect();
    let bars = settings
        .iter()
        .map(|s| (s.mean(MU).low(), s.mean(MU).high()))
        .collect();
    results.charts = vec![
        Chart::new(
            "Soft third body (trend of Zhang et al. 2020: rises, then levels)",
            Axis::new("cohesion over pressure C/P", ""),
            Axis::new("friction coefficient", ""),
        )
        .with(
            Series::new("ours, 95 % of three seeds", points)
                .style(Style::LineMarkers)
                .intervals(bars),
        ),
    ];
    Ok(results)
}
