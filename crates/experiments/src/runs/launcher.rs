//! Runs of a case in separate processes, and their stored results, which are looked up by a key so
//! that no run is repeated.

use super::key::Keys;
use super::perturbation::Perturbation;
use super::stored::{FinishedRun, Limits, StoredRun, interrupted};
use crate::{Error, RunSetup, load};
use fretwork_core::program;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Changes that switch off output of the case that an experiment does not need.
const NUMBERS_ONLY: [&str; 4] = [
    "output.frames=0",
    "output.views=0",
    "output.figures=false",
    "output.checkpoint=Never",
];

/// File in the folder of a run that is locked while it is made.
const LOCK: &str = "run.lock";

/// A run of a case: changes and seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Changes `key.path=value`, as `--set` takes them; the last of a key is used.
    pub sets: Vec<String>,
    /// Seed.
    pub seed: u64,
}

/// Time limits of a run.
#[derive(Clone, Copy, Debug)]
pub struct WaitLimits<'a> {
    /// Time at which the run is interrupted; nothing of it is then stored.
    pub deadline: Option<Instant>,
    /// Longest duration: a run that takes longer is stopped, and stored as too slow.
    pub limit: Option<Duration>,
    /// Whether to interrupt the run.
    pub stop: &'a AtomicBool,
}

impl WaitLimits<'_> {
    /// Whether the run is to be interrupted.
    fn is_over(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.deadline.is_some_and(|d| Instant::now() > d)
    }
}

/// Files of a run that are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
pub enum Keep {
    /// Numbers only: summary, statistics and tables.
    #[default]
    Numbers,
    /// All files that the case writes, and the report.
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
    /// Limits beyond which runs are not trusted.
    pub limits: Limits,
    /// Perturbation that distinguishes runs if the seed changes nothing.
    pub perturbation: Option<Perturbation>,
    /// Files that are kept.
    pub keep: Keep,
    /// Threads of each run.
    pub threads: u16,
    keys: Keys,
}

impl Launcher {
    /// Creates a launcher for a case with `--set` arguments of all runs, which stores runs in a
    /// folder.
    ///
    /// # Errors
    /// The path of the program cannot be determined.
    pub fn new(
        case: &Path,
        sets: &[String],
        setup: &RunSetup,
        folder: &Path,
        limits: Limits,
    ) -> Result<Self, Error> {
        Ok(Self {
            case: case.to_owned(),
            sets: sets.to_vec(),
            keys: Keys::new(&setup.plugins)?,
            plugins: setup.plugins.clone(),
            folder: folder.to_owned(),
            limits,
            perturbation: None,
            keep: Keep::Numbers,
            threads: 1,
        })
    }

    /// Distinguishes runs by their steps where the seed changes nothing; `first` is the first seed.
    pub fn perturb_unless(&mut self, random: bool, first: u64) {
        self.perturbation = (!random).then_some(Perturbation { first });
    }

    /// Returns the key of the case itself and the program.
    pub fn fingerprint(&self) -> String {
        self.keys.of_run(&self.case, &self.sets)
    }

    /// Returns the key of the program and its plugins.
    pub fn program(&self) -> String {
        self.keys.of_program()
    }

    /// Returns the folder of a run.
    pub fn place(&self, run: &Run) -> PathBuf {
        let key = self.keys.of_run(&self.case, &self.all_sets(run));
        self.folder.join(key)
    }

    /// Returns the stored result of an earlier run, assessed by the current limits.
    pub fn stored(&self, run: &Run) -> Option<FinishedRun> {
        self.stored_in(&self.place(run))
    }

    /// Returns the stored result of the run in a folder, unless a repetition may end differently.
    pub fn stored_in(&self, place: &Path) -> Option<FinishedRun> {
        self.ended_in(place).filter(|run| !run.temporary)
    }

    /// Returns how the run in a folder ended last, even if a repetition may end differently.
    pub fn ended_in(&self, place: &Path) -> Option<FinishedRun> {
        let text = std::fs::read_to_string(place.join("run.json")).ok()?;
        let run: StoredRun = serde_json::from_str(&text).ok()?;
        Some(run.assess(&self.limits))
    }

