//! The runs of a trade, as far as the budget allows.

use super::combination::Combination;
use super::plan::Trade;
use super::varied::ParameterEffect;
use crate::Error;
use crate::runs::launcher::{Launcher, Run, WaitLimits};
use crate::runs::pool::workers;
use crate::runs::stored::{FinishedRun, Status};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Ratio to the reference's duration above which another run is stopped as too slow. Wall time is
/// used, which other programs may affect.
const PATIENCE: f64 = 3.0;

/// Event for a progress display, with a setting and a seed.
#[derive(Debug)]
pub enum Event<'a> {
    /// A run begins, with its expected duration (s).
    Begins(&'a str, u64, f64),
    /// A run ended.
    Ended(&'a str, u64, &'a FinishedRun),
}

/// Called with every event.
pub type OnEvent<'a> = &'a (dyn Fn(&Event<'_>) + Sync);

impl Trade {
    /// Runs the settings. It ends early, without an error, when the budget is spent or `stop` is
    /// set.
    ///
    /// # Errors
    /// A run cannot be started, or no reference could be run.
    pub fn execute(&mut self, stop: &AtomicBool, watch: OnEvent<'_>) -> Result<(), Error> {
        self.run_reference(stop, watch)?;
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

    /// Runs the reference, or a coarser one if it fails.
    fn run_reference(&mut self, stop: &AtomicBool, watch: OnEvent<'_>) -> Result<(), Error> {
        loop {
            let reference = Combination::reference(&self.parameters);
            // Runs that were stopped as too slow compared with a finer reference may be the
            // reference now.
            self.done
                .retain(|(s, _), r| *s != reference || !matches!(r.status, Status::Slow(_)));
            self.batch(std::slice::from_ref(&reference), stop, watch)?;
            let mut runs = self.done.iter().filter(|((s, _), _)| *s == reference);
            let why = runs.find_map(|(_, r)| Some((r.status.failure()?, r.temporary)));
            let Some((why, temporary)) = why else {
                return Ok(());
            };
            let name = reference.name(&self.parameters);
            if temporary {
                return Err(Error::Failed(format!(
                    "the reference ({name}) has no result: {why}; the same command tries it again"
                )));
            }
            let coarser = (0..self.parameters.len())
                .filter(|&k| self.parameters[k].may_be_coarser())
                .max_by_key(|&k| {
                    let effect = self.parameters[k].effect;
                    (
                        effect == ParameterEffect::Tolerance,
                        effect != ParameterEffect::Form,
                        k,
                    )
                });
            let Some(k) = coarser else {
                return Err(Error::Failed(format!(
                    "the reference ({name}) failed, so there is nothing to compare with: {why}"
                )));
            };
            self.notes
                .push(format!("{name} could not be the reference: {why}"));
            self.parameters[k].reference += 1;
            self.write_plan(stop)?;
        }
    }

    /// Runs the settings that have not run yet, as far as the budget allows.
    fn batch(
        &mut self,
        settings: &[Combination],
        stop: &AtomicBool,
        watch: OnEvent<'_>,
    ) -> Result<(), Error> {
        let reference = Combination::reference(&self.parameters);
        let mut queue = VecDeque::new();
        for setting in settings {
            for &seed in &self.seeds {
                if self.done.contains_key(&(setting.clone(), seed)) {
                    continue;
                }
                match self.launcher.stored(&self.run_of(setting, seed)) {
                    Some(run) => {
                        self.reused += 1;
                        self.done.insert((setting.clone(), seed), run);
                    }
                    None => queue.push_back((setting.clone(), seed)),
                }
            }
        }
        let deadline = Some(self.started + self.budget);
        let jobs = self.jobs;
        let shared = Mutex::new((&mut *self, queue));
        let failure: Mutex<Option<Error>> = Mutex::new(None);
        workers(jobs, &|| {
            while let Some(job) = take(&shared, &reference, stop) {
                watch(&Event::Begins(&job.name, job.run.seed, job.expected));
                let wait = WaitLimits {
                    deadline,
                    limit: job.limit,
                    stop,
                };
                let ended = job.launcher.run(&job.run, wait);
                let Ok(mut guard) = shared.lock() else { return };
                match ended {
                    Ok(Some(run)) => {
                        watch(&Event::Ended(&job.name, job.run.seed, &run));
                        guard.0.fresh += 1;
                        guard.0.done.insert((job.setting, job.run.seed), run);
                    }
                    Ok(None) => {
                        guard.0.left_out.insert(job.setting);
                    }
                    Err(e) => {
                        guard.1.clear();
                        if let Ok(mut failure) = failure.lock() {
                            *failure = Some(e);
                        }
                    }
                }
            }
        });
        match failure.into_inner() {
            Ok(Some(e)) => Err(e),
            _ => Ok(()),
        }
    }
}

/// A pending run.
struct Job {
    setting: Combination,
    run: Run,
    name: String,
    expected: f64,
    limit: Option<Duration>,
    launcher: Arc<Launcher>,
}

type Shared<'a> = Mutex<(&'a mut Trade, VecDeque<(Combination, u64)>)>;

/// Returns the next run that fits into the remaining time by the forecast; a setting is started
/// only if all its seeds fit. The reference is always started, since nothing can be compared
/// without it.
fn take(shared: &Shared<'_>, reference: &Combination, stop: &AtomicBool) -> Option<Job> {
    let mut guard = shared.lock().ok()?;
    let (trade, queue) = &mut *guard;
    loop {
        let (setting, seed) = queue.pop_front()?;
        let left = trade.left();
        let failed = |r: &FinishedRun| r.status != Status::Done;
        let known = |s: &Combination| trade.done.range((s.clone(), 0)..=(s.clone(), u64::MAX));
        // A setting with one failed seed is rejected, so that its other seeds need not run.
        if known(&setting).any(|(_, r)| failed(r)) {
            continue;
        }
        let expected = trade.seconds(&setting);
        let begun = known(&setting).next().is_some();
        let seeds = 1 + queue.iter().filter(|(s, _)| *s == setting).count();
        let rounds = seeds.div_ceil(trade.jobs) as f64;
        let fits = begun || setting == *reference || 0.9 * expected * rounds <= left;
        if left <= 0.0 || stop.load(Ordering::Relaxed) || !fits {
            trade.left_out.insert(setting);
            continue;
        }
        let slowest = known(reference).map(|(_, r)| r.wall).fold(0.0, f64::max);
        let limit = (setting != *reference && slowest > 0.0)
            .then(|| Duration::from_secs_f64(PATIENCE * slowest + 5.0));
        return Some(Job {
            run: trade.run_of(&setting, seed),
            name: setting.name(&trade.parameters),
            launcher: Arc::clone(&trade.launcher),
            setting,
            expected,
            limit,
        });
    }
}
