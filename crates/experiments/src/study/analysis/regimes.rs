//! Regimes: the behaviour of the runs of a setting, and its map over two factors.

use crate::study::plan::Plan;
use crate::study::rows::Rows;

/// The regimes of all settings, by one text of the summary.
#[derive(Clone, Debug)]
pub struct Regimes {
    /// Name of the text that distinguishes them.
    pub name: String,
    /// For each setting, the regimes of its completed runs with their number, the most frequent
    /// first.
    pub shown: Vec<Vec<(String, usize)>>,
    /// Map of the regimes; `None` without a factor with numbers.
    pub map: Option<RegimeMap>,
}

/// Map of the regimes over two factors.
#[derive(Clone, Debug)]
pub struct RegimeMap {
    /// The factors of the two axes; one if only one has numbers.
    pub axes: (usize, Option<usize>),
    /// For each regime the settings with it in at least half of their runs: values of both axes,
    /// the second 0 without one.
    pub places: Vec<(String, Vec<(f64, f64)>)>,
}

impl Regimes {
    /// Describes the regimes of a setting: one name, or names with numbers of runs.
    pub fn words(&self, setting: usize) -> String {
        match self.shown[setting].as_slice() {
            [(one, _)] => one.clone(),
            several => {
                let each = several.iter().map(|(name, runs)| format!("{name} {runs}"));
                each.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

/// Returns, for each requested regime, the regimes of the settings, with a map over the first two
/// factors with numbers.
pub(super) fn regimes(plan: &Plan, rows: &Rows) -> Vec<Regimes> {
    let of = |name: &String| {
        let shown = shown(plan, rows, name);
        Regimes {
            name: name.clone(),
            map: map(plan, &shown),
            shown,
        }
    };
    plan.regimes.iter().map(of).collect()
}

fn shown(plan: &Plan, rows: &Rows, name: &str) -> Vec<Vec<(String, usize)>> {
    let seeds = plan.seeds.len();
    let mut all: Vec<Vec<(String, usize)>> = vec![Vec::new(); plan.settings.len()];
    for run in rows.done() {
        let (regime, counts) = (rows.table.text(name, run), &mut all[run / seeds]);
        match counts.iter_mut().find(|(name, _)| name == regime) {
            _ if regime.is_empty() => {}
            Some(known) => known.1 += 1,
            None => counts.push((regime.to_owned(), 1)),
        }
    }
    for counts in &mut all {
        counts.sort_by_key(|(_, runs)| std::cmp::Reverse(*runs));
    }
    all
}

fn map(plan: &Plan, shown: &[Vec<(String, usize)>]) -> Option<RegimeMap> {
    let mut axes = (0..plan.factors.len()).filter(|&f| plan.is_numeric(f));
    let (first, second) = (axes.next()?, axes.next());
    let mut places: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for (setting, shown) in plan.settings.iter().zip(shown) {
        let runs: usize = shown.iter().map(|(_, runs)| runs).sum();
        let place = |axis: Option<usize>| axis.map_or(Some(0.0), |f| setting[f].number);
        let Some((x, y)) = place(Some(first)).zip(place(second)) else {
            continue;
        };
        for (regime, _) in shown.iter().filter(|(_, own)| 2 * own >= runs) {
            match places.iter_mut().find(|(name, _)| name == regime) {
                Some(known) => known.1.push((x, y)),
                None => places.push((regime.clone(), vec![(x, y)])),
            }
        }
    }
    places.sort_by(|a, b| a.0.cmp(&b.0));
    Some(RegimeMap {
        axes: (first, second),
        places,
    })
}
