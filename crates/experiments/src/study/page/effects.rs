//! Effects of the factors on a page: comparisons of alternatives, effects, indices, trends.

use super::mean_text;
use crate::page::table;
use crate::study::analysis::{Alternatives, Change, Effects, OutputAnalysis};
use crate::study::plan::Plan;
use fretwork_math::sensitivity::anova::{Anova, Effect};
use fretwork_math::sensitivity::main_effects::MainEffect;
use fretwork_math::sensitivity::ranks::RankCorrelation;
use fretwork_math::sensitivity::regression::Regression;
use fretwork_math::sensitivity::sobol_indices::SobolIndices;
use fretwork_math::statistics::comparisons::Pair;
use fretwork_math::statistics::interval::{Interval, Mean};
use fretwork_observe::quantity::{number, quantity};
use fretwork_view::Block;

pub(super) fn effect_block(plan: &Plan, output: &OutputAnalysis) -> Block {
    let name = |f: usize| plan.factors[f].name.clone();
    let unit = &output.unit;
    match &output.effects {
        Effects::Nothing(why) => {
            Block::Text(format!("Effects of the factors are not known: {why}."))
        }
        Effects::Levels { effects, anova } => levels(&name, unit, effects, anova.as_ref()),
        Effects::FromCase(changes) => from_case(&name, unit, changes),
        Effects::Indices(indices) => sobol(&name, unit, indices),
        Effects::Trend { regression, ranks } => trend(&name, regression.as_ref(), ranks),
    }
}

fn levels(
    name: &dyn Fn(usize) -> String,
    unit: &str,
    effects: &[MainEffect],
    anova: Result<&Anova, &String>,
) -> Block {
    let change = "largest less smallest mean";
    let varied = effects
        .iter()
        .enumerate()
        .filter(|(_, e)| e.means.len() > 1);
    let row = |first: String, range: String, found: Option<&Effect>| {
        let shared = found.map_or(String::new(), |e| share(e.eta_squared));
        let p = found.and_then(|e| e.p).map_or(String::new(), probability);
        vec![first, range, shared, p]
    };
    let mut rows: Vec<Vec<String>> = Vec::new();
    for (f, effect) in varied {
        let mut found = anova.iter().flat_map(|a| &a.effects);
        let found = found.find(|e| e.factors == [f]);
        rows.push(row(name(f), quantity(effect.range, unit), found));
    }
    let anova = match anova {
        Ok(anova) => anova,
        Err(why) => {
            let note = format!("Shares of the variance are not known: {why}.");
            return table(note, ["factor", change, "", ""], rows);
        }
    };
    for effect in anova.effects.iter().filter(|e| e.factors.len() == 2) {
        let both = format!(
            "{} with {}",
            name(effect.factors[0]),
            name(effect.factors[1])
        );
        rows.push(row(both, String::new(), Some(effect)));
    }
    for (what, part) in [
        ("other interactions", anova.higher),
        ("scatter of seeds", anova.noise_share),
    ] {
        rows.push(vec![
            what.to_owned(),
            String::new(),
            share(part),
            String::new(),
        ]);
    }
    let note = "Effects: how much the mean changes over the levels of a factor, which share of the variance of all runs it explains, and how probable such a share is by chance alone (analysis of variance).";
    table(
        note,
        ["factor", change, "share of the variance", "by chance"],
        rows,
    )
}

fn from_case(name: &dyn Fn(usize) -> String, unit: &str, changes: &[Change]) -> Block {
    let row = |s: &Change| {
        let differs = match &s.change {
            None => "",
            Some(m) if m.may_be_zero() => "not known to differ",
            Some(_) => "differs",
        };
        let change = mean_or_none(s.change.as_ref(), unit);
        vec![name(s.factor), s.label.clone(), change, differs.to_owned()]
    };
    let note = "Changes from the case as it is, one factor at a time, with intervals of 95 % over the seeds.";
    let rows = changes.iter().map(row).collect();
    table(note, ["factor", "level", "change", ""], rows)
}

fn sobol(name: &dyn Fn(usize) -> String, unit: &str, indices: &SobolIndices) -> Block {
    let both = indices.first.iter().zip(&indices.total).enumerate();
    let rows = both.map(|(f, (first, total))| {
        let [first, total] = [first, total].map(|i| with_range(i.value, i.interval));
        vec![name(f), first, total]
    });
    let note = format!(
        "Sobol indices from {} base points ({} left out, since a run of theirs failed): the share of the variance that a factor explains alone, and with all its interactions, with intervals of 95 %. The mean is {}, the standard deviation {}.",
        indices.used,
        indices.left_out,
        quantity(indices.mean, unit),
        quantity(indices.variance.sqrt(), unit)
    );
    let heads = ["factor", "first-order index", "total index"];
    table(note, heads, rows.collect())
}

fn trend(
    name: &dyn Fn(usize) -> String,
    regression: Result<&Regression, &String>,
    ranks: &[RankCorrelation],
) -> Block {
    let row = |(f, rank): (usize, &RankCorrelation)| {
        let of = regression.ok().and_then(|r| r.coefficients.get(f));
        vec![
            name(f),
            of.map_or(String::new(), |c| with_range(c.standardised, c.interval)),
            with_range(rank.value, rank.interval),
            rank.p.map_or(String::new(), probability),
        ]
    };
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
    let heads = ["factor", "coefficient", "rank correlation", "by chance"];
    table(note, heads, ranks.iter().enumerate().map(row).collect())
}

pub(super) fn alternatives_table(of: &Alternatives, unit: &str) -> Block {
    let means = of.names.iter().zip(&of.comparisons.means);
    let rows = means.map(|(name, mean)| vec![name.clone(), mean_or_none(mean.as_ref(), unit)]);
    let note = format!("Alternatives of {}: {}.", of.factor, of.over);
    table(note, [of.factor.as_str(), "mean"], rows.collect())
}

pub(super) fn pairs_table(of: &Alternatives, unit: &str) -> Block {
    let row = |pair: &Pair| {
        let verdict = match (pair.p, pair.differs, pair.seeds_needed) {
            (None, ..) => "one run each: not known".to_owned(),
            (_, true, _) => "they differ".to_owned(),
            (_, false, Some(n)) => format!(
                "not known to differ; {n} {} would show a difference of this size",
                of.paired
            ),
            (_, false, None) => "not known to differ".to_owned(),
        };
        vec![
            format!("{} less {}", of.names[pair.second], of.names[pair.first]),
            pair.difference
                .as_ref()
                .map_or(String::new(), |m| mean_text(m, unit)),
            pair.p.map_or(String::new(), probability),
            verdict,
        ]
    };
    let note =
        "Differences, paired; probabilities by chance are adjusted for the number of pairs (Holm).";
    let rows = of.comparisons.pairs.iter().map(row).collect();
    table(note, ["pair", "difference", "by chance", ""], rows)
}

fn mean_or_none(mean: Option<&Mean>, unit: &str) -> String {
    mean.map_or("no run is done".to_owned(), |m| mean_text(m, unit))
}

fn share(x: f64) -> String {
    format!("{:.1} %", 100.0 * x)
}

fn with_range(value: f64, interval: Option<Interval>) -> String {
    let range = interval.map(|i| format!(" ({:.3} to {:.3})", i.low, i.high));
    format!("{value:.3}{}", range.unwrap_or_default())
}

fn probability(p: f64) -> String {
    match p {
        p if p < 1e-4 => "below 0.0001".to_owned(),
        p => number(p, 2),
    }
}
