//! The plan of a trade: which settings run, in which order, within the budget.
//!
//! The first runs are the reference, the case's own setting, and the neighbours of the reference
//! from which its own error is estimated. Then one parameter at a time is varied, outward from the
//! case's own value. Then follow combinations of levels that were cheaper alone, first those
//! predicted to meet the wanted error. Interactions of parameters outside these combinations are
//! not detected.

use super::combination::Combination;
use super::compare::{Comparison, neighbour};
use super::cost_law::CostLaw;
use super::output::Output;
use super::varied::{ParameterEffect, Varied};
use super::verdict::{Verdict, verdicts};
use crate::Error;
use crate::runs::launcher::{Launcher, Run};
use crate::runs::stored::FinishedRun;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Runs by setting and seed.
pub type RunsBySetting = BTreeMap<(Combination, u64), FinishedRun>;

/// Current state of a trade.
#[derive(Debug)]
pub struct Trade {
    /// Title of the case.
    pub title: String,
    /// Launcher of the runs.
    pub launcher: Arc<Launcher>,
    /// Varied parameters.
    pub parameters: Vec<Varied>,
    /// Compared outputs.
    pub outputs: Vec<Output>,
    /// Seeds, at least one.
    pub seeds: Vec<u64>,
    /// Whether the seeds change the scene.
    pub random: bool,
    /// Number of steps of the case itself.
    pub steps: f64,
    /// Number of parallel runs.
    pub jobs: usize,
    /// Time budget.
    pub budget: Duration,
    /// Finished runs.
    pub done: RunsBySetting,
    /// Expected cost of a setting.
    pub cost: CostLaw,
    /// Number of runs reused from an earlier trade in the same folder.
    pub reused: usize,
    /// Number of runs done now.
    pub fresh: usize,
    /// Settings left out for lack of time.
    pub left_out: BTreeSet<Combination>,
    /// Remarks for the report.
    pub notes: Vec<String>,
    /// Start time.
    pub started: Instant,
}

/// Stored part of a trade, with which a later trade in the same folder continues.
#[derive(Debug, Serialize, Deserialize)]
struct StoredPlan {
    fingerprint: String,
    #[serde(alias = "knobs")]
    parameters: String,
    reference: Vec<usize>,
    forecast: CostLaw,
}

/// Results of a trade.
#[derive(Debug)]
pub struct Findings {
    /// Each setting compared with the reference.
    pub found: Comparison,
    /// The cheapest settings for the errors wanted.
    pub verdicts: Vec<Verdict>,
    /// Whether all planned runs were made.
    pub complete: bool,
}

impl Trade {
    /// Returns the results of the runs so far; `interrupted` if more were planned.
    pub fn answer(&self, interrupted: bool) -> Findings {
        let found = self.compare();
        Findings {
            verdicts: verdicts(&found, &self.outputs, self.random),
            complete: self.left_out.is_empty() && self.dropped().is_empty() && !interrupted,
            found,
        }
    }

    fn plan_file(&self) -> std::path::PathBuf {
        let folder = self.launcher.folder.parent();
        folder.unwrap_or(&self.launcher.folder).join("plan.json")
    }

    fn plan(&self) -> StoredPlan {
        let levels: Vec<Varied> = self
            .parameters
            .iter()
            .map(|k| Varied {
                reference: 0,
                ..k.clone()
            })
            .collect();
        StoredPlan {
            fingerprint: self.launcher.fingerprint(),
            // A larger budget or more jobs may allow a finer reference.
            parameters: format!(
                "{levels:?} {} {} {}",
                self.seeds.len(),
                self.budget.as_secs_f64(),
                self.jobs
            ),
            reference: self.parameters.iter().map(|k| k.reference).collect(),
            forecast: self.cost.clone(),
        }
    }

