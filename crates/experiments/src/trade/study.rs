//! The study: which settings run, in which order, within the budget.
//!
//! The first runs are the reference, the case's own setting, and the neighbours of the reference from which
//! its own error is estimated. Then one parameter at a time is varied, outward from the case's own value.
//! Then follow combinations of levels that were cheaper alone, first those predicted to meet the wanted
//! error. Interactions of parameters outside these combinations are not detected.

use super::TradeError;
use super::compare::{Compared, Comparison, neighbour};
use super::forecast::Forecast;
use super::output::Output;
use super::parameters::{Sense, StudyParameter};
use super::setting::Setting;
use crate::runs::launcher::{Ended, Launcher};
use crate::runs::stored::{Finished, Status};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Runs by setting and seed.
pub type Ledger = BTreeMap<(Setting, u64), Finished>;

/// Factor on the reference's duration after which another run is stopped as too slow. Wall time is used,
/// which other programs may affect.
const PATIENCE: f64 = 3.0;

/// State of a study.
#[derive(Debug)]
pub struct Study {
    /// Launcher of the runs.
    pub launcher: Arc<Launcher>,
    /// Varied parameters.
    pub parameters: Vec<StudyParameter>,
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
    pub done: Ledger,
    /// Cost forecast.
    pub forecast: Forecast,
    /// Number of runs reused from an earlier study in the same folder.
    pub reused: usize,
    /// Number of runs done now.
    pub fresh: usize,
    /// Settings left out for lack of time.
    pub left_out: BTreeSet<Setting>,
    /// Remarks for the report.
    pub notes: Vec<String>,
    /// Start time.
    pub started: Instant,
}

/// Plan that a later study in the same folder continues.
#[derive(Debug, Serialize, Deserialize)]
struct Plan {
    fingerprint: String,
    #[serde(rename = "knobs")]
    parameters: String,
    reference: Vec<usize>,
    forecast: Forecast,
}

/// Event for a progress display.
#[derive(Debug)]
pub enum Event<'a> {
    /// A run begins, with its expected duration (s).
    Begins(&'a str, u64, f64),
    /// A run ended.
    Ended(&'a str, u64, &'a Finished),
}

impl Study {
    fn plan_file(&self) -> std::path::PathBuf {
        let folder = self.launcher.folder.parent();
        folder.unwrap_or(&self.launcher.folder).join("plan.json")
    }

    fn plan(&self) -> Plan {
        let levels: Vec<StudyParameter> = self
            .parameters
            .iter()
            .map(|k| StudyParameter {
                reference: 0,
                ..k.clone()
            })
            .collect();
        Plan {
            fingerprint: self.launcher.fingerprint(),
            // A larger budget or more jobs may allow a finer reference.
            parameters: format!(
                "{levels:?} {} {} {}",
                self.seeds.len(),
                self.budget.as_secs_f64(),
                self.jobs
            ),
            reference: self.parameters.iter().map(|k| k.reference).collect(),
            forecast: self.forecast.clone(),
        }
    }

    /// Probes the cost, and chooses the finest reference whose work fits: with its neighbours, at most 60 % of the
    /// budget. The plan of an earlier study for the same question and budget is reused unchanged.
    ///
    /// # Errors
    /// A run cannot be started, or the plan cannot be written.
    pub fn prepare(&mut self, stop: &AtomicBool) -> Result<(), TradeError> {
        let path = self.plan_file();
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        if let Ok(plan) = serde_json::from_str::<Plan>(&text) {
            let now = self.plan();
            let fits = plan
                .reference
                .iter()
                .zip(&self.parameters)
                .all(|(r, k)| *r < k.levels.len());
            if fits && plan.fingerprint == now.fingerprint && plan.parameters == now.parameters {
                for (parameter, reference) in self.parameters.iter_mut().zip(&plan.reference) {
                    parameter.reference = *reference;
                }
                self.forecast = plan.forecast;
                return Ok(());
            }
        }
        let each = self.budget.mul_f64(0.03);
        let each = each.clamp(Duration::from_millis(300), Duration::from_secs(20));
        let first = self.seeds[0];
        self.forecast = Forecast::probe(
            &self.launcher,
            &self.parameters,
            self.steps,
            first,
            each,
            &mut self.done,
            stop,
        )?;
        self.fresh = self.done.len();
        // Coarsen tolerance and step alternately, the tolerance first.
        while self.reference_work() > 0.6 * self.budget.as_secs_f64() {
            let coarser = |k: &StudyParameter| k.reference < k.own;
            let mut finest: Vec<usize> = (0..self.parameters.len())
                .filter(|&k| self.ordered(k) && coarser(&self.parameters[k]))
                .collect();
            finest.sort_by_key(|&k| {
                // Another form is the last to go: what it assumes is no question of accuracy.
                (
                    self.parameters[k].sense == Sense::Form,
                    self.parameters[k].reference,
                    self.parameters[k].sense == Sense::Step,
                )
            });
            let Some(&k) = finest.first() else { break };
            self.parameters[k].reference += 1;
        }
        self.write_plan(stop)
    }

