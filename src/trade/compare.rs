//! Errors against the reference: seed by seed, with their intervals, told apart from the scatter among seeds.

use super::child::{Finished, Launcher, Status, summary};
use super::frontier::frontier;
use super::interval::Mean;
use super::knobs::{Sense, StudyParameter};
use super::output::{Output, Wanted};
use super::setting::Setting;
use super::study::Ledger;
use std::collections::BTreeMap;

/// An output of a setting. Errors are shares of the reference's value where a share is wanted, else in the output's unit.
#[derive(Clone, Debug)]
pub struct OutputError {
    /// The output itself, over seeds, in its unit.
    pub value: Mean,
    /// What it is more than the reference, seed by seed.
    pub error: Mean,
    /// The error with its interval at most.
    pub at_most: f64,
    /// The same and the reference's own error.
    pub bound: f64,
    /// Whether no other setting is both cheaper and better known to be near.
    pub on_frontier: bool,
}

/// How far the reference may itself be off.
#[derive(Clone, Debug)]
pub struct OwnError {
    /// The reference over seeds, in the unit of the output.
    pub value: Mean,
    /// At most; infinite where it is not known.
    pub at_most: f64,
    /// From what: a sentence.
    pub why: String,
}

/// A setting and how it did.
#[derive(Clone, Debug)]
pub struct Row {
    /// It.
    pub setting: Setting,
    /// Its name.
    pub name: String,
    /// Seeds that ran.
    pub seeds: usize,
    /// Why it is not to be used, if so.
    pub failed: Option<String>,
    /// Seconds of stepping, a run.
    pub seconds: f64,
    /// Contact visits, a run.
    pub visits: f64,
    /// How many times faster than the reference: seed by seed, with the lowest and highest of its interval where there are
    /// seeds enough.
    pub faster: Option<(f64, Option<(f64, f64)>)>,
    /// One an output; none where it has no value.
    pub errors: Vec<Option<OutputError>>,
}

/// All settings that ran.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// From the cheapest to the dearest.
    pub rows: Vec<Row>,
    /// One an output; none while the reference has no value.
    pub own: Vec<Option<OwnError>>,
    /// The place of the reference, if it ran.
    pub reference: Option<usize>,
}

/// What is compared.
pub struct Compared<'a> {
    /// Varied.
    pub knobs: &'a [StudyParameter],
    /// Read.
    pub outputs: &'a [Output],
    /// Whether the seed changes the scene.
    pub random: bool,
    /// Seeds wanted.
    pub seeds: &'a [u64],
    /// The runs.
    pub done: &'a Ledger,
    /// Where they stand.
    pub launcher: &'a Launcher,
}

