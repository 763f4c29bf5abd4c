//! Runs of a case in separate processes, and their stored results, which are looked up by a key so that no
//! run is repeated.

use super::RunsError;
use super::key::Keys;
use super::perturbation::Perturbation;
use super::stored::{Finished, Limits, StoredRun, interrupted};
use crate::load;
use fretwork_core::program;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What the case would write besides numbers, and a study does not need.
const NUMBERS_ONLY: [&str; 4] = [
    "output.frames=0",
    "output.views=0",
    "output.figures=false",
    "output.checkpoint=Never",
];

/// The file in the folder of a run that is locked while it is made.
const LOCK: &str = "run.lock";

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// With a definite outcome.
    Finished(Finished),
    /// By its time limit or an interruption of the study; nothing is stored.
    Interrupted,
}

/// Which files of a run are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
pub enum Keep {
    /// Its numbers: summary, statistics and tables.
    #[default]
    Numbers,
    /// All that the case writes, and its report.
    All,
}

/// Launcher of the runs of one case.
#[derive(Debug)]
pub struct Launcher {
    /// The case.
    pub case: PathBuf,
    /// `--set` arguments of all runs.
    pub sets: Vec<String>,
    /// Plugin arguments passed to each run.
    pub plugins: Vec<String>,
    /// Folder in which runs are stored.
    pub folder: PathBuf,
    /// Limits beyond which they are not trusted.
    pub limits: Limits,
    /// Distinction of the runs if the seed changes nothing.
    pub perturbation: Option<Perturbation>,
    /// Which files are kept.
    pub keep: Keep,
    /// Threads of each run.
    pub threads: u16,
    keys: Keys,
}

impl Launcher {
    /// A launcher for a case with `--set` arguments of all runs, which stores in a folder.
    ///
    /// # Errors
    /// The path of the program cannot be determined.
    pub fn new(
        case: &Path,
        sets: &[String],
        plugins: Vec<String>,
        folder: &Path,
        limits: Limits,
    ) -> Result<Self, RunsError> {
        Ok(Self {
            case: case.to_owned(),
            sets: sets.to_vec(),
            keys: Keys::new(&plugins)?,
            plugins,
            folder: folder.to_owned(),
            limits,
            perturbation: None,
            keep: Keep::Numbers,
            threads: 1,
        })
    }

    /// Key of the case as it is and the program.
    pub fn fingerprint(&self) -> String {
        self.keys.of_run(&self.case, &self.sets)
    }

    /// Key of the program and its plugins.
    pub fn program(&self) -> String {
        self.keys.of_program()
    }

    /// Folder of a run.
    pub fn place(&self, sets: &[String], seed: u64) -> PathBuf {
        let key = self.keys.of_run(&self.case, &self.all_sets(sets, seed));
        self.folder.join(key)
    }

    /// Stored result of an earlier run, assessed by the current limits.
    pub fn stored(&self, sets: &[String], seed: u64) -> Option<Finished> {
        self.stored_in(&self.place(sets, seed))
    }

    /// Stored result of the run in a folder, unless a repetition may end differently.
    pub fn stored_in(&self, place: &Path) -> Option<Finished> {
        self.ended_in(place).filter(|run| !run.temporary)
    }

    /// How the run in a folder ended last, also if a repetition may end differently.
    pub fn ended_in(&self, place: &Path) -> Option<Finished> {
        let text = std::fs::read_to_string(place.join("run.json")).ok()?;
        let run: StoredRun = serde_json::from_str(&text).ok()?;
        Some(run.assess(&self.limits))
    }