    /// Levels finer than the reference's that were dropped because of the budget or a failed run.
    pub fn dropped(&self) -> Vec<String> {
        let ran = |k: usize, l: usize| self.done.keys().any(|(s, _)| s.0[k] == l);
        let mut all = Vec::new();
        for (k, parameter) in self.parameters.iter().enumerate() {
            if self.ordered(k) {
                let finer = (0..parameter.reference).filter(|&l| !ran(k, l));
                all.extend(
                    finer.map(|l| format!("{} {}", parameter.name, parameter.levels[l].label)),
                );
            }
        }
        all
    }

    /// Stores the plan, unless it rests on a guess or on interrupted probes.
    fn write_plan(&self, stop: &AtomicBool) -> Result<(), TradeError> {
        if !self.forecast.measured || stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let path = self.plan_file();
        let text = serde_json::to_string_pretty(&self.plan()).unwrap_or_default();
        std::fs::write(&path, text).map_err(|e| TradeError::write(&path, &e))
    }

    fn ordered(&self, k: usize) -> bool {
        let sense = self.parameters[k].sense;
        matches!(sense, Sense::Step | Sense::Tolerance | Sense::Form)
    }

    /// Expected duration of the reference, its neighbours and the case's own setting over the seeds (s).
    fn reference_work(&self) -> f64 {
        self.work(&self.first())
    }

    /// Expected duration of settings over all seeds with parallel jobs (s).
    pub fn work(&self, settings: &[Setting]) -> f64 {
        let one = |s: &Setting| self.forecast.seconds(s, &self.parameters, &self.done);
        settings.iter().map(one).sum::<f64>() * self.seeds.len() as f64 / self.jobs as f64
    }

    /// The reference, the case's own setting and the neighbours of the reference.
    pub fn first(&self) -> Vec<Setting> {
        let reference = Setting::reference(&self.parameters);
        let mut all = vec![reference.clone(), Setting::own(&self.parameters)];
        for (k, parameter) in self.parameters.iter().enumerate() {
            all.extend(neighbour(parameter).map(|next| reference.with(k, next)));
        }
        unique(all)
    }

    /// Settings that change one parameter of the case's own setting, near levels first; no level finer than
    /// the reference's.
    pub fn one_at_a_time(&self) -> Vec<Setting> {
        let own = Setting::own(&self.parameters);
        let mut all = Vec::new();
        for far in 1..=self
            .parameters
            .iter()
            .map(|k| k.levels.len())
            .max()
            .unwrap_or(0)
        {
            for (k, parameter) in self.parameters.iter().enumerate() {
                let levels = [
                    parameter.own.checked_add(far),
                    parameter.own.checked_sub(far),
                ];
                for level in levels.into_iter().flatten() {
                    let finer = self.ordered(k) && level < parameter.reference;
                    if level < parameter.levels.len() && !finer {
                        all.push(own.with(k, level));
                    }
                }
            }
        }
        let first = self.first();
        unique(all)
            .into_iter()
            .filter(|s| !first.contains(s))
            .collect()
    }