    /// Probes the cost, and chooses the finest reference whose work fits: with its neighbours, at
    /// most 60 % of the budget. The plan of an earlier trade for the same question and budget is
    /// reused unchanged.
    ///
    /// # Errors
    /// A run cannot be started, or the plan cannot be written.
    pub fn prepare(&mut self, stop: &AtomicBool) -> Result<(), Error> {
        let text = std::fs::read_to_string(self.plan_file()).unwrap_or_default();
        if let Ok(plan) = serde_json::from_str::<StoredPlan>(&text) {
            let now = self.plan();
            let mut levels = plan.reference.iter().zip(&self.parameters);
            let fits = levels.all(|(r, k)| *r < k.levels.len());
            if fits && plan.fingerprint == now.fingerprint && plan.parameters == now.parameters {
                for (parameter, reference) in self.parameters.iter_mut().zip(&plan.reference) {
                    parameter.reference = *reference;
                }
                self.cost = plan.forecast;
                return Ok(());
            }
        }
        self.probe(stop)?;
        self.fresh = self.done.len();
        // Tolerance and step are coarsened alternately, the tolerance first. Other forms are
        // dropped last: their assumptions are not a matter of accuracy.
        while self.work(&self.first()) > 0.6 * self.budget.as_secs_f64() {
            let finest = self.parameters.iter_mut().filter(|k| k.may_be_coarser());
            let finest = finest.min_by_key(|k| {
                (
                    k.effect == ParameterEffect::Form,
                    k.reference,
                    k.effect == ParameterEffect::Step,
                )
            });
            let Some(finest) = finest else { break };
            finest.reference += 1;
        }
        self.write_plan(stop)
    }

    /// Returns the levels finer than the reference's that were dropped because of the budget or a
    /// failed run.
    pub fn dropped(&self) -> Vec<String> {
        let ran = |k: usize, l: usize| self.done.keys().any(|(s, _)| s.0[k] == l);
        let mut all = Vec::new();
        for (k, parameter) in self.parameters.iter().enumerate() {
            if parameter.is_ordered() {
                let finer = (0..parameter.reference).filter(|&l| !ran(k, l));
                let named = |l: usize| format!("{} {}", parameter.name, parameter.levels[l].label);
                all.extend(finer.map(named));
            }
        }
        all
    }

    /// Stores the plan, unless it is based on an uncertain cost law or interrupted probes.
    pub(super) fn write_plan(&self, stop: &AtomicBool) -> Result<(), Error> {
        if !self.cost.measured || stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let path = self.plan_file();
        let text = serde_json::to_string_pretty(&self.plan()).unwrap_or_default();
        std::fs::write(&path, text).map_err(|e| Error::write(&path, &e))
    }

    /// The run of a setting with a seed.
    pub(super) fn run_of(&self, setting: &Combination, seed: u64) -> Run {
        Run {
            sets: setting.sets(&self.parameters),
            seed,
        }
    }

    /// Returns the expected duration of settings over all seeds with parallel jobs (s).
    pub fn work(&self, settings: &[Combination]) -> f64 {
        let one = |s: &Combination| self.seconds(s);
        settings.iter().map(one).sum::<f64>() * self.seeds.len() as f64 / self.jobs as f64
    }

    /// The reference, the case's own setting and the neighbours of the reference.
    pub fn first(&self) -> Vec<Combination> {
        let reference = Combination::reference(&self.parameters);
        let mut all = vec![reference.clone(), Combination::own(&self.parameters)];
        for (k, parameter) in self.parameters.iter().enumerate() {
            all.extend(neighbour(parameter).map(|next| reference.with(k, next)));
        }
        unique(all)
    }

    /// Returns settings that change one parameter of the case's own setting, near levels first; no
    /// level finer than the reference's.
    pub fn one_at_a_time(&self) -> Vec<Combination> {
        let own = Combination::own(&self.parameters);
        let most = self.parameters.iter().map(|k| k.levels.len()).max();
        let mut all = Vec::new();
        for far in 1..=most.unwrap_or(0) {
            for (k, parameter) in self.parameters.iter().enumerate() {
                let levels = [
                    parameter.own.checked_add(far),
                    parameter.own.checked_sub(far),
                ];
                for level in levels.into_iter().flatten() {
                    let finer = parameter.is_ordered() && level < parameter.reference;
                    if level < parameter.levels.len() && !finer {
                        all.push(own.with(k, level));
                    }
                }
            }
        }
        let first = self.first();
        all.retain(|s| !first.contains(s));
        unique(all)
    }

    /// Returns the remaining budget (s).
    pub(super) fn left(&self) -> f64 {
        (self.budget.as_secs_f64() - self.started.elapsed().as_secs_f64()).max(0.0)
    }
}

/// Removes duplicates, preserving the order.
fn unique(mut settings: Vec<Combination>) -> Vec<Combination> {
    let mut seen = BTreeSet::new();
    settings.retain(|s| seen.insert(s.clone()));
    settings
}
