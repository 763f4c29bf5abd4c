//! How long a run will take: from a few steps of a copy of the scene, timed for a short while. Nothing is written.

use crate::step::Simulation;
use crate::step::Steps;
use crate::trade::table::seconds;
use cpu_time::ThreadTime;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How long steps are timed, by the clock.
const WATCHED: Duration = Duration::from_millis(500);

/// Most steps that are timed.
const STEPS: u64 = 2000;

/// A run takes between the estimate over this and the estimate times this: contacts and iterations change on the way. Where
/// grains are loose at the start, the upper end is also raised to the contacts of a packing.
const FACTOR: f64 = 3.0;

/// A step that was timed.
#[derive(Clone, Copy, Debug)]
struct Timed {
    /// Processor time (s).
    seconds: f64,
    contacts: usize,
    iterations: u32,
}

/// What a short trial of a scene came to.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    timed: Vec<Timed>,
    /// How long the step at work had taken when the time was up (s, by the clock); 0 where none was.
    pending: f64,
    /// Why a step failed.
    failure: Option<String>,
}

/// The seconds a run may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunTime {
    /// The best guess; none where not even one step was done in time.
    pub about: Option<f64>,
    /// It hardly takes less.
    pub least: f64,
    /// It hardly takes more; infinite where not one step was done.
    pub most: f64,
}

impl Trial {
    /// Steps a scene for a short while, in a thread of its own, which is left behind when the time is up: no scene, however
    /// large, holds the program up for longer.
    pub fn of<S: Steps>(mut simulation: Simulation<S>, steps: u64) -> Self {
        let (sender, receiver) = channel::<Result<Timed, String>>();
        let watched = steps.min(STEPS);
        let work = move || {
            for _ in 0..watched {
                let clock = ThreadTime::now();
                let told = simulation.step().map_err(|e| e.to_string());
                let told = told.map(|report| Timed {
                    seconds: clock.elapsed().as_secs_f64(),
                    contacts: simulation.network.contacts.len(),
                    iterations: report.solver.iterations,
                });
                let failed = told.is_err();
                if sender.send(told).is_err() || failed {
                    return;
                }
            }
        };
        let mut out = Self::default();
        let begun = Instant::now();
        let mut last = begun;
        if let Err(e) = std::thread::Builder::new().spawn(work) {
            out.failure = Some(format!("there is no thread to time steps on ({e})"));
            return out;
        }
        loop {
            let left = WATCHED.saturating_sub(begun.elapsed());
            match receiver.recv_timeout(left) {
                Ok(Ok(step)) => {
                    out.timed.push(step);
                    last = Instant::now();
                }
                Ok(Err(e)) => {
                    let step = out.timed.len() + 1;
                    out.failure = Some(format!(
                        "step {step} of a trial FAILED, and a run will too: {e}"
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

    /// The steps that count: the first ones make lists and start from nothing.
    fn used(&self) -> &[Timed] {
        &self.timed[self.timed.len() / 2..]
    }

    /// Seconds a step. A step at work that has taken far longer than the others counts with what it took so far.
    fn step(&self) -> f64 {
        let (mean, n) = (self.mean(|t| t.seconds), self.used().len() as f64);
        if self.stuck() {
            (mean * n + self.pending) / (n + 1.0)
        } else {
            mean
        }
    }

    /// Whether the step at work takes far longer than the others did.
    fn stuck(&self) -> bool {
        self.pending > 10.0 * self.mean(|t| t.seconds).max(1e-3)
    }

    fn mean(&self, f: impl Fn(&Timed) -> f64) -> f64 {
        self.used().iter().map(f).sum::<f64>() / self.used().len() as f64
    }

    /// How many times as many contacts a dense packing of the grains has: two a disk, three a sphere, half of the four and
    /// six neighbours that each has there.
    fn growth(&self, grains: usize, dimension: usize) -> f64 {
        let dense = (grains * dimension) as f64;
        (dense / self.mean(|t| t.contacts as f64).max(1.0)).max(1.0)
    }

    /// What a run of so many steps takes on one thread; none where a step failed.
    pub fn run_time(&self, steps: u64, grains: usize, dimension: usize) -> Option<RunTime> {
        if self.failure.is_some() {
            return None;
        }
        if self.timed.is_empty() {
            return Some(RunTime {
                about: None,
                least: WATCHED.as_secs_f64() * steps as f64 / FACTOR,
                most: f64::INFINITY,
            });
        }
        let whole = self.step() * steps as f64;
        Some(RunTime {
            about: Some(whole),
            least: whole / FACTOR,
            most: whole * FACTOR * self.growth(grains, dimension),
        })
    }

    /// A line on it.
    pub fn text(&self, steps: u64, grains: usize, dimension: usize) -> String {
        let Some(time) = self.run_time(steps, grains, dimension) else {
            return format!(
                "not estimated: {}",
                self.failure.as_deref().unwrap_or_default()
            );
        };
        let Some(about) = time.about else {
            return format!(
                "more than {}: the first step alone takes longer than {}",
                amount(time.least),
                amount(WATCHED.as_secs_f64())
            );
        };
        let loose = if self.growth(grains, dimension) > 1.5 {
            let dense = grains * dimension;
            format!("; grains are loose yet, packed they have some {dense} contacts")
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

/// A time for people.
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
        // The first, dear step does not count.
        let trial = Trial {
            timed: vec![step(1.0), step(2e-3), step(4e-3), step(4e-3)],
            ..Trial::default()
        };
        let text = trial.text(10_000, 100, 2);
        let begins = "about 40.0 s on one thread, between 13.3 s and 120 s";
        assert!(
            text.starts_with(begins) && !text.contains("loose"),
            "{text}"
        );
        // A tenth of the contacts of a packing: ten times as long at most.
        let loose = trial.text(10_000, 1000, 2);
        assert!(
            loose.contains("and 20 min") && loose.contains("some 2000 contacts"),
            "{loose}"
        );
        // A step that does not come back counts: (2 x 4 ms + 1 s)/3 each.
        let stuck = Trial {
            pending: 1.0,
            ..trial.clone()
        };
        let stuck = stuck.text(10_000, 100, 2);
        assert!(
            stuck.starts_with("about 56 min") && stuck.contains("then one of more than 1.0 s"),
            "{stuck}"
        );
        let none = Trial::default().text(1000, 1, 3);
        assert!(none.starts_with("more than 167 s"), "{none}");
        let failed = Trial {
            failure: Some("no".into()),
            ..trial
        };
        assert_eq!(failed.run_time(10, 1, 2), None);
    }
}