    /// Runs the study. It ends early, without an error, when the budget is spent or `stop` is set.
    ///
    /// # Errors
    /// A run cannot be started, or no reference could be run.
    pub fn execute(
        &mut self,
        stop: &AtomicBool,
        watch: &(dyn Fn(&Event<'_>) + Sync),
    ) -> Result<(), TradeError> {
        loop {
            let reference = Setting::reference(&self.parameters);
            // Runs stopped as too slow for a finer reference may be the reference now.
            self.done
                .retain(|(s, _), r| *s != reference || !matches!(r.status, Status::Slow(_)));
            self.batch(std::slice::from_ref(&reference), stop, watch)?;
            let mut runs = self.done.iter().filter(|((s, _), _)| *s == reference);
            let why = runs.find_map(|(_, r)| Some((r.status.failure()?, r.temporary)));
            let Some((why, temporary)) = why else { break };
            let name = reference.name(&self.parameters);
            if temporary {
                return Err(TradeError::Reference(format!(
                    "the reference ({name}) has no result: {why}; the same command tries it again"
                )));
            }
            let coarser = (0..self.parameters.len())
                .filter(|&k| {
                    self.ordered(k) && self.parameters[k].reference < self.parameters[k].own
                })
                .max_by_key(|&k| {
                    let sense = self.parameters[k].sense;
                    (sense == Sense::Tolerance, sense != Sense::Form, k)
                });
            let Some(k) = coarser else {
                return Err(TradeError::Reference(format!(
                    "the reference ({name}) failed, so there is nothing to compare with: {why}"
                )));
            };
            self.notes
                .push(format!("{name} could not be the reference: {why}"));
            self.parameters[k].reference += 1;
            self.write_plan(stop)?;
        }
        let first = self.first();
        self.batch(&first, stop, watch)?;
        let one_at_a_time = self.one_at_a_time();
        self.batch(&one_at_a_time, stop, watch)?;
        if !stop.load(Ordering::Relaxed) {
            let combinations = self.combinations();
            self.batch(&combinations, stop, watch)?;
        }
        Ok(())
    }

    /// Compares the finished settings with the reference.
    pub fn compare(&self) -> Comparison {
        self.compared().compare()
    }

    fn compared(&self) -> Compared<'_> {
        Compared {
            parameters: &self.parameters,
            outputs: &self.outputs,
            random: self.random,
            seeds: &self.seeds,
            done: &self.done,
            launcher: &self.launcher,
        }
    }

    /// Remaining budget (s).
    fn left(&self) -> f64 {
        (self.budget.as_secs_f64() - self.started.elapsed().as_secs_f64()).max(0.0)
    }

    /// Runs the settings that have not run yet, as far as the budget allows.
    fn batch(
        &mut self,
        settings: &[Setting],
        stop: &AtomicBool,
        watch: &(dyn Fn(&Event<'_>) + Sync),
    ) -> Result<(), TradeError> {
        let reference = Setting::reference(&self.parameters);
        let mut queue = VecDeque::new();
        for setting in settings {
            let sets = setting.sets(&self.parameters);
            for &seed in &self.seeds {
                if self.done.contains_key(&(setting.clone(), seed)) {
                    continue;
                }
                match self.launcher.stored(&sets, seed) {
                    Some(run) => {
                        self.reused += 1;
                        self.done.insert((setting.clone(), seed), run);
                    }
                    None => queue.push_back((setting.clone(), seed)),
                }
            }
        }
        let deadline = self.started + self.budget;
        let shared = Mutex::new((&mut *self, queue));
        let failure: Mutex<Option<TradeError>> = Mutex::new(None);
        let jobs = shared.lock().map_or(1, |s| s.0.jobs);
        std::thread::scope(|scope| {
            let work = || {
                while let Some(job) = take(&shared, &reference, stop) {
                    let Job {
                        setting,
                        seed,
                        sets,
                        name,
                        expected,
                        bound,
                        launcher,
                    } = job;
                    watch(&Event::Begins(&name, seed, expected));
                    let ended = launcher.run(&sets, seed, deadline, bound, stop);
                    let Ok(mut guard) = shared.lock() else { return };
                    match ended {
                        Ok(Ended::Finished(run)) => {
                            watch(&Event::Ended(&name, seed, &run));
                            guard.0.fresh += 1;
                            guard.0.done.insert((setting, seed), run);
                        }
                        Ok(Ended::Interrupted) => {
                            guard.0.left_out.insert(setting);
                        }
                        Err(e) => {
                            guard.1.clear();
                            if let Ok(mut failure) = failure.lock() {
                                *failure = Some(e.into());
                            }
                        }
                    }
                }
            };
            for _ in 1..jobs {
                // Fewer jobs if the system provides no more threads.
                let _ = std::thread::Builder::new().spawn_scoped(scope, work);
            }
            work();
        });
        match failure.into_inner() {
            Ok(Some(e)) => Err(e),
            _ => Ok(()),
        }
    }
}

/// A pending run.
struct Job {
    setting: Setting,
    seed: u64,
    sets: Vec<String>,
    name: String,
    expected: f64,
    bound: Option<Duration>,
    launcher: Arc<Launcher>,
}

type Shared<'a> = Mutex<(&'a mut Study, VecDeque<(Setting, u64)>)>;

/// The next run that fits into the remaining time by the forecast; a setting is started only if all its seeds
/// fit. The reference is always started, since nothing can be compared without it.
fn take(shared: &Shared<'_>, reference: &Setting, stop: &AtomicBool) -> Option<Job> {
    let mut guard = shared.lock().ok()?;
    let (study, queue) = &mut *guard;
    loop {
        let (setting, seed) = queue.pop_front()?;
        let left = study.left();
        let failed = |r: &Finished| r.status != Status::Done;
        let known = |s: &Setting| study.done.range((s.clone(), 0)..=(s.clone(), u64::MAX));
        // A setting with one failed seed is rejected, so its other seeds need not run.
        if known(&setting).any(|(_, r)| failed(r)) {
            continue;
        }
        let expected = study
            .forecast
            .seconds(&setting, &study.parameters, &study.done);
        let begun = known(&setting).next().is_some();
        let seeds = 1 + queue.iter().filter(|(s, _)| *s == setting).count();
        let rounds = seeds.div_ceil(study.jobs) as f64;
        let fits = begun || setting == *reference || 0.9 * expected * rounds <= left;
        if left <= 0.0 || stop.load(Ordering::Relaxed) || !fits {
            study.left_out.insert(setting);
            continue;
        }
        let slowest = known(reference).map(|(_, r)| r.wall).fold(0.0, f64::max);
        let bound = (setting != *reference && slowest > 0.0)
            .then(|| Duration::from_secs_f64(PATIENCE * slowest + 5.0));
        return Some(Job {
            sets: setting.sets(&study.parameters),
            name: setting.name(&study.parameters),
            launcher: Arc::clone(&study.launcher),
            setting,
            seed,
            expected,
            bound,
        });
    }
}

/// Removes duplicates, preserving the order.
fn unique(settings: Vec<Setting>) -> Vec<Setting> {
    let mut seen = BTreeSet::new();
    settings
        .into_iter()
        .filter(|s| seen.insert(s.clone()))
        .collect()
}
