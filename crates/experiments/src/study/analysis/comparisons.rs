//! Comparison of the alternatives of a factor, such as laws.

use super::Data;
use crate::study::spec::DesignSpec;
use fretwork_math::statistics::comparisons::Comparisons;
use std::collections::HashMap;

/// The alternatives of a factor compared.
#[derive(Clone, Debug)]
pub struct Alternatives {
    /// The factor.
    pub factor: String,
    /// Names of the alternatives.
    pub names: Vec<String>,
    /// Quantity over which the means are taken, as the end of a sentence.
    pub over: String,
    /// Paired quantity: seeds or combinations.
    pub paired: &'static str,
    /// The comparison, seed by seed, or combination by combination of the other factors where there
    /// is one seed.
    pub comparisons: Comparisons,
}

/// Returns the alternatives of factors without numbers, in designs in which each occurs with the
/// same other values.
pub(super) fn comparisons(data: &Data<'_>) -> Vec<Alternatives> {
    match data.design {
        DesignSpec::Grid | DesignSpec::OneAtATime | DesignSpec::Table { .. } => {
            let factors = 0..data.plan.factors.len();
            factors.filter_map(|f| comparison(data, f)).collect()
        }
        _ => Vec::new(),
    }
}

fn comparison(data: &Data<'_>, factor: usize) -> Option<Alternatives> {
    let plan = data.plan;
    let names = data.labels(factor);
    if plan.is_numeric(factor) || names.len() < 2 {
        return None;
    }
    let place: HashMap<&str, usize> = names.iter().copied().zip(0..).collect();
    // A block is a combination of all other factors; for each alternative the first setting with it
    // is used.
    let mut blocks: Vec<Vec<Option<usize>>> = Vec::new();
    let mut known: HashMap<Vec<&str>, usize> = HashMap::new();
    for (k, setting) in plan.settings.iter().enumerate() {
        let others = setting.iter().enumerate().filter(|(f, _)| *f != factor);
        let others = others.map(|(_, v)| v.label.as_str()).collect();
        let block = *known.entry(others).or_insert_with(|| {
            blocks.push(vec![None; names.len()]);
            blocks.len() - 1
        });
        let Some(&name) = place.get(setting[factor].label.as_str()) else {
            continue;
        };
        blocks[block][name].get_or_insert(k);
    }
    let whole: Vec<Vec<usize>> = blocks
        .into_iter()
        .filter_map(|block| block.into_iter().collect())
        .collect();
    let seeds = data.seeds();
    // Runs with one seed have the same sample: they are not independent, and count as one.
    let by_seed = seeds > 1;
    let row = |name: usize| -> Vec<Option<f64>> {
        let runs: Vec<&[Option<f64>]> = whole
            .iter()
            .map(|block| data.of_setting(block[name]))
            .collect();
        match by_seed {
            true => (0..seeds)
                .map(|seed| {
                    let values: Option<Vec<f64>> = runs.iter().map(|r| r[seed]).collect();
                    values
                        .filter(|v| !v.is_empty())
                        .map(|v| v.iter().sum::<f64>() / v.len() as f64)
                })
                .collect(),
            false => runs.iter().map(|r| r[0]).collect(),
        }
    };
    let over = match (by_seed, whole.len()) {
        (true, 1) => format!("means over {seeds} seeds with intervals of 95 %"),
        (true, n) => format!(
            "means over {seeds} seeds, each the mean over {n} combinations of the other factors, with intervals of 95 %"
        ),
        (false, n) => format!("means over {n} combinations of the other factors, one run each"),
    };
    let rows: Vec<Vec<Option<f64>>> = (0..names.len()).map(row).collect();
    Some(Alternatives {
        factor: plan.factors[factor].name.clone(),
        names: names.iter().map(|n| (*n).to_owned()).collect(),
        over,
        paired: if by_seed { "seeds" } else { "combinations" },
        comparisons: Comparisons::of(&rows),
    })
}