    /// Runs to the end, to `deadline`, or for at most `bound`. If another process makes the same run, waits for it and takes its
    /// result.
    ///
    /// # Errors
    /// The process cannot be started, or the folder cannot be written.
    pub fn run(
        &self,
        sets: &[String],
        seed: u64,
        deadline: Instant,
        bound: Option<Duration>,
        stop: &AtomicBool,
    ) -> Result<Ended, RunsError> {
        let place = self.place(sets, seed);
        let fail = |e: &dyn std::fmt::Display| RunsError::write(&place, e);
        let Some(_lock) = self.lock(&place, deadline, stop)? else {
            return Ok(Ended::Interrupted);
        };
        if let Some(run) = self.stored_in(&place) {
            return Ok(Ended::Finished(run));
        }
        clear(&place).map_err(|e| fail(&e))?;
        let errors = File::create(place.join("stderr.txt")).map_err(|e| fail(&e))?;
        let started = Instant::now();
        let unstarted = |e: &dyn std::fmt::Display| {
            RunsError::Usage(format!(
                "the program cannot be started for a run: {e}; was it moved or built again meanwhile?"
            ))
        };
        let mut child = self
            .command(sets, seed, &place)
            .map_err(|e| unstarted(&e))?
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(errors)
            .spawn()
            .map_err(|e| unstarted(&e))?;
        let code = loop {
            if let Some(code) = child.try_wait().map_err(|e| fail(&e))? {
                break Some(code);
            }
            let slow = bound.is_some_and(|b| started.elapsed() > b);
            if slow || Instant::now() > deadline || stop.load(Ordering::Relaxed) {
                // It may have ended by itself meanwhile.
                let _ = child.kill();
                let _ = child.wait();
                if !slow || stop.load(Ordering::Relaxed) {
                    return Ok(Ended::Interrupted);
                }
                break None;
            }
            // The polling interval grows with the run time.
            let nap = started.elapsed() / 50;
            std::thread::sleep(nap.clamp(Duration::from_millis(2), Duration::from_millis(100)));
        };
        // Ctrl-C reaches the child process too, possibly before this program; the run then counts as
        // interrupted.
        let done = code.is_some_and(|c| c.success());
        let signalled = || interrupted(&place);
        if !done && (stop.load(Ordering::Relaxed) || signalled()) {
            return Ok(Ended::Interrupted);
        }
        let elapsed = started.elapsed().as_secs_f64();
        let left = StoredRun::read(&place, sets, seed, code.and_then(|c| c.code()), elapsed);
        let left = match code {
            Some(_) => left,
            None => left.stopped(elapsed),
        };
        let text = serde_json::to_string_pretty(&left).unwrap_or_default();
        let (draft, path) = (place.join("run.json.part"), place.join("run.json"));
        std::fs::write(&draft, text)
            .and_then(|()| std::fs::rename(&draft, &path))
            .map_err(|e| fail(&e))?;
        let finished = left.assess(&self.limits);
        if self.keep == Keep::Numbers {
            remove_states(&place);
        }
        Ok(Ended::Finished(finished))
    }

    /// The `--set` arguments of a run, all of them, the last of which counts.
    fn all_sets(&self, sets: &[String], seed: u64) -> Vec<String> {
        let mut all = [self.sets.as_slice(), sets].concat();
        let perturbation = self.perturbation.filter(|p| p.of(seed));
        let perturbed_step = perturbation.and_then(|p| {
            let step = load(&self.case, &all).ok()?.case.time.step;
            Some(p.step(step, seed))
        });
        if self.keep == Keep::Numbers {
            all.extend(NUMBERS_ONLY.map(str::to_owned));
        }
        all.push(format!("seed={seed}"));
        all.extend(perturbed_step.map(|step| format!("time.step={step:e}")));
        all
    }

    /// The words after `fretwork` that make a run by hand.
    pub fn words(&self, sets: &[String], seed: u64) -> Vec<String> {
        let mut words = vec!["run".to_owned(), self.case.display().to_string()];
        for set in self.all_sets(sets, seed) {
            words.extend(["--set".to_owned(), set]);
        }
        words.extend(self.plugins.iter().cloned());
        words
    }

    fn command(&self, sets: &[String], seed: u64, place: &Path) -> std::io::Result<Command> {
        let mut command = program::command()?;
        command.args(self.words(sets, seed)).arg("--json");
        if self.keep == Keep::Numbers {
            command.arg("--no-report");
        }
        command.arg("--out").arg(place);
        command.args(["--threads", &self.threads.to_string()]);
        Ok(command)
    }

    /// Waits until no other process makes the run in a folder; `None` if the wait was ended.
    fn lock(
        &self,
        place: &Path,
        deadline: Instant,
        stop: &AtomicBool,
    ) -> Result<Option<File>, RunsError> {
        std::fs::create_dir_all(place).map_err(|e| RunsError::write(place, &e))?;
        let path = place.join(LOCK);
        let mut options = File::options();
        let opened = options.create(true).append(true).open(&path);
        let file = opened.map_err(|e| RunsError::write(&path, &e))?;
        loop {
            match file.try_lock() {
                // Some file systems have no locks.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(Some(file)),
                Err(TryLockError::WouldBlock) => {}
            }
            if Instant::now() > deadline || stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// Removes what an earlier run left that did not end.
fn clear(place: &Path) -> std::io::Result<()> {
    for file in std::fs::read_dir(place)? {
        let path = file?.path();
        if path.is_dir() {
            std::fs::remove_dir_all(path)?;
        } else if !path.ends_with(LOCK) {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Removes states and pictures, which of every run would fill the disk.
fn remove_states(place: &Path) {
    for file in std::fs::read_dir(place).into_iter().flatten().flatten() {
        let path = file.path();
        let of_states = path.extension().is_some_and(|e| e == "vtkhdf");
        if of_states || path.ends_with("results.h5") {
            let _ = std::fs::remove_file(path);
        }
    }
    let _ = std::fs::remove_dir_all(place.join("frames"));
}
