//! Comparison with the reference: errors seed by seed with confidence intervals, distinguished from
//! the scatter among seeds.

use super::combination::Combination;
use super::frontier::frontier;
use super::output::ErrorTarget;
use super::plan::Trade;
use super::varied::{ParameterEffect, Varied};
use crate::runs::stored::{FinishedRun, Status, summary};
use fretwork_math::statistics::interval::Mean;
use std::collections::{BTreeMap, BTreeSet};

/// An output of a setting. Errors are fractions of the reference's value if the wanted error is
/// relative, otherwise in the output's unit.
#[derive(Clone, Debug)]
pub struct OutputError {
    /// The output over the seeds, in its unit.
    pub value: Mean,
    /// Difference from the reference, seed by seed.
    pub error: Mean,
    /// Upper bound of the error from its interval.
    pub at_most: f64,
    /// Upper bound of the error including the reference's own.
    pub bound: f64,
    /// Whether no other setting is cheaper with a smaller bound on the error.
    pub on_frontier: bool,
}

/// Error of the reference itself.
#[derive(Clone, Debug)]
pub struct OwnError {
    /// The output of the reference over the seeds, in its unit.
    pub value: Mean,
    /// Upper bound; infinite if unknown.
    pub at_most: f64,
    /// Basis of the estimate, as a sentence.
    pub why: String,
}

/// A setting and its results.
#[derive(Clone, Debug)]
pub struct Row {
    /// The setting.
    pub setting: Combination,
    /// Name of the setting.
    pub name: String,
    /// Number of seeds that ran.
    pub seeds: usize,
    /// Reason why it cannot be used, if any.
    pub failed: Option<String>,
    /// Number of runs that report that they are not trustworthy.
    pub doubted: usize,
    /// Keywords of their reasons, in order.
    pub doubts: BTreeSet<String>,
    /// Processor time of the steps per run (s).
    pub seconds: f64,
    /// Contacts times iterations per run.
    pub visits: f64,
    /// Speed relative to the reference, seed by seed, with its confidence interval if there are
    /// enough seeds.
    pub faster: Option<(f64, Option<(f64, f64)>)>,
    /// One entry per output; `None` if it has no value.
    pub errors: Vec<Option<OutputError>>,
}

/// Comparison of all settings that ran.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Settings from the cheapest to the most expensive.
    pub rows: Vec<Row>,
    /// One entry per output; `None` if the reference has no value.
    pub own: Vec<Option<OwnError>>,
    /// Index of the reference, if it ran.
    pub reference: Option<usize>,
}

impl Row {
    /// Describes how many of its runs report that they are not trustworthy, and why; `None` where
    /// all are trustworthy.
    pub fn not_trustworthy(&self) -> Option<String> {
        let words: Vec<&str> = self.doubts.iter().map(String::as_str).collect();
        let (doubted, seeds) = (self.doubted, self.seeds);
        let text = format!(
            "{doubted} of {seeds} runs not trustworthy: {}",
            words.join(", ")
        );
        (doubted > 0).then_some(text)
    }
}

impl Trade {
    /// Compares every setting with the reference.
    pub fn compare(&self) -> Comparison {
        let reference = Combination::reference(&self.parameters);
        let mut settings: Vec<&Combination> = self.done.keys().map(|(s, _)| s).collect();
        settings.dedup();
        let values: BTreeMap<(&Combination, usize), BTreeMap<u64, f64>> = settings
            .iter()
            .flat_map(|s| (0..self.outputs.len()).map(move |o| (*s, o)))
            .map(|(s, o)| ((s, o), self.values(s, o)))
            .collect();
        let of = |s: &Combination, o: usize| values.get(&(s, o)).cloned().unwrap_or_default();
        let own: Vec<Option<OwnError>> = (0..self.outputs.len())
            .map(|o| self.own_error(o, &reference, &of))
            .collect();
        let mut rows: Vec<Row> = settings
            .iter()
            .map(|s| self.row(s, &reference, &of, &own))
            .collect();
        rows.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        for o in 0..self.outputs.len() {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .map(|r| {
                    let bound = match &r.errors[o] {
                        // If nothing bounds its own error, the reference is exact by definition.
                        Some(e) if r.setting == reference && e.bound.is_infinite() => 0.0,
                        Some(e) => e.bound,
                        None => f64::INFINITY,
                    };
                    (
                        r.seconds,
                        if r.failed.is_some() {
                            f64::INFINITY
                        } else {
                            bound
                        },
                    )
                })
                .collect();
            for (row, on) in rows.iter_mut().zip(frontier(&points)) {
                if let Some(e) = &mut row.errors[o] {
                    e.on_frontier = on;
                }
            }
        }
        Comparison {
            reference: rows.iter().position(|r| r.setting == reference),
            rows,
            own,
        }
    }

    fn runs(&self, setting: &Combination) -> impl Iterator<Item = (u64, &FinishedRun)> {
        let from = (setting.clone(), 0);
        let to = (setting.clone(), u64::MAX);
        self.done.range(from..=to).map(|((_, seed), r)| (*seed, r))
    }

