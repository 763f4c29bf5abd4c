//! What a page says of the factors: alternatives compared, effects, indices, trends.

use super::mean_text;
use crate::study::analysis::{Comparison, Effects, OutputAnalysis};
use crate::study::plan::Plan;
use fretwork_observe::quantity::{number, quantity};
use fretwork_study::interval::Interval;
use fretwork_view::{Block, SheetTable};

/// In place of a mean.
const NONE_DONE: &str = "no run is done";

pub(super) fn effect_blocks(plan: &Plan, output: &OutputAnalysis) -> Vec<Block> {
    let name = |f: usize| plan.factors[f].name.clone();
    let share = |x: f64| format!("{:.1} %", 100.0 * x);
    match &output.effects {
        Effects::Nothing(why) => vec![Block::Text(format!(
            "Effects of the factors are not known: {why}."
        ))],
        Effects::Levels { effects, anova } => {
            let mut rows = Vec::new();
            for (f, effect) in effects
                .iter()
                .enumerate()
                .filter(|(_, e)| e.levels.len() > 1)
            {
                let found = anova
                    .as_ref()
                    .ok()
                    .and_then(|a| a.effects.iter().find(|e| e.factors == [f]));
                rows.push(vec![
                    name(f),
                    quantity(effect.range, &output.unit),
                    found.map_or(String::new(), |e| share(e.eta_squared)),
                    found.and_then(|e| e.p).map_or(String::new(), probability),
                ]);
            }
            let Ok(anova) = anova else {
                let why = anova.as_ref().err().cloned().unwrap_or_default();
                let note = format!("Shares of the variance are not known: {why}.");
                let heads = ["factor", "largest less smallest mean", "", ""]
                    .map(str::to_owned)
                    .to_vec();
                return vec![Block::Table(SheetTable { note, heads, rows })];
            };
            for effect in anova.effects.iter().filter(|e| e.factors.len() == 2) {
                rows.push(vec![
                    format!(
                        "{} with {}",
                        name(effect.factors[0]),
                        name(effect.factors[1])
                    ),
                    String::new(),
                    share(effect.eta_squared),
                    effect.p.map_or(String::new(), probability),
                ]);
            }
            rows.push(vec![
                "other interactions".to_owned(),
                String::new(),
                share(anova.higher),
                String::new(),
            ]);
            rows.push(vec![
                "scatter of seeds".to_owned(),
                String::new(),
                share(anova.noise_share),
                String::new(),
            ]);
            let note = "Effects: how much the mean changes over the levels of a factor, which share of the variance of all runs it explains, and how probable such a share is by chance alone (analysis of variance).";
            let heads = [
                "factor",
                "largest less smallest mean",
                "share of the variance",
                "by chance",
            ];
            vec![Block::Table(SheetTable {
                note: note.to_owned(),
                heads: heads.map(str::to_owned).to_vec(),
                rows,
            })]
        }
        Effects::FromCase(changes) => {
            let rows = changes.iter().map(|s| {
                vec![
                    name(s.factor),
                    s.label.clone(),
                    s.change
                        .as_ref()
                        .map_or(NONE_DONE.to_owned(), |m| mean_text(m, &output.unit)),
                    s.change
                        .as_ref()
                        .map_or("", |m| {
                            if m.may_be_zero() {
                                "not known to differ"
                            } else {
                                "differs"
                            }
                        })
                        .to_owned(),
                ]
            });
            let note = "Changes from the case as it is, one factor at a time, with intervals of 95 % over the seeds.".to_owned();
            let heads = ["factor", "level", "change", ""]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable {
                note,
                heads,
                rows: rows.collect(),
            })]
        }
        Effects::Indices(indices) => {
            let index = |i: &fretwork_study::sensitivity::sobol_indices::Index| {
                format!(
                    "{:.3}{}",
                    i.value,
                    i.interval.as_ref().map_or(String::new(), range)
                )
            };
            let rows = (0..indices.first.len())
                .map(|f| vec![name(f), index(&indices.first[f]), index(&indices.total[f])]);
            let note = format!(
                "Sobol indices from {} base points ({} left out, since a run of theirs failed): the share of the variance that a factor explains alone, and with all its interactions, with intervals of 95 %. The mean is {}, the standard deviation {}.",
                indices.used,
                indices.left_out,
                quantity(indices.mean, &output.unit),
                quantity(indices.variance.sqrt(), &output.unit)
            );
            let heads = ["factor", "first-order index", "total index"]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable {
                note,
                heads,
                rows: rows.collect(),
            })]
        }
        Effects::Trend { regression, ranks } => {
            let mut rows = Vec::new();
            for (f, rank) in ranks.iter().enumerate() {
                let of = regression.as_ref().ok().and_then(|r| r.coefficients.get(f));
                rows.push(vec![
                    name(f),
                    of.map_or(String::new(), |c| {
                        format!(
                            "{:.3}{}",
                            c.standardised,
                            c.interval.as_ref().map_or(String::new(), range)
                        )
                    }),
                    format!(
                        "{:.3}{}",
                        rank.value,
                        rank.interval.as_ref().map_or(String::new(), range)
                    ),
                    rank.p.map_or(String::new(), probability),
                ]);
            }
            let fit = match regression {
                Ok(r) => format!(
                    "The linear trend explains {} of the variance.",
                    share(r.r_squared)
                ),
                Err(why) => format!("There is no linear trend: {why}."),
            };
            let note = format!(
                "Standardised coefficients of a linear trend, rank correlations with intervals of 95 %, and how probable such a correlation is by chance alone. {fit}"
            );
            let heads = ["factor", "coefficient", "rank correlation", "by chance"]
                .map(str::to_owned)
                .to_vec();
            vec![Block::Table(SheetTable { note, heads, rows })]
        }
    }
}

