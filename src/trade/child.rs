//! Runs of a case in separate processes, and their stored results, which are looked up by a key so that no
//! run is repeated.

use super::TradeError;
use super::chaos::Perturbation;
use super::output::column;
use super::parameters::openings;
use crate::program;
use crate::scene::Loaded;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// It finished, and can be compared.
    Done,
    /// It failed, was rejected or is not trustworthy: reason.
    Failed(String),
    /// It was stopped after this many seconds, as slower than the reference.
    Slow(f64),
}

/// Contents of `run.json` for a run that ended by itself: numbers only, assessed whenever they are read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StoredRun {
    sets: Vec<String>,
    seed: u64,
    /// Exit code.
    exit: i32,
    /// First line of its output on stderr.
    said: String,
    steps: Option<f64>,
    unconverged: f64,
    uncoupled: f64,
    /// `None` if the energy is not finite.
    residual: Option<f64>,
    seconds: f64,
    wall: f64,
    visits: f64,
    /// Words of the reasons why the run says that it is not trustworthy.
    #[serde(default)]
    doubts: Vec<String>,
}

impl StoredRun {
    /// Whether a repetition may end differently: the run was rejected (files may have changed), could not
    /// write, or left nothing.
    fn temporary(&self) -> bool {
        match self.exit {
            0 => self.steps.is_none(),
            1 => self.said.contains("cannot write") || self.said.contains("No space left"),
            _ => true,
        }
    }
}

/// A run that ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// Outcome.
    pub status: Status,
    /// Whether a failure may be temporary: it is not stored, and the next study tries again.
    pub temporary: bool,
    /// The `--set` arguments of the run.
    pub sets: Vec<String>,
    /// Seed of the run.
    pub seed: u64,
    /// Processor time of the steps (s).
    pub seconds: f64,
    /// Wall time of the whole run (s).
    pub wall: f64,
    /// Contacts times iterations, summed over the steps: a machine-independent measure of cost.
    pub visits: f64,
    /// Words of the reasons why the run says that it is not trustworthy, `NOT SMALL STRAIN`; none of one that is.
    pub doubts: Vec<String>,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// With a definite outcome.
    Finished(Finished),
    /// By its time limit or an interruption of the study; nothing is stored.
    Interrupted,
}

/// Limits beyond which a run is not trusted.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Fraction of steps that may miss the tolerance.
    pub unconverged: f64,
    /// Energy residual over the largest energy.
    pub residual: f64,
}

/// Launcher of the runs of one case.
#[derive(Debug)]
pub struct Launcher {
    /// The case.
    pub case: PathBuf,
    /// `--set` arguments of the user.
    pub sets: Vec<String>,
    /// Plugin arguments passed to each run.
    pub plugins: Vec<String>,
    /// Folder in which runs are stored.
    pub folder: PathBuf,
    /// Limits beyond which they are not trusted.
    pub limits: Limits,
    /// Distinction of the runs if the seed changes nothing.
    pub perturbation: Option<Perturbation>,
    fingerprint: String,
}

impl Launcher {
    /// A launcher for a case with the materials it reads, `(name, text)`.
    ///
    /// # Errors
    /// The path of the program cannot be determined, or the folder cannot be created.
    pub fn new(
        loaded: &Loaded,
        materials: &[(String, String)],
        plugins: Vec<String>,
        out: &Path,
        limits: Limits,
    ) -> Result<Self, TradeError> {
        let unknown = |e: &dyn std::fmt::Display| {
            TradeError::Usage(format!("the path of the program cannot be determined: {e}"))
        };
        program::command().map_err(|e| unknown(&e))?;
        let file = program::file().map_err(|e| unknown(&e))?;
        let mut hash = Sha256::new();
        hash.update(std::fs::read(&file).map_err(|e| unknown(&e))?);
        hash.update(loaded.source.text());
        for (name, text) in materials {
            hash.update(name);
            hash.update(text);
        }
        for word in &plugins {
            hash.update(word);
        }
        let folder = out.join("runs");
        std::fs::create_dir_all(&folder).map_err(|e| TradeError::write(&folder, &e))?;
        Ok(Self {
            case: loaded.path.clone(),
            sets: [loaded.source.sets(), &openings(loaded)].concat(),
            plugins,
            folder,
            limits,
            perturbation: None,
            fingerprint: hex(&hash.finalize()),
        })
    }

    /// Hash that identifies the case and the program.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }

    /// Folder of a run.
    pub fn place(&self, sets: &[String], seed: u64) -> PathBuf {
        let mut hash = Sha256::new();
        hash.update(&self.fingerprint);
        for set in sets {
            hash.update(set);
            hash.update([0]);
        }
        hash.update(seed.to_le_bytes());
        self.folder.join(&hex(&hash.finalize())[..16])
    }

    /// Stored result of an earlier run, assessed by the current limits.
    pub fn stored(&self, sets: &[String], seed: u64) -> Option<Finished> {
        let text = std::fs::read_to_string(self.place(sets, seed).join("run.json")).ok()?;
        let run: StoredRun = serde_json::from_str(&text).ok()?;
        (!run.temporary()).then(|| self.assess(run))
    }

    /// Runs to the end, to `deadline`, or for at most `bound`.
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
    ) -> Result<Ended, TradeError> {
        let place = self.place(sets, seed);
        let fail = |e: &dyn std::fmt::Display| TradeError::write(&place, e);
        if place.exists() {
            std::fs::remove_dir_all(&place).map_err(|e| fail(&e))?;
        }
        std::fs::create_dir_all(&place).map_err(|e| fail(&e))?;
        let errors = std::fs::File::create(place.join("stderr.txt")).map_err(|e| fail(&e))?;
        let started = Instant::now();
        let mut child = self
            .command(sets, seed, &place)
            .map_err(|e| fail(&e))?
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(errors)
            .spawn()
            .map_err(|e| fail(&e))?;
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
        let left = read_run(&place, sets, seed, code.and_then(|c| c.code()), elapsed);
        let finished = match code.map(|c| c.code()) {
            Some(Some(_)) => {
                if !left.temporary() {
                    let text = serde_json::to_string_pretty(&left).unwrap_or_default();
                    let (draft, path) = (place.join("run.json.part"), place.join("run.json"));
                    std::fs::write(&draft, text)
                        .and_then(|()| std::fs::rename(&draft, &path))
                        .map_err(|e| fail(&e))?;
                }
                self.assess(left)
            }
            ended => {
                let mut run = self.assess(left);
                run.temporary = true;
                run.status = match ended {
                    None => Status::Slow(elapsed),
                    _ => Status::Failed("ended by a signal".into()),
                };
                run
            }
        };
        // Only the numbers are kept; states and pictures of every setting would fill the disk.
        for file in std::fs::read_dir(&place).into_iter().flatten().flatten() {
            let path = file.path();
            let of_states = path.extension().is_some_and(|e| e == "vtkhdf");
            if of_states || path.ends_with("results.h5") {
                let _ = std::fs::remove_file(path);
            }
        }
        let _ = std::fs::remove_dir_all(place.join("frames"));
        Ok(Ended::Finished(finished))
    }

    fn command(&self, sets: &[String], number: u64, place: &Path) -> std::io::Result<Command> {
        let mut command = program::command()?;
        command
            .arg("run")
            .arg(&self.case)
            .args(["--json", "--no-report"]);
        command.arg("--out").arg(place).args(["--threads", "1"]);
        let quiet = [
            "output.frames=0",
            "output.views=0",
            "output.figures=false",
            "output.checkpoint=Never",
        ];
        let seed = format!("seed={number}");
        let all: Vec<&str> = self.sets.iter().chain(sets).map(String::as_str).collect();
        let perturbed_step = self.perturbed_step(&all, number);
        let last = [seed.as_str()].into_iter().chain(perturbed_step.as_deref());
        for set in all.into_iter().chain(quiet).chain(last) {
            command.args(["--set", set]);
        }
        command.args(&self.plugins);
        Ok(command)
    }

    fn assess(&self, run: StoredRun) -> Finished {
        let temporary = run.temporary();
        let status = match run.exit {
            0 => self.rejection(&run).map_or(Status::Done, Status::Failed),
            code => {
                let what = if code == 2 { "refused" } else { "failed" };
                Status::Failed(format!("{what}: {}", run.said))
            }
        };
        Finished {
            status,
            temporary,
            sets: run.sets,
            seed: run.seed,
            seconds: run.seconds,
            wall: run.wall,
            visits: run.visits,
            doubts: run.doubts,
        }
    }

    /// Reason why a finished run is not trusted.
    fn rejection(&self, run: &StoredRun) -> Option<String> {
        let Some(steps) = run.steps else {
            return Some("it wrote no summary".into());
        };
        let most = self.limits.unconverged * steps.max(1.0);
        if run.unconverged > most {
            let missed = run.unconverged;
            return Some(format!("{missed} of {steps} steps did not converge"));
        }
        if run.uncoupled > most {
            return Some(format!(
                "{} of {steps} steps did not converge in the damage coupling",
                run.uncoupled
            ));
        }
        match run.residual {
            Some(r) if r.abs() <= self.limits.residual => None,
            Some(r) => Some(format!(
                "its energy residual is {:.1} % of the largest energy",
                100.0 * r.abs()
            )),
            None => Some("its energy is not finite".into()),
        }
    }
}