    /// Returns the values of an output by seed.
    fn values(&self, setting: &Combination, output: usize) -> BTreeMap<u64, f64> {
        let good = self.runs(setting).filter(|(_, r)| r.status == Status::Done);
        good.filter_map(|(seed, r)| {
            let place = self.launcher.place(&r.run);
            let value = self.outputs[output]
                .quantity
                .read(&summary(&place), &place)?;
            Some((seed, value))
        })
        .collect()
    }

    fn mean(&self, values: &[f64]) -> Option<Mean> {
        match values {
            [one] if !self.random => Some(Mean::certain(*one)),
            _ => Mean::of(values),
        }
    }

    /// Returns the differences seed by seed, as errors.
    fn error(
        &self,
        o: usize,
        of: &BTreeMap<u64, f64>,
        against: &BTreeMap<u64, f64>,
    ) -> Option<Mean> {
        let output = &self.outputs[o];
        let base: Vec<f64> = against.values().copied().collect();
        let scale = match output.wanted {
            ErrorTarget::Absolute(_) => 1.0,
            ErrorTarget::Relative(_) => {
                let size = match output.exact {
                    Some(x) => x,
                    None => self.mean(&base)?.mean,
                };
                size.abs()
            }
        };
        let difference = |(seed, v): (&u64, &f64)| match output.exact {
            Some(x) => Some(v - x),
            None => Some(v - against.get(seed)?),
        };
        let all: Vec<f64> = of.iter().filter_map(difference).collect();
        let mean = self.mean(&all)?;
        // An output that is zero in both is exact; a fraction of zero is undefined.
        match scale > 0.0 {
            true => Some(mean.scaled(1.0 / scale)),
            false => (mean.mean == 0.0 && mean.scatter.is_none_or(|s| s == 0.0)).then_some(mean),
        }
    }

    fn own_error(
        &self,
        o: usize,
        reference: &Combination,
        of: &dyn Fn(&Combination, usize) -> BTreeMap<u64, f64>,
    ) -> Option<OwnError> {
        let base = of(reference, o);
        let all: Vec<f64> = base.values().copied().collect();
        let value = self.mean(&all)?;
        if self.outputs[o].exact.is_some() {
            return Some(OwnError {
                value,
                at_most: 0.0,
                why: "its true value is given".into(),
            });
        }
        let (mut sum, mut parts, mut known) = (0.0, Vec::new(), true);
        for (k, parameter) in self.parameters.iter().enumerate() {
            let Some(next) = neighbour(parameter) else {
                continue;
            };
            let found = self.error(o, &of(&reference.with(k, next), o), &base);
            let label = &parameter.levels[next].label;
            let weight = ratio(parameter, next).and_then(weight);
            match (found, weight) {
                (Some(error), Some(weight)) => {
                    sum += weight * error.at_most();
                    parts.push(format!(
                        "{} {label} differs by {}",
                        parameter.name,
                        ShownError(&error, self.outputs[o].wanted)
                    ));
                }
                (_, None) => {
                    known = false;
                    parts.push(format!(
                        "{} {label} is too close to the reference's to compare; give a level {NEAREST} times as coarse or more",
                        parameter.name
                    ));
                }
                (None, _) => {
                    known = false;
                    parts.push(format!("{} {label} did not run", parameter.name));
                }
            }
        }
        if parts.is_empty() {
            parts.push("neither step nor tolerance is varied, so there is no estimate".into());
            known = false;
        }
        Some(OwnError {
            value,
            at_most: if known { sum } else { f64::INFINITY },
            why: parts.join(", "),
        })
    }

    fn row(
        &self,
        setting: &Combination,
        reference: &Combination,
        of: &dyn Fn(&Combination, usize) -> BTreeMap<u64, f64>,
        own: &[Option<OwnError>],
    ) -> Row {
        let runs: Vec<(u64, &FinishedRun)> = self.runs(setting).collect();
        let n = runs.len().max(1) as f64;
        let failed = runs.iter().find_map(|(seed, r)| match &r.status {
            Status::Slow(s) => Some(format!("slower than the reference, stopped after {s:.0} s")),
            status if self.random => status.failure().map(|why| format!("seed {seed}: {why}")),
            status => status.failure(),
        });
        let base: BTreeMap<u64, f64> = self.runs(reference).map(|(s, r)| (s, r.seconds)).collect();
        let ratios: Vec<f64> = runs
            .iter()
            .filter_map(|(seed, r)| Some((base.get(seed)? / r.seconds).ln()))
            .collect();
        let faster = Mean::of(&ratios).map(|m| {
            let ends = m
                .half_width
                .map(|h| ((m.mean - h).exp(), (m.mean + h).exp()));
            (m.mean.exp(), ends.filter(|_| setting != reference))
        });
        let errors = (0..self.outputs.len()).map(|o| {
            let here = of(setting, o);
            let all: Vec<f64> = here.values().copied().collect();
            let error = self.error(o, &here, &of(reference, o))?;
            let rest = own[o].as_ref().map_or(f64::INFINITY, |x| x.at_most);
            let at_most = error.at_most();
            let bound = if setting == reference && self.outputs[o].exact.is_none() {
                rest
            } else if rest.is_finite() {
                at_most + rest
            } else {
                at_most
            };
            Some(OutputError {
                value: self.mean(&all)?,
                error,
                at_most,
                bound,
                on_frontier: false,
            })
        });
        Row {
            name: setting.name(&self.parameters),
            seeds: runs.len(),
            failed,
            doubted: runs.iter().filter(|r| !r.1.doubts.is_empty()).count(),
            doubts: runs.iter().flat_map(|r| r.1.doubts.clone()).collect(),
            seconds: runs.iter().map(|r| r.1.seconds).sum::<f64>() / n,
            visits: runs.iter().map(|r| r.1.visits).sum::<f64>() / n,
            faster,
            errors: errors.collect(),
            setting: setting.clone(),
        }
    }
}

