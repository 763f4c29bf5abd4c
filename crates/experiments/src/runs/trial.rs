//! Estimate of the run time from steps of a copy of the scene, timed for a short while: at the
//! start, and in a state under load, to which longer steps lead. No files are written.

use crate::duration::seconds;
use crate::runs::loaded::loaded_at;
use cpu_time::ThreadTime;
use fretwork_core::view::RunControl;
use fretwork_scene::Built;
use fretwork_scene::case::Case;
use fretwork_scene::most_steps::most_steps;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::{Duration, Instant};

/// Processor time for which steps are timed, at the start and again under load.
const WATCHED: Duration = Duration::from_millis(500);

/// Wall time after which no further step is timed: a busy machine gives the processor to others.
const WATCHED_AT_MOST: Duration = Duration::from_secs(1);

/// Wall time in which these steps end.
const WATCHED_WITHIN: Duration = Duration::from_secs(2);

/// Wall time that the first step of a scene with deformable bodies may take before the timing: it
/// computes data that later steps keep.
const FIRST: Duration = Duration::from_secs(4);

/// Processor time for the steps that lead to the state under load.
const FORWARD: Duration = Duration::from_secs(2);

/// Wall time in which these steps end; the last of them may take long.
const FORWARD_WITHIN: Duration = Duration::from_secs(10);

/// Wall time beyond these for a step that is not finished in time.
const GRACE: Duration = Duration::from_millis(250);

/// Limit on the number of timed steps in each of the two states.
const STEPS: u64 = 2000;

/// Number of long steps to the state under load, and the largest ratio of their length to that of
/// the run.
const STRIDES: f64 = 60.0;
const LONGEST: f64 = 50.0;

/// Run time (s) below which the state under load is not looked for.
const SHORT: f64 = 3.0;

/// Number of steps of the length of the run after which those under load are timed.
const SETTLING: u64 = 10;

/// Factor between the estimate and its lower and upper bounds, since contacts and iterations change
/// during the run. If grains are loose at the start, the upper bound is also raised to the contacts
/// of a packing.
const FACTOR: f64 = 3.0;

/// A timed step.
#[derive(Clone, Copy, Debug)]
struct Timed {
    /// Processor time (s).
    seconds: f64,
    contacts: usize,
    iterations: u32,
}

/// What the thread that steps does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TrialState {
    /// Steps at the start.
    Start,
    /// Longer steps to the state under load.
    Forward,
    /// Steps under load.
    Loaded,
}

/// A message of the thread that steps.
enum Progress {
    /// A step at the start, or under load.
    Step(Timed),
    /// Steps at the start are done, and longer ones follow.
    Forward,
    /// The state under load is reached.
    Loaded,
    /// A step of the run failed.
    Failed(String),
}

/// Result of a short trial of a scene.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// Steps of the run.
    steps: u64,
    grains: usize,
    dimension: usize,
    timed: Vec<Timed>,
    /// Steps under load, and the number of steps of the run before that state.
    loaded: Vec<Timed>,
    before_load: u64,
    /// Wall time for which the unfinished step had run at the end (s); 0 if none was unfinished.
    pending: f64,
    /// Message of a failed step.
    failure: Option<String>,
}

/// Estimated duration of a run (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunTime {
    /// Best estimate; `None` if not even one step finished in time.
    pub about: Option<f64>,
    /// Lower bound.
    pub least: f64,
    /// Upper bound; infinite if not one step finished.
    pub most: f64,
}

/// Steps the simulation at the start, then to a time under load by longer steps, and there again. A
/// failure of a longer step ends it without a message, since no step of the run failed.
fn work(
    run: &mut dyn RunControl,
    steps: u64,
    target: f64,
    sender: &SyncSender<Progress>,
) -> Option<()> {
    let h = run.options().scheme.h;
    let timed = |run: &mut dyn RunControl| {
        let clock = ThreadTime::now();
        let report = run.step().map_err(|e| e.to_string())?;
        Ok::<_, String>(Timed {
            seconds: clock.elapsed().as_secs_f64(),
            contacts: run.contact_count(),
            iterations: report.solver.iterations,
        })
    };
    let watch = |run: &mut dyn RunControl, most: u64| {
        let mut begun = (ThreadTime::now(), Instant::now());
        for k in 0..most {
            let step = timed(run);
            let failed = step.is_err();
            let sent = sender.send(step.map_or_else(Progress::Failed, Progress::Step));
            if k == 0 {
                // The first step forms what later ones keep.
                begun = (ThreadTime::now(), Instant::now());
            }
            if failed || sent.is_err() {
                return None;
            }
            if begun.0.elapsed() > WATCHED || begun.1.elapsed() > WATCHED_AT_MOST {
                break;
            }
        }
        Some(())
    };
    let clock = ThreadTime::now();
    watch(run, steps.min(STEPS))?;
    let whole = clock.elapsed().as_secs_f64() * steps as f64 / run.steps().max(1) as f64;
    if run.steps() >= steps || run.time() >= target || whole < SHORT {
        return None;
    }
    sender.send(Progress::Forward).ok()?;
    let longer = ((target - run.time()) / h / STRIDES).clamp(1.0, LONGEST);
    let clock = ThreadTime::now();
    run.change_step(longer * h);
    while run.time() < target && clock.elapsed() < FORWARD {
        run.step().ok()?;
    }
    run.change_step(h);
    for _ in 0..SETTLING {
        run.step().ok()?;
    }
    sender.send(Progress::Loaded).ok()?;
    watch(run, STEPS)
}

