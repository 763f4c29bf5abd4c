//! The table of the settings of a study, with means over their runs.

use super::analysis::Analysis;
use super::plan::Plan;
use super::rows::factor_column;
use crate::table::{Column, Table};
use fretwork_math::statistics::interval::Mean;

/// Returns the table of settings: values of the factors, and means over the seeds with half-widths
/// of 95 %, scatter and numbers of runs.
pub fn settings(plan: &Plan, analysis: &Analysis) -> Table {
    let count = plan.settings.len();
    let numbers = (1..=count).map(|k| Some(k as f64));
    let mut columns = vec![Column::whole("setting", numbers)];
    for k in 0..plan.factors.len() {
        columns.push(factor_column(plan, k, plan.settings.iter().map(|s| &s[k])));
    }
    for output in &analysis.outputs {
        let (name, unit) = (&output.name, &output.unit);
        let of = |f: fn(&Mean) -> Option<f64>| {
            let means = output.means.iter();
            means.map(move |m| m.as_ref().and_then(f))
        };
        columns.extend([
            Column::real(name, unit, of(|m| Some(m.mean))),
            Column::real(format!("{name}_half_width"), unit, of(|m| m.half_width)),
            Column::real(format!("{name}_scatter"), unit, of(|m| m.scatter)),
            Column::whole(format!("{name}_runs"), of(|m| Some(m.count as f64))),
        ]);
    }
    for regimes in &analysis.regimes {
        let words = (0..count).map(|k| regimes.words(k));
        columns.push(Column::text(&regimes.name, words));
    }
    Table { columns }
}