pub(super) fn comparison_table(comparison: &Comparison, unit: &str) -> SheetTable {
    let rows = comparison
        .names
        .iter()
        .zip(&comparison.tournament.means)
        .map(|(name, mean)| {
            vec![
                name.clone(),
                mean.as_ref()
                    .map_or(NONE_DONE.to_owned(), |m| mean_text(m, unit)),
            ]
        });
    SheetTable {
        note: format!(
            "Alternatives of {}: {}.",
            comparison.factor, comparison.over
        ),
        heads: vec![comparison.factor.clone(), "mean".to_owned()],
        rows: rows.collect(),
    }
}

pub(super) fn pair_table(comparison: &Comparison, unit: &str) -> SheetTable {
    let rows = comparison.tournament.pairs.iter().map(|pair| {
        let names = format!(
            "{} less {}",
            comparison.names[pair.second], comparison.names[pair.first]
        );
        let verdict = match (pair.p, pair.differs) {
            (None, _) => "one run each: not known".to_owned(),
            (_, true) => "they differ".to_owned(),
            (_, false) => match pair.seeds_needed {
                Some(n) => {
                    format!(
                        "not known to differ; {n} {} would tell a difference of this size",
                        comparison.pairs
                    )
                }
                None => "not known to differ".to_owned(),
            },
        };
        vec![
            names,
            pair.difference
                .as_ref()
                .map_or(String::new(), |m| mean_text(m, unit)),
            pair.p.map_or(String::new(), probability),
            verdict,
        ]
    });
    SheetTable {
        note: "Differences, paired; probabilities by chance are adjusted for the number of pairs (Holm).".to_owned(),
        heads: ["pair", "difference", "by chance", ""].map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

fn range(interval: &Interval) -> String {
    format!(" ({:.3} to {:.3})", interval.low, interval.high)
}

fn probability(p: f64) -> String {
    match p {
        p if p < 1e-4 => "below 0.0001".to_owned(),
        p => number(p, 2),
    }
}