impl Trial {
    /// Steps a scene for a short time in a separate thread. The thread is abandoned when the time
    /// is up, so that even the largest scene does not block the program.
    pub fn of(case: &Case, built: Built) -> Self {
        let mut simulation = built.simulation;
        let steps = most_steps(case);
        let (h, target) = (case.time.step, loaded_at(case));
        let mut out = Self {
            steps,
            grains: simulation.grains().len(),
            dimension: simulation.dimension(),
            before_load: (target / h) as u64,
            ..Self::default()
        };
        // The thread waits for a reader, so that it stops when it is abandoned.
        let (sender, receiver) = sync_channel::<Progress>(1);
        let deformable = simulation.system_count() > 0;
        let work = move || work(&mut *simulation, steps, target, &sender);
        if let Err(e) = std::thread::Builder::new().spawn(work) {
            out.failure = Some(format!("cannot start a thread to time steps ({e})"));
            return out;
        }
        out.read(&receiver, deformable);
        out
    }

    /// Reads the steps until the thread ends, or the time for what it does is over.
    fn read(&mut self, receiver: &Receiver<Progress>, deformable: bool) {
        let mut last = Instant::now();
        let mut end = last
            + if deformable {
                FIRST
            } else {
                WATCHED_WITHIN + GRACE
            };
        let mut state = TrialState::Start;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match receiver.recv_timeout(left) {
                Ok(Progress::Step(step)) => {
                    last = Instant::now();
                    if state == TrialState::Loaded {
                        self.loaded.push(step);
                        continue;
                    }
                    if self.timed.is_empty() {
                        end = last + WATCHED_WITHIN + GRACE;
                    }
                    self.timed.push(step);
                }
                Ok(Progress::Forward) => {
                    state = TrialState::Forward;
                    end = Instant::now() + FORWARD_WITHIN;
                }
                Ok(Progress::Loaded) => {
                    state = TrialState::Loaded;
                    end = Instant::now() + WATCHED_WITHIN + GRACE;
                }
                Ok(Progress::Failed(_)) if state == TrialState::Loaded => return,
                Ok(Progress::Failed(e)) => {
                    let step = self.timed.len() + 1;
                    self.failure = Some(format!(
                        "step {step} of a trial FAILED, and a run will too: {e}"
                    ));
                    return;
                }
                Err(RecvTimeoutError::Timeout) if deformable && self.timed.is_empty() => {
                    self.failure = Some(format!(
                        "the first step, which forms what later steps keep of deformable bodies, takes more than {}",
                        amount(FIRST.as_secs_f64())
                    ));
                    return;
                }
                Err(RecvTimeoutError::Timeout) => {
                    if state == TrialState::Start {
                        self.pending = last.elapsed().as_secs_f64();
                    }
                    return;
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Returns the steps that are used: the first ones build neighbour lists and have no warm
    /// start.
    fn used(&self) -> &[Timed] {
        &self.timed[self.timed.len() / 2..]
    }

    /// Returns seconds per step at the start. An unfinished step that has taken much longer than
    /// the others counts with its time so far.
    fn step(&self) -> f64 {
        let (mean, n) = (mean(self.used(), |t| t.seconds), self.used().len() as f64);
        if self.stuck() {
            (mean * n + self.pending) / (n + 1.0)
        } else {
            mean
        }
    }

    /// Returns the duration of all steps (s): up to the state under load the mean of both states,
    /// then that of the load. Longer steps may have thrown grains apart, so that a state of less
    /// cost than the start does not count.
    fn whole(&self) -> f64 {
        let (start, steps) = (self.step(), self.steps as f64);
        if self.loaded.is_empty() {
            return start * steps;
        }
        let loaded = mean(&self.loaded, |t| t.seconds).max(start);
        let before = (self.before_load as f64).min(steps);
        0.5 * (start + loaded) * before + loaded * (steps - before)
    }

    /// Returns whether the unfinished step has taken much longer than the others.
    fn stuck(&self) -> bool {
        self.pending > 10.0 * mean(self.used(), |t| t.seconds).max(1e-3)
    }

    /// Returns the ratio of the contacts in a dense packing to those of the last state: two per
    /// disk and three per sphere, half of the four and six neighbours of each.
    fn growth(&self) -> f64 {
        let dense = (self.grains * self.dimension) as f64;
        let last = match self.loaded.is_empty() {
            true => self.used(),
            false => &self.loaded,
        };
        (dense / mean(last, |t| t.contacts as f64).max(1.0)).max(1.0)
    }

    /// Returns the duration of the run on one thread; `None` if a step failed.
    pub fn run_time(&self) -> Option<RunTime> {
        if self.failure.is_some() {
            return None;
        }
        if self.timed.is_empty() {
            return Some(RunTime {
                about: None,
                least: WATCHED.as_secs_f64() * self.steps as f64 / FACTOR,
                most: f64::INFINITY,
            });
        }
        let whole = self.whole();
        Some(RunTime {
            about: Some(whole),
            least: whole / FACTOR,
            most: whole * FACTOR * self.growth(),
        })
    }

    /// Returns the line of the report.
    pub fn text(&self) -> String {
        let Some(time) = self.run_time() else {
            return format!(
                "not estimated: {}",
                self.failure.as_deref().unwrap_or_default()
            );
        };
        let Some(about) = time.about else {
            return format!(
                "more than {}: the first step alone takes more than {}",
                amount(time.least),
                amount(WATCHED.as_secs_f64())
            );
        };
        let loose = if self.growth() > 1.5 {
            let dense = self.grains * self.dimension;
            format!("; grains are still loose, a packing has about {dense} contacts")
        } else {
            String::new()
        };
        let under = match self.loaded.is_empty() {
            true => String::new(),
            false => format!(
                ", under load {:.1e} s with {:.0} contacts and {:.0} iterations",
                mean(&self.loaded, |t| t.seconds),
                mean(&self.loaded, |t| t.contacts as f64),
                mean(&self.loaded, |t| f64::from(t.iterations))
            ),
        };
        let stuck = if self.stuck() {
            format!(", then one of more than {}", amount(self.pending))
        } else {
            String::new()
        };
        format!(
            "about {} on one thread, between {} and {}: {} steps timed, the last {} of {:.1e} s each with {:.0} contacts and {:.0} iterations{stuck}{under}{loose}; \
             pictures and files are not counted",
            amount(about),
            amount(time.least),
            amount(time.most),
            self.timed.len(),
            self.used().len(),
            mean(self.used(), |t| t.seconds),
            mean(self.used(), |t| t.contacts as f64),
            mean(self.used(), |t| f64::from(t.iterations))
        )
    }
}

/// The mean of a property of steps; NaN for none.
fn mean(steps: &[Timed], f: impl Fn(&Timed) -> f64) -> f64 {
    steps.iter().map(f).sum::<f64>() / steps.len() as f64
}

/// A duration in a readable unit.
fn amount(s: f64) -> String {
    if s < 1e-3 {
        "less than 1 ms".to_owned()
    } else {
        seconds(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_is_steps_times_their_time() {
        let step = |seconds| Timed {
            seconds,
            contacts: 200,
            iterations: 10,
        };
        // The first, expensive step is not used.
        let trial = Trial {
            steps: 10_000,
            grains: 100,
            dimension: 2,
            timed: vec![step(1.0), step(2e-3), step(4e-3), step(4e-3)],
            ..Trial::default()
        };
        let text = trial.text();
        let begins = "about 40.0 s on one thread, between 13.3 s and 120 s";
        assert!(
            text.starts_with(begins) && !text.contains("loose"),
            "{text}"
        );
        // Under load a step takes 10 ms: 2000 steps of 7 ms to that state, 8000 of 10 ms.
        let loaded = Trial {
            loaded: vec![step(8e-3), step(12e-3)],
            before_load: 2000,
            ..trial.clone()
        };
        let loaded = loaded.text();
        assert!(
            loaded.starts_with("about 94.0 s") && loaded.contains("under load 1.0e-2 s"),
            "{loaded}"
        );
        // A tenth of the contacts of a packing: at most ten times as long.
        let loose = Trial {
            grains: 1000,
            ..trial.clone()
        };
        let loose = loose.text();
        assert!(
            loose.contains("and 20 min") && loose.contains("about 2000 contacts"),
            "{loose}"
        );
        // A step that does not finish counts: (2 x 4 ms + 1 s)/3 each.
        let stuck = Trial {
            pending: 1.0,
            ..trial.clone()
        };
        let stuck = stuck.text();
        assert!(
            stuck.starts_with("about 56 min") && stuck.contains("then one of more than 1.0 s"),
            "{stuck}"
        );
        let none = Trial {
            steps: 1000,
            ..Trial::default()
        };
        let none = none.text();
        assert!(none.starts_with("more than 167 s"), "{none}");
        let failed = Trial {
            failure: Some("no".into()),
            ..trial
        };
        assert_eq!(failed.run_time(), None);
    }
}