/// Whether a run reports that a signal ended it.
fn interrupted(place: &Path) -> bool {
    summary(place)["interrupted"] == Value::Bool(true)
}

/// Result that a run left in its folder; `exit` is `None` if it did not end by itself.
fn read_run(
    place: &Path,
    sets: &[String],
    seed: u64,
    exit: Option<i32>,
    elapsed: f64,
) -> StoredRun {
    let summary = summary(place);
    let number = |key: &str| summary.pointer(key).and_then(Value::as_f64);
    let said = std::fs::read_to_string(place.join("stderr.txt")).unwrap_or_default();
    let reasons = summary["reasons"].as_array().into_iter().flatten();
    let doubts = reasons.filter_map(Value::as_str).map(words).collect();
    let first = said.lines().next().unwrap_or("no reason was given");
    StoredRun {
        sets: sets.to_vec(),
        seed,
        exit: exit.unwrap_or(-1),
        said: first.trim_start_matches("error: ").to_owned(),
        steps: number("/steps"),
        unconverged: number("/solver/unconverged_steps").unwrap_or(0.0),
        uncoupled: number("/solver/uncoupled_steps").unwrap_or(0.0),
        residual: number("/energy_residual_relative"),
        seconds: number("/cpu_seconds").unwrap_or(elapsed),
        wall: elapsed,
        visits: visits(place, number("/steps").unwrap_or(0.0)),
        doubts,
    }
}

/// The words in capitals that a reason begins with; the reason itself where there are none.
fn words(reason: &str) -> String {
    let first = reason.split(':').next().unwrap_or(reason);
    first.trim().to_owned()
}

/// Summary of a run; null if there is none.
pub fn summary(place: &Path) -> Value {
    std::fs::read_to_string(place.join("summary.json"))
        .ok()
        .and_then(|text| serde_json::from_str(&text).ok())
        .unwrap_or(Value::Null)
}

/// Contacts times iterations over all steps, estimated from the rows of the statistics.
fn visits(place: &Path, steps: f64) -> f64 {
    let path = place.join("statistics.csv");
    let both = column(&path, "contacts").zip(column(&path, "iterations"));
    both.map_or(0.0, |(c, i)| {
        let sum: f64 = c.iter().zip(&i).map(|(c, i)| c * i).sum();
        steps * sum / c.len() as f64
    })
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stored run is assessed by the current limits; a failure that may be temporary is not stored.
    #[test]
    fn a_stored_run_is_assessed_by_todays_limits() {
        let run = |exit, said: &str| StoredRun {
            sets: Vec::new(),
            seed: 1,
            exit,
            said: said.into(),
            steps: Some(100.0),
            unconverged: 3.0,
            uncoupled: 0.0,
            residual: Some(1e-4),
            seconds: 1.0,
            wall: 1.0,
            visits: 1.0,
            doubts: Vec::new(),
        };
        let folder = std::env::temp_dir().join(format!("fretwork-kept-{}", std::process::id()));
        let mut launcher = Launcher {
            case: PathBuf::new(),
            sets: Vec::new(),
            plugins: Vec::new(),
            folder: folder.clone(),
            limits: Limits {
                unconverged: 0.01,
                residual: 0.01,
            },
            perturbation: None,
            fingerprint: String::new(),
        };
        let place = launcher.place(&[], 1);
        std::fs::create_dir_all(&place).unwrap();
        let text = serde_json::to_string(&run(0, "")).unwrap();
        std::fs::write(place.join("run.json"), text).unwrap();
        let strict = launcher.stored(&[], 1).unwrap().status;
        launcher.limits.unconverged = 0.05;
        let lenient = launcher.stored(&[], 1).unwrap().status;
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(matches!(strict, Status::Failed(why) if why.contains("3 of 100 steps")));
        assert_eq!(lenient, Status::Done);
        assert!(run(1, "cannot write x: full").temporary() && run(2, "no such mesh").temporary());
        assert!(!run(1, "a body left the domain").temporary() && !run(0, "").temporary());
    }
}
