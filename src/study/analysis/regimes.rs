//! Maps of regimes: which of several behaviours a run shows, over two factors.

use super::numeric;
use crate::study::plan::Plan;
use crate::study::table::{Cell, DONE, Table};

/// Where each regime occurs.
#[derive(Clone, Debug)]
pub struct RegimeMap {
    /// What is mapped.
    pub name: String,
    /// The factors of the two axes; one if only one has numbers.
    pub axes: (usize, Option<usize>),
    /// By regime, the settings with it: values of both axes, and the share of the runs of the setting that show it.
    pub regimes: Vec<(String, Vec<RegimePoint>)>,
}

/// A setting that shows a regime.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegimePoint {
    /// Value of the first axis.
    pub x: f64,
    /// Value of the second axis; 0 without one.
    pub y: f64,
    /// Share of the runs of the setting that are done and show it.
    pub share: f64,
}

/// A map for each regime that is asked for, over the first two factors with numbers.
pub(super) fn maps(plan: &Plan, table: &Table) -> Vec<RegimeMap> {
    let mut axes = (0..plan.factors.len()).filter(|&f| numeric(plan, f));
    let (Some(first), second) = (axes.next(), axes.next()) else {
        return Vec::new();
    };
    let cells = |name: &str| {
        table
            .column(name)
            .map(|c| c.cells.as_slice())
            .unwrap_or_default()
    };
    let done: Vec<bool> = cells("status")
        .iter()
        .map(|c| matches!(c, Cell::Text(text) if text == DONE))
        .collect();
    let seeds = plan.seeds.len();
    let map = |name: &String| {
        let told = cells(name);
        let mut regimes: Vec<(String, Vec<RegimePoint>)> = Vec::new();
        for (k, setting) in plan.settings.iter().enumerate() {
            let runs = k * seeds..(k + 1) * seeds;
            let shown: Vec<&str> = runs
                .filter(|&r| done.get(r) == Some(&true))
                .filter_map(|r| match told.get(r) {
                    Some(Cell::Text(text)) => Some(text.as_str()),
                    _ => None,
                })
                .collect();
            let mut names = shown.clone();
            names.sort_unstable();
            names.dedup();
            for regime in names {
                let count = shown.iter().filter(|s| **s == regime).count();
                let point = RegimePoint {
                    x: setting[first].number.unwrap_or(f64::NAN),
                    y: second.and_then(|f| setting[f].number).unwrap_or(0.0),
                    share: count as f64 / shown.len() as f64,
                };
                match regimes.iter_mut().find(|r| r.0 == regime) {
                    Some(known) => known.1.push(point),
                    None => regimes.push((regime.to_owned(), vec![point])),
                }
            }
        }
        regimes.sort_by(|a, b| a.0.cmp(&b.0));
        RegimeMap {
            name: name.clone(),
            axes: (first, second),
            regimes,
        }
    };
    plan.regimes.iter().map(map).collect()
}