/// Smallest ratio to the reference for estimating its own error: below it a small difference would
/// be multiplied by a large factor.
const NEAREST: f64 = 1.5;

/// Returns the level next to the reference's, for an ordered parameter: the first that is coarse
/// enough for the estimate, otherwise the next one.
pub fn neighbour(parameter: &Varied) -> Option<usize> {
    let ordered = matches!(
        parameter.effect,
        ParameterEffect::Step | ParameterEffect::Tolerance
    );
    let mut coarser = parameter.reference + 1..parameter.levels.len();
    let next = coarser.clone().next().filter(|_| ordered)?;
    coarser
        .find(|&l| ratio(parameter, l).and_then(weight).is_some())
        .or(Some(next))
}

/// Returns the ratio of a level to the reference's level.
fn ratio(parameter: &Varied, level: usize) -> Option<f64> {
    Some(parameter.levels.get(level)?.number? / parameter.levels.get(parameter.reference)?.number?)
}

/// Returns the factor on the difference from a level `ratio` times as coarse that bounds the
/// reference's own error. For first order e(rh) - e(h) = (r - 1) e(h), hence 1/(r - 1), and at
/// least 1 up to r = 2. `None` if the levels are too close.
fn weight(ratio: f64) -> Option<f64> {
    match ratio {
        r if r >= 2.0 => Some(1.0),
        r if r >= NEAREST * (1.0 - 1e-9) => Some(1.0 / (r - 1.0)),
        _ => None,
    }
}

/// A formatted error: `-0.8 +- 0.3 %`.
pub struct ShownError<'a>(pub &'a Mean, pub ErrorTarget);

impl std::fmt::Display for ShownError<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mean = self.0;
        let half = match (mean.half_width, self.1) {
            (Some(0.0), _) => String::new(),
            (Some(h), ErrorTarget::Relative(_)) => format!(" +- {}", share(h)),
            (Some(h), ErrorTarget::Absolute(_)) => format!(" +- {h:.1e}"),
            (None, _) => " +- ?".into(),
        };
        match self.1 {
            ErrorTarget::Relative(_) => write!(f, "{}{half} %", share(mean.mean)),
            ErrorTarget::Absolute(_) => write!(f, "{:.2e}{half}", mean.mean),
        }
    }
}

/// A fraction in per cent with significant digits.
pub fn share(x: f64) -> String {
    let percent = 100.0 * x;
    match percent.abs() {
        0.0 => "0".into(),
        p if p >= 10.0 => format!("{percent:.0}"),
        p if p >= 1.0 => format!("{percent:.1}"),
        p if p >= 0.01 => format!("{percent:.2}"),
        _ => format!("{percent:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factor::Level;

    /// For a first-order error e = c h, the reported bound is never below the error.
    #[test]
    fn the_own_error_follows_the_ratio_of_the_steps() {
        let c = 0.3;
        for r in [1.5, 1.7, 2.0, 3.0] {
            let difference = c * r - c;
            let bound = weight(r).unwrap() * difference;
            assert!(bound >= c * (1.0 - 1e-12), "{r}: {bound}");
            assert!(r > 2.0 || (bound - c).abs() < 1e-12, "{r}: {bound}");
        }
        assert_eq!(weight(1.1), None);
        assert_eq!(weight(f64::NAN), None);
    }

    #[test]
    fn levels_too_near_are_passed_over() {
        let level = |x: f64| Level::of(&[], &x.to_string());
        let levels = [1.0, 1.1, 2.0].map(level).into();
        let mut parameter = Varied::new("step", ParameterEffect::Step, levels, Some(0));
        assert_eq!(neighbour(&parameter), Some(2));
        parameter.levels.pop();
        assert_eq!(neighbour(&parameter), Some(1));
        assert_eq!(ratio(&parameter, 1).and_then(weight), None);
        parameter.effect = ParameterEffect::Choice;
        assert_eq!(neighbour(&parameter), None);
    }
}
