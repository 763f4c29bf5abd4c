//! An output as a function of each factor with numbers.

use super::Data;
use crate::study::plan::Plan;
use crate::study::spec::DesignSpec;
use fretwork_math::statistics::interval::Mean;
use std::collections::BTreeSet;

/// Largest number of lines of a response; if there are more, the mean over the other factors is
/// shown.
const LINES: usize = 7;

/// An output as a function of one factor.
#[derive(Clone, Debug)]
pub struct Response {
    /// Number of the factor.
    pub factor: usize,
    /// Meaning of the lines and intervals, as a sentence.
    pub note: String,
    /// Lines, or single points.
    pub curves: Vec<Curve>,
    /// Whether points are not connected, since other factors vary between them too.
    pub scattered: bool,
}

/// One line.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Common value along the line; empty if there is only one line.
    pub label: String,
    /// Values of the factor, with the mean output.
    pub points: Vec<(f64, Mean)>,
}

/// The responses to all factors with two numbers or more.
pub(super) fn responses(data: &Data<'_>) -> Vec<Response> {
    (0..data.plan.factors.len())
        .filter(|&f| data.plan.is_numeric(f) && numbers(data.plan, f) > 1)
        .map(|f| response(data, f))
        .collect()
}

/// Returns the number of different values of a factor.
fn numbers(plan: &Plan, factor: usize) -> usize {
    let numbers = plan.settings.iter().filter_map(|s| s[factor].number);
    let different: BTreeSet<u64> = numbers.map(|x| (x + 0.0).to_bits()).collect();
    different.len()
}

fn response(data: &Data<'_>, factor: usize) -> Response {
    let seeds = match data.seeds() {
        1 => "one run each",
        _ => "means over seeds with intervals of 95 %",
    };
    let varied: Vec<usize> = (0..data.plan.factors.len())
        .filter(|&f| f != factor && data.labels(f).len() > 1)
        .collect();
    let of = |note: String, curves, scattered| Response {
        factor,
        note,
        curves,
        scattered,
    };
    match data.design {
        DesignSpec::OneAtATime => {
            let own = |k: usize| {
                let setting = &data.plan.settings[k];
                varied
                    .iter()
                    .all(|&f| setting[f].label == data.plan.settings[0][f].label)
            };
            let curve = curve(data, factor, String::new(), own);
            let unknown = data.plan.settings[0][factor].is_unknown();
            let base = match unknown {
                true => " The case's own value is a default and is not shown.",
                false => "",
            };
            of(
                format!("The other factors as in the case; {seeds}.{base}"),
                vec![curve],
                false,
            )
        }
        DesignSpec::Grid | DesignSpec::Table { .. } if varied.is_empty() => of(
            format!("{}.", capital(seeds)),
            vec![curve(data, factor, String::new(), |_| true)],
            false,
        ),
        DesignSpec::Grid => {
            // One other factor distinguishes the lines, preferably one without numbers; the output
            // is averaged over the rest.
            let few = |f: &&usize| data.labels(**f).len() <= LINES;
            let words = varied
                .iter()
                .filter(few)
                .find(|&&f| !data.plan.is_numeric(f));
            let other = words.or_else(|| varied.iter().find(few)).copied();
            let rest: Vec<&str> = varied
                .iter()
                .filter(|&&f| Some(f) != other)
                .map(|&f| data.plan.factors[f].name.as_str())
                .collect();
            let lines = match other {
                None => vec![curve(data, factor, String::new(), |_| true)],
                Some(other) => {
                    let line = |label: &str| {
                        let has = |k: usize| data.plan.settings[k][other].label == label;
                        curve(data, factor, line_label(data.plan, other, label), has)
                    };
                    data.labels(other).into_iter().map(line).collect()
                }
            };
            let note = match rest.as_slice() {
                [] => format!("{}.", capital(seeds)),
                rest => format!("Averaged over {}; {seeds}.", rest.join(", ")),
            };
            of(note, lines, false)
        }
        _ => {
            let means = data.means();
            let points = data.plan.settings.iter().zip(means);
            let points = points.filter_map(|(s, mean)| Some((s[factor].number?, mean?)));
            let curve = Curve {
                label: String::new(),
                points: points.collect(),
            };
            of(
                format!("Each point has other values of the other factors; {seeds}."),
                vec![curve],
                true,
            )
        }
    }
}

/// Returns the mean output by value of a factor, over the settings that are kept: for each seed the
/// mean over those with that value.
fn curve(data: &Data<'_>, factor: usize, label: String, keep: impl Fn(usize) -> bool) -> Curve {
    let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
    for (k, setting) in data.plan.settings.iter().enumerate() {
        let Some(x) = setting[factor].number.filter(|_| keep(k)) else {
            continue;
        };
        match groups.iter_mut().find(|g| g.0 == x) {
            Some(group) => group.1.push(k),
            None => groups.push((x, vec![k])),
        }
    }
    groups.sort_by(|a, b| a.0.total_cmp(&b.0));
    let point = |(x, settings): (f64, Vec<usize>)| {
        let of_seed = |seed: usize| {
            let values = settings.iter().map(|&k| data.of_setting(k)[seed]);
            let values: Option<Vec<f64>> = values.collect();
            values.map(|v| v.iter().sum::<f64>() / v.len() as f64)
        };
        let means: Vec<f64> = (0..data.seeds()).filter_map(of_seed).collect();
        Some((x, Mean::of(&means)?))
    };
    Curve {
        label,
        points: groups.into_iter().filter_map(point).collect(),
    }
}

/// Returns the name of a line by its factor, `pressure 300.0 Pa`.
fn line_label(plan: &Plan, factor: usize, label: &str) -> String {
    let unit = plan.unit_of(factor);
    let words = format!("{} {label} {unit}", plan.factors[factor].name);
    words.trim_end().to_owned()
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or(String::new(), |c| c.to_uppercase().chain(chars).collect())
}