impl Compared<'_> {
    /// Sets every setting against the reference.
    pub fn compare(&self) -> Comparison {
        let reference = Setting::reference(self.knobs);
        let mut settings: Vec<&Setting> = self.done.keys().map(|(s, _)| s).collect();
        settings.dedup();
        let values: BTreeMap<(&Setting, usize), BTreeMap<u64, f64>> = settings
            .iter()
            .flat_map(|s| (0..self.outputs.len()).map(move |o| (*s, o)))
            .map(|(s, o)| ((s, o), self.values(s, o)))
            .collect();
        let of = |s: &Setting, o: usize| values.get(&(s, o)).cloned().unwrap_or_default();
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
                        // Where nothing tells its own error, it is right by definition.
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

    fn runs(&self, setting: &Setting) -> impl Iterator<Item = (u64, &Finished)> {
        let from = (setting.clone(), 0);
        let to = (setting.clone(), u64::MAX);
        self.done.range(from..=to).map(|((_, seed), r)| (*seed, r))
    }

    /// An output by seed.
    fn values(&self, setting: &Setting, output: usize) -> BTreeMap<u64, f64> {
        let good = self.runs(setting).filter(|(_, r)| r.status == Status::Done);
        good.filter_map(|(seed, r)| {
            let place = self.launcher.place(&r.sets, seed);
            let value = self.outputs[output].read(&summary(&place), &place)?;
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

    /// Differences seed by seed, as errors.
    fn error(
        &self,
        o: usize,
        of: &BTreeMap<u64, f64>,
        against: &BTreeMap<u64, f64>,
    ) -> Option<Mean> {
        let output = &self.outputs[o];
        let base: Vec<f64> = against.values().copied().collect();
        let scale = match output.wanted {
            Wanted::Absolute(_) => 1.0,
            Wanted::Relative(_) => {
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
        // What is zero in the reference and here is right; a share of zero is not known.
        match scale > 0.0 {
            true => Some(mean.scaled(1.0 / scale)),
            false => (mean.mean == 0.0 && mean.scatter.is_none_or(|s| s == 0.0)).then_some(mean),
        }
    }

    fn own_error(
        &self,
        o: usize,
        reference: &Setting,
        of: &dyn Fn(&Setting, usize) -> BTreeMap<u64, f64>,
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
        for (k, knob) in self.knobs.iter().enumerate() {
            let Some(next) = neighbour(knob) else {
                continue;
            };
            let found = self.error(o, &of(&reference.with(k, next), o), &base);
            let label = &knob.levels[next].label;
            let weight = ratio(knob, next).and_then(weight);
            match (found, weight) {
                (Some(error), Some(weight)) => {
                    sum += weight * error.at_most();
                    parts.push(format!(
                        "{} {label} differs by {}",
                        knob.name,
                        Told(&error, self.outputs[o].wanted)
                    ));
                }
                (_, None) => {
                    known = false;
                    parts.push(format!(
                        "{} {label} is too near the reference's to tell; give a level {NEAREST} times as coarse or more",
                        knob.name
                    ));
                }
                (None, _) => {
                    known = false;
                    parts.push(format!("{} {label} did not run", knob.name));
                }
            }
        }
        if parts.is_empty() {
            parts.push("neither step nor tolerance is varied, so that nothing tells".into());
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
        setting: &Setting,
        reference: &Setting,
        of: &dyn Fn(&Setting, usize) -> BTreeMap<u64, f64>,
        own: &[Option<OwnError>],
    ) -> Row {
        let runs: Vec<(u64, &Finished)> = self.runs(setting).collect();
        let n = runs.len().max(1) as f64;
        let failed = runs.iter().find_map(|(seed, r)| match &r.status {
            Status::Done => None,
            Status::Failed(why) if self.random => Some(format!("seed {seed}: {why}")),
            Status::Failed(why) => Some(why.clone()),
            Status::Slow(s) => Some(format!("slower than the reference, stopped after {s:.0} s")),
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
            name: setting.name(self.knobs),
            seeds: runs.len(),
            failed,
            seconds: runs.iter().map(|r| r.1.seconds).sum::<f64>() / n,
            visits: runs.iter().map(|r| r.1.visits).sum::<f64>() / n,
            faster,
            errors: errors.collect(),
            setting: setting.clone(),
        }
    }
}

/// The least ratio to the reference from which its own error is judged: below it a small difference would be taken many times.
const NEAREST: f64 = 1.5;

/// The level next to the reference's, of a knob that has an order: the first coarse enough to judge from, else the next.
pub fn neighbour(knob: &StudyParameter) -> Option<usize> {
    let ordered = matches!(knob.sense, Sense::Step | Sense::Tolerance);
    let mut coarser = knob.reference + 1..knob.levels.len();
    let next = coarser.clone().next().filter(|_| ordered)?;
    coarser
        .find(|&l| ratio(knob, l).and_then(weight).is_some())
        .or(Some(next))
}

/// How many times as coarse as the reference's a level is.
fn ratio(knob: &StudyParameter, level: usize) -> Option<f64> {
    Some(knob.levels.get(level)?.number? / knob.levels.get(knob.reference)?.number?)
}

/// What the difference from a level `ratio` times as coarse is multiplied by to bound the reference's own error. Of first
/// order e(rh) - e(h) = (r - 1) e(h): 1/(r - 1), and 1 from r = 2 on. None where the levels are too near.
fn weight(ratio: f64) -> Option<f64> {
    match ratio {
        r if r >= 2.0 => Some(1.0),
        r if r >= NEAREST * (1.0 - 1e-9) => Some(1.0 / (r - 1.0)),
        _ => None,
    }
}

/// An error for people: `-0.8 +- 0.3 %`.
pub struct Told<'a>(pub &'a Mean, pub Wanted);

impl std::fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mean = self.0;
        let half = match (mean.half_width, self.1) {
            (Some(0.0), _) => String::new(),
            (Some(h), Wanted::Relative(_)) => format!(" +- {}", share(h)),
            (Some(h), Wanted::Absolute(_)) => format!(" +- {h:.1e}"),
            (None, _) => " +- ?".into(),
        };
        match self.1 {
            Wanted::Relative(_) => write!(f, "{}{half} %", share(mean.mean)),
            Wanted::Absolute(_) => write!(f, "{:.2e}{half}", mean.mean),
        }
    }
}

/// A share as a number of per cent with the digits it deserves.
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
    use super::super::knobs::Level;
    use super::*;

    /// An error of first order, e = c h: what is said of it is never below it.
    #[test]
    fn the_own_error_follows_the_ratio_of_the_steps() {
        let c = 0.3;
        for r in [1.5, 1.7, 2.0, 3.0] {
            let difference = c * r - c;
            let said = weight(r).unwrap() * difference;
            assert!(said >= c * (1.0 - 1e-12), "{r}: {said}");
            assert!(r > 2.0 || (said - c).abs() < 1e-12, "{r}: {said}");
        }
        assert_eq!(weight(1.1), None);
        assert_eq!(weight(f64::NAN), None);
    }

    #[test]
    fn levels_too_near_are_passed_over() {
        let level = |x: f64| Level {
            label: x.to_string(),
            sets: Vec::new(),
            number: Some(x),
        };
        let mut knob = StudyParameter {
            name: "step".into(),
            sense: Sense::Step,
            levels: [1.0, 1.1, 2.0].map(level).into(),
            own: 0,
            reference: 0,
        };
        assert_eq!(neighbour(&knob), Some(2));
        knob.levels.pop();
        assert_eq!(neighbour(&knob), Some(1));
        assert_eq!(ratio(&knob, 1).and_then(weight), None);
        knob.sense = Sense::Choice;
        assert_eq!(neighbour(&knob), None);
    }
}
