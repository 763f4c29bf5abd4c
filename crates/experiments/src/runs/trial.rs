//! Estimate of the run time from a few steps of a copy of the scene, timed for a short while. No
//! files are written.

use crate::duration::seconds;
use cpu_time::ThreadTime;
use fretwork_scene::Built;
use fretwork_scene::case::Case;
use fretwork_scene::most_steps::most_steps;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Wall time for which steps are timed.
const WATCHED: Duration = Duration::from_millis(500);

/// Wall time that the first step of a scene with deformable bodies may take before the timing: it
/// computes data that later steps keep.
const FIRST: Duration = Duration::from_secs(4);

/// Limit on the number of timed steps.
const STEPS: u64 = 2000;

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

/// Result of a short trial of a scene.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// Steps of the run.
    steps: u64,
    grains: usize,
    dimension: usize,
    timed: Vec<Timed>,
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

impl Trial {
    /// Steps a scene for a short time in a separate thread. The thread is abandoned when the time
    /// is up, so that even the largest scene does not block the program.
    pub fn of(case: &Case, built: Built) -> Self {
        let mut simulation = built.simulation;
        let steps = most_steps(case);
        let mut out = Self {
            steps,
            grains: simulation.grains().len(),
            dimension: simulation.dimension(),
            ..Self::default()
        };
        let (sender, receiver) = channel::<Result<Timed, String>>();
        let deformable = simulation.system_count() > 0;
        let watched = steps.min(STEPS);
        let work = move || {
            for _ in 0..watched {
                let clock = ThreadTime::now();
                let stepped = simulation.step().map_err(|e| e.to_string());
                let stepped = stepped.map(|report| Timed {
                    seconds: clock.elapsed().as_secs_f64(),
                    contacts: simulation.contact_count(),
                    iterations: report.solver.iterations,
                });
                let failed = stepped.is_err();
                if sender.send(stepped).is_err() || failed {
                    return;
                }
            }
        };
        let begun = Instant::now();
        let mut last = begun;
        if let Err(e) = std::thread::Builder::new().spawn(work) {
            out.failure = Some(format!("cannot start a thread to time steps ({e})"));
            return out;
        }
        let mut end = begun + if deformable { FIRST } else { WATCHED };
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match receiver.recv_timeout(left) {
                Ok(Ok(step)) => {
                    last = Instant::now();
                    if deformable && out.timed.is_empty() {
                        end = last + WATCHED;
                    }
                    out.timed.push(step);
                }
                Ok(Err(e)) => {
                    let step = out.timed.len() + 1;
                    out.failure = Some(format!(
                        "step {step} of a trial FAILED, and a run will too: {e}"
                    ));
                    break;
                }
                Err(RecvTimeoutError::Timeout) if deformable && out.timed.is_empty() => {
                    out.failure = Some(format!(
                        "the first step, which forms what later steps keep of deformable bodies, takes more than {}",
                        amount(FIRST.as_secs_f64())
                    ));
                    break;
                }
                Err(RecvTimeoutError::Timeout) => {
                    out.pending = last.elapsed().as_secs_f64();
                    break;
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        out
    }

    /// Returns the steps that are used: the first ones build neighbour lists and have no warm
    /// start.
    fn used(&self) -> &[Timed] {
        &self.timed[self.timed.len() / 2..]
    }

    /// Returns seconds per step. An unfinished step that has taken much longer than the others
    /// counts with its time so far.
    fn step(&self) -> f64 {
        let (mean, n) = (self.mean(|t| t.seconds), self.used().len() as f64);
        if self.stuck() {
            (mean * n + self.pending) / (n + 1.0)
        } else {
            mean
        }
    }

    /// Returns whether the unfinished step has taken much longer than the others.
    fn stuck(&self) -> bool {
        self.pending > 10.0 * self.mean(|t| t.seconds).max(1e-3)
    }

    fn mean(&self, f: impl Fn(&Timed) -> f64) -> f64 {
        self.used().iter().map(f).sum::<f64>() / self.used().len() as f64
    }

    /// Returns the ratio of the contacts in a dense packing to the current ones: two per disk and
    /// three per sphere, half of the four and six neighbours of each.
    fn growth(&self) -> f64 {
        let dense = (self.grains * self.dimension) as f64;
        (dense / self.mean(|t| t.contacts as f64).max(1.0)).max(1.0)
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
        let whole = self.step() * self.steps as f64;
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
        let stuck = if self.stuck() {
            format!(", then one of more than {}", amount(self.pending))
        } else {
            String::new()
        };
        format!(
            "about {} on one thread, between {} and {}: {} steps timed, the last {} of {:.1e} s each with {:.0} contacts and {:.0} iterations{stuck}{loose}; \
             pictures and files are not counted",
            amount(about),
            amount(time.least),
            amount(time.most),
            self.timed.len(),
            self.used().len(),
            self.mean(|t| t.seconds),
            self.mean(|t| t.contacts as f64),
            self.mean(|t| f64::from(t.iterations))
        )
    }
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
