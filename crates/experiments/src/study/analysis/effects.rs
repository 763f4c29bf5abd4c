//! Importance of each factor for an output.

use super::{Data, logarithmic};
use crate::study::spec::DesignSpec;
use fretwork_math::sensitivity::anova::{Anova, anova};
use fretwork_math::sensitivity::main_effects::{MainEffect, main_effects};
use fretwork_math::sensitivity::ranks::{RankCorrelation, rank_correlations};
use fretwork_math::sensitivity::regression::{Regression, regression};
use fretwork_math::sensitivity::sobol_indices::{SobolIndices, sobol_indices};

/// Effects of the factors, in the form that the design permits.
#[derive(Clone, Debug)]
pub enum Effects {
    /// None, and the reason.
    Nothing(String),
    /// Means by level and shares of the variance, for a grid.
    Levels {
        /// Effects by factor.
        effects: Vec<MainEffect>,
        /// The analysis of variance, or the reason why there is none.
        anova: Result<Anova, String>,
    },
    /// Changes from the case itself, for one factor at a time.
    FromCase(Vec<Change>),
    /// Sobol indices, for a design made for them.
    Indices(SobolIndices),
    /// Trends, for points distributed over all factors.
    Trend {
        /// Linear model in the factors, or in their logarithms for logarithmic factors.
        regression: Result<Regression, String>,
        /// Rank correlations.
        ranks: Vec<RankCorrelation>,
    },
}

/// Change by a level of a factor from the case itself.
#[derive(Clone, Debug)]
pub struct Change {
    /// Number of the factor.
    pub factor: usize,
    /// The level.
    pub label: String,
    /// Mean over the seeds of the difference, seed by seed.
    pub change: Option<fretwork_math::statistics::interval::Mean>,
}

/// Seed of the resamples for intervals of Sobol indices.
const BOOTSTRAP: u64 = 1;

pub(super) fn effects(data: &Data<'_>) -> Effects {
    let said = |e: &dyn std::fmt::Display| e.to_string();
    match data.design {
        DesignSpec::Grid => {
            let (counts, settings) = data.levels();
            let seeds = data.seeds();
            let rows: Vec<Vec<usize>> = settings
                .iter()
                .flat_map(|r| std::iter::repeat_n(r.clone(), seeds))
                .collect();
            match main_effects(&rows, &data.values) {
                Ok(effects) => Effects::Levels {
                    effects,
                    anova: anova(&counts, &rows, &data.values).map_err(|e| said(&e)),
                },
                Err(e) => Effects::Nothing(said(&e)),
            }
        }
        DesignSpec::OneAtATime => Effects::FromCase(changes(data)),
        DesignSpec::Sensitivity { .. } => {
            // Rows are ordered by setting, as are these means.
            let means = data.means().into_iter().map(|m| m.map(|m| m.mean));
            let outputs: Vec<Option<f64>> = means.collect();
            match sobol_indices(&outputs, data.plan.factors.len(), BOOTSTRAP) {
                Ok(indices) => Effects::Indices(indices),
                Err(e) => Effects::Nothing(said(&e)),
            }
        }
        DesignSpec::LatinHypercube { .. } | DesignSpec::Sobol { .. } | DesignSpec::Table { .. } => {
            trend(data)
        }
    }
}

fn trend(data: &Data<'_>) -> Effects {
    let plan = data.plan;
    let varied: Vec<usize> = (0..plan.factors.len())
        .filter(|&f| data.labels(f).len() > 1)
        .collect();
    if let Some(&f) = varied.iter().find(|&&f| !plan.is_numeric(f)) {
        return Effects::Nothing(format!(
            "`{}` has no numbers, and a trend is over numbers; compare its alternatives on a grid",
            plan.factors[f].name
        ));
    }
    let place = |f: usize, x: f64| {
        if logarithmic(&plan.factors[f]) {
            x.ln()
        } else {
            x
        }
    };
    let mut rows = Vec::new();
    for setting in &plan.settings {
        let row: Vec<f64> = (0..plan.factors.len())
            .map(|f| place(f, setting[f].number.unwrap_or(0.0)))
            .collect();
        rows.extend(std::iter::repeat_n(row, data.seeds()));
    }
    Effects::Trend {
        regression: regression(&rows, &data.values).map_err(|e| e.to_string()),
        ranks: rank_correlations(&rows, &data.values).unwrap_or_default(),
    }
}

fn changes(data: &Data<'_>) -> Vec<Change> {
    let plan = data.plan;
    let base = data.of_setting(0);
    let mut out = Vec::new();
    for (k, setting) in plan.settings.iter().enumerate().skip(1) {
        let changed =
            (0..plan.factors.len()).find(|&f| setting[f].label != plan.settings[0][f].label);
        let Some(factor) = changed else { continue };
        let differences: Vec<f64> = data
            .of_setting(k)
            .iter()
            .zip(base)
            .filter_map(|(a, b)| Some((*a)? - (*b)?))
            .collect();
        out.push(Change {
            factor,
            label: setting[factor].label.clone(),
            change: fretwork_math::statistics::interval::Mean::of(&differences),
        });
    }
    out
}