    /// Makes a run; `None` if it was interrupted. If another process is making it, waits for that
    /// process and uses its result.
    ///
    /// # Errors
    /// The process cannot be started, or the folder cannot be written.
    pub fn run(&self, run: &Run, wait: WaitLimits<'_>) -> Result<Option<FinishedRun>, Error> {
        let place = self.place(run);
        let fail = |e: std::io::Error| Error::write(&place, &e);
        let Some(_lock) = lock(&place, wait)? else {
            return Ok(None);
        };
        if let Some(stored) = self.stored_in(&place) {
            return Ok(Some(stored));
        }
        clear(&place).map_err(fail)?;
        let errors = File::create(place.join("stderr.txt")).map_err(fail)?;
        let started = Instant::now();
        let mut child = self.start(run, &place, errors)?;
        let code = loop {
            if let Some(code) = child.try_wait().map_err(fail)? {
                break Some(code);
            }
            let slow = wait.limit.is_some_and(|l| started.elapsed() > l);
            if slow || wait.is_over() {
                // The process may have ended by itself meanwhile.
                let _ = child.kill();
                let _ = child.wait();
                if !slow || wait.stop.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                break None;
            }
            // The polling interval grows with the run time.
            let nap = started.elapsed() / 50;
            std::thread::sleep(nap.clamp(Duration::from_millis(2), Duration::from_millis(100)));
        };
        // Ctrl-C reaches the child process too, possibly before this program; the run then counts
        // as interrupted.
        let done = code.is_some_and(|c| c.success());
        if !done && (wait.stop.load(Ordering::Relaxed) || interrupted(&place)) {
            return Ok(None);
        }
        let elapsed = started.elapsed().as_secs_f64();
        let exit = code.and_then(|c| c.code());
        let mut left = StoredRun::read(&place, run, exit, elapsed);
        if code.is_none() {
            left = left.stopped(elapsed);
        }
        let text = serde_json::to_string_pretty(&left).unwrap_or_default();
        let (draft, path) = (place.join("run.json.part"), place.join("run.json"));
        std::fs::write(&draft, text)
            .and_then(|()| std::fs::rename(&draft, &path))
            .map_err(fail)?;
        if self.keep == Keep::Numbers {
            remove_states(&place);
        }
        Ok(Some(left.assess(&self.limits)))
    }

    /// Returns all `--set` arguments of a run, of which the last for a key is used.
    fn all_sets(&self, run: &Run) -> Vec<String> {
        let mut all = [self.sets.as_slice(), &run.sets].concat();
        let perturbation = self.perturbation.filter(|p| p.of(run.seed));
        let perturbed_step = perturbation.and_then(|p| {
            let step = load(&self.case, &all).ok()?.case.time.step;
            Some(p.step(step, run.seed))
        });
        if self.keep == Keep::Numbers {
            all.extend(NUMBERS_ONLY.map(str::to_owned));
        }
        all.push(format!("seed={}", run.seed));
        all.extend(perturbed_step.map(|step| format!("time.step={step:e}")));
        all
    }

    fn start(&self, run: &Run, place: &Path, errors: File) -> Result<Child, Error> {
        let child = program::command().and_then(|mut command: Command| {
            command.arg("run").arg(&self.case);
            for set in self.all_sets(run) {
                command.args(["--set", &set]);
            }
            command.args(&self.plugins).arg("--json");
            if self.keep == Keep::Numbers {
                command.arg("--no-report");
            }
            command.arg("--out").arg(place);
            command.args(["--threads", &self.threads.to_string()]);
            command
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(errors);
            command.spawn()
        });
        child.map_err(|e| {
            Error::Usage(format!(
                "the program cannot be started for a run: {e}; was it moved or built again meanwhile?"
            ))
        })
    }
}

/// Waits until no other process makes the run in a folder; `None` if the wait was ended.
fn lock(place: &Path, wait: WaitLimits<'_>) -> Result<Option<File>, Error> {
    std::fs::create_dir_all(place).map_err(|e| Error::write(place, &e))?;
    let path = place.join(LOCK);
    let mut options = File::options();
    let opened = options.create(true).append(true).open(&path);
    let file = opened.map_err(|e| Error::write(&path, &e))?;
    loop {
        match file.try_lock() {
            // Some file systems have no locks.
            Ok(()) | Err(TryLockError::Error(_)) => return Ok(Some(file)),
            Err(TryLockError::WouldBlock) => {}
        }
        if wait.is_over() {
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Removes files of an earlier run that did not end.
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

/// Removes states and pictures, which would fill the disk if every run kept them.
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
